//! Functions of rotors over many rows: exp, log and powers.
//!
//! The formulas are those of [`crate::Rotor`] in double-double arithmetic (`simd::double`), or in integers
//! (`simd::payne_hanek`) where that is not accurate enough. Each step of a formula is a loop of its own, because
//! processors overlap only short chains of operations.

use crate::g3::values::scale_of;
use crate::simd::double::{Size, Tangent, common_reciprocal, divide, quarter_turns, sin_cos};
use crate::simd::map::{BUILT_WITH_FMA, Map, alone, lanes_of_one, run};
use crate::simd::payne_hanek;
use crate::simd::threads::Threads;
use crate::simd::{Element, Path};
use std::f64::consts::PI;

/// `cos|B| + B sin|B|/|B|`.
#[derive(Clone, Copy)]
pub(crate) struct Exp;

impl Exp {
    /// `cos|B|` and `sin|B|/|B|`; the cosine is NaN where the long method is needed.
    #[inline(always)]
    pub fn cosine_and_sinc<const W: usize, const FMA: bool>(b: [&[f64; W]; 3]) -> [[f64; W]; 2] {
        /// `r` has an error of 2⁻¹⁰² |B|, which must be negligible. Compared with |B|² this also selects the long
        /// method from |B| = 10⁶ on.
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
        let [mut cosine, mut sinc] = [[0.0; W]; 2];
        for l in 0..W {
            let known = r[l].abs() >= hi[l] * hi[l] * KEPT;
            let cos;
            ((sin[l], rest[l]), cos) = sin_cos::<FMA>(k[l], r[l], rest[l]);
            cosine[l] = if known { cos } else { f64::NAN };
        }
        for l in 0..W {
            let (quotient, correction) = divide::<FMA>((sin[l], rest[l]), (hi[l], lo[l]), reciprocal[l]);
            sinc[l] = quotient + correction;
        }
        [cosine, sinc]
    }
}

impl Map<3, 0, 4> for Exp {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(&self, b: [&[f64; W]; 3], _: [&[f64; W]; 0]) -> [[f64; W]; 4] {
        let [cosine, sinc] = Exp::cosine_and_sinc::<W, FMA>(b);
        let mut out = [cosine, [0.0; W], [0.0; W], [0.0; W]];
        for l in 0..W {
            for i in 0..3 {
                out[i + 1][l] = b[i][l] * sinc[l];
            }
        }
        out
    }

    fn long(&self, b: [f64; 3], _: [f64; 0]) -> [f64; 4] {
        let scale = scale_of(&b);
        let scaled = b.map(|x| x / scale);
        let size = Size::of::<BUILT_WITH_FMA>(scaled);
        let (k, r, rest) = payne_hanek::quarter_turns(b);
        let (sin, cos) = sin_cos::<BUILT_WITH_FMA>(k, r, rest);
        let reciprocal = 1.0 / size.hi;
        let (sinc, correction) = divide::<BUILT_WITH_FMA>(sin, (size.hi, size.lo(reciprocal)), reciprocal);
        let [x, y, z] = scaled.map(|x| x * (sinc + correction));
        [cos, x, y, z]
    }
}

/// `B atan2(|B|, s)/|B|` of `s + B`.
#[derive(Clone, Copy)]
pub(crate) struct Log;

impl Log {
    /// `atan2(|B|, s)/|B|`; NaN where the long method is needed.
    #[inline(always)]
    pub fn angle_over_size<const W: usize, const FMA: bool>(c: [&[f64; W]; 4]) -> [f64; W] {
        /// Between these bounds rounding errors of squares are exact. Only rotors that are −1 up to a tiny bivector are
        /// outside.
        const LEAST: f64 = 1e-100;
        const MOST: f64 = 1e100;
        let [s, x, y, z] = c;
        let [mut hi, mut lo, mut square, mut reciprocal] = [[0.0; W]; 4];
        let [mut u, mut rest, mut eighths, mut excess] = [[0.0; W]; 4];
        for l in 0..W {
            let size = Size::of::<FMA>([x[l], y[l], z[l]]);
            (hi[l], rest[l], square[l]) = (size.hi, size.rest, size.square);
        }
        for l in 0..W {
            let size = Size { hi: hi[l], rest: rest[l], square: square[l] };
            reciprocal[l] = common_reciprocal(size, s[l]);
        }
        for l in 0..W {
            let size = Size { hi: hi[l], rest: rest[l], square: square[l] };
            let tangent;
            (tangent, lo[l], reciprocal[l]) = Tangent::of::<FMA>(size, s[l], reciprocal[l]);
            (u[l], rest[l], eighths[l]) = (tangent.u, tangent.rest, tangent.eighths);
        }
        let tangent = |u, rest, eighths| Tangent { u, rest, eighths };
        for l in 0..W {
            excess[l] = tangent(u[l], rest[l], eighths[l]).excess();
        }
        for l in 0..W {
            (u[l], rest[l]) = tangent(u[l], rest[l], eighths[l]).angle::<FMA>(s[l], excess[l]);
        }
        let mut factor = [0.0; W];
        for l in 0..W {
            let (quotient, correction) = divide::<FMA>((u[l], rest[l]), (hi[l], lo[l]), reciprocal[l]);
            let quotient = quotient + correction;
            let known = (quotient > LEAST) & (quotient < MOST);
            factor[l] = if known { quotient } else { f64::NAN };
        }
        factor
    }
}

impl Map<4, 0, 3> for Log {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(&self, c: [&[f64; W]; 4], _: [&[f64; W]; 0]) -> [[f64; W]; 3] {
        let factor = Log::angle_over_size::<W, FMA>(c);
        let mut out = [[0.0; W]; 3];
        for l in 0..W {
            for i in 0..3 {
                out[i][l] = c[i + 1][l] * factor[l];
            }
        }
        out
    }

    /// Rows beyond the fast method, once scaled, are −1 up to a tiny bivector, or zero, which is not a rotor.
    fn long(&self, c: [f64; 4], _: [f64; 0]) -> [f64; 3] {
        const EXACT_PI: (f64, f64) = (PI, 1.224_646_799_147_353_2e-16);
        let scale = scale_of(&c);
        let [s, x, y, z] = c.map(|x| x / scale);
        let value = alone(Log.short::<1, BUILT_WITH_FMA>(lanes_of_one(&[s, x, y, z]), []));
        if !value[0].is_nan() {
            return value;
        }
        let scale = scale_of(&[x, y, z]);
        let b = [x, y, z].map(|x| x / scale);
        if b == [0.0; 3] {
            return [0.0, 0.0, if s < 0.0 { PI } else { 0.0 }];
        }
        let size = Size::of::<BUILT_WITH_FMA>(b);
        let reciprocal = 1.0 / size.hi;
        let lo = size.lo(reciprocal);
        let (factor, correction) = divide::<BUILT_WITH_FMA>(EXACT_PI, (size.hi, lo), reciprocal);
        b.map(|x| x * (factor + correction))
    }
}

/// `exp(t log R)`: turns t times as far.
#[derive(Clone, Copy)]
pub(crate) struct Power;

impl Map<4, 1, 4> for Power {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(&self, c: [&[f64; W]; 4], t: [&[f64; W]; 1]) -> [[f64; W]; 4] {
        let mut log = Log.short::<W, FMA>(c, []);
        for l in 0..W {
            for i in 0..3 {
                log[i][l] *= t[0][l];
            }
        }
        Exp.short::<W, FMA>(log.each_ref(), [])
    }

    fn long(&self, c: [f64; 4], [t]: [f64; 1]) -> [f64; 4] {
        Exp.value(Log.value(c, []).map(|x| x * t), [])
    }
}

/// Sine and cosine of a finite angle; NaN if the short method is not accurate enough.
#[inline(always)]
fn circular<const FMA: bool>(x: f64) -> (f64, f64) {
    /// As for [`Exp`].
    const KEPT: f64 = 1.0 / (1u64 << 40) as f64;
    let angle = x.abs();
    let (k, r, rest) = quarter_turns::<FMA>(angle, 0.0);
    let r = if r.abs() >= angle * angle * KEPT { r } else { f64::NAN };
    odd(x, sin_cos::<FMA>(k, r, rest))
}

/// [`circular`] of any finite angle.
fn circular_long(x: f64) -> (f64, f64) {
    let (k, r, rest) = payne_hanek::quarter_turns([x, 0.0, 0.0]);
    odd(x, sin_cos::<BUILT_WITH_FMA>(k, r, rest))
}

/// Gives the sine the sign of the angle.
#[inline(always)]
fn odd(x: f64, ((sin, rest), cos): ((f64, f64), f64)) -> (f64, f64) {
    ((sin + rest) * 1f64.copysign(x), cos)
}

/// A function of sine and cosine as a map of one number.
macro_rules! circular_map {
    ($(#[$doc:meta])* $name:ident, $value:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub(crate) struct $name;

        impl Map<1, 0, 1> for $name {
            #[inline(always)]
            fn short<const W: usize, const FMA: bool>(&self, [x]: [&[f64; W]; 1], _: [&[f64; W]; 0]) -> [[f64; W]; 1] {
                // A loop, because the closure of a map would not be compiled for the instructions of this path.
                let mut out = [0.0; W];
                for l in 0..W {
                    out[l] = $value(circular::<FMA>(x[l]));
                }
                [out]
            }

            fn long(&self, [x]: [f64; 1], _: [f64; 0]) -> [f64; 1] {
                [$value(circular_long(x))]
            }
        }
    };
}

circular_map!(
    /// The sine of an angle within an ulp.
    Sin,
    |(sin, _): (f64, f64)| sin
);
circular_map!(
    /// The cosine of an angle within an ulp.
    Cos,
    |(_, cos): (f64, f64)| cos
);
circular_map!(
    /// The tangent of an angle within 2 ulps.
    Tan,
    |(sin, cos): (f64, f64)| sin / cos
);

/// `exp(B)` of rows of bivectors, as rows of rotor components, each within 2 ulps. Fails with the index of
/// the first row that is not finite; the result is then unspecified.
///
/// # Panics
/// If the numbers of rows do not fit together. One row may stand for all.
pub fn exp<T: Element>(threads: Threads, bivectors: &[T], out: &mut [T]) -> Result<(), usize> {
    run(Exp, (Path::best(), threads), bivectors, &[], out)
}

/// `log R` of rows of rotor components, as rows of bivectors, each number within 2 ulps: on the whole
/// double cover, as [`crate::Rotor::log`]. That the rotors are unit is not checked. Fails as [`exp`].
///
/// # Panics
/// If the numbers of rows do not fit together. One row may stand for all.
pub fn log<T: Element>(threads: Threads, rotors: &[T], out: &mut [T]) -> Result<(), usize> {
    run(Log, (Path::best(), threads), rotors, &[], out)
}

/// `exp(t log R)` of rows of rotor components and rows of one number t: turns t times as far. Fails with
/// the index of the first row that is not finite, or whose angle overflows.
///
/// # Panics
/// If the numbers of rows do not fit together. One row of either may stand for all.
pub fn power<T: Element>(
    threads: Threads,
    rotors: &[T],
    exponents: &[T],
    out: &mut [T],
) -> Result<(), usize> {
    run(Power, (Path::best(), threads), rotors, exponents, out)
}

/// `exp(B)` of one bivector, the same bits as [`exp`]; NaN if it is not finite.
pub(crate) fn exp_one(b: [f64; 3]) -> [f64; 4] {
    Exp.value(b, [])
}

/// `log R` of one rotor, the same bits as [`log`]; NaN if it is not finite.
pub(crate) fn log_one(c: [f64; 4]) -> [f64; 3] {
    Log.value(c, [])
}

/// `exp(t log R)` of one rotor, the same bits as [`power`]; NaN if it has no value.
pub(crate) fn power_one(c: [f64; 4], t: f64) -> [f64; 4] {
    Power.value(c, [t])
}

#[cfg(test)]
mod tests;
