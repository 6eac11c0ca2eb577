//! Programs on lanes that the caller fills repeatedly, for bodies stepped side by side.

use super::apart;
use super::schedule::{Schedule, Task};
use super::single::{Given, Runner};
use crate::formula::InputKind;
use crate::graded::Graded;
use crate::simd::{Lane, Path};

/// A program with memory for `W` rows, a multiple of 8, as lanes. Steps common to all rows and times are computed once.
pub struct Beside<'r, const W: usize> {
    runner: &'r Runner,
    path: Path,
    schedule: Schedule,
    /// For each input, one lane for each of its numbers.
    inputs: Vec<Vec<Lane<W>>>,
    lanes: Vec<Lane<W>>,
}

impl Runner {
    /// Prepares the lanes. `known` are the inputs common to all rows and times; `None` if a step that depends only on
    /// these has no value.
    ///
    /// # Panics
    /// If the inputs are not of their kinds and grades.
    pub fn beside<const W: usize>(&self, known: &[Option<Given>]) -> Option<Beside<'_, W>> {
        assert_eq!(known.len(), self.inputs.len(), "an entry for each input");
        let fixed = self.fixed(&known.iter().map(Option::is_some).collect::<Vec<_>>());
        let given = |i: usize| known[i].unwrap_or(Given::Determinant(f64::NAN));
        let values = self.values(given, |id| fixed[id]).ok()?;
        let numbers = |given: &Given| match given {
            Given::Value(value) => value.components().to_vec(),
            Given::Matrix(m) => m.to_vec(),
            Given::Determinant(d) => vec![*d],
        };
        let map = |(kind, given): (&InputKind, &Option<Given>)| {
            given.as_ref().filter(|_| !matches!(kind, InputKind::Value(_))).map(numbers)
        };
        let maps: Vec<_> = self.inputs.iter().zip(known).map(map).collect();
        let schedule = self.schedule(&fixed, &values, &maps);
        let mut lanes = vec![Lane::filled(1.0); schedule.lanes];
        for (first, numbers) in &schedule.fixed {
            lanes[*first..].iter_mut().zip(numbers).for_each(|(lane, &x)| *lane = Lane::filled(x));
        }
        let input = |(kind, given): (&InputKind, &Option<Given>)| match given {
            Some(given) => numbers(given).into_iter().map(Lane::filled).collect(),
            None => vec![Lane::filled(1.0); kind.size()],
        };
        let inputs = self.inputs.iter().zip(known).map(input).collect();
        Some(Beside { runner: self, path: Path::best(), schedule, inputs, lanes })
    }
}

impl<const W: usize> Beside<'_, W> {
    /// The numbers of an input, to be set before evaluation; they keep their values.
    pub fn input(&mut self, number: usize) -> &mut [Lane<W>] {
        &mut self.inputs[number]
    }

    /// The numbers of a result.
    pub fn result(&self, number: usize) -> &[Lane<W>] {
        let first = self.schedule.results[number];
        &self.lanes[first..first + self.runner.size_of_result(number)]
    }

    /// Evaluates all rows, each with the bits of [`Runner::value`]; a row with a failing step has NaN as its results.
    pub fn run(&mut self) {
        let mut known = true;
        for task in &self.schedule.tasks {
            match task {
                Task::Read { input, to } => self.lanes[to.clone()].copy_from_slice(&self.inputs[*input]),
                Task::Do { step, operands, to } => {
                    let step = &self.runner.steps[*step];
                    let of = self.runner.steps[step.operands[0]].grades;
                    known &= step.block(self.path, of, W, apart(&mut self.lanes, operands, to));
                }
            }
        }
        if !known {
            (0..W).for_each(|row| self.complete(row));
        }
    }

    /// Evaluates one row, where another one failed in its block.
    #[cold]
    fn complete(&mut self, row: usize) {
        let runner = self.runner;
        let given = |i: usize| {
            let number = |k: usize| self.inputs[i][k].0[row];
            match runner.inputs[i] {
                InputKind::Value(ty) => Given::Value(Graded::from_fn(ty.grades, number)),
                InputKind::Matrix { .. } => Given::Matrix(std::array::from_fn(number)),
                InputKind::Determinant => Given::Determinant(number(0)),
            }
        };
        let values = runner.values(given, |_| true);
        for (number, (&id, &first)) in runner.results.iter().zip(&self.schedule.results).enumerate() {
            if self.schedule.fixed.iter().any(|(fixed, _)| *fixed == first) {
                // Constant lanes keep their values.
                continue;
            }
            for k in 0..runner.size_of_result(number) {
                let value = values.as_ref().map_or(f64::NAN, |values| values[id].components()[k]);
                self.lanes[first + k].0[row] = value;
            }
        }
    }
}
