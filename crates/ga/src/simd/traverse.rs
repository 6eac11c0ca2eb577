//! Application of kernels to rows of numbers.
//!
//! Values are stored row by row, `(rows, components)`. A block of rows is transposed into lanes, the kernel works on the
//! lanes, and the result is transposed back. Results of data beyond the caches bypass them. Rows are read in order, as the
//! hardware foresees; software prefetches further ahead would evict lines of the first-level cache that are still in use.

use super::threads::Threads;
use super::{ByRow, Element, Kernel, Lane, Path, in_line, to_next_line};
use std::ops::{ControlFlow, Range};

/// From this many bytes on, factors and product together, the product bypasses the caches.
pub(crate) const STREAMED: usize = 16 << 20;

/// Rows up to which a block of that many is used, and its lanes, which fit the stack.
pub(crate) const FEW_ROWS: usize = 16;
const FEW_LANES: usize = 8;

/// Numbers per thread from which another thread pays.
pub(crate) const SHARED: usize = 1 << 17;

/// Whether factors and product together exceed the caches.
pub(crate) fn beyond_caches<T>(a: &[T], b: &[T], out: &[T]) -> bool {
    size_of_val(a) + size_of_val(b) + size_of_val(out) >= STREAMED
}

/// Rows of a factor: one for all, or one for each.
#[derive(Clone, Copy)]
pub(crate) struct Factor<'a, T> {
    data: &'a [T],
    size: usize,
    pub one: bool,
}

impl<'a, T: Element> Factor<'a, T> {
    pub fn new(data: &'a [T], size: usize, total: usize) -> Factor<'a, T> {
        let one = data.len() == size;
        assert!(one || data.len() == total * size, "a factor has the wrong length");
        Factor { data, size, one }
    }

    /// Those rows alone.
    pub fn piece(self, rows: Range<usize>) -> Factor<'a, T> {
        Factor { data: self.rows(rows.start, rows.len()), ..self }
    }

    /// The numbers in a row.
    pub fn size(&self) -> usize {
        self.size
    }

    /// All rows.
    pub fn all(&self) -> &'a [T] {
        self.data
    }

    pub fn rows(&self, first: usize, count: usize) -> &'a [T] {
        if self.one { self.data } else { &self.data[first * self.size..(first + count) * self.size] }
    }

    /// Fills the lanes from rows, or at the first block from the single row.
    pub fn load<const W: usize>(&self, path: Path, first: usize, count: usize, lanes: &mut [Lane<W>]) {
        if !self.one {
            path.gather(self.rows(first, count), lanes);
        } else if first == 0 {
            for (lane, &x) in lanes.iter_mut().zip(self.data) {
                *lane = Lane::filled(x.into());
            }
        }
    }
}

/// Rows to fill from the lanes from `at` on.
pub(crate) struct Target<'a, T> {
    pub data: &'a mut [T],
    pub size: usize,
    pub at: usize,
}

impl<'a, T> Target<'a, T> {
    /// Splits off the first rows.
    pub fn split_off(&mut self, rows: usize) -> Target<'a, T> {
        let data = self.data.split_off_mut(..rows * self.size).expect("there are so many rows");
        Target { data, ..*self }
    }
}

/// Rows written block by block: past the caches, in whole cache lines, where the rest of a line stays in the buffer until
/// the next block; or without a buffer, as they come.
struct Writer<'a, T, const W: usize> {
    path: Path,
    /// The lanes that it writes.
    lanes: Range<usize>,
    out: &'a mut [T],
    written: usize,
    buffer: Option<Vec<Lane<W>>>,
    waiting: usize,
}

impl<'a, T: Element, const W: usize> Writer<'a, T, W> {
    fn new(path: Path, streamed: bool, target: &'a mut Target<T>) -> Writer<'a, T, W> {
        let buffer = streamed.then(|| vec![Lane::filled(0.0); target.size + 2]);
        let lanes = target.at..target.at + target.size;
        Writer { path, lanes, out: target.data, written: 0, buffer, waiting: 0 }
    }

    fn write(&mut self, lanes: &[Lane<W>], count: usize) {
        let lanes = &lanes[self.lanes.clone()];
        let filled = self.waiting + count * lanes.len();
        let out = &mut self.out[self.written..self.written + filled];
        let Some(buffer) = &mut self.buffer else {
            self.written += filled;
            return self.path.scatter(lanes, out);
        };
        let buffer = Lane::flat(buffer);
        self.path.scatter(lanes, &mut buffer[self.waiting..filled]);
        // Numbers before the first whole line.
        let head = to_next_line(out).min(filled);
        let tail = (filled - head) % in_line::<T>();
        out[..head].copy_from_slice(&buffer[..head]);
        self.path.stream(&buffer[head..filled - tail], &mut out[head..filled - tail]);
        buffer.copy_within(filled - tail..filled, 0);
        self.written += filled - tail;
        self.waiting = tail;
    }

    fn finish(mut self) {
        let Some(buffer) = &mut self.buffer else { return };
        let rest = &mut self.out[self.written..self.written + self.waiting];
        rest.copy_from_slice(&Lane::flat(buffer)[..self.waiting]);
        self.path.fence();
    }
}

/// Calls `work` for each block with its first row, number of rows and lanes, and writes the lanes to the targets.
pub(crate) fn by_blocks<T: Element, const W: usize>(
    (path, streamed): (Path, bool),
    total: usize,
    lanes: &mut [Lane<W>],
    targets: &mut [Target<T>],
    mut work: impl FnMut(usize, usize, &mut [Lane<W>]) -> ControlFlow<()>,
) {
    let mut writers: Vec<_> = targets.iter_mut().map(|target| Writer::new(path, streamed, target)).collect();
    for first in (0..total).step_by(W) {
        let count = W.min(total - first);
        if work(first, count, lanes).is_break() {
            break;
        }
        writers.iter_mut().for_each(|writer| writer.write(lanes, count));
    }
    writers.into_iter().for_each(Writer::finish);
}

/// Applies a kernel to the rows one by one.
fn by_rows<T: Element, K: ByRow>(
    path: Path,
    kernel: &K,
    a: Factor<T>,
    b: Factor<T>,
    (out, nout): (&mut [T], usize),
) {
    let mut numbers = vec![0.0; a.size + b.size + nout];
    let (x, rest) = numbers.split_at_mut(a.size);
    let (y, z) = rest.split_at_mut(b.size);
    for (row, out) in out.chunks_exact_mut(nout).enumerate() {
        for (wide, rows) in [(&mut *x, a.rows(row, 1)), (&mut *y, b.rows(row, 1))] {
            for (wide, &number) in wide.iter_mut().zip(rows) {
                *wide = number.into();
            }
        }
        kernel.row(path, x, y, z);
        for (number, &wide) in out.iter_mut().zip(&*z) {
            *number = T::nearest(wide);
        }
    }
}

/// Applies a kernel to all rows of `(numbers, numbers in a row)`.
pub(crate) fn sweep<T: Element, const W: usize, K: Kernel<W> + ByRow>(
    path: Path,
    threads: Threads,
    kernel: &K,
    (a, na): (&[T], usize),
    (b, nb): (&[T], usize),
    (out, nout): (&mut [T], usize),
) {
    let total = out.len() / nout;
    assert_eq!(out.len(), total * nout, "the result is not a whole number of rows");
    let (a, b) = (Factor::new(a, na, total), Factor::new(b, nb, total));
    let streamed = path.streams() && beyond_caches(a.data, b.data, out);
    threads.for_each_piece(SHARED / (na + nb + nout), nout, out, |rows, out| {
        let (a, b) = (a.piece(rows.clone()), b.piece(rows));
        sweep_piece(path, streamed, kernel, a, b, (out, nout));
    });
}

fn sweep_piece<T: Element, const W: usize, K: Kernel<W> + ByRow>(
    path: Path,
    streamed: bool,
    kernel: &K,
    a: Factor<T>,
    b: Factor<T>,
    (out, nout): (&mut [T], usize),
) {
    let few = out.len() / nout < K::FEW;
    let done = if few { 0 } else { kernel.in_registers(path, a.data, b.data, out, streamed) };
    let rows = done..out.len() / nout;
    let out = &mut out[done * nout..];
    if rows.is_empty() {
        return;
    }
    let (a, b, total) = (a.piece(rows.clone()), b.piece(rows.clone()), rows.len());
    if total < K::FEW || K::FAST_ROWS && path.is_portable() {
        return by_rows(path, kernel, a, b, (out, nout));
    }
    let at = a.size + b.size;
    let size = at + nout;
    let work = |first, count, lanes: &mut [Lane<W>]| {
        let (a_lanes, rest) = lanes.split_at_mut(a.size);
        let (b_lanes, out_lanes) = rest.split_at_mut(b.size);
        a.load(path, first, count, a_lanes);
        b.load(path, first, count, b_lanes);
        path.apply(kernel, a_lanes, b_lanes, out_lanes);
        ControlFlow::Continue(())
    };
    // Lanes beyond the last rows are computed too; 1 is in the domain of all functions.
    let one = Lane::<W>::filled(1.0);
    if total <= W && W <= FEW_ROWS && size <= FEW_LANES {
        // One block, for which allocating memory would take a fifth of the time.
        let lanes = &mut [one; FEW_LANES][..size];
        let _ = work(0, total, lanes);
        return path.scatter(&lanes[at..], out);
    }
    let (mut lanes, mut target) = (vec![one; size], [Target { data: out, size: nout, at }]);
    by_blocks((path, streamed), total, &mut lanes, &mut target, work);
}
