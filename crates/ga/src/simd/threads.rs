//! Distribution of rows over threads.
//!
//! A row depends only on its own numbers, so results have the same bits for any number of threads.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// The number of threads that may share the rows of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threads(usize);

impl Threads {
    /// Only the caller's thread.
    pub const ONE: Threads = Threads(1);

    /// This number, but at least one and at most 1024.
    pub fn new(count: usize) -> Threads {
        Threads(count.clamp(1, 1024))
    }

    /// The parallelism available to this process.
    pub fn available() -> Threads {
        thread::available_parallelism().map_or(Threads::ONE, |count| Threads::new(count.get()))
    }

    /// The number.
    pub fn count(self) -> usize {
        self.0
    }

    /// Splits rows into one contiguous range for each thread, of at least `least` rows. Starting a thread takes some
    /// 30 µs; a range should take longer.
    pub fn ranges(self, rows: usize, least: usize) -> impl ExactSizeIterator<Item = Range<usize>> {
        let count = self.0.min(rows / least.max(1)).max(1);
        (0..count).map(move |i| i * rows / count..(i + 1) * rows / count)
    }

    /// Splits `out`, rows of `size` numbers, as [`Threads::ranges`], and calls `work` for each range with the
    /// rows it spans and the piece itself.
    ///
    /// # Panics
    /// If `out` is not a whole number of rows.
    pub fn for_each_piece<T: Send>(
        self,
        least: usize,
        size: usize,
        out: &mut [T],
        work: impl Fn(Range<usize>, &mut [T]) + Sync,
    ) {
        let total = out.len().checked_div(size).unwrap_or(0);
        assert_eq!(out.len(), total * size, "the result is not a whole number of rows");
        let mut rest = out;
        let pieces = self.ranges(total, least).map(|rows| {
            let piece = rest.split_off_mut(..rows.len() * size).expect("pieces fill the result");
            (rows, piece)
        });
        for_each(pieces, |(rows, piece)| work(rows, piece));
    }
}

/// Calls `work` for each item, in a thread of its own if one can be started.
pub fn for_each<I: Send>(items: impl ExactSizeIterator<Item = I> + Send, work: impl Fn(I) + Sync) {
    let count = items.len();
    if count <= 1 {
        return items.for_each(work);
    }
    let items = Mutex::new(items);
    let next = || items.lock().unwrap_or_else(PoisonError::into_inner).next();
    let worker = || {
        while let Some(item) = next() {
            work(item);
        }
    };
    thread::scope(|scope| {
        // If no more threads can be started, the existing ones do all the work.
        for _ in 1..count {
            if thread::Builder::new().spawn_scoped(scope, worker).is_err() {
                break;
            }
        }
        worker();
    });
}

#[cfg(test)]
mod tests;
