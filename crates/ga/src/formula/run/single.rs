//! Programs on single values.

use super::steps::{Ready, Selection, Sum, Work, applied};
use crate::MathError;
use crate::formula::compile::program::{Id, InputKind, Program};
use crate::g3::rotor::Rotor;
use crate::g3::values::norm;
use crate::graded::Graded;
use crate::product::Grades;
use crate::rows::rotor_functions::{self, Cos, Sin, Tan};
use crate::simd::map::Map;
use crate::table::G3;

/// The value of an input.
#[derive(Clone, Copy, Debug)]
pub enum Given {
    /// A value of the input's grades.
    Value(Graded),
    /// A matrix by rows.
    Matrix([f64; 9]),
    /// A determinant.
    Determinant(f64),
}

/// A program of 3-d space, ready to run.
pub struct Runner {
    pub(crate) inputs: Vec<InputKind>,
    pub(crate) steps: Vec<Ready>,
    /// The steps that are results.
    pub(crate) results: Vec<Id>,
}

impl Runner {
    /// Prepares a program; `None` if its algebra is not that of 3-d space.
    pub fn new(program: &Program) -> Option<Runner> {
        (program.signature == G3.signature()).then(|| Runner {
            inputs: program.inputs.iter().map(|input| input.kind).collect(),
            steps: Ready::steps(program),
            results: program.results.concat(),
        })
    }

    /// The values of all steps, each with the bits of the corresponding method. Fails with the first step without a
    /// value.
    ///
    /// # Panics
    /// If the inputs are not of their kinds and grades.
    pub fn value(&self, inputs: &[Given]) -> Result<Vec<Graded>, (Id, MathError)> {
        let mut values = Vec::new();
        self.value_to(inputs, &mut values)?;
        Ok(values)
    }

    /// The same, in memory that can be reused.
    ///
    /// # Panics
    /// As [`Runner::value`].
    pub fn value_to(&self, inputs: &[Given], values: &mut Vec<Graded>) -> Result<(), (Id, MathError)> {
        assert_eq!(inputs.len(), self.inputs.len(), "a value for each input");
        self.values_to(values, |i| inputs[i], |_| true)
    }

    /// The values of the steps that are wanted; others are 0.
    pub(crate) fn values(
        &self,
        input: impl Fn(usize) -> Given,
        wanted: impl Fn(Id) -> bool,
    ) -> Result<Vec<Graded>, (Id, MathError)> {
        let mut values = Vec::new();
        self.values_to(&mut values, input, wanted)?;
        Ok(values)
    }

    fn values_to(
        &self,
        values: &mut Vec<Graded>,
        input: impl Fn(usize) -> Given,
        wanted: impl Fn(Id) -> bool,
    ) -> Result<(), (Id, MathError)> {
        values.resize(self.steps.len(), Graded::default());
        for (id, step) in self.steps.iter().enumerate().filter(|(id, _)| wanted(*id)) {
            let (before, rest) = values.split_at_mut(id);
            step.set(&mut rest[0], before, &input).map_err(|error| (id, error))?;
        }
        Ok(())
    }
}

/// The rotor of four components.
fn rotor(value: &Graded) -> Rotor {
    let c = value.components();
    Rotor::from_unit_components([c[0], c[1], c[2], c[3]])
}

/// The first component: that of a scalar.
fn number(value: &Graded) -> f64 {
    value.components()[0]
}

fn three(value: &Graded) -> [f64; 3] {
    let c = value.components();
    [c[0], c[1], c[2]]
}

/// A value of which some number was NaN for want of one.
fn known<const N: usize>(numbers: [f64; N], grades: Grades) -> Result<Graded, MathError> {
    if numbers[0].is_nan() { Err(MathError::NotFinite) } else { Ok(Graded::from_fn(grades, |k| numbers[k])) }
}

impl Ready {
    /// Computes the value from those of earlier steps.
    #[inline]
    fn set(
        &self,
        out: &mut Graded,
        values: &[Graded],
        input: impl Fn(usize) -> Given,
    ) -> Result<(), MathError> {
        let operand = |k: usize| &values[self.operands[k]];
        let value = match &self.work {
            Work::Input(i) => match input(*i) {
                Given::Value(value) if value.grades() == self.grades => value,
                other => panic!("input {i} is a value of the grades {:?}, got {other:?}", self.grades),
            },
            Work::Constant(value) => *value,
            Work::Sum(sum) => {
                sum.set(out, operand(0), operand(1), self.grades);
                return Ok(());
            }
            Work::Selection(selection) => selection.of(operand(0), self.grades),
            Work::Product(plan) => {
                out.set_product(plan, operand(0), operand(1));
                return Ok(());
            }
            Work::Compose => {
                let product = rotor(operand(0)).compose(rotor(operand(1))).components();
                Graded::from_fn(self.grades, |k| product[k])
            }
            Work::Turn => {
                *out = *operand(1);
                out.turn(rotor(operand(0)));
                return Ok(());
            }
            Work::Divide => {
                let divisor = number(operand(1));
                if divisor == 0.0 {
                    return Err(MathError::DivisionByZero);
                }
                operand(0).map(|x| x / divisor)
            }
            Work::Exp => known(rotor_functions::exp_one(three(operand(0))), self.grades)?,
            Work::Log => known(rotor_functions::log_one(rotor(operand(0)).components()), self.grades)?,
            Work::Power(t) => {
                known(rotor_functions::power_one(rotor(operand(0)).components(), *t), self.grades)?
            }
            Work::Function(f) => applied(*f, operand(0), self.grades)?,
            Work::Norm => Graded::from_fn(self.grades, |_| norm(operand(0).components())),
            Work::Sin => known(Sin::value([number(operand(0))], []), self.grades)?,
            Work::Cos => known(Cos::value([number(operand(0))], []), self.grades)?,
            Work::Tan => known(Tan::value([number(operand(0))], []), self.grades)?,
            Work::Map(i) => match input(*i) {
                Given::Matrix(m) => {
                    let [x, y, z] = three(operand(0));
                    Graded::from_fn(self.grades, |k| m[3 * k] * x + m[3 * k + 1] * y + m[3 * k + 2] * z)
                }
                Given::Determinant(d) => operand(0).map(|x| 0.0 + x * d),
                Given::Value(_) => panic!("input {i} is a linear map, got a value"),
            },
        };
        out.assign(&value);
        Ok(())
    }
}

impl Sum {
    /// As [`Graded::zip`], in place.
    fn set(&self, out: &mut Graded, a: &Graded, b: &Graded, grades: Grades) {
        let (a, b) = (a.components(), b.components());
        let held = |place: Option<usize>, c: &[f64]| place.map_or(0.0, |k| c[k]);
        out.fill(grades, |k| {
            let [i, j] = self.places[k];
            held(i, a) + self.sign * held(j, b)
        });
    }
}

impl Selection {
    fn of(&self, a: &Graded, grades: Grades) -> Graded {
        let held = a.components();
        let component =
            |place: &Option<(f64, usize)>| place.map_or(0.0, |(sign, k)| sign * held[k] + self.start);
        Graded::from_fn(grades, |k| component(&self.places[k]))
    }
}
