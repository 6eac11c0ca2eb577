//! Trees by hand, for tests.

use super::number::Number;
use super::tree::{Kind, Named, Node, Span, Tight, Tree};
use crate::functions::Function;
use crate::product::Grades;

pub(super) fn node(kind: Kind) -> Node {
    Node::new(kind, Span::default())
}

pub(super) fn tree(sides: impl Into<Vec<Node>>) -> Tree {
    Tree { sides: sides.into() }
}

/// A name; digits make a number, `I` and `e1` blades, `½` a half.
pub(super) fn x(text: &str) -> Node {
    node(match text {
        "½" => Kind::Number(Number::ratio(1, 2).unwrap()),
        "π" => Kind::Pi,
        "I" => Kind::Blade(vec![1, 2, 3]),
        "e1" => Kind::Blade(vec![1]),
        "e2" => Kind::Blade(vec![2]),
        "e12" => Kind::Blade(vec![1, 2]),
        _ => Number::decimal(text).map_or_else(|| Kind::Name(text.to_owned()), Kind::Number),
    })
}

pub(super) fn minus(a: Node) -> Node {
    node(Kind::Sum(vec![(true, a)]))
}

pub(super) fn plus(a: Node, b: Node) -> Node {
    node(Kind::Sum(vec![(false, a), (false, b)]))
}

pub(super) fn product(factors: impl Into<Vec<Node>>) -> Node {
    node(Kind::Product(factors.into()))
}

pub(super) fn over(a: Node, b: Node) -> Node {
    node(Kind::Quotient(Box::new((a, b))))
}

pub(super) fn tight(tight: Tight, operands: impl Into<Vec<Node>>) -> Node {
    node(Kind::Tight(tight, operands.into()))
}

pub(super) fn wedge(a: Node, b: Node) -> Node {
    tight(Tight::Wedge, [a, b])
}

pub(super) fn reverse(a: Node) -> Node {
    node(Kind::Reverse(Box::new(a)))
}

pub(super) fn power(a: Node, n: i32) -> Node {
    node(Kind::Power(Box::new(a), n))
}

pub(super) fn part(a: Node, grades: u16) -> Node {
    node(Kind::Part(Box::new(a), Grades(grades)))
}

pub(super) fn exp(a: Node) -> Node {
    node(Kind::Function(Named::Function(Function::Exp), Box::new(a)))
}

pub(super) fn function(f: Named, a: Node) -> Node {
    node(Kind::Function(f, Box::new(a)))
}

pub(super) fn call(name: &str, arguments: impl Into<Vec<Node>>) -> Node {
    node(Kind::Call(name.to_owned(), arguments.into()))
}

pub(super) fn derivative(a: Node) -> Node {
    node(Kind::Derivative(Box::new(a)))
}

pub(super) fn total(index: &str, a: Node) -> Node {
    node(Kind::Total(index.to_owned(), Box::new(a)))
}
