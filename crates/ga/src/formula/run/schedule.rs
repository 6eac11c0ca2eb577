//! Assignment of values to lanes, and the order of evaluation.

use super::single::Runner;
use super::steps::Work;
use crate::formula::compile::program::Id;
use crate::graded::{Graded, size};
use std::ops::Range;

/// A value, or an input that is a map, at its lanes.
pub(crate) enum Task {
    /// Reads rows of an input.
    Read { input: usize, to: Range<usize> },
    /// Does a step.
    Do { step: Id, operands: [Range<usize>; 2], to: Range<usize> },
}

/// The tasks for each block of rows.
pub(crate) struct Schedule {
    /// Values common to all rows: numbers, each for a lane, and the first lane.
    pub fixed: Vec<(usize, Vec<f64>)>,
    pub tasks: Vec<Task>,
    /// The first lane of each result.
    pub results: Vec<usize>,
    /// The number of lanes.
    pub lanes: usize,
}

/// Lanes that are in use.
#[derive(Default)]
struct Lanes(Vec<bool>);

impl Lanes {
    /// The first `count` adjacent free lanes.
    fn take(&mut self, size: usize) -> Range<usize> {
        let mut first = 0;
        while let Some(taken) = self.0.iter().skip(first).take(size).rposition(|&taken| taken) {
            first += taken + 1;
        }
        self.0.resize(self.0.len().max(first + size), false);
        self.0[first..first + size].fill(true);
        first..first + size
    }

    fn free(&mut self, lanes: Range<usize>) {
        self.0[lanes].fill(false);
    }
}

impl Runner {
    /// Marks the steps with one value for all rows, given the inputs that have one.
    pub(crate) fn fixed(&self, one: &[bool]) -> Vec<bool> {
        let mut fixed: Vec<bool> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let own = match step.work {
                Work::Input(i) | Work::Map(i) => one[i],
                _ => true,
            };
            fixed.push(own && step.operands.iter().all(|&id| fixed[id]));
        }
        fixed
    }

    /// Lanes for the values of steps, those `fixed` given. Lanes are reused after the last use of
    /// their value, so that all stay in the first-level cache.
    pub(crate) fn schedule(&self, fixed: &[bool], values: &[Graded], maps: &[Option<Vec<f64>>]) -> Schedule {
        let mut last = vec![0; self.steps.len()];
        for (id, step) in self.steps.iter().enumerate().filter(|(id, _)| !fixed[*id]) {
            step.operands.iter().for_each(|&operand| last[operand] = id);
        }
        self.results.iter().for_each(|&id| last[id] = usize::MAX);
        let mut lanes = Lanes::default();
        let mut schedule = Schedule { fixed: Vec::new(), tasks: Vec::new(), results: Vec::new(), lanes: 0 };
        let mut places = vec![0..0; self.steps.len()];
        let mut of_maps = vec![0..0; self.inputs.len()];
        // Values common to all rows keep their lanes.
        for id in (0..self.steps.len()).filter(|&id| fixed[id] && last[id] > 0) {
            places[id] = lanes.take(size(self.steps[id].grades));
            schedule.fixed.push((places[id].start, values[id].components().to_vec()));
        }
        for (input, numbers) in maps.iter().enumerate() {
            if let Some(numbers) = numbers {
                of_maps[input] = lanes.take(numbers.len());
                schedule.fixed.push((of_maps[input].start, numbers.clone()));
            }
        }
        for (id, step) in self.steps.iter().enumerate().filter(|(id, _)| !fixed[*id]) {
            let mut operands = [0..0, 0..0];
            for (place, &operand) in operands.iter_mut().zip(&*step.operands) {
                *place = places[operand].clone();
            }
            if let Work::Map(input) = step.work {
                if of_maps[input].is_empty() {
                    of_maps[input] = lanes.take(self.inputs[input].size());
                    schedule.tasks.push(Task::Read { input, to: of_maps[input].clone() });
                }
                operands[1] = of_maps[input].clone();
            }
            let to = lanes.take(size(step.grades));
            places[id] = to.clone();
            schedule.tasks.push(match step.work {
                Work::Input(input) => Task::Read { input, to },
                _ => Task::Do { step: id, operands, to },
            });
            for &operand in step.operands.iter().filter(|&&operand| last[operand] == id && !fixed[operand]) {
                lanes.free(places[operand].clone());
            }
        }
        schedule.results = self.results.iter().map(|&id| places[id].start).collect();
        schedule.lanes = lanes.0.len();
        schedule
    }
}
