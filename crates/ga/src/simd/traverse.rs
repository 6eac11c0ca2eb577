//! Application of kernels to rows of numbers.
//!
//! Values are stored row by row, `(rows, components)`. A block of rows is transposed into lanes, the kernel works on the
//! lanes, and the result is transposed back. Data beyond the caches is prefetched, and results bypass the caches.

use super::threads::Threads;
use super::{ByRow, Element, Kernel, Lane, Path, in_line, to_next_line};
use std::ops::{ControlFlow, Range};

/// From this many bytes on, factors and product together, the product bypasses the caches.
pub(crate) const STREAMED: usize = 16 << 20;

/// Numbers per thread from which another thread pays.
pub(crate) const SHARED: usize = 1 << 19;

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
        let data =
            if self.one { self.data } else { &self.data[rows.start * self.size..rows.end * self.size] };
        Factor { data, ..self }
    }

    pub fn rows(&self, first: usize, count: usize) -> &[T] {
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

/// Rows written block by block past the caches, in whole cache lines. The rest of a line stays in the buffer until the
/// next block.
struct Stream<'a, T, const W: usize> {
    path: Path,
    out: &'a mut [T],
    written: usize,
    buffer: Vec<Lane<W>>,
    waiting: usize,
}

impl<'a, T: Element, const W: usize> Stream<'a, T, W> {
    fn new(path: Path, target: &'a mut Target<T>) -> Stream<'a, T, W> {
        let buffer = vec![Lane::filled(0.0); target.size + 2];
        Stream { path, out: target.data, written: 0, buffer, waiting: 0 }
    }

    fn write(&mut self, lanes: &[Lane<W>], count: usize) {
        let buffer = Lane::flat(&mut self.buffer);
        let filled = self.waiting + count * lanes.len();
        self.path.scatter(lanes, &mut buffer[self.waiting..filled]);
        let out = &mut self.out[self.written..self.written + filled];
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
        let rest = &mut self.out[self.written..self.written + self.waiting];
        rest.copy_from_slice(&Lane::flat(&mut self.buffer)[..self.waiting]);
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
    let blocks = (0..total).step_by(W).map(|first| (first, W.min(total - first)));
    if streamed {
        let places: Vec<Range<usize>> = targets.iter().map(|t| t.at..t.at + t.size).collect();
        let mut streams: Vec<_> = targets.iter_mut().map(|target| Stream::new(path, target)).collect();
        for (first, count) in blocks {
            if work(first, count, lanes).is_break() {
                break;
            }
            for (stream, place) in streams.iter_mut().zip(&places) {
                stream.write(&lanes[place.clone()], count);
            }
        }
        streams.into_iter().for_each(Stream::finish);
    } else {
        for (first, count) in blocks {
            if work(first, count, lanes).is_break() {
                break;
            }
            for target in &mut *targets {
                let rows = &mut target.data[first * target.size..(first + count) * target.size];
                path.scatter(&lanes[target.at..target.at + target.size], rows);
            }
        }
    }
}

/// Applies a kernel to the rows one by one.
fn by_rows<T: Element, K: ByRow>(kernel: &K, a: Factor<T>, b: Factor<T>, (out, nout): (&mut [T], usize)) {
    let mut numbers = vec![0.0; a.size + b.size + nout];
    let (x, rest) = numbers.split_at_mut(a.size);
    let (y, z) = rest.split_at_mut(b.size);
    for (row, out) in out.chunks_exact_mut(nout).enumerate() {
        for (wide, rows) in [(&mut *x, a.rows(row, 1)), (&mut *y, b.rows(row, 1))] {
            for (wide, &number) in wide.iter_mut().zip(rows) {
                *wide = number.into();
            }
        }
        kernel.row(x, y, z);
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
    let total = out.len() / nout;
    if total < K::FEW || K::FAST_ROWS && path.is_portable() {
        return by_rows(kernel, a, b, (out, nout));
    }
    // Lanes beyond the last rows are computed too; 1 is in the domain of all functions.
    let mut lanes = vec![Lane::<W>::filled(1.0); a.size + b.size + nout];
    let mut target = [Target { data: out, size: nout, at: a.size + b.size }];
    by_blocks((path, streamed), total, &mut lanes, &mut target, |first, count, lanes| {
        let (a_lanes, rest) = lanes.split_at_mut(a.size);
        let (b_lanes, out_lanes) = rest.split_at_mut(b.size);
        a.load(path, first, count, a_lanes);
        b.load(path, first, count, b_lanes);
        path.apply(kernel, a_lanes, b_lanes, out_lanes);
        ControlFlow::Continue(())
    });
}
