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
    let (mut input, mut out) = (Lane::<W>::filled(0.0), [Lane::filled(0.0); MOST]);
    let blocks = arguments.chunks(W).zip(first.chunks_mut(W * A)).zip(second.chunks_mut(W * B));
    for ((arguments, a), b) in blocks {
        input.0[..arguments.len()].copy_from_slice(arguments);
        path.run(OnLanes::<_, A, B, W> { curve, arguments: &input, out: &mut out });
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
    arguments: &'a Lane<W>,
    out: &'a mut [Lane<W>; MOST],
}

impl<C: Curve<A, B>, const A: usize, const B: usize, const W: usize> Work for OnLanes<'_, C, A, B, W> {
    type Output = ();

    /// [`TOGETHER`] at a time, so that intermediate results stay in registers.
    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let (first, second) = self.out[..A + B].split_at_mut(A);
        for (i, arguments) in self.arguments.0.as_chunks::<TOGETHER>().0.iter().enumerate() {
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
mod tests {
    use super::*;
    use crate::simd::double::{sin_cos, two_product};

    /// Sine, and square with its rounding error.
    struct Sample;

    impl Curve<1, 2> for Sample {
        #[inline(always)]
        fn values<const W: usize, const FMA: bool>(&self, x: &[f64; W]) -> ([[f64; W]; 1], [[f64; W]; 2]) {
            let (mut sin, mut square) = ([[0.0; W]], [[0.0; W]; 2]);
            for l in 0..W {
                sin[0][l] = sin_cos::<FMA>(1, x[l], 0.0).0.0;
                (square[0][l], square[1][l]) = two_product::<FMA>(x[l], x[l]);
            }
            (sin, square)
        }
    }

    /// Its multiples by numbers of one curve or of one for each lane.
    struct Multiples<const C: usize>([f64; C]);

    impl<const C: usize> Curve<1, 2> for Multiples<C> {
        #[inline(always)]
        fn values<const W: usize, const FMA: bool>(&self, x: &[f64; W]) -> ([[f64; W]; 1], [[f64; W]; 2]) {
            let (mut first, mut second) = Sample.values::<W, FMA>(x);
            for l in 0..W {
                let factor = self.0[if C == 1 { 0 } else { l }];
                first[0][l] *= factor;
                second[0][l] *= factor;
                second[1][l] *= factor;
            }
            (first, second)
        }
    }

    #[test]
    fn curves_side_by_side_give_the_same_bits() {
        let factors: [f64; TOGETHER] = std::array::from_fn(|l| 0.3 * l as f64 - 1.7);
        let arguments = factors.map(|x| 0.1 * x);
        for path in Path::available() {
            let (mut a, mut b) = ([[0.5]; TOGETHER], [[0.5; 2]; TOGETHER]);
            let (first, second) = (a.as_flattened_mut(), b.as_flattened_mut());
            blocks::<TOGETHER, 1, 2>(path, &Multiples(factors), &arguments, first, second);
            for l in 0..TOGETHER {
                assert_eq!((a[l], b[l]), value(&Multiples([factors[l]]), arguments[l]), "{path:?}");
            }
        }
    }

    #[test]
    fn every_path_gives_the_same_bits() {
        let arguments: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.003_7 - 0.37).collect();
        for path in Path::available() {
            for count in [0, 1, 15, 16, 17, 63, 64, 65, 80, 81, 200] {
                let (mut a, mut b) = (vec![0.5; count], vec![0.5; 2 * count]);
                piece(path, &Sample, &arguments[..count], &mut a, &mut b);
                for (i, &x) in arguments[..count].iter().enumerate() {
                    assert_eq!(([a[i]], [b[2 * i], b[2 * i + 1]]), value(&Sample, x), "{path:?}");
                }
            }
        }
        let many: Vec<f64> = arguments.iter().cycle().take(3 * SHARED).copied().collect();
        let (mut a, mut b) = (vec![0.0; many.len()], vec![0.0; 2 * many.len()]);
        sample(&Sample, Threads::new(3), &many, &mut a, &mut b);
        assert!(many.iter().enumerate().all(|(i, &x)| [a[i]] == value(&Sample, x).0));
    }
}
