//! Programs on single values.

use super::steps::{Given, Ready};
use super::tasks::Schedule;
use crate::MathError;
use crate::formula::compile::program::{Id, InputKind, Program};
use crate::graded::Graded;
use crate::table::G3;
use std::borrow::Borrow;
use std::sync::OnceLock;

/// A program of 3-d space, ready to run.
pub struct Runner {
    pub(crate) inputs: Vec<InputKind>,
    pub(crate) steps: Vec<Ready>,
    /// The steps that are results.
    pub(crate) results: Vec<Id>,
    /// The order of evaluation where all inputs have many rows.
    pub(super) varying: OnceLock<Schedule>,
}

impl Runner {
    /// Prepares a program; `None` if its algebra is not that of 3-d space.
    pub fn new(program: &Program) -> Option<Runner> {
        (program.signature == G3.signature()).then(|| Runner {
            inputs: program.inputs.iter().map(|input| input.kind).collect(),
            steps: Ready::steps(program),
            results: program.results.concat(),
            varying: OnceLock::new(),
        })
    }

    /// The values of all steps, each with the bits of the corresponding method. Fails with the first step without a
    /// value.
    ///
    /// # Panics
    /// If the inputs are not of their kinds and grades.
    pub fn value(&self, inputs: &[Given]) -> Result<Vec<Graded>, (Id, MathError)> {
        let mut values = Vec::new();
        self.value_to(inputs, &mut values).map(|()| values)
    }

    /// The same, in memory that can be reused.
    ///
    /// # Panics
    /// As [`Runner::value`].
    pub fn value_to(&self, inputs: &[Given], values: &mut Vec<Graded>) -> Result<(), (Id, MathError)> {
        assert_eq!(inputs.len(), self.inputs.len(), "a value for each input");
        self.values_to(values, |i| &inputs[i], |_| true)
    }

    /// The values of the steps that are wanted; others are 0.
    pub(crate) fn values(
        &self,
        input: impl Fn(usize) -> Given,
        wanted: impl Fn(Id) -> bool,
    ) -> Result<Vec<Graded>, (Id, MathError)> {
        let mut values = Vec::new();
        self.values_to(&mut values, input, wanted).map(|()| values)
    }

    fn values_to<G: Borrow<Given>>(
        &self,
        values: &mut Vec<Graded>,
        input: impl Fn(usize) -> G,
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
