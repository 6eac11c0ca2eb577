//! Grades of parts of a formula as far as a reader sees them, before it is compiled.

use super::indices::{first_of, indexed, is_built_in};
use super::names::{Meaning, Names};
use super::tree::{Kind, Named, Node, Tight};
use crate::product::Grades;

/// Whether a number stands on the right of a tight product of what is not a number: `x∧m`, `a·2`.
pub(crate) fn ends_in_number(operands: &[Node], names: &Names) -> bool {
    let not_number = |node| grades(node, names).is_some_and(|g| g != Grades::SCALAR);
    operands.split_last().is_some_and(|(last, before)| {
        grades(last, names) == Some(Grades::SCALAR) && before.iter().any(not_number)
    })
}

/// Whether this may be so whatever names mean, so that as a factor it is written in brackets: `(x∧2) v`.
pub(crate) fn is_loose(node: &Node) -> bool {
    let Kind::Tight(_, operands) = &node.kind else { return false };
    let is_number = |node| grades(node, &Names::default()) == Some(Grades::SCALAR);
    operands.split_last().is_some_and(|(last, before)| is_number(last) && !before.iter().all(is_number))
}

/// The grades that a part may hold; `None` if they are not plain to see.
pub(crate) fn grades(node: &Node, names: &Names) -> Option<Grades> {
    let of = |node: &Node| grades(node, names);
    match &node.kind {
        Kind::Number(_) | Kind::Pi => Some(Grades::SCALAR),
        Kind::Function(Named::Norm | Named::Sin | Named::Cos | Named::Tan, _) => Some(Grades::SCALAR),
        Kind::Function(_, x) => of(x).filter(|&g| g == Grades::SCALAR),
        Kind::Blade(generators) => Some(Grades(1 << generators.len())),
        Kind::Name(name) => named(name, names),
        Kind::Part(_, grades) => Some(*grades),
        Kind::Reverse(x) | Kind::Derivative(x) | Kind::Total(_, x) | Kind::Power(x, 1) => of(x),
        Kind::Power(x, power) => {
            let square = |g| g == Grades::SCALAR || g == Grades::VECTOR && power % 2 == 0;
            of(x).filter(|&g| square(g)).map(|_| Grades::SCALAR)
        }
        Kind::Sum(terms) => {
            terms.iter().try_fold(Grades(0), |sum, (_, term)| Some(Grades(sum.0 | of(term)?.0)))
        }
        Kind::Quotient(pair) => of(&pair.1).filter(|&g| g == Grades::SCALAR).and_then(|_| of(&pair.0)),
        Kind::Product(factors) => multiplied(factors, of, |r, s| (r.abs_diff(s), r + s)),
        Kind::Tight(Tight::Wedge, operands) => multiplied(operands, of, |r, s| (r + s, r + s)),
        Kind::Tight(Tight::Dot, operands) => multiplied(operands, of, |r, s| (r.abs_diff(s), r.abs_diff(s))),
        Kind::Tight(Tight::Cross, _) => Some(Grades::VECTOR),
        Kind::Pseudoscalar | Kind::Tight(..) => None,
        Kind::Call(name, _) => match names.get(name)? {
            Meaning::Map { grade: 2 } => Some(Grades::BIVECTOR),
            _ => None,
        },
    }
}

/// The grades of a name's value; names with indices hold those of their first value.
fn named(name: &str, names: &Names) -> Option<Grades> {
    match names.get(name) {
        Some(Meaning::Value(ty)) => Some(ty.grades),
        Some(_) => None,
        None if is_built_in(name) => {
            Some(if indexed(name)?.0 == "e" { Grades::VECTOR } else { Grades::SCALAR })
        }
        None => match names.get(&first_of(name)?)? {
            Meaning::Value(ty) => Some(ty.grades),
            _ => None,
        },
    }
}

/// The greatest grade of any algebra.
const MOST: usize = 8;

/// The grades of a product whose parts of grades r and s give every second grade from the least to the greatest.
fn multiplied(
    operands: &[Node],
    of: impl Fn(&Node) -> Option<Grades>,
    range: fn(usize, usize) -> (usize, usize),
) -> Option<Grades> {
    let (first, rest) = operands.split_first()?;
    let product = |a: Grades, b: Grades| {
        let pairs = (0..=MOST).flat_map(|r| (0..=MOST).map(move |s| (r, s)));
        let ranges = pairs.filter(|&(r, s)| a.contains(r) && b.contains(s)).map(|(r, s)| range(r, s));
        let found = ranges.flat_map(|(least, greatest)| (least..=greatest.min(MOST)).step_by(2));
        Some(Grades(found.fold(0, |all, k| all | 1 << k))).filter(|g| g.0 != 0)
    };
    rest.iter().try_fold(of(first)?, |all, operand| product(all, of(operand)?))
}
