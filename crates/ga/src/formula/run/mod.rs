//! Programs over many rows: each block of rows runs through all steps before the next block.

pub(crate) mod general;
pub(crate) mod schedule;
pub(crate) mod short_steps;
pub(crate) mod side_by_side;
pub(crate) mod single;
pub(crate) mod steps;
pub(crate) mod tasks;
#[cfg(test)]
mod tests;

use super::compile::program::Id;
use crate::MathError;
use crate::graded::{Graded, size};
use crate::simd::short::{GROUP, Numbers, Source};
use crate::simd::threads::{Threads, for_each};
use crate::simd::traverse::{Factor, SHARED, Target, by_blocks};
use crate::simd::{Element, Lane, Path};
use schedule::apart;
use single::Runner;
use std::ops::{ControlFlow, Range};
use std::sync::{Mutex, PoisonError};
use steps::{Given, Work};
use tasks::{Schedule, Task};

/// Below this number of rows, transposing them into lanes does not pay.
const FEW: usize = 8;

/// From this many bytes on, inputs and results together, results bypass the caches: earlier than for a single
/// product, since all inputs are read at once.
const STREAMED: usize = 8 << 20;

/// From this many bytes on, more than the second-level cache keeps beside other data, blocks are smaller: reading takes
/// longer, and small blocks interleave it more finely with arithmetic.
const FAR: usize = 1 << 20;

/// From this many lanes on, blocks of 32 rows pay where results bypass the caches: they leave room in the first-level cache
/// for what the hardware reads ahead. Of fewer lanes blocks of 64 rows do too, with less overhead.
const LANES_OF_32: usize = 9;

/// This many lanes of 128 rows leave room in the first-level cache. Each step of a block has an overhead of some
/// nanoseconds, so large blocks are faster.
const FEW_LANES: usize = 24;

/// This many lanes of 64 rows still fit.
const MANY_LANES: usize = 64;

/// The first row without a value, and its first failing step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowError {
    /// The row.
    pub row: usize,
    /// The step.
    pub step: Id,
    /// The error.
    pub error: MathError,
}

impl Runner {
    /// Evaluates a range of rows; each input has one row for all, or one for each. The results, in the order of
    /// the program, are written to the same rows of the outputs. Each row has the bits of [`Runner::value`], on any
    /// machine and with any number of threads. After an error the outputs are unspecified.
    ///
    /// # Panics
    /// If the numbers of rows do not fit together.
    pub fn run<T: Element>(
        &self,
        threads: Threads,
        inputs: &[&[T]],
        outputs: &mut [&mut [T]],
        rows: Range<usize>,
    ) -> Result<(), RowError> {
        self.run_on(Path::best(), threads, inputs, outputs, rows)
    }

    pub(super) fn run_on<T: Element>(
        &self,
        path: Path,
        threads: Threads,
        inputs: &[&[T]],
        outputs: &mut [&mut [T]],
        rows: Range<usize>,
    ) -> Result<(), RowError> {
        assert_eq!((inputs.len(), outputs.len()), (self.inputs.len(), self.results.len()), "all that are");
        let total = outputs[0].len() / self.size_of_result(0);
        let factors = self.inputs.iter().zip(inputs);
        let factors = factors.map(|(&kind, data)| Factor::new(data, kind.size(), total));
        let bytes: usize = inputs.iter().map(|x| size_of_val(*x)).sum::<usize>()
            + outputs.iter().map(|x| size_of_val(*x)).sum::<usize>();
        let mut targets: Vec<Target<T>> = Vec::with_capacity(outputs.len());
        for (k, data) in outputs.iter_mut().enumerate() {
            let size = self.size_of_result(k);
            assert_eq!(data.len(), total * size, "an output has the wrong length");
            targets.push(Target { data: &mut data[rows.start * size..rows.end * size], size, at: 0 });
        }
        let first = rows.start;
        let factors: Vec<Factor<T>> = factors.map(|factor| factor.piece(rows.clone())).collect();
        let late = |error: RowError| RowError { row: first + error.row, ..error };
        if rows.len() < FEW {
            return self.by_rows(&factors, &mut targets, rows.len()).map_err(late);
        }
        let known = factors.iter().enumerate();
        let known: Vec<_> = known.map(|(i, factor)| factor.one.then(|| self.given(&factors, i, 0))).collect();
        let varying = known.iter().all(Option::is_none);
        let own;
        let schedule = match self.varying.get().filter(|_| varying) {
            Some(schedule) => schedule,
            None => match self.schedule(&known, false, &self.whole()) {
                Ok(schedule) if varying => self.varying.get_or_init(|| schedule),
                Ok(schedule) => {
                    own = schedule;
                    &own
                }
                // An earlier step may fail in the first row too.
                Err(_) => return self.by_rows(&factors, &mut targets, 1).map_err(late),
            },
        };
        targets.iter_mut().zip(&schedule.results).for_each(|(target, &at)| target.at = at);
        let streamed = path.streams() && bytes >= STREAMED;
        let sweep = Sweep { runner: self, schedule, path, streamed, failure: Mutex::new(None) };
        match sweep.schedule.lanes {
            0..=FEW_LANES if bytes < FAR && rows.len() > 64 => {
                sweep.run::<T, 128>(threads, &factors, targets, rows.len())
            }
            LANES_OF_32..=MANY_LANES if streamed => {
                sweep.run::<T, 32>(threads, &factors, targets, rows.len())
            }
            0..=MANY_LANES if rows.len() > 16 => sweep.run::<T, 64>(threads, &factors, targets, rows.len()),
            _ => sweep.run::<T, 16>(threads, &factors, targets, rows.len()),
        }
        let failure = sweep.failure.into_inner().unwrap_or_else(PoisonError::into_inner);
        failure.map_or(Ok(()), |error| Err(late(error)))
    }

    pub(super) fn size_of_result(&self, k: usize) -> usize {
        size(self.steps[self.results[k]].grades)
    }

    /// Row by row, the first so many.
    fn by_rows<T: Element>(
        &self,
        factors: &[Factor<T>],
        targets: &mut [Target<T>],
        count: usize,
    ) -> Result<(), RowError> {
        for row in 0..count {
            let values = self.row(factors, row)?;
            for (target, &id) in targets.iter_mut().zip(&self.results) {
                let out = &mut target.data[row * target.size..(row + 1) * target.size];
                out.iter_mut().zip(values[id].components()).for_each(|(out, &x)| *out = T::nearest(x));
            }
        }
        Ok(())
    }

    /// The values of all steps for one row.
    fn row<T: Element>(&self, factors: &[Factor<T>], row: usize) -> Result<Vec<Graded>, RowError> {
        let values = self.values(|i| self.given(factors, i, row), |_| true);
        values.map_err(|(step, error)| RowError { row, step, error })
    }

    /// A row of an input.
    fn given<T: Element>(&self, factors: &[Factor<T>], input: usize, row: usize) -> Given {
        let numbers = factors[input].rows(row, 1);
        Given::new(self.inputs[input], |k| numbers[k].into())
    }

    /// The work for a row, in units of reading or writing a number; several threads pay from a million units on.
    pub fn weight(&self) -> usize {
        let of_step = |work: &Work| if matches!(work, Work::Function(_)) { 300 } else { 2 };
        self.inputs.iter().map(|&kind| kind.size()).sum::<usize>()
            + self.steps.iter().map(|step| of_step(&step.work)).sum::<usize>()
    }
}

/// A sweep over all rows.
struct Sweep<'a> {
    runner: &'a Runner,
    schedule: &'a Schedule,
    path: Path,
    /// Whether results bypass the caches.
    streamed: bool,
    failure: Mutex<Option<RowError>>,
}

impl Sweep<'_> {
    fn run<T: Element, const W: usize>(
        &self,
        threads: Threads,
        factors: &[Factor<T>],
        mut targets: Vec<Target<T>>,
        total: usize,
    ) {
        let pieces = threads.ranges(total, SHARED / self.runner.weight());
        let pieces = pieces.map(|rows| {
            let piece: Vec<_> = targets.iter_mut().map(|target| target.split_off(rows.len())).collect();
            (rows, piece)
        });
        for_each(pieces, |(mut rows, mut targets)| {
            let mut factors: Vec<_> = factors.iter().map(|factor| factor.piece(rows.clone())).collect();
            let chained = self.chained(&factors, &mut targets);
            let count = rows.len() - chained;
            if count == 0 {
                return;
            }
            if chained > 0 {
                factors.iter_mut().for_each(|factor| *factor = factor.piece(chained..rows.len()));
                rows.start += chained;
            }
            let done = if count < GROUP {
                self.piece::<T, GROUP>(&factors, &mut targets, count)
            } else {
                self.piece::<T, W>(&factors, &mut targets, count)
            };
            if let Err(error) = done {
                let error = RowError { row: rows.start + error.row, ..error };
                let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
                if failure.is_none_or(|earlier| error.row < earlier.row) {
                    *failure = Some(error);
                }
            }
        });
    }

    /// The first rows of a piece as a chain, if the program is one; returns their number.
    fn chained<T: Element>(&self, factors: &[Factor<T>], targets: &mut [Target<T>]) -> usize {
        let [target] = targets else { return 0 };
        if target.data.len() < GROUP * target.size {
            return 0;
        }
        let rows = |input: usize| (Source::Rows(factors[input].all()), factors[input].size());
        let Some(links) = self.runner.chain(self.path, self.schedule, rows) else { return 0 };
        let mut lanes = self.schedule.filled::<GROUP>();
        let place = (target.at, target.size);
        let done = self.path.chain(&links, &mut lanes, place, target.data, self.streamed);
        let _ = target.split_off(done);
        done
    }

    /// All rows of a piece, up to the first that has no value.
    fn piece<T: Element, const W: usize>(
        &self,
        factors: &[Factor<T>],
        targets: &mut [Target<T>],
        total: usize,
    ) -> Result<(), RowError> {
        let mut lanes = self.schedule.filled::<W>();
        let mut result = Ok(());
        by_blocks((self.path, self.streamed), total, &mut lanes, targets, |first, count, lanes| {
            // Whole blocks can be read in registers.
            let direct = count == W && self.path.has_short_blocks();
            let own = |task: &Task, lanes: &mut [Lane<W>]| match task {
                Task::Read { input, to, direct: by_step } => {
                    if !(direct && *by_step) {
                        self.path.gather(factors[*input].rows(first, count), &mut lanes[to.clone()]);
                    }
                    true
                }
                Task::Do { step, operands, rows, to } if direct && *rows != [None; 2] => {
                    let (a, b, out) = apart(lanes, operands, to);
                    let numbers = |rows: Option<usize>, lanes| match rows {
                        Some(input) => Numbers::Rows(factors[input].rows(first, count)),
                        None => Numbers::Lanes(lanes),
                    };
                    let [a, b] = [numbers(rows[0], a), numbers(rows[1], b)];
                    self.runner.steps[*step].in_registers(self.path, a, b, out);
                    true
                }
                Task::Do { .. } => false,
            };
            let known = self.runner.do_all(&self.schedule.tasks, (self.path, count), lanes, own);
            if !known {
                result = (first..first + count).try_for_each(|row| self.runner.row(factors, row).map(drop));
            }
            if result.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        result
    }
}
