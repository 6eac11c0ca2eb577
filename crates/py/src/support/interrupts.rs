//! Long work that Ctrl-C stops within a moment.

use pyo3::prelude::*;
use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Pieces of work between which Python may interrupt become longer below this time, and shorter above four times it.
const SHORT: Duration = Duration::from_millis(8);

/// Interval between checks while another thread works.
const BETWEEN_CHECKS: Duration = Duration::from_millis(20);

/// Calls `work` with consecutive ranges of the numbers up to `count`; Python may interrupt between them. The first has
/// `first` numbers, the others as many as take some milliseconds.
pub(crate) fn in_pieces(
    py: Python<'_>,
    count: usize,
    first: usize,
    mut work: impl FnMut(Range<usize>) -> PyResult<()>,
) -> PyResult<()> {
    let (mut done, mut size) = (0, first.max(1));
    while done < count {
        let end = count.min(done.saturating_add(size));
        let begin = Instant::now();
        work(done..end)?;
        py.check_signals()?;
        match begin.elapsed() {
            took if took < SHORT => size = size.saturating_mul(2),
            took if took > 4 * SHORT => size = (size / 2).max(1),
            _ => {}
        }
        done = end;
    }
    Ok(())
}

/// The result of `work`, done by another thread. If Python interrupts, that thread goes on, and its result is dropped.
pub(crate) fn in_background<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = channel();
    // A receiver that is gone does not want the result.
    let worker = thread::Builder::new().spawn(move || _ = sender.send(work()))?;
    loop {
        let answer;
        (receiver, answer) = py.detach(move || {
            let answer = receiver.recv_timeout(BETWEEN_CHECKS);
            (receiver, answer)
        });
        match answer {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => resume_unwind(panic),
                Ok(()) => unreachable!("the thread sends its result"),
            },
        }
    }
}
