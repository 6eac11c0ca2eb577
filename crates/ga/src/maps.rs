//! Functions of rotors over many rows: exp, log and powers.
//!
//! Each row is computed by arithmetic without branches ([`crate::lanes_math`]), which fails only where the
//! row needs more than sums of two numbers, and says so by NaN. Such rows are computed again, one by
//! one, the long way. Results are the same bits on every machine and path, for one row or many.

use crate::lanes_math::{REDUCED, Size, angle_over_size, divide, quarter_turns, sin_cos};
use crate::reduction;
use crate::simd::{Kernel, LANES, Lane, Path};
use crate::sweep::sweep;
use crate::values::scale_of;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether this build has fused multiply-add everywhere. If not, lanes may still have it.
const FMA: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// A function of a row of `A` numbers and one of `B`.
trait Map<const A: usize, const B: usize, const OUT: usize> {
    /// Its value where the first number is not NaN. No branches.
    fn short<const FMA: bool>(a: [f64; A], b: [f64; B]) -> [f64; OUT];

    /// Its value for any finite row.
    fn long(a: [f64; A], b: [f64; B]) -> [f64; OUT];

    /// Its value; NaN if the row is not finite.
    fn value(a: [f64; A], b: [f64; B]) -> [f64; OUT] {
        let value = Self::short::<FMA>(a, b);
        if !value[0].is_nan() {
            value
        } else if a.iter().chain(&b).all(|x| x.is_finite()) {
            Self::long(a, b)
        } else {
            [f64::NAN; OUT]
        }
    }
}

/// `cos|B| + B sin|B|/|B|`.
struct Exp;

impl Map<3, 0, 4> for Exp {
    #[inline(always)]
    fn short<const FMA: bool>(b: [f64; 3], _: [f64; 0]) -> [f64; 4] {
        /// Below, `sin x/x` is 1 to 2⁻⁵⁸.
        const TINY: f64 = 1.0 / (1u64 << 56) as f64;
        /// `r` must be so much of the angle that 2⁻¹⁰³ of the angle is nothing to it.
        const KEPT: f64 = 1.0 / (1u64 << 46) as f64;
        let size = Size::of::<FMA>(b);
        let tiny = size.square < TINY;
        let reciprocal = 1.0 / if tiny { 1.0 } else { size.hi };
        let lo = size.lo(reciprocal);
        let (k, r, rest) = quarter_turns(size.hi, lo);
        let (sin, (cos, _)) = sin_cos(k, r, rest);
        let quotient = divide::<FMA>(sin, (size.hi, lo), reciprocal).0;
        let sinc = if tiny { 1.0 } else { quotient };
        let known = size.hi <= REDUCED && r.abs() >= size.hi * KEPT;
        [if known { cos } else { f64::NAN }, b[0] * sinc, b[1] * sinc, b[2] * sinc]
    }

    fn long(b: [f64; 3], _: [f64; 0]) -> [f64; 4] {
        let scale = scale_of(&b);
        let scaled = b.map(|x| x / scale);
        let size = Size::of::<FMA>(scaled);
        let (k, r, rest) = reduction::quarter_turns(b);
        let (sin, (cos, _)) = sin_cos(k, r, rest);
        let reciprocal = 1.0 / size.hi;
        let sinc = divide::<FMA>(sin, (size.hi, size.lo(reciprocal)), reciprocal).0;
        let [x, y, z] = scaled.map(|x| x * sinc);
        [cos, x, y, z]
    }
}

/// `B atan2(|B|, s)/|B|` of `s + B`.
struct Log;

impl Map<4, 0, 3> for Log {
    #[inline(always)]
    fn short<const FMA: bool>([s, x, y, z]: [f64; 4], _: [f64; 0]) -> [f64; 3] {
        /// |B|² and s² are as exact as they must be between these.
        const TINY: f64 = 1e-200;
        const HUGE: f64 = 1e200;
        let size = Size::of::<FMA>([x, y, z]);
        let tiny = size.square < TINY;
        let factor = angle_over_size::<FMA>(size, s, tiny);
        let known = size.square + s * s < HUGE && (s > 0.0 || !tiny);
        let factor = if known { factor } else { f64::NAN };
        [x * factor, y * factor, z * factor]
    }

    /// Scaled, a row is too short for the other way only if it is −1 but for a tiny bivector.
    fn long(c: [f64; 4], _: [f64; 0]) -> [f64; 3] {
        let scale = scale_of(&c);
        let [s, x, y, z] = c.map(|x| x / scale);
        let value = Log::short::<FMA>([s, x, y, z], []);
        if !value[0].is_nan() {
            return value;
        }
        let scale = scale_of(&[x, y, z]);
        let b = [x, y, z].map(|x| x / scale);
        let size = Size::of::<FMA>(b);
        if size.hi == 0.0 {
            return [0.0, 0.0, PI];
        }
        let reciprocal = 1.0 / size.hi;
        let pi = (PI, 1.224_646_799_147_353_2e-16);
        let factor = divide::<FMA>(pi, (size.hi, size.lo(reciprocal)), reciprocal).0;
        b.map(|x| x * factor)
    }
}

/// A map as a kernel, which remembers whether it met a row that is not finite.
struct Mapped<M, const A: usize, const B: usize, const OUT: usize> {
    map: std::marker::PhantomData<M>,
    failed: AtomicBool,
}

impl<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize> Mapped<M, A, B, OUT> {
    fn value(&self, a: [f64; A], b: [f64; B]) -> [f64; OUT] {
        let value = M::value(a, b);
        if value[0].is_nan() {
            self.failed.store(true, Ordering::Relaxed);
        }
        value
    }

    #[inline(always)]
    fn lanes<const FMA: bool>(&self, a: &[Lane], b: &[Lane], out: &mut [Lane]) {
        let (a, b, out) = (&a[..A], &b[..B], &mut out[..OUT]);
        let row = |l: usize| (std::array::from_fn(|k| a[k].0[l]), std::array::from_fn(|k| b[k].0[l]));
        let mut missing = 0;
        for l in 0..LANES {
            let (a, b) = row(l);
            let value = M::short::<FMA>(a, b);
            for k in 0..OUT {
                out[k].0[l] = value[k];
            }
            missing |= u64::from(value[0].is_nan());
        }
        if missing != 0 {
            for l in 0..LANES {
                if out[0].0[l].is_nan() {
                    let (a, b) = row(l);
                    let value = self.value(a, b);
                    for k in 0..OUT {
                        out[k].0[l] = value[k];
                    }
                }
            }
        }
    }
}

impl<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize> Kernel for Mapped<M, A, B, OUT> {
    fn row(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.value(std::array::from_fn(|k| a[k]), std::array::from_fn(|k| b[k])));
    }

    #[inline(always)]
    fn block(&self, a: &[Lane], b: &[Lane], out: &mut [Lane]) {
        self.lanes::<FMA>(a, b, out);
    }

    #[inline(always)]
    fn block_fma(&self, a: &[Lane], b: &[Lane], out: &mut [Lane]) {
        self.lanes::<true>(a, b, out);
    }
}

/// Sweeps a map over rows; the first row that is not finite, if there is one.
fn run<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(
    _: M,
    path: Path,
    a: &[f64],
    b: &[f64],
    out: &mut [f64],
) -> Result<(), usize> {
    let kernel = Mapped::<M, A, B, OUT> { map: std::marker::PhantomData, failed: AtomicBool::new(false) };
    sweep(path, &kernel, (a, A), (b, B), (out, OUT));
    if kernel.failed.into_inner() {
        let bad = out.chunks_exact(OUT).position(|row| row[0].is_nan());
        return bad.map_or(Ok(()), Err);
    }
    Ok(())
}

/// `exp(B)` of rows of bivectors, as rows of rotor components. If a row is not finite, its index; the
/// result is then of no use.
///
/// # Panics
/// If the numbers of rows differ.
pub fn exp(bivectors: &[f64], out: &mut [f64]) -> Result<(), usize> {
    run(Exp, Path::best(), bivectors, &[], out)
}

/// `log R` of rows of rotor components, as rows of bivectors: on the whole double cover, as
/// [`crate::Rotor::log`]. If a row is not finite, its index; the result is then of no use.
///
/// # Panics
/// If the numbers of rows differ.
pub fn log(rotors: &[f64], out: &mut [f64]) -> Result<(), usize> {
    run(Log, Path::best(), rotors, &[], out)
}
