//! Distribution of rows over threads.
//!
//! A row depends only on its own numbers, so results have the same bits for any number of threads.

use super::workers::together;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The available parallelism is asked for again after this time: to ask takes 30 µs.
const KNOWN: Duration = Duration::from_millis(100);

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

    /// The parallelism available to this process, now or a moment ago.
    pub fn available() -> Threads {
        static LATEST: Mutex<Option<(Threads, Instant)>> = Mutex::new(None);
        let ask = || thread::available_parallelism().map_or(Threads::ONE, |count| Threads::new(count.get()));
        // A lock that is held may have been so when this process was forked. WebAssembly has no clock.
        let latest = if cfg!(target_family = "wasm") { None } else { LATEST.try_lock().ok() };
        let Some(mut latest) = latest else { return ask() };
        if let Some((threads, asked)) = *latest
            && asked.elapsed() < KNOWN
        {
            return threads;
        }
        latest.insert((ask(), Instant::now())).0
    }

    /// The number.
    pub fn count(self) -> usize {
        self.0
    }

    /// Splits rows into one contiguous range for each thread, of at least `least` rows. To wake a thread takes some 10 µs,
    /// to start one 30 µs; a range should take longer.
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

/// Calls `work` for each item, by as many threads as there are items and the system provides.
pub fn for_each<I: Send>(items: impl ExactSizeIterator<Item = I> + Send, work: impl Fn(I) + Sync) {
    let count = items.len();
    if count <= 1 {
        return items.for_each(work);
    }
    let items = Mutex::new(items);
    let next = || items.lock().unwrap_or_else(PoisonError::into_inner).next();
    together(count - 1, &|| {
        while let Some(item) = next() {
            work(item);
        }
    });
}

#[cfg(test)]
mod tests;
