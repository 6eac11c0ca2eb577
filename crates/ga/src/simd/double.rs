//! Double-double numbers `hi + lo` and circular functions of them, for lanes.
//!
//! There are no branches, so loops over lanes are vectorised.
//!
//! The rounding error of a product is a float (T. J. Dekker, *A floating-point technique for extending the available
//! precision*, Numer. Math. 18, 1971), computed by fused multiply-add (`FMA`) or by splitting the factors, with the same
//! bits. Nothing else here is fused, so that every machine gives the same results.

/// `a + b` and its rounding error (Knuth).
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let hi = a + b;
    let part = hi - a;
    (hi, (a - (hi - part)) + (b - part))
}

/// `a + b` and its rounding error, for `a = 0` or `|a| >= |b|`.
#[inline(always)]
pub fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let hi = a + b;
    (hi, b - (hi - a))
}

/// `a b` and its rounding error, exact where neither overflows nor underflows.
#[inline(always)]
pub fn two_product<const FMA: bool>(a: f64, b: f64) -> (f64, f64) {
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

/// The sum of double-double numbers.
#[inline(always)]
pub fn add(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let ((hi, e), (lo, f)) = (two_sum(a.0, b.0), two_sum(a.1, b.1));
    let (hi, e) = quick_two_sum(hi, e + lo);
    quick_two_sum(hi, e + f)
}

/// The product of double-double numbers.
#[inline(always)]
pub fn multiply<const FMA: bool>(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (hi, e) = two_product::<FMA>(a.0, b.0);
    quick_two_sum(hi, e + a.0 * b.1 + a.1 * b.0)
}

/// `a b + c` where `a b` is exact, so that fusing the two changes nothing.
#[inline(always)]
fn exact_product_plus<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

/// `c − a b` rounded once, for rounded `a b` so near to c that their difference is exact.
#[inline(always)]
fn remainder<const FMA: bool>(c: f64, a: f64, b: f64) -> f64 {
    if FMA {
        return (-a).mul_add(b, c);
    }
    let (product, error) = two_product::<false>(a, b);
    (c - product) - error
}

/// `a/b` to a little more than half an ulp, given `1/b`: faster than a division of many numbers by one.
#[inline(always)]
pub(crate) fn quotient<const FMA: bool>(a: f64, b: f64, reciprocal: f64) -> f64 {
    let q = a * reciprocal;
    q + remainder::<FMA>(a, q, b) * reciprocal
}

/// `x` where `keep` is true, else 0.
#[inline(always)]
fn only(keep: bool, x: f64) -> f64 {
    if keep { x } else { 0.0 }
}

/// The bit of the sign.
const SIGN: u64 = 1 << 63;

/// `x`, or `−x` where `sign` is [`SIGN`] and not 0.
#[inline(always)]
fn flip(x: f64, sign: u64) -> f64 {
    f64::from_bits(x.to_bits() ^ sign)
}

/// The size of three components, `√(x² + y² + z²) = √(hi² + rest)`, to 2⁻¹⁰² of it. Sizes below
/// [`Size::LEAST`] are that size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    /// The root of the rounded sum of the squares, rounded.
    pub hi: f64,
    /// The remainder of the sum.
    pub rest: f64,
    /// The rounded sum of the squares.
    pub square: f64,
}

impl Size {
    /// Its square is negligible beside the square of a number 10¹⁰ times as large, and still has exact rounding errors.
    const LEAST: f64 = 1e-120;

    /// The exact squares are added, their rounding errors after them.
    #[inline(always)]
    pub fn of<const FMA: bool>(c: [f64; 3]) -> Size {
        let [(a, ea), (b, eb), (c, ec)] = c.map(|x| two_product::<FMA>(x, x));
        let (sum, e1) = two_sum(a, b);
        // Beside the last square, of which it changes no digit unless all are tiny, it does not lengthen the chain.
        let (square, e2) = two_sum(sum, c + Size::LEAST * Size::LEAST);
        let hi = square.sqrt();
        let rest = remainder::<FMA>(square, hi, hi) + ((ea + eb) + (ec + e1) + e2);
        Size { hi, rest, square }
    }

    /// The correction to `hi`, given `1/hi`: `√(h² + ρ) = h + ρ/2h` to `ρ²/8h³`.
    #[inline(always)]
    pub fn lo(self, reciprocal: f64) -> f64 {
        self.rest * (0.5 * reciprocal)
    }
}

/// `(a + b)/(c + d)` as the quotient `a/c` to a few roundings and its correction, given `1/c` to a few roundings.
///
/// Here and below sums are left as two numbers of any sizes where the next step can begin with the first: their sum would
/// lengthen the chain of operations, on which the time of a single row depends.
#[inline(always)]
pub(crate) fn divide<const FMA: bool>((a, b): (f64, f64), (c, d): (f64, f64), reciprocal: f64) -> (f64, f64) {
    let q = a * reciprocal;
    (q, (remainder::<FMA>(a, q, c) + (b - q * d)) * reciprocal)
}

/// `angle + rest = k π/2 + r`, k the nearest integer: `(k mod 4, r, rest of r)`, for angles up to 10⁶.
///
/// π/2 is taken off in three parts. The products of the first and the last with `k < 2²⁰` are exact, and so
/// is the first difference; the others keep their rounding errors.
#[inline(always)]
pub(crate) fn quarter_turns<const FMA: bool>(angle: f64, rest: f64) -> (u64, f64, f64) {
    const PARTS: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11, 3.521_559_864_706_184e-27];
    // Adding 1.5·2⁵² leaves the nearest integer in the last bits.
    const INTEGER: f64 = 6_755_399_441_055_744.0;
    let shifted = angle * std::f64::consts::FRAC_2_PI + INTEGER;
    let k = shifted - INTEGER;
    let (second, e1) = two_product::<FMA>(k, PARTS[1]);
    let (r, e2) = two_sum(exact_product_plus::<FMA>(k, -PARTS[0], angle), -second);
    let (r, rest) = quick_two_sum(r, (e2 + rest) - exact_product_plus::<FMA>(k, PARTS[2], e1));
    (shifted.to_bits() & 3, r, rest)
}

/// Sine and cosine of `k π/2 + r + rest`, `|r| <= π/4`, the sine as two numbers, the second at most a ninth of the first,
/// with an error below half an ulp. The polynomials are those of fdlibm, good to 2⁻⁵⁸.
#[inline(always)]
pub fn sin_cos<const FMA: bool>(k: u64, r: f64, rest: f64) -> ((f64, f64), f64) {
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
    let zz = z * z;
    let z4 = zz * zz;
    let s = ((S[0] + z * S[1]) + zz * (S[2] + z * S[3])) + z4 * (S[4] + z * S[5]);
    let c = ((C[0] + z * C[1]) + zz * (C[2] + z * C[3])) + z4 * (C[4] + z * C[5]);
    // 1 − z/2 and its rounding error. It is the cosine, as far as the rest is concerned.
    let one = exact_product_plus::<FMA>(z, -0.5, 1.0);
    let e = exact_product_plus::<FMA>(z, -0.5, 1.0 - one);
    let sin = (r, (z * r) * s + rest * one);
    let cos = (one, e + (zz * c - r * rest));
    let (sin, cos) = if k & 1 == 1 { (cos, sin) } else { (sin, cos) };
    // Quarters 2 and 3 have a negative sine, 1 and 2 a negative cosine.
    let (minus_sin, minus_cos) = ((k & 2) << 62, ((k + 1) & 2) << 62);
    ((flip(sin.0, minus_sin), flip(sin.1, minus_sin)), flip(cos.0 + cos.1, minus_cos))
}

const TAN_22_5: f64 = 0.414_213_562_373_095_03;

/// Its square, to compare squares: those of a size are known before its root. If one of them overflows or underflows, the
/// comparison is that of the numbers; both overflow only where the fast method gives up.
const TAN2_22_5: f64 = 0.171_572_875_253_809_9;

/// Whether the point `(c, size)` lies below 67.5°, and above 22.5°, of which `tan` is the tangent. Turned back by 0 if only
/// below, by 90° if only above, else by 45°, it is within ±22.5°: `(c, size)` becomes
/// `(below c + above size, below size − above c)` up to a factor.
#[inline(always)]
fn turned_back(size: f64, c: f64, tan: f64) -> (bool, bool) {
    (size * tan <= c, size > c * tan)
}

/// `1/(size · denominator)` for [`Tangent::of`]: one division for the two quotients of a logarithm.
#[inline(always)]
pub(crate) fn common_reciprocal(size: Size, s: f64) -> f64 {
    let (below, above) = turned_back(size.square, s * s, TAN2_22_5);
    1.0 / (size.hi * (only(above, size.hi) + only(below, s.abs())))
}

/// The angle in [0, π/2] of the point `(|s|, size)`, not both 0, to a few roundings: [`Tangent::angle`] in single floats.
#[inline(always)]
pub(crate) fn angle(size: f64, s: f64) -> f64 {
    let c = s.abs();
    let (below, above) = turned_back(size, c, TAN_22_5);
    let num = only(below, size) - only(above, c);
    let den = only(above, size) + only(below, c);
    let eighths = only(above, 1.0) + only(!below, 1.0);
    let tangent = Tangent { u: num / den, rest: 0.0, eighths };
    eighths * std::f64::consts::FRAC_PI_4 + (tangent.u + tangent.excess())
}

/// A quotient `u + rest` whose arc tangent is at most 22.5°, and the eighths of a turn to add.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tangent {
    pub u: f64,
    pub rest: f64,
    /// Eighths of a turn by which it was turned back.
    pub eighths: f64,
}

impl Tangent {
    /// Of the point `(|s|, size)` turned back, given [`common_reciprocal`]. Also the rest of the size, and
    /// `1/size.hi`.
    #[inline(always)]
    pub fn of<const FMA: bool>(size: Size, s: f64, common: f64) -> (Tangent, f64, f64) {
        let c = s.abs();
        let (below, above) = turned_back(size.square, s * s, TAN2_22_5);
        let (num, num_rest) = two_sum(only(below, size.hi), -only(above, c));
        let (den, den_rest) = two_sum(only(above, size.hi), only(below, c));
        let over_size = den * common;
        let lo = size.lo(over_size);
        let (num_rest, den_rest) = (num_rest + only(below, lo), den_rest + only(above, lo));
        let (u, rest) = divide::<FMA>((num, num_rest), (den, den_rest), size.hi * common);
        let eighths = only(above, 1.0) + only(!below, 1.0);
        (Tangent { u, rest, eighths }, lo, over_size)
    }

    /// The excess of the arc tangent over `u`. The polynomial is fdlibm's, good to 2⁻⁵⁸.
    #[inline(always)]
    pub fn excess(self) -> f64 {
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
        let Tangent { u, rest, .. } = self;
        let z = u * u;
        let zz = z * z;
        let high = (A[6] + z * A[7]) + zz * ((A[8] + z * A[9]) + zz * A[10]);
        let low = (A[0] + z * A[1]) + zz * ((A[2] + z * A[3]) + zz * (A[4] + z * A[5]));
        (z * u) * (low + (zz * zz) * zz * high) + (rest - z * rest)
    }

    /// The angle in [0, π] of `(s, size)` as two numbers, the second at most a seventeenth of the first, given the
    /// [`Tangent::excess`].
    #[inline(always)]
    pub fn angle<const FMA: bool>(self, s: f64, excess: f64) -> (f64, f64) {
        /// π/4; the first part has 50 bits, so that its product with 3 is exact.
        const EIGHTH: (f64, f64) = (std::f64::consts::FRAC_PI_4, 3.061_616_997_868_383e-17);
        let Tangent { u, eighths, .. } = self;
        // For a negative s the angle is the supplement.
        let minus = s.to_bits() & SIGN;
        let eighths = if minus == 0 { eighths } else { 4.0 - eighths };
        let u = flip(u, minus);
        let hi = exact_product_plus::<FMA>(eighths, EIGHTH.0, u);
        let error = exact_product_plus::<FMA>(eighths, EIGHTH.0, -hi) + u;
        (hi, (error + flip(excess, minus)) + eighths * EIGHTH.1)
    }
}
