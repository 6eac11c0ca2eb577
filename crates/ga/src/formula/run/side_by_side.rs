//! Programs on lanes that the caller fills repeatedly, for bodies stepped side by side.

use super::schedule::Schedule;
use super::single::Runner;
use super::steps::Given;
use crate::simd::{Lane, Path};
use std::ops::Range;

/// A program with memory for `W` rows, a multiple of 8, as lanes. Steps common to all rows and times are computed once.
pub struct Beside<'r, const W: usize> {
    runner: &'r Runner,
    path: Path,
    schedule: Schedule,
    /// The inputs common to all rows and times.
    known: Vec<Option<Given>>,
    /// The lanes of each result.
    results: Vec<Range<usize>>,
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
        let schedule = self.schedule(known, true).ok()?;
        let lanes = schedule.filled();
        let of = |(number, &first): (usize, &usize)| first..first + self.size_of_result(number);
        let results = schedule.results.iter().enumerate().map(of).collect();
        Some(Beside { runner: self, path: Path::best(), schedule, known: known.to_vec(), results, lanes })
    }
}

impl<const W: usize> Beside<'_, W> {
    /// The numbers of an input, to be set before evaluation; they keep their values. None of an input that is known.
    #[inline]
    pub fn input(&mut self, number: usize) -> &mut [Lane<W>] {
        &mut self.lanes[self.schedule.inputs[number].clone()]
    }

    /// The numbers of a result.
    #[inline]
    pub fn result(&self, number: usize) -> &[Lane<W>] {
        &self.lanes[self.results[number].clone()]
    }

    /// Evaluates all rows, each with the bits of [`Runner::value`]; a row with a failing step has NaN as its results.
    pub fn run(&mut self) {
        let inputs = &self.schedule.inputs;
        let known = self.runner.do_all(
            &self.schedule.tasks,
            (self.path, W),
            &mut self.lanes,
            |_| {},
            |input, to, lanes| lanes.copy_within(inputs[input].clone(), to.start),
        );
        if !known {
            (0..W).for_each(|row| self.complete(row));
        }
    }

    /// Evaluates one row, where another one failed in its block.
    #[cold]
    fn complete(&mut self, row: usize) {
        let runner = self.runner;
        let given = |i: usize| {
            let own = || {
                let lanes = &self.lanes[self.schedule.inputs[i].clone()];
                Given::new(runner.inputs[i], |k| lanes[k].0[row])
            };
            self.known[i].unwrap_or_else(own)
        };
        let values = runner.values(given, |_| true);
        for (lanes, &id) in self.results.iter().zip(&runner.results) {
            if self.schedule.fixed.iter().any(|(fixed, _)| *fixed == lanes.start) {
                // Constant lanes keep their values.
                continue;
            }
            for (k, lane) in lanes.clone().enumerate() {
                let value = values.as_ref().map_or(f64::NAN, |values| values[id].components()[k]);
                self.lanes[lane].0[row] = value;
            }
        }
    }
}
