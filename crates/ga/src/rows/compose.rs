//! Products of rotors over many rows, renormalized.

use crate::g3::rotor::Rotor;
use crate::simd::short::Short;
use crate::simd::threads::Threads;
use crate::simd::traverse::sweep;
use crate::simd::{ByRow, Element, Kernel, LANES, Lane, Path, by_lanes};
use std::array::from_fn;

/// `S R` for rows of rotor components, as [`Rotor::compose`].
pub(crate) struct Compose;

#[inline(always)]
fn product(s: [f64; 4], r: [f64; 4]) -> [f64; 4] {
    Rotor::from_unit_components(s).compose(Rotor::from_unit_components(r)).components()
}

impl ByRow for Compose {
    const FAST_ROWS: bool = true;

    fn row(&self, _: Path, s: &[f64], r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&product(from_fn(|k| s[k]), from_fn(|k| r[k])));
    }

    fn in_registers<T: Element>(&self, path: Path, s: &[T], r: &[T], out: &mut [T], streamed: bool) -> usize {
        path.short::<Compose, T, 4, 4, 4>(s, r, out, streamed)
    }
}

impl Short<4, 4, 4> for Compose {
    #[inline(always)]
    fn value(s: [f64; 4], r: [f64; 4]) -> [f64; 4] {
        product(s, r)
    }
}

impl<const W: usize> Kernel<W> for Compose {
    #[inline(always)]
    fn block(&self, s: &[Lane<W>], r: &[Lane<W>], out: &mut [Lane<W>]) {
        by_lanes(s, r, out, product);
    }
}

/// The products S R, which turn by R first, row by row; a single row is broadcast.
///
/// # Panics
/// If the numbers of rows do not fit together.
pub fn compose<T: Element>(threads: Threads, s: &[T], r: &[T], out: &mut [T]) {
    compose_on(Path::best(), threads, s, r, out);
}

fn compose_on<T: Element>(path: Path, threads: Threads, s: &[T], r: &[T], out: &mut [T]) {
    sweep::<_, LANES, _>(path, threads, &Compose, (s, 4), (r, 4), (out, 4));
}

#[cfg(test)]
mod tests;
