//! A kernel over rows of numbers.
//!
//! Values lie row by row, `(rows, components)`. A block of rows is turned into lanes, each component
//! contiguous; the kernel works on the lanes; the block is turned back. Beyond the caches all that counts
//! is memory: rows are asked for ahead of time, and results go past the caches.

use crate::simd::{Kernel, LANES, Lane, Path, to_next_line};

/// Below so many rows, turning them into lanes does not pay.
const FEW: usize = 8;

/// From so many numbers on, factors and product together, the product goes past the caches: 16 MiB.
pub(crate) const STREAMED: usize = 1 << 21;

/// Rows of a factor: one for all, or one for each.
struct Factor<'a> {
    data: &'a [f64],
    size: usize,
    one: bool,
}

impl<'a> Factor<'a> {
    fn new(data: &'a [f64], size: usize, total: usize) -> Factor<'a> {
        let one = data.len() == size;
        assert!(one || data.len() == total * size, "a factor has the wrong length");
        Factor { data, size, one }
    }

    fn rows(&self, first: usize, count: usize) -> &[f64] {
        if self.one { self.data } else { &self.data[first * self.size..(first + count) * self.size] }
    }

    /// Fills the lanes from rows, or once and for all, at the first block, from the one row.
    fn load(&self, path: Path, first: usize, count: usize, lanes: &mut [Lane]) {
        if !self.one {
            path.gather(self.rows(first, count), lanes);
        } else if first == 0 {
            for (lane, &x) in lanes.iter_mut().zip(self.data) {
                *lane = Lane::filled(x);
            }
        }
    }
}

/// Rows written one block after the other past the caches, where only whole cache lines are fast. What
/// does not fill a line waits in the buffer for the next block.
struct Stream<'a> {
    path: Path,
    out: &'a mut [f64],
    written: usize,
    buffer: &'a mut [f64],
    waiting: usize,
}

impl Stream<'_> {
    fn write(&mut self, lanes: &[Lane], count: usize) {
        let filled = self.waiting + count * lanes.len();
        self.path.scatter(lanes, &mut self.buffer[self.waiting..filled]);
        let out = &mut self.out[self.written..self.written + filled];
        // Before the first line, and in it only.
        let head = to_next_line(out).min(filled);
        let tail = (filled - head) % 8;
        out[..head].copy_from_slice(&self.buffer[..head]);
        self.path.stream(&self.buffer[head..filled - tail], &mut out[head..filled - tail]);
        self.buffer.copy_within(filled - tail..filled, 0);
        self.written += filled - tail;
        self.waiting = tail;
    }

    fn finish(self) {
        self.out[self.written..].copy_from_slice(&self.buffer[..self.waiting]);
        self.path.fence();
    }
}

/// Applies a kernel to all rows of `(numbers, numbers in a row)`.
pub(crate) fn sweep<K: Kernel>(
    path: Path,
    kernel: &K,
    (a, na): (&[f64], usize),
    (b, nb): (&[f64], usize),
    (out, nout): (&mut [f64], usize),
) {
    let total = out.len() / nout;
    assert_eq!(out.len(), total * nout, "the result is not a whole number of rows");
    let (a, b) = (Factor::new(a, na, total), Factor::new(b, nb, total));
    if total < FEW || K::FAST_ROWS && path.is_portable() {
        for (row, out) in out.chunks_exact_mut(nout).enumerate() {
            kernel.row(a.rows(row, 1), b.rows(row, 1), out);
        }
        return;
    }
    let streamed = !path.is_portable() && a.data.len() + b.data.len() + out.len() >= STREAMED;
    // What lies beyond the last rows is computed too; no function has difficulties with 1.
    let mut lanes = vec![Lane::filled(1.0); na + nb + nout + if streamed { nout + 1 } else { 0 }];
    let (a_lanes, rest) = lanes.split_at_mut(na);
    let (b_lanes, rest) = rest.split_at_mut(nb);
    let (out_lanes, buffer) = rest.split_at_mut(nout);
    let mut block = |first, count, out: &mut [Lane]| {
        a.load(path, first, count, a_lanes);
        b.load(path, first, count, b_lanes);
        path.apply(kernel, a_lanes, b_lanes, out);
    };
    if streamed {
        let buffer = Lane::flat(buffer);
        let mut stream = Stream { path, out, written: 0, buffer, waiting: 0 };
        for first in (0..total).step_by(LANES) {
            let count = LANES.min(total - first);
            block(first, count, out_lanes);
            stream.write(out_lanes, count);
        }
        stream.finish();
    } else {
        for (i, rows) in out.chunks_mut(LANES * nout).enumerate() {
            block(i * LANES, rows.len() / nout, out_lanes);
            path.scatter(out_lanes, rows);
        }
    }
}
