//! Signs of components, as of reversion and involutions.

use crate::simd::lanes::{Work, fastest};
use crate::simd::threads::Threads;
use crate::simd::traverse::{SHARED, beyond_caches};
use crate::simd::{Element, Path, in_line, to_next_line};
use std::array;

/// Numbers that are written at a time: a few cache lines.
const BLOCK: usize = 512;

/// Multiplies each component of rows by the number of its place, 1 or −1.
///
/// # Panics
/// If there are no signs, if `rows` and `out` differ in length, or if they are not whole rows.
pub fn with_signs<T: Element>(threads: Threads, rows: &[T], signs: &[T], out: &mut [T]) {
    assert_eq!(rows.len(), out.len(), "a number for each");
    let size = signs.len();
    // From any place of a row on there are signs for a block.
    let signs: Vec<f64> = signs.iter().cycle().take(BLOCK + size).map(|&sign| sign.into()).collect();
    let streamed = Path::best().streams() && beyond_caches(rows, &[], out);
    threads.for_each_piece(SHARED / size, size, out, |piece, out| {
        let rows = &rows[size * piece.start..size * piece.end];
        fastest(Signed { rows, signs: &signs, size, out, streamed });
    });
}

/// Rows with signs as work.
struct Signed<'a, T> {
    rows: &'a [T],
    signs: &'a [f64],
    size: usize,
    out: &'a mut [T],
    streamed: bool,
}

impl<T: Element> Work for Signed<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Signed { rows, signs, size, out, streamed } = self;
        let path = Path::best();
        let head = if streamed { to_next_line(out).min(out.len()) } else { 0 };
        multiply(&rows[..head], signs, &mut out[..head]);
        for first in (head..out.len()).step_by(BLOCK) {
            let (rows, out) = (&rows[first..], &mut out[first..]);
            let (rows, signs) = (&rows[..BLOCK.min(rows.len())], &signs[first % size..]);
            let out = &mut out[..rows.len()];
            if streamed && out.len().is_multiple_of(in_line::<T>()) {
                let mut block: [T; BLOCK] = array::from_fn(|_| T::nearest(0.0));
                multiply(rows, signs, &mut block[..rows.len()]);
                path.stream(&block[..rows.len()], out);
            } else {
                multiply(rows, signs, out);
            }
        }
        if streamed {
            path.fence();
        }
    }
}

#[inline(always)]
fn multiply<T: Element>(rows: &[T], signs: &[f64], out: &mut [T]) {
    for ((out, &x), sign) in out.iter_mut().zip(rows).zip(signs) {
        let x: f64 = x.into();
        *out = T::nearest(x * sign);
    }
}

#[cfg(test)]
mod tests;
