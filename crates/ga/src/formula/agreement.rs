//! Agreement of the sides of an equation: residual, size of the terms, tolerance.
//!
//! [`term_size`] and [`tolerance`] hold for any coefficients; [`Agreement`] is that of single values over floats.

use super::compile::program::{Id, Op, Program};
use super::run::steps::Given;
use crate::g3::functions::Function;
use crate::g3::values::norm;
use crate::graded::Graded;
use std::convert::Infallible;

/// Spacing of single precision; coarser floats count as single precision.
const SINGLE: f64 = 1.0 / (1 << 23) as f64;

/// The largest residual, relative to the size of the terms, at which sides agree, for floats of spacing `eps`.
///
/// A formula has at most 10,000 steps, and 64 roundings in each of them make 1.4e-10 in double precision. More digits
/// keep as many in reserve; single precision, half as long, keeps three.
pub fn tolerance(eps: f64) -> f64 {
    if eps >= SINGLE { 1e-4 } else { 1e-9 / f64::EPSILON * eps }
}

/// The rounding of an angle of this size makes the tolerance a thousandth; a larger angle would hide any difference.
fn largest_angle(eps: f64) -> f64 {
    if eps >= SINGLE { 10.0 } else { 1e6 }
}

/// The distance between the sides of an equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// `|lhs − rhs|`, the norm of the components `√Σ c²`; of several pairs of sides, that of the pair with the largest
    /// residual relative to its size.
    pub residual: f64,
    /// The size of the terms that make up the sides: of a sum the sum of its terms' sizes, of a product the size of one
    /// factor's terms times the norm of the other. So `a∧b + b∧a = 0` is compared with `2|a||b|`.
    pub size: f64,
}

impl Agreement {
    /// Of an equation, from the values of all its steps ([`super::Runner::value`]).
    pub fn of(program: &Program, inputs: &[Given], values: &[Graded]) -> Agreement {
        let mut sizes = Vec::with_capacity(values.len());
        for (step, value) in program.steps.iter().zip(values) {
            let operands: Vec<(f64, f64)> =
                step.op.operands().map(|id| (length(&values[id]), sizes[id])).collect();
            let length = match step.op {
                Op::Map { input, .. } => match &inputs[input] {
                    Given::Determinant(determinant) => determinant.abs(),
                    given => norm(given.numbers()),
                },
                _ => length(value),
            };
            let Ok(size) = term_size(&step.op, &length, &operands, f64::EPSILON);
            sizes.push(size);
        }
        let pairs = program.results.iter().flat_map(|sides| {
            sides.iter().skip(1).map(|&other| (sides.first().copied().unwrap_or(other), other))
        });
        let apart = |(a, b): (Id, Id)| {
            let (a_full, b_full) = (values[a].full(), values[b].full());
            let difference: [f64; 8] = std::array::from_fn(|k| a_full[k] - b_full[k]);
            Agreement { residual: norm(&difference), size: sizes[a].max(sizes[b]) }
        };
        pairs.map(apart).reduce(Agreement::worse).unwrap_or(Agreement { residual: 0.0, size: 0.0 })
    }

    /// Whether the sides agree.
    pub fn holds(self) -> bool {
        self.residual <= tolerance(f64::EPSILON) * self.size && self.size < f64::INFINITY
    }

    fn worse(self, other: Agreement) -> Agreement {
        let (r, s) = (other.residual, other.size);
        let worse = r * self.size > self.residual * s || s == 0.0 && r > 0.0 || r.is_nan();
        if worse { other } else { self }
    }
}

fn length(value: &Graded) -> f64 {
    norm(value.components())
}

/// An operation on two sizes.
#[derive(Clone, Copy, Debug)]
pub enum Arithmetic {
    /// The sum.
    Plus,
    /// The product.
    Times,
    /// The quotient.
    Over,
    /// The larger of two.
    Larger,
    /// The smaller of a size and a number.
    Smaller,
}

/// Sizes: of one value, or of a batch of any floats.
pub trait Magnitude: Clone {
    /// Why an operation fails.
    type Error;
    /// The result of an operation.
    fn apply(&self, operation: Arithmetic, other: &Self) -> Result<Self, Self::Error>;
    /// A number of the same floats.
    fn number(&self, x: f64) -> Self;
    /// 1 in place of 0.
    fn nonzero(&self) -> Result<Self, Self::Error>;
}

/// The size of the terms that make up a step, whose rounding is a few ulps of that, for floats of spacing `eps`.
///
/// `length` is the norm of the value, or of the matrix of a linear map; `operands` are norms and sizes. To first order
/// `AB` changes by `A dB + dA B`, and functions stretch the rounding of their argument by their derivative.
pub fn term_size<M: Magnitude>(op: &Op, length: &M, operands: &[(M, M)], eps: f64) -> Result<M, M::Error> {
    use Arithmetic::{Larger, Over, Plus, Smaller, Times};
    let v = length;
    let plus = |a: &M, b: &M| a.apply(Plus, b);
    let times = |a: &M, b: &M| a.apply(Times, b);
    let over = |a: &M, b: &M| a.apply(Over, b);
    let larger = |a: M, b: M| a.apply(Larger, &b);
    let plus_one = |a: M| a.apply(Plus, &a.number(1.0));
    let multiple =
        |a: &M, factor: f64| times(a, &a.number(factor))?.apply(Smaller, &a.number(largest_angle(eps)));
    match (op, operands) {
        (Op::Add(..) | Op::Subtract(..), [(_, s), (_, t)]) => plus(s, t),
        (
            Op::Negate(_) | Op::Reverse(_) | Op::Part(_) | Op::Dual(_) | Op::Undual(_) | Op::Norm(_),
            [(_, s)],
        ) => Ok(s.clone()),
        (Op::Product(..) | Op::Compose(..), [(a, s), (b, t)]) => larger(times(a, t)?, times(s, b)?),
        (Op::Turn(..), [(a, s), (b, t)]) => larger(times(&times(a, a)?, t)?, times(&times(a, s)?, b)?),
        (Op::Divide(..), [(a, s), (b, t)]) => larger(over(s, b)?, times(&over(a, b)?, &over(t, b)?)?),
        (Op::Function(Function::Inverse, _), [(_, s)]) => times(v, &times(v, s)?),
        (Op::Function(Function::Log, _), [(a, s)]) => plus(v, &over(s, a)?),
        (Op::Function(Function::Sqrt, _), [(a, s)]) => times(v, &plus_one(over(s, &a.nonzero()?)?)?),
        (Op::Function(Function::Exp, _), [(_, s)]) => times(v, &plus_one(multiple(s, 1.0)?)?),
        (Op::RotorPower(_, n), [(_, s)]) => plus(v, &multiple(s, f64::from(*n).abs())?),
        (Op::Sin(_) | Op::Cos(_), [(_, s)]) => plus(v, &multiple(s, 1.0)?),
        (Op::Tan(_), [(_, s)]) => plus(v, &times(&multiple(s, 1.0)?, &plus_one(times(v, v)?)?)?),
        (Op::Map { .. }, [(_, s)]) => times(s, v),
        _ => Ok(v.clone()),
    }
}

impl Magnitude for f64 {
    type Error = Infallible;
    fn apply(&self, operation: Arithmetic, other: &f64) -> Result<f64, Infallible> {
        Ok(match operation {
            Arithmetic::Plus => self + other,
            Arithmetic::Times => self * other,
            Arithmetic::Over => self / other,
            Arithmetic::Larger => self.max(*other),
            Arithmetic::Smaller => self.min(*other),
        })
    }
    fn number(&self, x: f64) -> f64 {
        x
    }
    fn nonzero(&self) -> Result<f64, Infallible> {
        Ok(if *self == 0.0 { 1.0 } else { *self })
    }
}
