//! Functions of rotors over many rows: exp, log and powers.
//!
//! Each row is computed by arithmetic without branches ([`crate::lanes_math`]), which fails only where the
//! row needs more than sums of two numbers, and says so by NaN. Such rows are computed again, one by
//! one, the long way. Results are the same bits on every machine and path, for one row or many.

use crate::lanes_math::{Size, Tangent, common_reciprocal, divide, quarter_turns, sin_cos};
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
    /// Its values for `W` rows, given by components; the first number is NaN where the row needs the long
    /// way. No branches.
    fn short<const W: usize, const FMA: bool>(a: [&[f64; W]; A], b: [&[f64; W]; B]) -> [[f64; W]; OUT];

    /// Its value for any finite row.
    fn long(a: [f64; A], b: [f64; B]) -> [f64; OUT];

    /// Its value; NaN if the row is not finite.
    fn value(a: [f64; A], b: [f64; B]) -> [f64; OUT] {
        let value = Self::short::<1, FMA>(
            a.each_ref().map(std::array::from_ref),
            b.each_ref().map(std::array::from_ref),
        )
        .map(|[x]| x);
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
    fn short<const W: usize, const FMA: bool>(b: [&[f64; W]; 3], _: [&[f64; W]; 0]) -> [[f64; W]; 4] {
        /// `r` must be so much of |B|² that 2⁻¹⁰³ |B| is nothing to it. It is not beyond |B| = 10⁶ either.
        const KEPT: f64 = 1.0 / (1u64 << 40) as f64;
        let [mut hi, mut lo, mut reciprocal, mut r, mut rest, mut sin] = [[0.0; W]; 6];
        for l in 0..W {
            let size = Size::of::<FMA>(b.map(|x| x[l]));
            reciprocal[l] = 1.0 / size.hi;
            (hi[l], lo[l]) = (size.hi, size.lo(reciprocal[l]));
        }
        let mut k = [0; W];
        for l in 0..W {
            (k[l], r[l], rest[l]) = quarter_turns::<FMA>(hi[l], lo[l]);
        }
        let mut out = [[0.0; W]; 4];
        for l in 0..W {
            let known = r[l].abs() >= hi[l] * hi[l] * KEPT;
            let cos;
            ((sin[l], rest[l]), cos) = sin_cos::<FMA>(k[l], r[l], rest[l]);
            out[0][l] = if known { cos } else { f64::NAN };
        }
        for l in 0..W {
            let sinc = divide::<FMA>((sin[l], rest[l]), (hi[l], lo[l]), reciprocal[l]).0;
            for i in 0..3 {
                out[i + 1][l] = b[i][l] * sinc;
            }
        }
        out
    }

    fn long(b: [f64; 3], _: [f64; 0]) -> [f64; 4] {
        let scale = scale_of(&b);
        let scaled = b.map(|x| x / scale);
        let size = Size::of::<FMA>(scaled);
        let (k, r, rest) = reduction::quarter_turns(b);
        let (sin, cos) = sin_cos::<FMA>(k, r, rest);
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
    fn short<const W: usize, const FMA: bool>(c: [&[f64; W]; 4], _: [&[f64; W]; 0]) -> [[f64; W]; 3] {
        /// Between these squares and their rounding errors are exact. A rotor is beyond them only if it is
        /// −1 but for a tiny bivector.
        const LEAST: f64 = 1e-100;
        const MOST: f64 = 1e100;
        let [s, x, y, z] = c;
        let [mut hi, mut lo, mut reciprocal, mut u, mut rest, mut eighths] = [[0.0; W]; 6];
        for l in 0..W {
            let size = Size::of::<FMA>([x[l], y[l], z[l]]);
            (hi[l], rest[l]) = (size.hi, size.rest);
        }
        for l in 0..W {
            reciprocal[l] = common_reciprocal(hi[l], s[l]);
        }
        for l in 0..W {
            let size = Size { hi: hi[l], rest: rest[l] };
            let tangent;
            (tangent, lo[l], reciprocal[l]) = Tangent::of::<FMA>(size, s[l], reciprocal[l]);
            (u[l], rest[l], eighths[l]) = (tangent.u, tangent.rest, tangent.eighths);
        }
        for l in 0..W {
            (u[l], rest[l]) = Tangent { u: u[l], rest: rest[l], eighths: eighths[l] }.angle::<FMA>(s[l]);
        }
        let mut out = [[0.0; W]; 3];
        for l in 0..W {
            let factor = divide::<FMA>((u[l], rest[l]), (hi[l], lo[l]), reciprocal[l]).0;
            let known = (factor > LEAST) & (factor < MOST);
            let factor = if known { factor } else { f64::NAN };
            for i in 0..3 {
                out[i][l] = c[i + 1][l] * factor;
            }
        }
        out
    }

    /// Scaled, a row is too short for the other way only if it is −1 but for a tiny bivector, or zero.
    fn long(c: [f64; 4], _: [f64; 0]) -> [f64; 3] {
        let scale = scale_of(&c);
        let [s, x, y, z] = c.map(|x| x / scale);
        let value = Log::short::<1, FMA>([&[s], &[x], &[y], &[z]], []).map(|[x]| x);
        if !value[0].is_nan() {
            return value;
        }
        let scale = scale_of(&[x, y, z]);
        let b = [x, y, z].map(|x| x / scale);
        let size = Size::of::<FMA>(b);
        if b == [0.0; 3] {
            return [0.0, 0.0, if s < 0.0 { PI } else { 0.0 }];
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
        const W: usize = 32;
        let mut most = 0;
        for i in 0..LANES / W {
            let rows = |lane: &Lane| lane.0.as_chunks::<W>().0[i];
            let (x, y): ([[f64; W]; A], [[f64; W]; B]) =
                (std::array::from_fn(|k| rows(&a[k])), std::array::from_fn(|k| rows(&b[k])));
            let values = M::short::<W, FMA>(x.each_ref(), y.each_ref());
            for k in 0..OUT {
                out[k].0.as_chunks_mut::<W>().0[i] = values[k];
            }
            for x in values[0] {
                most = most.max(x.abs().to_bits());
            }
        }
        if f64::from_bits(most).is_nan() {
            for l in 0..LANES {
                if out[0].0[l].is_nan() {
                    let (a, b) = (std::array::from_fn(|k| a[k].0[l]), std::array::from_fn(|k| b[k].0[l]));
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

/// `exp(B)` of one bivector, the same bits as [`exp`]; NaN if it is not finite.
pub(crate) fn exp_one(b: [f64; 3]) -> [f64; 4] {
    Exp::value(b, [])
}

/// `log R` of one rotor, the same bits as [`log`]; NaN if it is not finite.
pub(crate) fn log_one(c: [f64; 4]) -> [f64; 3] {
    Log::value(c, [])
}
