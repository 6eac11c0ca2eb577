//! Trees by hand and at random, for tests.

use crate::formula::Number;
use crate::formula::syntax::number::FRACTIONS;
use crate::formula::syntax::tree::{Kind, Named, Node, Span, Tight, Tree};
use crate::g3::functions::Function;
use crate::product::Grades;
use proptest::prelude::*;

pub(crate) fn node(kind: Kind) -> Node {
    Node::new(kind, Span::default())
}

pub(crate) fn tree(sides: impl Into<Vec<Node>>) -> Tree {
    Tree { sides: sides.into() }
}

/// A name; digits make a number, `I` and `e1` blades, `½` a half.
pub(crate) fn x(text: &str) -> Node {
    node(match text {
        "½" => Kind::Number(Number::ratio(1, 2).unwrap()),
        "π" => Kind::Pi,
        "I" => Kind::Pseudoscalar,
        "e1" => Kind::Blade(vec![1]),
        "e2" => Kind::Blade(vec![2]),
        "e12" => Kind::Blade(vec![1, 2]),
        _ => Number::decimal(text).map_or_else(|| Kind::Name(text.to_owned()), Kind::Number),
    })
}

pub(crate) fn minus(a: Node) -> Node {
    node(Kind::Sum(vec![(true, a)]))
}

pub(crate) fn plus(a: Node, b: Node) -> Node {
    node(Kind::Sum(vec![(false, a), (false, b)]))
}

pub(crate) fn product(factors: impl Into<Vec<Node>>) -> Node {
    node(Kind::Product(factors.into()))
}

pub(crate) fn over(a: Node, b: Node) -> Node {
    node(Kind::Quotient(Box::new((a, b))))
}

pub(crate) fn tight(tight: Tight, operands: impl Into<Vec<Node>>) -> Node {
    node(Kind::Tight(tight, operands.into()))
}

pub(crate) fn wedge(a: Node, b: Node) -> Node {
    tight(Tight::Wedge, [a, b])
}

pub(crate) fn reverse(a: Node) -> Node {
    node(Kind::Reverse(Box::new(a)))
}

pub(crate) fn power(a: Node, n: i32) -> Node {
    node(Kind::Power(Box::new(a), n))
}

pub(crate) fn part(a: Node, grades: u16) -> Node {
    node(Kind::Part(Box::new(a), Grades(grades)))
}

pub(crate) fn exp(a: Node) -> Node {
    node(Kind::Function(Named::Function(Function::Exp), Box::new(a)))
}

pub(crate) fn function(f: Named, a: Node) -> Node {
    node(Kind::Function(f, Box::new(a)))
}

pub(crate) fn call(name: &str, arguments: impl Into<Vec<Node>>) -> Node {
    node(Kind::Call(name.to_owned(), arguments.into()))
}

pub(crate) fn derivative(a: Node) -> Node {
    node(Kind::Derivative(Box::new(a)))
}

pub(crate) fn total(index: &str, a: Node) -> Node {
    node(Kind::Total(index.to_owned(), Box::new(a)))
}

/// Names of values in random trees.
pub(crate) const NAMES: [&str; 16] =
    ["a", "b", "B", "R", "x", "θ", "Ω_B", "a'", "f1", "f2", "f3", "a∥", "R(0)", "R(x)", "spin", "omega_body"];

fn number() -> impl Strategy<Value = Node> {
    let whole = (0u32..2000).prop_map(|n| n.to_string());
    let decimal = (0u32..2000, "[0-9]{0,16}[1-9]").prop_map(|(n, part)| format!("{n}.{part}"));
    let power = (1u32..100, 1u32..40).prop_map(|(n, e)| format!("{n}e-{e}"));
    let large = (1u32..100, 1u32..40).prop_map(|(n, e)| format!("{n}e+{e}"));
    let written = prop_oneof![8 => whole, 2 => decimal, 1 => power, 1 => large]
        .prop_map(|text| node(Kind::Number(Number::decimal(&text).unwrap())));
    let fraction = proptest::sample::select(&FRACTIONS)
        .prop_map(|(_, n, d)| node(Kind::Number(Number::ratio(n.into(), d.into()).unwrap())));
    prop_oneof![4 => written, 1 => fraction]
}

fn leaf() -> impl Strategy<Value = Node> {
    let blades =
        prop_oneof![Just(vec![1]), Just(vec![3]), Just(vec![1, 2]), Just(vec![3, 1]), Just(vec![1, 2, 3])];
    prop_oneof![
        6 => proptest::sample::select(&NAMES).prop_map(x),
        2 => blades.prop_map(|blade| node(Kind::Blade(blade))),
        1 => Just(x("I")),
        2 => number(),
        1 => Just(x("π")),
    ]
}

/// Whether a sign before it or nothing is between the number and a `∧` before it.
fn is_number(node: &Node) -> bool {
    match &node.kind {
        Kind::Number(_) => true,
        Kind::Sum(terms) => terms.len() == 1 && is_number(&terms[0].1),
        _ => false,
    }
}

/// Any part of a formula that a text can stand for.
pub(crate) fn any_node() -> impl Strategy<Value = Node> {
    leaf().prop_recursive(5, 40, 4, |inner| {
        let functions: Vec<Named> = Named::ALL.into_iter().filter(|f| *f != Named::Reverse).collect();
        let some = |least| proptest::collection::vec(inner.clone(), least..5);
        let sum = proptest::collection::vec((any::<bool>(), inner.clone()), 2..5);
        let pair = (inner.clone(), inner.clone());
        let chain = some(3).prop_filter("an exponent", |operands| !operands[1..].iter().any(is_number));
        prop_oneof![
            3 => sum.prop_map(|terms| node(Kind::Sum(terms))),
            2 => inner.clone().prop_map(minus),
            4 => some(2).prop_map(product),
            2 => pair.clone().prop_filter_map("a fraction", |(a, b)| {
                let numbers = matches!((&a.kind, &b.kind), (Kind::Number(_), Kind::Number(_)));
                (!numbers).then(|| over(a, b))
            }),
            2 => (proptest::sample::select(&Tight::ALL), pair).prop_map(|(t, (a, b))| tight(t, [a, b])),
            1 => chain.prop_map(|operands| tight(Tight::Wedge, operands)),
            2 => inner.clone().prop_map(reverse),
            2 => (inner.clone(), -12i32..30).prop_map(|(a, n)| power(a, n)),
            1 => (inner.clone(), 1u16..16).prop_map(|(a, grades)| part(a, grades)),
            1 => (proptest::sample::select(functions), inner.clone()).prop_map(|(f, a)| function(f, a)),
            1 => inner.clone().prop_map(|a| call("inertia", [a])),
            1 => inner.clone().prop_map(|a| call("V", [a])),
            1 => inner.clone().prop_map(|a| call("I", [a])),
            1 => Just(call("c", [])),
            1 => inner.clone().prop_map(derivative),
            1 => inner.clone().prop_map(|a| total("k", a)),
        ]
    })
}

/// Any formula that a text can stand for.
pub(crate) fn any_tree() -> impl Strategy<Value = Tree> {
    proptest::collection::vec(any_node(), 1..4).prop_map(tree)
}
