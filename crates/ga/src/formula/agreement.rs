//! Agreement of the sides of an equation: residual, size of the terms, tolerance.
//!
//! [`term_size`] and [`tolerance`] hold for any coefficients; [`Agreement`] is that of single values over floats.

use super::compile::program::{Id, Op, Program};
use super::run::single::Given;
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

/// Arithmetic of sizes: of one value, or of a batch of any floats.
pub trait Magnitude: Sized {
    /// Why an operation fails.
    type Error;
    /// The sum.
    fn plus(&self, other: &Self) -> Result<Self, Self::Error>;
    /// One more.
    fn plus_one(&self) -> Result<Self, Self::Error>;
    /// The product.
    fn times(&self, other: &Self) -> Result<Self, Self::Error>;
    /// The quotient.
    fn over(&self, other: &Self) -> Result<Self, Self::Error>;
    /// The larger of two.
    fn larger(&self, other: &Self) -> Result<Self, Self::Error>;
    /// A multiple, at most `most`.
    fn multiple(&self, factor: f64, most: f64) -> Result<Self, Self::Error>;
    /// 1 in place of 0.
    fn nonzero(&self) -> Result<Self, Self::Error>;
    /// The same.
    fn same(&self) -> Self;
}

/// The size of the terms that make up a step, whose rounding is a few ulps of that, for floats of spacing `eps`.
///
/// `length` is the norm of the value, or of the matrix of a linear map; `operands` are norms and sizes. To first order
/// `AB` changes by `A dB + dA B`, and functions stretch the rounding of their argument by their derivative.
pub fn term_size<M: Magnitude>(op: &Op, length: &M, operands: &[(M, M)], eps: f64) -> Result<M, M::Error> {
    let v = length;
    let most = largest_angle(eps);
    match (op, operands) {
        (Op::Add(..) | Op::Subtract(..), [(_, s), (_, t)]) => s.plus(t),
        (
            Op::Negate(_) | Op::Reverse(_) | Op::Part(_) | Op::Dual(_) | Op::Undual(_) | Op::Norm(_),
            [(_, s)],
        ) => Ok(s.same()),
        (Op::Product(..) | Op::Compose(..), [(a, s), (b, t)]) => a.times(t)?.larger(&s.times(b)?),
        (Op::Turn(..), [(a, s), (b, t)]) => a.times(a)?.times(t)?.larger(&a.times(s)?.times(b)?),
        (Op::Divide(..), [(a, s), (b, t)]) => s.over(b)?.larger(&a.over(b)?.times(&t.over(b)?)?),
        (Op::Function(Function::Inverse, _), [(_, s)]) => v.times(&v.times(s)?),
        (Op::Function(Function::Log, _), [(a, s)]) => v.plus(&s.over(a)?),
        (Op::Function(Function::Sqrt, _), [(a, s)]) => v.times(&s.over(&a.nonzero()?)?.plus_one()?),
        (Op::Function(Function::Exp, _), [(_, s)]) => v.times(&s.multiple(1.0, most)?.plus_one()?),
        (Op::RotorPower(_, n), [(_, s)]) => v.plus(&s.multiple(f64::from(*n).abs(), most)?),
        (Op::Sin(_) | Op::Cos(_), [(_, s)]) => v.plus(&s.multiple(1.0, most)?),
        (Op::Tan(_), [(_, s)]) => v.plus(&s.multiple(1.0, most)?.times(&v.times(v)?.plus_one()?)?),
        (Op::Map { .. }, [(_, s)]) => s.times(v),
        _ => Ok(v.same()),
    }
}

impl Magnitude for f64 {
    type Error = Infallible;
    fn plus(&self, other: &f64) -> Result<f64, Infallible> {
        Ok(self + other)
    }
    fn plus_one(&self) -> Result<f64, Infallible> {
        Ok(self + 1.0)
    }
    fn times(&self, other: &f64) -> Result<f64, Infallible> {
        Ok(self * other)
    }
    fn over(&self, other: &f64) -> Result<f64, Infallible> {
        Ok(self / other)
    }
    fn larger(&self, other: &f64) -> Result<f64, Infallible> {
        Ok(self.max(*other))
    }
    fn multiple(&self, factor: f64, most: f64) -> Result<f64, Infallible> {
        Ok((self * factor).min(most))
    }
    fn nonzero(&self) -> Result<f64, Infallible> {
        Ok(if *self == 0.0 { 1.0 } else { *self })
    }
    fn same(&self) -> f64 {
        *self
    }
}
