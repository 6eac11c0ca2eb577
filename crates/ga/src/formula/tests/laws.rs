//! What holds for every tree and for every text.

use super::build::*;
use super::*;
use proptest::prelude::*;

/// The names that trees and texts below use; `I` is a map, too, and two names look like others called.
fn names() -> Names {
    let value = |name: &str| (name.to_owned(), Meaning::Value(Type::of(Grades::ALL)));
    let mut names = Names::new(NAMES.map(value));
    names.bind("inertia".to_owned(), Meaning::Map { grade: 2 });
    names.bind("I".to_owned(), Meaning::Map { grade: 2 });
    names.bind("F".to_owned(), Meaning::Map { grade: 1 });
    define("c", "0.1 e3", Space::g3(), &mut names).unwrap();
    define("V(u)", "½ u·u + c", Space::g3(), &mut names).unwrap();
    names
}

/// Formulas as they are written.
const WRITTEN: [&str; 24] = [
    "R x ~R + (a∧b)·x",
    "-½ Ω_B R",
    "½ΩR",
    "RaR̃",
    "a∧b∧x = x∧a∧b",
    "a^b|x",
    "exp(-θ/2 e1∧e2) e1",
    "e^(-e12 θ/2) a",
    "⟨a b⟩_2 + <a b>_{0,2} - ⟨R ~R⟩",
    "inertia(B×Ω_B) ~R",
    "Σ_k f_k I e_k",
    "f_k = R e_k ~R",
    "(~R)' = -~R R' ~R",
    "a⁻¹ b² a^-1 b†",
    "left_contraction(a, B) + a⌋B",
    "cross(a, b) = a⨯b = −I a∧b",
    "B1² + 1e-3 a₁ + 2.5e+7",
    "V(x + a∥) / 2",
    "{a [b (x + 1)]}",
    "norm(a∧b) sqrt(2) log(R) sin(θ)",
    "a″ + f_k' ",
    "x/2a",
    "a·b∧x",
    "omega_body spin e1e2e3 e123",
];

/// Text over the language's own signs.
fn alphabet() -> impl Strategy<Value = String> {
    let pieces: Vec<&'static str> = concat!(
        "a b B R x θ Ω_B Ω _ _k _1 ₁ ₖ ' ′ ’ ″ e e1 e12 e0 e9 I π pi 0 1 2 7 12 0.5 .5 5. 1e-3 2e1 ½ ⅓ ² ³ ⁻¹ ⁻ + - − * / ",
        "^ ∧ · ⋅ | × ⨯ ⌋ ⌊ ~ † ( ) [ ] { } ⟨ ⟩ < > = == , ; Σ_k Σ sum_k sum exp( log( sqrt( inertia( V( F norm( wedge( ",
        "cross( commutator( ∥ ⊥ \u{303} \u{302} ã â ϕ ᾰ 𝛺 K \u{200b} ⟩_2 >_2 ⟩_{0,2} ^-1 ^2 spin omega_body f_k f1 R(0)",
    )
    .split(' ')
    .collect();
    let piece = prop_oneof![8 => proptest::sample::select(pieces), 3 => Just(" "), 1 => Just("\n")];
    proptest::collection::vec(piece, 0..60).prop_map(|pieces| pieces.concat())
}

/// A formula cut anywhere, and another one's end put there.
fn spliced() -> impl Strategy<Value = String> {
    let one = proptest::sample::select(&WRITTEN);
    (one.clone(), one, any::<prop::sample::Index>(), any::<prop::sample::Index>()).prop_map(|(a, b, i, j)| {
        let cut = |text: &str, at: prop::sample::Index| at.index(text.chars().count() + 1);
        let head: String = a.chars().take(cut(a, i)).collect();
        let tail: String = b.chars().skip(cut(b, j)).collect();
        head + &tail
    })
}

fn any_text() -> impl Strategy<Value = String> {
    prop_oneof![2 => any::<String>(), 1 => "\\PC*", 6 => alphabet(), 4 => spliced()]
}

/// Formulas of letters that run together and brackets.
fn letters_in_brackets() -> impl Strategy<Value = String> {
    let pieces: Vec<&str> =
        "a b B x θ 2 ab aB Bθx (ab) (aB) ((xθ)) ( ( ) ) ~ ~( - + / /( ² ^2 · · ∧ × * = exp( norm("
            .split(' ')
            .collect();
    let piece = prop_oneof![20 => proptest::sample::select(pieces), 4 => Just(" "), 1 => Just(" e^(")];
    // The minus of one operand, `a·−b`, is printed in brackets.
    let is_sum = |text: &String| {
        let plain = text.replace(' ', "");
        !plain
            .match_indices('-')
            .any(|(at, _)| plain[..at].ends_with(['~', '·', '∧', '×', '*', '/', '+', '-']))
    };
    proptest::collection::vec(piece, 1..12).prop_map(|pieces| pieces.concat()).prop_filter("a sign", is_sum)
}

/// Whether each part lies in the text, between characters, and within what it is a part of.
fn spans_are_places(node: &Node, text: &str, outer: Span) -> Result<(), TestCaseError> {
    let Span { start, end } = node.span;
    prop_assert!(outer.start <= start && start < end && end <= outer.end, "{start}..{end} of {text:?}");
    prop_assert!(text.is_char_boundary(start) && text.is_char_boundary(end), "{start}..{end} of {text:?}");
    node.children().into_iter().try_for_each(|child| spans_are_places(child, text, node.span))
}

/// What is true of any text with any names.
pub(super) fn is_read_or_refused(text: &str, names: &Names) -> Result<(), TestCaseError> {
    let whole = Span { start: 0, end: text.len() };
    match parse(text, Space::g3(), names) {
        Ok(tree) => {
            tree.sides.iter().try_for_each(|side| spans_are_places(side, text, whole))?;
            prints_and_is_read_again(&tree, names)?;
            if let Err(error) = compile(&tree, Space::g3(), names) {
                error_has_a_place(&error, text)?;
            }
        }
        Err(error) => error_has_a_place(&error, text)?,
    }
    Ok(())
}

fn error_has_a_place(error: &Error, text: &str) -> Result<(), TestCaseError> {
    let Span { start, end } = error.span;
    prop_assert!(start <= end && end <= text.len(), "{start}..{end} of {text:?}: {error}");
    prop_assert!(text.is_char_boundary(start) && text.is_char_boundary(end), "{start}..{end} of {text:?}");
    prop_assert!(!error.message.is_empty());
    prop_assert!(error.shown(text).lines().last().is_some_and(|line| line.ends_with('^')));
    Ok(())
}

fn prints_and_is_read_again(tree: &Tree, names: &Names) -> Result<(), TestCaseError> {
    for style in [Style::Unicode, Style::Ascii] {
        let text = tree.text(style);
        match parse(&text, Space::g3(), names) {
            Ok(again) => {
                prop_assert_eq!(&again, tree, "{}", text);
                prop_assert_eq!(again.text(style), text);
            }
            Err(error) => prop_assert!(false, "{}\n{tree:?}", error.shown(&text)),
        }
    }
    prop_assert!(!tree.latex().is_empty());
    Ok(())
}

/// `a b c` for `(a b) c`, throughout.
fn without_inner_products(mut node: Node) -> Node {
    for child in node.children_mut() {
        *child = without_inner_products(child.clone());
    }
    if let Kind::Product(factors) = node.kind {
        let spread = |factor: Node| match factor.kind {
            Kind::Product(inner) => inner,
            _ => vec![factor],
        };
        node.kind = Kind::Product(factors.into_iter().flat_map(spread).collect());
    }
    node
}

proptest! {
    #[test]
    fn a_tree_prints_as_text_that_is_read_as_the_same_tree(tree in any_tree()) {
        prints_and_is_read_again(&tree, &names())?;
    }

    /// Names that are still open may become letters: no bracket that matters then may be lost.
    #[test]
    fn brackets_around_open_names_are_kept(text in letters_in_brackets()) {
        let Ok(tree) = parse(&text, Space::g3(), &Names::open()) else { return Ok(()) };
        prints_and_is_read_again(&tree, &Names::open())?;
        let Ok(letters) = parse(&text, Space::g3(), &names()) else { return Ok(()) };
        let printed = tree.text(Style::Unicode);
        let again = parse(&printed, Space::g3(), &names());
        let plain = |tree: Tree| tree.sides.into_iter().map(without_inner_products).collect::<Vec<_>>();
        prop_assert_eq!(again.map(plain), Ok(plain(letters)), "{}", printed);
    }

    #[test]
    fn any_text_is_read_or_refused_with_a_place(text in any_text()) {
        is_read_or_refused(&text, &names())?;
        is_read_or_refused(&text, &Names::open())?;
        is_read_or_refused(&text, &Names::default())?;
    }
}
