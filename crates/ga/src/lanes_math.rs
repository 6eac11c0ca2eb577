//! Sums `hi + lo` of two numbers, and circular functions of them, for lanes: no branches, so that a loop
//! over them is vectorised.
//!
//! A rounding error of a product is itself a number (T. J. Dekker, *A floating-point technique for
//! extending the available precision*, Numer. Math. 18, 1971). Machines with fused multiply-add find it
//! in one instruction (`FMA`), others by splitting the factors: the same number bit for bit. Nothing
//! else here is fused, so that every machine gives the same results.

/// `a + b` and its rounding error (Knuth).
#[inline(always)]
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let hi = a + b;
    let part = hi - a;
    (hi, (a - (hi - part)) + (b - part))
}

/// `a + b` and its rounding error, for `a = 0` or `|a| >= |b|`.
#[inline(always)]
pub(crate) fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let hi = a + b;
    (hi, b - (hi - a))
}

/// `a b` and its rounding error, exact where neither overflows nor underflows.
#[inline(always)]
pub(crate) fn two_product<const FMA: bool>(a: f64, b: f64) -> (f64, f64) {
    let hi = a * b;
    if FMA {
        return (hi, a.mul_add(b, -hi));
    }
    let split = |x: f64| {
        let c = 134_217_729.0 * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (hi, ((a1 * b1 - hi) + a1 * b2 + a2 * b1) + a2 * b2)
}

/// `x` where `keep` is true, else 0.
#[inline(always)]
fn only(keep: bool, x: f64) -> f64 {
    if keep { x } else { 0.0 }
}

/// `x` with the signs of the bits `sign` flipped; only the highest may be set.
#[inline(always)]
fn flip(x: f64, sign: u64) -> f64 {
    f64::from_bits(x.to_bits() ^ sign)
}

/// The size of three components, `√(x² + y² + z²) = √(hi² + rest)`, to about 2⁻¹⁰³ of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    /// The sum of the squares, rounded.
    pub square: f64,
    /// Its root, rounded.
    pub hi: f64,
    rest: f64,
}

impl Size {
    /// The exact squares are added, their rounding errors after them.
    #[inline(always)]
    pub fn of<const FMA: bool>(c: [f64; 3]) -> Size {
        let [(a, ea), (b, eb), (c, ec)] = c.map(|x| two_product::<FMA>(x, x));
        let (sum, e1) = two_sum(a, b);
        let (square, e2) = two_sum(sum, c);
        let hi = square.sqrt();
        let (p, e) = two_product::<FMA>(hi, hi);
        Size { square, hi, rest: ((square - p) - e) + ((ea + eb) + (ec + e1) + e2) }
    }

    /// What `hi` lacks, given `1/hi`: `√(h² + ρ) = h + ρ/2h` to `ρ²/8h³`.
    #[inline(always)]
    pub fn lo(self, reciprocal: f64) -> f64 {
        self.rest * (0.5 * reciprocal)
    }
}

/// `(a + b)/(c + d)` as `hi + lo`, given `1/c` to a few roundings.
#[inline(always)]
pub(crate) fn divide<const FMA: bool>((a, b): (f64, f64), (c, d): (f64, f64), reciprocal: f64) -> (f64, f64) {
    let q = a * reciprocal;
    let (p, e) = two_product::<FMA>(q, c);
    quick_two_sum(q, (((a - p) - e) + (b - q * d)) * reciprocal)
}

/// Up to here [`quarter_turns`] reduces angles; as far as products of its constants are exact.
pub(crate) const REDUCED: f64 = 1e6;

/// `angle = k π/2 + r`, k the nearest integer, for `0 <= angle <= REDUCED`: `(k mod 4, r, rest of r)`.
///
/// π/2 is taken off in parts of 33, 32 and 30 bits, whose products with k < 2²⁰ are exact. The first
/// difference is exact; the second keeps its rounding error. The rest is known to 2⁻¹⁰³ of the angle.
#[inline(always)]
pub(crate) fn quarter_turns(angle: f64, rest: f64) -> (u64, f64, f64) {
    const PARTS: [f64; 4] = [1.570_796_326_734_125_6e0, 6.077_100_506_303_966e-11, 2.022_266_248_711_166_5e-21, 8.478_427_660_368_9e-32];
    // Adding 1.5·2⁵² leaves the nearest integer in the last bits.
    const INTEGER: f64 = 6_755_399_441_055_744.0;
    let shifted = angle * std::f64::consts::FRAC_2_PI + INTEGER;
    let k = shifted - INTEGER;
    let (r, e1) = two_sum(angle - k * PARTS[0], -(k * PARTS[1]));
    let (r, e2) = two_sum(r, -(k * PARTS[2]));
    let (r, rest) = quick_two_sum(r, (e1 + rest) + (e2 - k * PARTS[3]));
    (shifted.to_bits() & 3, r, rest)
}

/// Sine and cosine of `k π/2 + r + rest`, `|r| <= π/4`, both as `hi + lo` whose error is below a quarter
/// ulp. The polynomials are those of fdlibm, good to 2⁻⁵⁸.
#[inline(always)]
pub(crate) fn sin_cos(k: u64, r: f64, rest: f64) -> ((f64, f64), (f64, f64)) {
    const S: [f64; 6] = [
        -1.666_666_666_666_663_2e-1,
        8.333_333_333_322_49e-3,
        -1.984_126_982_985_795e-4,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ];
    const C: [f64; 6] = [
        4.166_666_666_666_66e-2,
        -1.388_888_888_887_411e-3,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ];
    let z = r * r;
    let s = S[0] + z * (S[1] + z * (S[2] + z * (S[3] + z * (S[4] + z * S[5]))));
    let c = C[0] + z * (C[1] + z * (C[2] + z * (C[3] + z * (C[4] + z * C[5]))));
    let half = 0.5 * z;
    let sin = quick_two_sum(r, (z * r) * s + (rest - half * rest));
    let (one, e) = quick_two_sum(1.0, -half);
    let cos = quick_two_sum(one, e + ((z * z) * c - r * rest));
    let odd = k & 1 == 1;
    let (sin, cos) = if odd { (cos, sin) } else { (sin, cos) };
    // Quarters 2 and 3 have a negative sine, 1 and 2 a negative cosine.
    let (minus_sin, minus_cos) = ((k & 2) << 62, ((k + 1) & 2) << 62);
    ((flip(sin.0, minus_sin), flip(sin.1, minus_sin)), (flip(cos.0, minus_cos), flip(cos.1, minus_cos)))
}

/// The angle in [0, π] of the point `(s, size)`, over the size: `atan2(size, s)/size`. With `tiny` it is
/// `1/|s|`.
///
/// The point `(|s|, size)` is turned back by 0, 45° or 90°, whichever leaves at most 22.5°; what is left
/// is an arc tangent of a quotient. One division serves it and the last one. The polynomial is fdlibm's.
#[inline(always)]
pub(crate) fn angle_over_size<const FMA: bool>(size: Size, s: f64, tiny: bool) -> f64 {
    const TAN_22_5: f64 = 0.414_213_562_373_095_03;
    const A: [f64; 11] = [
        -3.333_333_333_333_293e-1,
        1.999_999_999_987_648_3e-1,
        -1.428_571_427_250_346_6e-1,
        1.111_111_040_546_235_6e-1,
        -9.090_887_133_436_507e-2,
        7.691_876_205_044_83e-2,
        -6.661_073_137_387_531e-2,
        5.833_570_133_790_573_5e-2,
        -4.976_877_994_615_932_4e-2,
        3.653_157_274_421_691_6e-2,
        -1.628_582_011_536_578_2e-2,
    ];
    /// π/4, the first part of 51 bits, so that its product with 3 is exact.
    const EIGHTH: (f64, f64) = (0.785_398_163_397_448_3, 3.061_616_997_868_383e-17);
    let c = s.abs();
    let (below, above) = (size.hi * TAN_22_5 <= c, size.hi > c * TAN_22_5);
    let (num, num_rest) = two_sum(only(below, size.hi), -only(above, c));
    let (den, den_rest) = two_sum(only(above, size.hi), only(below, c));
    let common = 1.0 / if tiny { c } else { size.hi * den };
    let (over_den, over_size) = (size.hi * common, den * common);
    let lo = size.lo(over_size);
    let (num_rest, den_rest) = (num_rest + only(below, lo), den_rest + only(above, lo));
    let (u, rest) = divide::<FMA>((num, num_rest), (den, den_rest), over_den);
    let z = u * u;
    let a = A[5] + z * (A[6] + z * (A[7] + z * (A[8] + z * (A[9] + z * A[10]))));
    let a = A[0] + z * (A[1] + z * (A[2] + z * (A[3] + z * (A[4] + z * a))));
    let tail = (z * u) * a + (rest - z * rest);
    let eighths = only(above, 1.0) + only(!below, 1.0);
    // For a negative s the angle is what is missing to π.
    let minus = s.to_bits() & (1 << 63);
    let eighths = if minus == 0 { eighths } else { 4.0 - eighths };
    let (hi, e) = quick_two_sum(eighths * EIGHTH.0, flip(u, minus));
    let sum = quick_two_sum(hi, (e + flip(tail, minus)) + eighths * EIGHTH.1);
    let quotient = divide::<FMA>(sum, (size.hi, lo), over_size).0;
    if tiny { common } else { quotient }
}
