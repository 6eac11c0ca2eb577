//! Parser: any text is an error at a place in it, or a formula that prints as text that parses to the same formula.
#![no_main]

mod names;

use libfuzzer_sys::fuzz_target;
use names::BOUND;
use polhode_ga::formula::{Error, Names, Node, Space, Span, Style, Tree, compile, parse};

// The first byte selects the names; the rest is the text.
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
                check_round_trip(&tree, names);
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

/// Call it far from the limits only: the canonical text may be longer and deeper than the original.
fn check_round_trip(tree: &Tree, names: &Names) {
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
