//! The tasks of a program, in the order of evaluation, and the lanes of their values.

use crate::formula::compile::program::Id;
use crate::simd::Lane;
use std::ops::Range;

/// A value, or an input that is a map, at its lanes.
pub(crate) enum Task {
    /// Reads rows of an input; `direct` if the only step that needs them can do without lanes.
    Read { input: usize, to: Range<usize>, direct: bool },
    /// Does a step. `rows` are the inputs among its operands that are read for it alone.
    Do { step: Id, operands: [Range<usize>; 2], rows: [Option<usize>; 2], to: Range<usize> },
}

/// The tasks for each block of rows.
#[derive(Default)]
pub(crate) struct Schedule {
    /// Values common to all rows: numbers, each for a lane, and the first lane.
    pub fixed: Vec<(usize, Vec<f64>)>,
    pub tasks: Vec<Task>,
    /// The first lane of each result.
    pub results: Vec<usize>,
    /// The lanes of the inputs that stay filled, empty for others.
    pub inputs: Vec<Range<usize>>,
    /// The lanes of the values that the caller gives.
    pub given: Vec<Range<usize>>,
    /// The number of lanes.
    pub lanes: usize,
}

impl Schedule {
    /// The lanes with the values common to all rows. Lanes beyond the last rows are computed too; 1 is in the domain of
    /// nearly all functions.
    pub fn filled<const W: usize>(&self) -> Vec<Lane<W>> {
        let mut lanes = vec![Lane::filled(1.0); self.lanes];
        for (first, numbers) in &self.fixed {
            lanes[*first..].iter_mut().zip(numbers).for_each(|(lane, &x)| *lane = Lane::filled(x));
        }
        lanes
    }
}

/// Lanes that are in use.
#[derive(Default)]
pub(super) struct Lanes(Vec<bool>);

impl Lanes {
    /// The first `count` adjacent free lanes.
    pub fn take(&mut self, size: usize) -> Range<usize> {
        let mut first = 0;
        while let Some(taken) = self.0.iter().skip(first).take(size).rposition(|&taken| taken) {
            first += taken + 1;
        }
        self.0.resize(self.0.len().max(first + size), false);
        self.0[first..first + size].fill(true);
        first..first + size
    }

    pub fn free(&mut self, lanes: Range<usize>) {
        self.0[lanes].fill(false);
    }

    /// The number of lanes that were ever in use.
    pub fn count(&self) -> usize {
        self.0.len()
    }
}
