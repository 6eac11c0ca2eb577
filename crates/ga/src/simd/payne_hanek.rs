//! Reduction of the angle of any bivector modulo quarter turns, beyond double-double precision.
//!
//! Needed if the angle is huge, or so near to a multiple of π/2 that nearly all of it cancels.
//!
//! Integers are exact: `N = |B|²` in units of 2⁻⁵¹², its root `R` in units of 2⁻²⁵⁶, multiplied by the digits of 2/π that
//! matter (M. Payne and R. Hanek, *Radian reduction for trigonometric functions*, SIGNUM Newsletter 18, 1983). There are
//! fewer than 2¹⁹² triples of binary64 numbers, so none is expected nearer to a multiple of π/2 than 2⁻¹⁹², which leaves
//! 64 bits of the remainder.

use super::double::{quick_two_sum, two_product};

/// Limbs behind the point of `R`; twice as many behind that of `N`.
const FRACTION: usize = 4;

/// Limbs of a root: `|B| < 2¹⁰²⁵` has 17 before the point.
const ROOT: usize = FRACTION + 17;

/// Limbs of `N`, with one more for products to run over.
const SQUARE: usize = 2 * ROOT + 1;

/// 2/π to 1408 bits, the highest first.
const TWO_OVER_PI: [u64; ROOT + 1] = [
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
    0xa9e3_9161_5ee6_1b08,
    0x6599_855f_14a0_6840,
];

/// `to += sign · m · by · 2^shift`, in two's complement. Overflow is discarded.
fn add_product(to: &mut [u64], by: &[u64], m: u64, shift: usize, negative: bool) {
    let m = u128::from(m) << (shift % 64);
    for (first, digit) in [(shift / 64, m as u64), (shift / 64 + 1, (m >> 64) as u64)] {
        if digit == 0 || first >= to.len() {
            continue;
        }
        let mut carry = 0;
        for (i, limb) in to[first..].iter_mut().enumerate() {
            if i >= by.len() && carry == 0 {
                break;
            }
            let term = u128::from(digit) * u128::from(by.get(i).copied().unwrap_or(0)) + carry;
            let over;
            (*limb, over) =
                if negative { limb.overflowing_sub(term as u64) } else { limb.overflowing_add(term as u64) };
            carry = (term >> 64) + u128::from(over);
        }
    }
}

/// A whole number in two's complement as `(f, e)`, `f 2^e` with `2⁶³ <= |f| <= 2⁶⁴` to rounding; or (0, 0).
fn leading(limbs: &[u64]) -> (f64, i32) {
    let negative = limbs.last().is_some_and(|&top| top >> 63 == 1);
    let fill = if negative { u64::MAX } else { 0 };
    let Some(top) = limbs.iter().rposition(|&limb| limb != fill) else {
        return (0.0, 0);
    };
    let limb = |i: usize| u128::from(if i <= top { limbs[top - i] ^ fill } else { 0 });
    let pair = limb(0) << 64 | limb(1);
    let zeros = pair.leading_zeros();
    // The complement is one less than the number: nothing in 64 bits but where these are all there is.
    let f = ((pair << zeros) >> 64) as u64 as f64;
    (if negative { -f } else { f }, 64 * top as i32 - zeros as i32)
}

/// `|B| = k π/2 + r`, k the nearest integer: `(k mod 4, r, rest of r)`. The components are finite.
pub(crate) fn quarter_turns(components: [f64; 3]) -> (u64, f64, f64) {
    let mut square = [0; SQUARE];
    let mut largest = 0;
    for x in components {
        let bits = x.abs().to_bits();
        let exponent = (bits >> 52).max(1) as i32;
        let m = if bits >> 52 == 0 { bits } else { bits & ((1 << 52) - 1) | 1 << 52 };
        largest = largest.max(exponent - 1022);
        // m² counts units of 2^(2 exponent − 2150); what is below one of N is dropped.
        let shift = 2 * (exponent - 1075) + 128 * FRACTION as i32;
        let m = u128::from(m) * u128::from(m);
        let (m, shift) = if shift < 0 { (m.checked_shr(-shift as u32).unwrap_or(0), 0) } else { (m, shift) };
        add_product(&mut square, &[m as u64, (m >> 64) as u64], 1, shift as usize, false);
    }
    // |B| < 2^(largest + 1).
    let limbs = FRACTION + 1 + largest.max(0) as usize / 64;
    let root = root(&mut square[..2 * limbs + 1], limbs);
    turns(&root[..limbs])
}

/// The root of N, whose remainder is left in its place.
///
/// With the leading digits `h` of the root and the remainder `ρ = N − R²`, `δ = ρ/2h` corrects R to 50 bits and leaves
/// `ρ − 2Rδ − δ²`.
fn root(square: &mut [u64], limbs: usize) -> [u64; ROOT] {
    /// Bits of δ behind the point of a quotient of leading digits.
    const BITS: i32 = 20;
    let mut root = [0; ROOT];
    let (f, e) = leading(square);
    let (h, h_exponent) = ((f * f64::from(1 + (e & 1))).sqrt(), e >> 1);
    let (mut step, mut exponent) = (h, h_exponent);
    // Each step takes off more than 40 of at most 64 · 21 bits.
    for _ in 0..40 {
        let exact = exponent - BITS;
        let digits = (step.abs() * f64::from(1 << BITS)) as u64;
        let (m, shift) =
            if exact < 0 { (digits.checked_shr(-exact as u32).unwrap_or(0), 0) } else { (digits, exact) };
        if m == 0 {
            break;
        }
        let (negative, shift) = (step < 0.0, shift as usize);
        add_product(square, &root[..limbs], m, shift + 1, !negative);
        let twice = u128::from(m) * u128::from(m);
        add_product(square, &[twice as u64, (twice >> 64) as u64], 1, 2 * shift, true);
        add_product(&mut root[..limbs], &[1], m, shift, negative);
        let (f, e) = leading(square);
        (step, exponent) = (f / (2.0 * h), e - h_exponent);
    }
    root
}

/// Multiplies by 2/π and splits at the nearest integer.
fn turns(root: &[u64]) -> (u64, f64, f64) {
    // As many limbs of 2/π as the root has, and one more.
    let digits = &TWO_OVER_PI[..root.len() + 1];
    let mut product = [0; 2 * ROOT + 1];
    for (i, &digit) in digits.iter().rev().enumerate() {
        add_product(&mut product[i..], root, digit, 0, false);
    }
    // Behind the point are the limbs of both factors.
    let point = FRACTION + digits.len();
    let negative = product[point - 1] >> 63 == 1;
    let k = product[point].wrapping_add(u64::from(negative)) & 3;
    let fraction = &mut product[..point];
    let (f, e) = leading(fraction);
    // The remainder beyond these 53 bits, which count units of 2^(e + 11).
    add_product(fraction, &[1], (f.abs() / 2048.0) as u64, (e + 11).max(0) as usize, f > 0.0);
    let (g, d) = leading(fraction);
    let scaled = |f: f64, e: i32| f * two_to(e - 64 * point as i32);
    let (hi, lo) = (scaled(f, e), scaled(g, d));
    const HALF_PI: (f64, f64) = (std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);
    let (r, error) = two_product::<false>(hi, HALF_PI.0);
    let (r, rest) = quick_two_sum(r, error + (hi * HALF_PI.1 + lo * HALF_PI.0));
    (k, r, rest)
}

/// 2^n, or the least normal power for a lower one.
fn two_to(n: i32) -> f64 {
    f64::from_bits(((n + 1023).max(1) as u64) << 52)
}
