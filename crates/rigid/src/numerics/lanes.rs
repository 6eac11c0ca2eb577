//! Arithmetic in lanes without branches: phase reduction, exponentials, sine and cosine.

use super::double_double::{DoubleDouble, DoubleDoubles};
use polhode_ga::simd::double::{add, quick_two_sum, sin_cos, two_product, two_sum};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Adding 1.5·2⁵² rounds to an integer in the last bits, the nearest up to 2⁵¹.
const INTEGER: f64 = 6_755_399_441_055_744.0;

/// A phase that grows linearly with time, in turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phase {
    /// Per second.
    pub rate: DoubleDouble,
    /// At time 0, as a sum whose large part is exact.
    pub start: [f64; 2],
}

impl Phase {
    /// The phase at time t less whole turns, in [−½, ½], and its rounding error. Whole turns are subtracted from the
    /// exact product of the rate's high part and time, then from the sum with the rest.
    #[inline(always)]
    pub fn turns<const FMA: bool>(&self, t: f64) -> (f64, f64) {
        let (product, error) = two_product::<FMA>(self.rate.hi, t);
        self.reduced(product, error + self.rate.lo * t)
    }

    /// The same at a time in double-double precision.
    #[inline(always)]
    pub fn turns_at_pair<const FMA: bool>(&self, (t, rest): Pair) -> (f64, f64) {
        let (product, error) = two_product::<FMA>(self.rate.hi, t);
        self.reduced(product, error + (self.rate.lo * t + self.rate.hi * rest))
    }

    /// The phase from a product and a small rest.
    #[inline(always)]
    fn reduced(&self, product: f64, rest: f64) -> (f64, f64) {
        let small = rest + self.start[1];
        let rest = product - ((product + INTEGER) - INTEGER);
        let (sum, e) = two_sum(rest, self.start[0]);
        let (sum, e) = two_sum(sum, small + e);
        (sum - ((sum + INTEGER) - INTEGER), e)
    }
}

/// Sine and cosine of a few turns, and a small rest.
#[inline(always)]
pub(crate) fn sin_cos_turns<const FMA: bool>(turns: f64, rest: f64) -> (f64, f64) {
    let quarters = 4.0 * turns;
    let shifted = quarters + INTEGER;
    let part = (quarters - (shifted - INTEGER)) + 4.0 * rest;
    let ((sin, rest), cos) = sin_cos::<FMA>(shifted.to_bits() & 3, part * FRAC_PI_2, 0.0);
    (sin + rest, cos)
}

/// Sine and cosine of an angle in [0, π/2], to a few roundings of each. The remainder of an angle above π/4 is exact but
/// for the low part of π/2.
#[inline(always)]
pub(crate) fn sin_cos_of_quarter<const FMA: bool>(angle: f64) -> (f64, f64) {
    const HALF_PI_REST: f64 = 6.123_233_995_736_766e-17;
    let (quarters, whole) = if angle > FRAC_PI_4 { (1, 1.0) } else { (0, 0.0) };
    let ((sin, rest), cos) = sin_cos::<FMA>(quarters, angle - whole * FRAC_PI_2, -whole * HALF_PI_REST);
    (sin + rest, cos)
}

/// A place within a half period of `u = 4K · turns`.
pub(crate) struct HalfPeriod {
    /// −1 in the half periods beside that about 0.
    pub odd: f64,
    /// `u/2K` from the middle, in [−½, ½], and its sign.
    pub part: f64,
    pub side: f64,
    /// `|u|/2K` from the middle and to the border, with the rest.
    pub from_middle: f64,
    pub to_border: f64,
}

/// The place after turns in [−½, ½] and a rest.
#[inline(always)]
pub(crate) fn half_period(turn: f64, rest: f64) -> HalfPeriod {
    let whole = if turn > 0.25 {
        1.0
    } else if turn < -0.25 {
        -1.0
    } else {
        0.0
    };
    let part = 2.0 * turn - whole;
    let side = 1f64.copysign(part);
    let more = 2.0 * side * rest;
    let from_middle = (part.abs() + more).max(0.0);
    let to_border = ((0.5 - part.abs()) - more).max(0.0);
    HalfPeriod { odd: 1.0 - 2.0 * f64::abs(whole), part, side, from_middle, to_border }
}

/// 1/(k + first)!; the factorials up to 18! are exact.
const fn reciprocal_factorials<const N: usize>(first: usize) -> [f64; N] {
    let (mut c, mut factorial, mut k) = ([0.0; N], 1.0, 2);
    while k < first + N {
        factorial *= k as f64;
        if k >= first {
            c[k - first] = 1.0 / factorial;
        }
        k += 1;
    }
    c
}

/// Largest argument of [`exp_minus`].
pub(crate) const LARGEST: f64 = 705.0;

/// `e^{−x}` and `e^{−x} − 1`, each to a few roundings, for x in [0, [`LARGEST`]].
///
/// `−x = n ln 2 + r` with `|r| <= ½ ln 2`; the series of `e^r − 1` ends below 2⁻⁵⁶ of it.
#[inline(always)]
pub(crate) fn exp_minus(x: f64) -> (f64, f64) {
    /// ln 2 in two parts, the first of 32 bits, so that its products with n are exact.
    const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
    const C: [f64; 12] = reciprocal_factorials(2);
    let shifted = INTEGER - x * std::f64::consts::LOG2_E;
    let n = shifted - INTEGER;
    let r = (-x - n * LN_2[0]) - n * LN_2[1];
    let (r2, r4) = (r * r, (r * r) * (r * r));
    let low = (C[0] + r * C[1]) + r2 * (C[2] + r * C[3]);
    let middle = (C[4] + r * C[5]) + r2 * (C[6] + r * C[7]);
    let high = (C[8] + r * C[9]) + r2 * (C[10] + r * C[11]);
    let p = r + r2 * (low + r4 * (middle + r4 * high));
    let power = f64::from_bits((shifted.to_bits().wrapping_add(1023)) << 52);
    (power + power * p, power * p + (power - 1.0))
}

/// `e^{−x}` for x >= 0 to a few roundings; 0 where it is hardly above the least normal number.
#[inline(always)]
pub(crate) fn decay(x: f64) -> f64 {
    if x > LARGEST { 0.0 } else { exp_minus(x).0 }
}

/// `√(x² + y²)`, also where the squares are beyond the range of floats.
#[inline(always)]
pub(crate) fn hypotenuse(x: f64, y: f64) -> f64 {
    /// The exponents of the least and the largest number whose reciprocal power of two is normal.
    const EXPONENTS: [u64; 2] = [1, 0x7fd];
    let (x, y) = (x.abs(), y.abs());
    let exponent = ((if x > y { x } else { y }).to_bits() >> 52).clamp(EXPONENTS[0], EXPONENTS[1]);
    let (unit, inverse) = (f64::from_bits(exponent << 52), f64::from_bits((0x7fe - exponent) << 52));
    let (x, y) = (x * inverse, y * inverse);
    (x * x + y * y).sqrt() * unit
}

/// A double-double number `hi + lo`, as [`DoubleDouble`], in a lane.
pub(crate) type Pair = (f64, f64);

/// How often [`exp_of_pairs`] doubles an exponent.
const DOUBLINGS: usize = 6;

/// `e^x` and `e^x − 1` of double-double numbers, for |x| up to 720, to 2⁻⁹⁰ of them.
///
/// With `x = n ln 2 + 2⁶ r` a short series gives `e^r − 1`, and `e^{2r} − 1 = (e^r − 1)(2 + (e^r − 1))` doubles the exponent
/// without cancellation. Each step waits for the one before it, so each is done for all lanes before the next one, and
/// low parts are left up to a few ulps of the high ones: products and sums of such pairs are still exact to 2⁻¹⁰⁰.
#[inline(always)]
pub(crate) fn exp_of_pairs<const W: usize, const FMA: bool>(
    x: &DoubleDoubles<W, FMA>,
) -> [DoubleDoubles<W, FMA>; 2] {
    let (n, r) = exponent_and_rest::<W, FMA>(x);
    let mut p = exp_less_1_of_small::<W, FMA>(&r);
    for _ in 0..DOUBLINGS {
        for l in 0..W {
            // 2p + p².
            let double = (p.hi[l] + p.hi[l], p.lo[l] + p.lo[l]);
            let (square, error) = two_product::<FMA>(p.hi[l], p.hi[l]);
            (p.hi[l], p.lo[l]) = loose_sum(double, (square, error + double.0 * p.lo[l]));
        }
    }
    let mut powers = [DoubleDoubles::all(DoubleDouble::ZERO); 2];
    for l in 0..W {
        // 2ⁿ in two factors, for it may be less than the least normal number.
        let half = nearest(0.5 * n[l]);
        let power = power_of_two(half) * power_of_two(n[l] - half);
        let scaled = (p.hi[l] * power, p.lo[l] * power);
        (powers[0].hi[l], powers[0].lo[l]) = add((power, 0.0), scaled);
        (powers[1].hi[l], powers[1].lo[l]) = add(scaled, two_sum(power, -1.0));
    }
    powers
}

/// n and r of `x = n ln 2 + 2⁶ r`, with `|r| < 0.0055`.
#[inline(always)]
fn exponent_and_rest<const W: usize, const FMA: bool>(
    x: &DoubleDoubles<W, FMA>,
) -> ([f64; W], DoubleDoubles<W, FMA>) {
    const LN_2: Pair = (std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
    const SCALE: f64 = 1.0 / (1 << DOUBLINGS) as f64;
    let (mut n, mut r) = ([0.0; W], DoubleDoubles::all(DoubleDouble::ZERO));
    for l in 0..W {
        n[l] = if x.hi[l].abs() <= 0.35 { 0.0 } else { nearest(x.hi[l] * std::f64::consts::LOG2_E) };
        // The difference of the high parts is exact, for the product is 0 or within a factor of two of x.
        let (product, error) = two_product::<FMA>(LN_2.0, n[l]);
        let rest = two_sum(x.hi[l] - product, (x.lo[l] - error) - LN_2.1 * n[l]);
        (r.hi[l], r.lo[l]) = (rest.0 * SCALE, rest.1 * SCALE);
    }
    (n, r)
}

/// `e^r − 1` for `|r| < 0.0055`: the terms from `r⁵/5!` on are below 1e-11 of it, where doubles are enough; those from
/// `r¹²/12!` on are below 1e-33.
#[inline(always)]
fn exp_less_1_of_small<const W: usize, const FMA: bool>(r: &DoubleDoubles<W, FMA>) -> DoubleDoubles<W, FMA> {
    /// 1/(k + 1)!
    const LARGE: [Pair; 4] = [
        (1.0, 0.0),
        (0.5, 0.0),
        (0.166_666_666_666_666_66, 9.251_858_538_542_97e-18),
        (0.041_666_666_666_666_664, 2.312_964_634_635_742_7e-18),
    ];
    const SMALL: [f64; 7] = reciprocal_factorials(5);
    let mut sum = DoubleDoubles::all(DoubleDouble::ZERO);
    for l in 0..W {
        let r = r.hi[l];
        let r2 = r * r;
        let low = (SMALL[0] + r * SMALL[1]) + r2 * (SMALL[2] + r * SMALL[3]);
        let high = (SMALL[4] + r * SMALL[5]) + r2 * SMALL[6];
        (sum.hi[l], sum.lo[l]) = loose_sum(LARGE[3], (r * (low + (r2 * r2) * high), 0.0));
    }
    for k in (0..LARGE.len() - 1).rev() {
        for l in 0..W {
            let product = loose_product::<FMA>((sum.hi[l], sum.lo[l]), (r.hi[l], r.lo[l]));
            (sum.hi[l], sum.lo[l]) = loose_sum(LARGE[k], product);
        }
    }
    for l in 0..W {
        (sum.hi[l], sum.lo[l]) = loose_product::<FMA>((sum.hi[l], sum.lo[l]), (r.hi[l], r.lo[l]));
    }
    sum
}

/// The product of double-double numbers, with a low part up to a few ulps of the high one.
#[inline(always)]
fn loose_product<const FMA: bool>(a: Pair, b: Pair) -> Pair {
    let (hi, error) = two_product::<FMA>(a.0, b.0);
    (hi, error + (a.0 * b.1 + a.1 * b.0))
}

/// The sum of double-double numbers of which the first is larger, with a low part up to a few ulps of the high one.
#[inline(always)]
fn loose_sum(a: Pair, b: Pair) -> Pair {
    let (hi, error) = quick_two_sum(a.0, b.0);
    (hi, error + (a.1 + b.1))
}

/// The nearest integer.
#[inline(always)]
fn nearest(x: f64) -> f64 {
    (x + INTEGER) - INTEGER
}

/// 2ⁿ of a normal number.
#[inline(always)]
fn power_of_two(n: f64) -> f64 {
    f64::from_bits((n + INTEGER).to_bits().wrapping_add(1023) << 52)
}

/// A polynomial, coefficients by rising powers.
#[inline(always)]
pub(crate) fn horner<const N: usize>(c: &[f64; N], x: f64) -> f64 {
    let mut sum = c[N - 1];
    for k in (0..N - 1).rev() {
        sum = sum * x + c[k];
    }
    sum
}

/// The same with coefficients common to all lanes, or one for each.
#[inline(always)]
pub(crate) fn horner_in_lane<const N: usize, const C: usize>(c: &[[f64; C]; N], l: usize, x: f64) -> f64 {
    let mut sum = in_lane(&c[N - 1], l);
    for k in (0..N - 1).rev() {
        sum = sum * x + in_lane(&c[k], l);
    }
    sum
}

/// The number of lane l, from one number for all lanes or one for each.
#[inline(always)]
pub(crate) fn in_lane<const C: usize>(numbers: &[f64; C], l: usize) -> f64 {
    numbers[if C == 1 { 0 } else { l }]
}

#[cfg(test)]
mod tests;
