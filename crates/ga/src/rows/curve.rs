//! Curves: functions of one number, such as a time, whose values are two rows of numbers, in lanes.
//!
//! A [`Curve`] is branch-free arithmetic over `W` arguments, compiled for the widest instructions of the machine. Its
//! values have the same bits on every machine and path, for any number of arguments and threads.

use crate::simd::lanes::Work;
use crate::simd::map::{BUILT_WITH_FMA, alone};
use crate::simd::threads::{Threads, for_each};
use crate::simd::{LANES, Lane, Path};

/// A function of one number with rows of `A` and of `B` numbers for values, at most [`MOST`] together.
pub trait Curve<const A: usize, const B: usize>: Sync {
    /// Its values for `W` arguments, by components. No branches; `#[inline(always)]` down to the arithmetic, so that each
    /// path compiles it for its own instructions. `FMA` must not change results: see [`crate::simd::double`].
    fn values<const W: usize, const FMA: bool>(&self, arguments: &[f64; W])
    -> ([[f64; W]; A], [[f64; W]; B]);
}

/// Numbers in the two rows of a curve.
pub const MOST: usize = 8;

/// Number of arguments from which another thread pays.
const SHARED: usize = 4096;

/// The value of a curve, the same bits as [`sample`].
pub fn value<const A: usize, const B: usize>(
    curve: &impl Curve<A, B>,
    argument: f64,
) -> ([f64; A], [f64; B]) {
    let (first, second) = curve.values::<1, BUILT_WITH_FMA>(&[argument]);
    (alone(first), alone(second))
}

/// The values of a curve for many arguments, as rows.
///
/// # Panics
/// If the numbers of rows do not fit together, or the rows are longer than [`MOST`].
pub fn sample<const A: usize, const B: usize>(
    curve: &impl Curve<A, B>,
    threads: Threads,
    arguments: &[f64],
    mut first: &mut [f64],
    mut second: &mut [f64],
) {
    let count = arguments.len();
    assert!(first.len() == count * A && second.len() == count * B, "results of the wrong length");
    let pieces = threads.ranges(count, SHARED).map(|rows| {
        let length = rows.len();
        let a = first.split_off_mut(..length * A).expect("pieces fill the result");
        let b = second.split_off_mut(..length * B).expect("pieces fill the result");
        (&arguments[rows], a, b)
    });
    let path = Path::best();
    for_each(pieces, |(arguments, a, b)| piece(path, curve, arguments, a, b));
}

/// In lanes as wide as possible, and the rest in narrower ones.
fn piece<const A: usize, const B: usize>(
    path: Path,
    curve: &impl Curve<A, B>,
    arguments: &[f64],
    first: &mut [f64],
    second: &mut [f64],
) {
    let (whole, rest) = arguments.split_at(arguments.len() / LANES * LANES);
    let (a, more_a) = first.split_at_mut(whole.len() * A);
    let (b, more_b) = second.split_at_mut(whole.len() * B);
    blocks::<LANES, A, B>(path, curve, whole, a, b);
    blocks::<TOGETHER, A, B>(path, curve, rest, more_a, more_b);
}

fn blocks<const W: usize, const A: usize, const B: usize>(
    path: Path,
    curve: &impl Curve<A, B>,
    arguments: &[f64],
    first: &mut [f64],
    second: &mut [f64],
) {
    let (mut last, mut out) = ([0.0; W], [Lane::filled(0.0); MOST]);
    let blocks = arguments.chunks(W).zip(first.chunks_mut(W * A)).zip(second.chunks_mut(W * B));
    for ((arguments, a), b) in blocks {
        let arguments = arguments.try_into().unwrap_or_else(|_| {
            last[..arguments.len()].copy_from_slice(arguments);
            &last
        });
        path.run(OnLanes::<_, A, B, W> { curve, arguments, out: &mut out });
        path.scatter(&out[..A], a);
        path.scatter(&out[A..A + B], b);
    }
}

/// Curves that [`together`] evaluates at a time.
pub const TOGETHER: usize = 16;

/// Prefetches data that is read soon, since hardware prefetching stops at the end of each page.
pub fn expect<T>(soon: &T) {
    Path::best().prefetch(soon, 0..size_of::<T>().div_ceil(64));
}

/// Values of as many curves as there are lanes, each for its own argument, as rows: `curves` has coefficients of
/// its own for each lane. The same bits as [`value`] of each.
pub fn together<const A: usize, const B: usize>(
    curves: &impl Curve<A, B>,
    arguments: &[f64; TOGETHER],
    first: &mut [[f64; A]; TOGETHER],
    second: &mut [[f64; B]; TOGETHER],
) {
    let (first, second) = (first.as_flattened_mut(), second.as_flattened_mut());
    blocks::<TOGETHER, A, B>(Path::best(), curves, arguments, first, second);
}

/// The values of a curve for a lane of arguments.
struct OnLanes<'a, C, const A: usize, const B: usize, const W: usize> {
    curve: &'a C,
    arguments: &'a [f64; W],
    out: &'a mut [Lane<W>; MOST],
}

impl<C: Curve<A, B>, const A: usize, const B: usize, const W: usize> Work for OnLanes<'_, C, A, B, W> {
    type Output = ();

    /// [`TOGETHER`] at a time, so that intermediate results stay in registers.
    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let (first, second) = self.out[..A + B].split_at_mut(A);
        for (i, arguments) in self.arguments.as_chunks::<TOGETHER>().0.iter().enumerate() {
            let (a, b) = self.curve.values::<TOGETHER, FMA>(arguments);
            for k in 0..A {
                first[k].0.as_chunks_mut::<TOGETHER>().0[i] = a[k];
            }
            for k in 0..B {
                second[k].0.as_chunks_mut::<TOGETHER>().0[i] = b[k];
            }
        }
    }
}

#[cfg(test)]
mod tests;
