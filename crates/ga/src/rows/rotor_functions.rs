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

impl Map<3, 0, 4> for Exp {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(b: [&[f64; W]; 3], _: [&[f64; W]; 0]) -> [[f64; W]; 4] {
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
        let size = Size::of::<BUILT_WITH_FMA>(scaled);
        let (k, r, rest) = payne_hanek::quarter_turns(b);
        let (sin, cos) = sin_cos::<BUILT_WITH_FMA>(k, r, rest);
        let reciprocal = 1.0 / size.hi;
        let sinc = divide::<BUILT_WITH_FMA>(sin, (size.hi, size.lo(reciprocal)), reciprocal).0;
        let [x, y, z] = scaled.map(|x| x * sinc);
        [cos, x, y, z]
    }
}

/// `B atan2(|B|, s)/|B|` of `s + B`.
#[derive(Clone, Copy)]
pub(crate) struct Log;

impl Map<4, 0, 3> for Log {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(c: [&[f64; W]; 4], _: [&[f64; W]; 0]) -> [[f64; W]; 3] {
        /// Between these bounds rounding errors of squares are exact. Only rotors that are −1 up to a tiny bivector are
        /// outside.
        const LEAST: f64 = 1e-100;
        const MOST: f64 = 1e100;
        let [s, x, y, z] = c;
        let [mut hi, mut lo, mut reciprocal] = [[0.0; W]; 3];
        let [mut u, mut rest, mut eighths, mut excess] = [[0.0; W]; 4];
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
        let tangent = |u, rest, eighths| Tangent { u, rest, eighths };
        for l in 0..W {
            excess[l] = tangent(u[l], rest[l], eighths[l]).excess();
        }
        for l in 0..W {
            (u[l], rest[l]) = tangent(u[l], rest[l], eighths[l]).angle::<FMA>(s[l], excess[l]);
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

    /// Rows beyond the fast method, once scaled, are −1 up to a tiny bivector, or zero, which is not a rotor.
    fn long(c: [f64; 4], _: [f64; 0]) -> [f64; 3] {
        const EXACT_PI: (f64, f64) = (PI, 1.224_646_799_147_353_2e-16);
        let scale = scale_of(&c);
        let [s, x, y, z] = c.map(|x| x / scale);
        let value = alone(Log::short::<1, BUILT_WITH_FMA>(lanes_of_one(&[s, x, y, z]), []));
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
        let factor = divide::<BUILT_WITH_FMA>(EXACT_PI, (size.hi, lo), reciprocal).0;
        b.map(|x| x * factor)
    }
}

/// `exp(t log R)`: turns t times as far.
#[derive(Clone, Copy)]
pub(crate) struct Power;

impl Map<4, 1, 4> for Power {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(c: [&[f64; W]; 4], t: [&[f64; W]; 1]) -> [[f64; W]; 4] {
        let mut log = Log::short::<W, FMA>(c, []);
        for l in 0..W {
            for i in 0..3 {
                log[i][l] *= t[0][l];
            }
        }
        Exp::short::<W, FMA>(log.each_ref(), [])
    }

    fn long(c: [f64; 4], [t]: [f64; 1]) -> [f64; 4] {
        Exp::value(Log::value(c, []).map(|x| x * t), [])
    }
}

/// Sine and cosine of a finite angle, the sine as `hi + lo`; NaN if the short method is not accurate enough.
#[inline(always)]
fn circular<const FMA: bool>(x: f64) -> ((f64, f64), f64) {
    /// As for [`Exp`].
    const KEPT: f64 = 1.0 / (1u64 << 40) as f64;
    let angle = x.abs();
    let (k, r, rest) = quarter_turns::<FMA>(angle, 0.0);
    let r = if r.abs() >= angle * angle * KEPT { r } else { f64::NAN };
    odd(x, sin_cos::<FMA>(k, r, rest))
}

/// [`circular`] of any finite angle.
fn circular_long(x: f64) -> ((f64, f64), f64) {
    let (k, r, rest) = payne_hanek::quarter_turns([x, 0.0, 0.0]);
    odd(x, sin_cos::<BUILT_WITH_FMA>(k, r, rest))
}

/// Gives the sine the sign of the angle.
#[inline(always)]
fn odd(x: f64, ((sin, rest), cos): ((f64, f64), f64)) -> ((f64, f64), f64) {
    let sign = 1f64.copysign(x);
    ((sign * sin, sign * rest), cos)
}

/// A function of sine and cosine as a map of one number.
macro_rules! circular_map {
    ($(#[$doc:meta])* $name:ident, $value:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub(crate) struct $name;

        impl Map<1, 0, 1> for $name {
            #[inline(always)]
            fn short<const W: usize, const FMA: bool>([x]: [&[f64; W]; 1], _: [&[f64; W]; 0]) -> [[f64; W]; 1] {
                [x.map(|x| $value(circular::<FMA>(x)))]
            }

            fn long([x]: [f64; 1], _: [f64; 0]) -> [f64; 1] {
                [$value(circular_long(x))]
            }
        }
    };
}

circular_map!(
    /// The sine of an angle within an ulp.
    Sin,
    |((sin, _), _): ((f64, f64), f64)| sin
);
circular_map!(
    /// The cosine of an angle within an ulp.
    Cos,
    |(_, cos): ((f64, f64), f64)| cos
);
circular_map!(
    /// The tangent of an angle within 2 ulps.
    Tan,
    |((sin, _), cos): ((f64, f64), f64)| sin / cos
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
    Exp::value(b, [])
}

/// `log R` of one rotor, the same bits as [`log`]; NaN if it is not finite.
pub(crate) fn log_one(c: [f64; 4]) -> [f64; 3] {
    Log::value(c, [])
}

/// `exp(t log R)` of one rotor, the same bits as [`power`]; NaN if it has no value.
pub(crate) fn power_one(c: [f64; 4], t: f64) -> [f64; 4] {
    Power::value(c, [t])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// From nothing to the largest, with the borders of the long way and multiples of π/2 between.
    const SIZES: [f64; 20] = [
        0.0,
        5e-324,
        1e-310,
        1e-200,
        1e-121,
        1e-119,
        1e-100,
        1e-60,
        4e-9,
        0.3,
        1.0,
        FRAC_PI_2,
        PI,
        100.0 * PI,
        1e4,
        9.9e5,
        1.1e6,
        1e30,
        1e300,
        f64::MAX,
    ];

    /// Rows of numbers up to any two of the sizes, from a linear congruence.
    fn rows(count: usize, width: usize) -> Vec<f64> {
        let mut state = 1u64;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / (1 << 24) as f64
        };
        let mut pick = move || (SIZES[(next() * 20.0) as usize], 2.0 * next() - 1.0, next());
        let mut all = Vec::new();
        for _ in 0..count {
            let ((size, ..), (other, ..)) = (pick(), pick());
            for _ in 0..width {
                let (_, factor, choice) = pick();
                all.push(match (choice * 8.0) as usize {
                    0 => 0.0,
                    1 => other * factor,
                    2 => size,
                    _ => size * factor,
                });
            }
        }
        all
    }

    fn assert_same(got: &[f64], expected: &[f64], what: &str) {
        for (i, (x, y)) in got.iter().zip(expected).enumerate() {
            assert!(x.to_bits() == y.to_bits(), "{what}, number {i}: {x:e} {y:e}");
        }
    }

    /// Every path, with and without fused instructions, for few rows and many: the same bits.
    fn check<M: Map<A, B, OUT> + Copy, const A: usize, const B: usize, const OUT: usize>(
        map: M,
        a: &[f64],
        b: &[f64],
    ) {
        let pick = |i: usize| (std::array::from_fn(|k| a[i * A + k]), std::array::from_fn(|k| b[i * B + k]));
        let expected: Vec<f64> = (0..a.len() / A).flat_map(|i| M::value(pick(i).0, pick(i).1)).collect();
        assert!(expected.iter().all(|x| x.is_finite()));
        for path in Path::available() {
            for count in [0, 1, 7, 8, 9, 63, 64, 65, a.len() / A] {
                let mut out = vec![0.5; count * OUT];
                run(map, (path, Threads::new(3)), &a[..count * A], &b[..count * B], &mut out).unwrap();
                assert_same(&out, &expected[..count * OUT], &format!("{path:?}, {count} rows"));
            }
        }
    }

    #[test]
    fn every_path_gives_the_same_bits() {
        let bivectors = rows(3000, 3);
        check(Exp, &bivectors, &[]);
        let mut rotors = vec![0.0; 4 * 3000];
        exp(Threads::ONE, &bivectors, &mut rotors).unwrap();
        check(Log, &rotors, &[]);
        let others: Vec<f64> = rows(3000, 4).iter().map(|&x| if x.abs() > 1e200 { 1.0 } else { x }).collect();
        check(Log, &others, &[]);
        check(Power, &rotors, &(0..3000).map(|i| 0.01 * f64::from(i) - 10.0).collect::<Vec<_>>());
    }

    #[test]
    fn the_first_bad_row_is_reported() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for at in 0..4 {
                for row in [0, 3, 69, 130] {
                    let mut c = vec![0.5; 4 * 140];
                    c[4 * row + at] = bad;
                    c[4 * 135] = bad;
                    for path in Path::available() {
                        assert_eq!(
                            run(Log, (path, Threads::ONE), &c, &[], &mut [0.0; 3 * 140]),
                            Err(row),
                            "{path:?}"
                        );
                        let row = (4 * row + at) / 3;
                        assert_eq!(
                            run(Exp, (path, Threads::ONE), &c[..540], &[], &mut [0.0; 4 * 180]),
                            Err(row),
                            "{path:?}"
                        );
                    }
                }
            }
        }
        assert_eq!(power(Threads::ONE, &[0.0, 1.0, 0.0, 0.0], &[1.0, f64::MAX], &mut [0.0; 8]), Err(1));
    }

    #[test]
    fn logarithms_at_the_ends() {
        let cases = [
            ([1.0, 0.0, 0.0, 0.0], [0.0; 3]),
            ([-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, PI]),
            ([-1.0, -0.0, -5e-324, 0.0], [0.0, -PI, 0.0]),
            ([-1.0, f64::MIN_POSITIVE, 0.0, 0.0], [PI, 0.0, 0.0]),
            ([1.0, 5e-324, 0.0, -1e-310], [5e-324, 0.0, -1e-310]),
            ([0.0, 0.0, 1.0, 0.0], [0.0, FRAC_PI_2, 0.0]),
            ([-0.0, 0.0, 0.0, -1.0], [0.0, 0.0, -FRAC_PI_2]),
        ];
        for (rotor, log) in cases {
            assert_eq!(log_one(rotor), log, "{rotor:?}");
        }
    }

    #[test]
    fn powers_multiply_the_angle() {
        let r = exp_one([0.3, -0.2, 0.5]);
        let mut out = [0.0; 12];
        power(Threads::ONE, &r, &[0.0, 1.0, -3.0], &mut out).unwrap();
        let expected = [[1.0, 0.0, 0.0, 0.0], r, exp_one([-0.9, 0.6, -1.5])].concat();
        for (x, y) in out.iter().zip(expected) {
            assert!((x - y).abs() <= 4.0 * f64::EPSILON, "{x} {y}");
        }
    }
}
