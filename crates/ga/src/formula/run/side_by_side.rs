//! Programs on lanes that the caller fills repeatedly, for bodies stepped side by side.

use super::schedule::Schedule;
use super::single::Runner;
use super::steps::Given;
use crate::formula::InputKind;
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
        let schedule = self.schedule(known).ok()?;
        let input = |(kind, given): (&InputKind, &Option<Given>)| match given {
            Some(given) => given.numbers().iter().copied().map(Lane::filled).collect(),
            None => vec![Lane::filled(1.0); kind.size()],
        };
        let inputs = self.inputs.iter().zip(known).map(input).collect();
        let lanes = schedule.filled();
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
            known &= self.runner.task(task, (self.path, W), &mut self.lanes, |input, lanes| {
                lanes.copy_from_slice(&self.inputs[input]);
            });
        }
        if !known {
            (0..W).for_each(|row| self.complete(row));
        }
    }

    /// Evaluates one row, where another one failed in its block.
    #[cold]
    fn complete(&mut self, row: usize) {
        let runner = self.runner;
        let given = |i: usize| Given::new(runner.inputs[i], |k| self.inputs[i][k].0[row]);
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
