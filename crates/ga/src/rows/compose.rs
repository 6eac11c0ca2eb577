//! Products of rotors over many rows, renormalized.

use crate::g3::rotor::Rotor;
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

    fn row(&self, s: &[f64], r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&product(from_fn(|k| s[k]), from_fn(|k| r[k])));
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
mod tests {
    use super::*;

    /// Rows of norm 1 to rounding, and some as far off as those of single precision.
    fn rotors(count: usize, phase: f64) -> Vec<f64> {
        let rotor = |i: usize| {
            let c = std::array::from_fn(|k| ((4 * i + k) as f64 + phase).sin());
            let size = if i.is_multiple_of(5) { 1.0 + 3e-8 } else { 1.0 };
            Rotor::from_components(c).unwrap().components().map(|x| x * size)
        };
        (0..count).flat_map(rotor).collect()
    }

    /// Every path and any number of threads give the bits of single rotors, of norm 1.
    #[test]
    fn rows_equal_single_rotors() {
        let (s, r) = (rotors(150, 0.3), rotors(150, 1.1));
        let unit = |c: &[f64]| Rotor::from_unit_components(std::array::from_fn(|k| c[k]));
        for path in Path::available() {
            for (many_s, many_r) in [(1, 150), (150, 1), (150, 150), (5, 5), (1, 1)] {
                let rows = many_s.max(many_r);
                let mut out = vec![f64::NAN; 4 * rows];
                compose_on(path, Threads::new(3), &s[..4 * many_s], &r[..4 * many_r], &mut out);
                for (i, got) in out.chunks_exact(4).enumerate() {
                    let (i, j) = (i.min(many_s - 1), i.min(many_r - 1));
                    let expected = unit(&s[4 * i..]).compose(unit(&r[4 * j..])).components();
                    assert_eq!(got, expected, "{path:?}");
                    let norm = got.iter().map(|x| x * x).sum::<f64>().sqrt();
                    assert!((norm - 1.0).abs() <= 4.0 * f64::EPSILON, "{norm}");
                }
            }
        }
    }

    #[test]
    fn the_identity_changes_no_bit() {
        let one = Rotor::IDENTITY.components();
        let r = rotors(151, 0.7).split_off(4); // without the first, which is not a unit
        for c in r.chunks_exact(4).enumerate().filter(|(i, _)| i % 5 != 4).map(|(_, c)| c) {
            let mut out = [0.0; 4];
            compose(Threads::ONE, &one, c, &mut out);
            assert_eq!(out, c);
        }
    }
}
