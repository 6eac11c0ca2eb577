//! Arithmetic in lanes without branches: phase reduction, exponentials, sine and cosine.

use super::double_double::DoubleDouble;
use polhode_ga::simd::double::{add, multiply, quick_two_sum, sin_cos, two_product, two_sum};
use std::f64::consts::FRAC_PI_2;

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

/// `e^{−x}` and `e^{−x} − 1`, each to a few roundings, for x in [0, 705].
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

/// A double-double number `hi + lo`, as [`DoubleDouble`], in a lane.
pub(crate) type Pair = (f64, f64);

/// `e^x` and `e^x − 1` in double-double precision, for |x| up to 720. With `x = n ln 2 + 2⁶ r` a short series gives
/// `e^r − 1`, and `e^{2r} − 1 = (e^r − 1)(2 + (e^r − 1))` doubles the exponent without cancellation.
#[inline(always)]
pub(crate) fn exp_of_pair<const FMA: bool>(x: Pair) -> [Pair; 2] {
    const LN_2: Pair = (std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
    const DOUBLINGS: usize = 6;
    /// 1/(k + 1)!
    const LARGE: [Pair; 6] = [
        (1.0, 0.0),
        (0.5, 0.0),
        (0.166_666_666_666_666_66, 9.251_858_538_542_97e-18),
        (0.041_666_666_666_666_664, 2.312_964_634_635_742_7e-18),
        (0.008_333_333_333_333_333, 1.156_482_317_317_871_4e-19),
        (0.001_388_888_888_888_889, -5.300_543_954_373_577e-20),
    ];
    const SMALL: [f64; 6] = reciprocal_factorials(7);
    let n = if x.0.abs() <= 0.35 { 0.0 } else { nearest(x.0 * std::f64::consts::LOG2_E) };
    let rest = add(x, multiply::<FMA>(LN_2, (-n, 0.0)));
    let scale = 0.5 / (1 << (DOUBLINGS - 1)) as f64;
    let r = (rest.0 * scale, rest.1 * scale);
    // |r| < 0.0055: the terms from r⁶/7! on are below 1e-17, where doubles are enough; those from r¹²/13! on are below
    // 1e-36.
    let mut series = (horner(&SMALL, r.0), 0.0);
    for k in (0..LARGE.len()).rev() {
        series = add_smaller(LARGE[k], multiply::<FMA>(series, r));
    }
    let mut p = multiply::<FMA>(series, r);
    for _ in 0..DOUBLINGS {
        // 2p + p².
        let double = (p.0 + p.0, p.1 + p.1);
        let (square, error) = two_product::<FMA>(p.0, p.0);
        p = add_smaller(double, (square, error + double.0 * p.1));
    }
    // 2ⁿ in two factors, for it may be less than the least normal number.
    let half = nearest(0.5 * n);
    let power = power_of_two(half) * power_of_two(n - half);
    let scaled = (p.0 * power, p.1 * power);
    [add_smaller((power, 0.0), scaled), add(scaled, two_sum(power, -1.0))]
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

/// The sum of double-double numbers of which the first is larger, to twice the precision of the larger one.
#[inline(always)]
fn add_smaller(a: Pair, b: Pair) -> Pair {
    let (hi, error) = quick_two_sum(a.0, b.0);
    quick_two_sum(hi, error + (a.1 + b.1))
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
