//! Any text is a formula, which prints as text that is read as the same formula, or is refused at a place in it.
#![no_main]

use libfuzzer_sys::fuzz_target;
use polhode_ga::formula::{Error, Meaning, Names, Node, Space, Span, Style, Tree, Type, compile, define, parse};
use polhode_ga::product::Grades;
use std::sync::LazyLock;

static BOUND: LazyLock<Names> = LazyLock::new(|| {
    let vectors = ["a", "b", "x", "a∥", "f1", "f2", "f3"].map(|name| (name, Grades(0b0010)));
    let others = [("B", Grades::BIVECTOR), ("M", Grades::ALL), ("θ", Grades::SCALAR), ("a'", Grades::ALL)];
    let values = vectors.into_iter().chain(others).map(|(name, grades)| (name, Type::of(grades)));
    let values = values.chain([("R", Type::ROTOR), ("spin", Type::ROTOR)]);
    let mut names = Names::new(values.map(|(name, ty)| (name.to_owned(), Meaning::Value(ty))));
    names.bind("I".to_owned(), Meaning::Map { grade: 2 });
    names.bind("F".to_owned(), Meaning::Map { grade: 1 });
    define("V(x)", "½ x·x", Space::g3(), &mut names).expect("a formula");
    names
});

// The first byte says what the names are; the text follows.
fuzz_target!(|data: (u8, &str)| {
    let (choice, text) = data;
    match choice % 3 {
        0 => check(text, &BOUND),
        1 => check(text, &Names::open()),
        _ => check(text, &Names::default()),
    }
});

fn check(text: &str, names: &Names) {
    match parse(text, Space::g3(), names) {
        Ok(tree) => {
            tree.sides.iter().for_each(|side| check_spans(side, text));
            if tree.nodes().len() < 500 && tree.sides.iter().map(height).max() < Some(40) {
                is_read_again(&tree, names);
            }
            if let Err(error) = compile(&tree, Space::g3(), names) {
                check_error(&error, text);
            }
        }
        Err(error) => check_error(&error, text),
    }
}

fn height(node: &Node) -> usize {
    1 + node.children().into_iter().map(height).max().unwrap_or(0)
}

/// Far from the limits, for the canonical text may be longer and deeper than the one that was read.
fn is_read_again(tree: &Tree, names: &Names) {
    for style in [Style::Unicode, Style::Ascii] {
        let text = tree.text(style);
        let again = parse(&text, Space::g3(), names).unwrap_or_else(|error| panic!("{}", error.shown(&text)));
        assert_eq!(&again, tree, "{text}");
        assert_eq!(again.text(style), text);
    }
    assert!(!tree.latex().is_empty());
}

fn check_error(error: &Error, text: &str) {
    check_span(error.span, text);
    assert!(error.shown(text).ends_with('^'));
}

fn check_spans(node: &Node, text: &str) {
    check_span(node.span, text);
    node.children().into_iter().for_each(|child| check_spans(child, text));
}

fn check_span(span: Span, text: &str) {
    assert!(text.get(span.start..span.end).is_some(), "{span:?} of {text:?}");
}
