//! Whether the sides of an equation agree, on single values: what `polhode._formula.agreement` is for batches and for other
//! coefficients.

use super::compile::program::{Id, Op, Program, Step};
use super::run::single::Given;
use crate::g3::functions::Function;
use crate::g3::values::norm;
use crate::graded::Graded;

/// The rounding of an angle of this size makes the tolerance a thousandth; beyond it would hide any difference.
const MOST_TURNED: f64 = 1e6;

/// How far the sides of an equation are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// `|lhs − rhs|`, the size of the components `√Σ c²`; of several pairs of sides, that of the pair which is worst
    /// beside its size.
    pub residual: f64,
    /// Of the terms that make up the sides: of a sum the sum of its terms' sizes, of a product that of one factor's
    /// terms times the size of the other. So `a∧b + b∧a = 0` is measured by `2|a||b|`.
    pub size: f64,
}

impl Agreement {
    /// The sides agree if their residual is at most so much of the size.
    pub const TOLERANCE: f64 = 1e-9;

    /// Of an equation, from the values of all its steps ([`super::Runner::value`]).
    pub fn of(program: &Program, inputs: &[Given], values: &[Graded]) -> Agreement {
        let mut sizes = Vec::with_capacity(values.len());
        for (step, value) in program.steps.iter().zip(values) {
            sizes.push(size(step, value, values, &sizes, inputs));
        }
        let pairs = program.results.iter().flat_map(|sides| {
            sides.iter().skip(1).map(|&other| (sides.first().copied().unwrap_or(other), other))
        });
        let apart = |(a, b): (Id, Id)| {
            let (a_held, b_held) = (values[a].full(), values[b].full());
            let difference: [f64; 8] = std::array::from_fn(|k| a_held[k] - b_held[k]);
            Agreement { residual: norm(&difference), size: sizes[a].max(sizes[b]) }
        };
        pairs.map(apart).reduce(Agreement::worse).unwrap_or(Agreement { residual: 0.0, size: 0.0 })
    }

    /// Whether the sides agree.
    pub fn holds(self) -> bool {
        self.residual <= Agreement::TOLERANCE * self.size && self.size < f64::INFINITY
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

/// The size of the terms that make up a step, whose rounding is a few ulps of that. To first order `AB` changes by
/// `A dB + dA B`, and functions stretch the rounding of their argument by their derivative.
fn size(step: &Step, value: &Graded, values: &[Graded], sizes: &[f64], inputs: &[Given]) -> f64 {
    let of = |id: Id| (length(&values[id]), sizes[id]);
    let v = length(value);
    match step.op {
        Op::Input(_) | Op::Constant(..) | Op::Pi => v,
        Op::Add(a, b) | Op::Subtract(a, b) => sizes[a] + sizes[b],
        Op::Negate(a) | Op::Reverse(a) | Op::Part(a) | Op::Dual(a) | Op::Undual(a) | Op::Norm(a) => sizes[a],
        Op::Product(_, a, b) | Op::Compose(a, b) => {
            let ((a, s), (b, t)) = (of(a), of(b));
            (a * t).max(s * b)
        }
        Op::Turn(a, b) => {
            let ((a, s), (b, t)) = (of(a), of(b));
            (a * a * t).max(a * s * b)
        }
        Op::Divide(a, b) => {
            let ((a, s), (b, t)) = (of(a), of(b));
            (s / b).max(a / b * (t / b))
        }
        Op::Function(Function::Inverse, a) => v * (v * sizes[a]),
        Op::Function(Function::Log, a) => v + sizes[a] / length(&values[a]),
        Op::Function(Function::Sqrt, a) => {
            let (a, s) = of(a);
            v * (1.0 + s / if a == 0.0 { 1.0 } else { a })
        }
        Op::Function(Function::Exp, a) => v * (1.0 + sizes[a].min(MOST_TURNED)),
        Op::RotorPower(a, n) => v + (sizes[a] * f64::from(n).abs()).min(MOST_TURNED),
        Op::Sin(a) | Op::Cos(a) => v + sizes[a].min(MOST_TURNED),
        Op::Tan(a) => v + sizes[a].min(MOST_TURNED) * (1.0 + v * v),
        Op::Map { input, argument } => {
            sizes[argument]
                * match &inputs[input] {
                    Given::Matrix(matrix) => norm(matrix),
                    Given::Determinant(determinant) => determinant.abs(),
                    Given::Value(value) => length(value),
                }
        }
    }
}
