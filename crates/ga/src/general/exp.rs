//! The exponential.
//!
//! Three methods, depending on V in `M = s + V`:
//! - `V² = w` a number: `exp V = cosh √w + V sinh √w / √w`, as for vectors, blades and simple bivectors;
//! - a bivector of up to five generators, `V² = S` of the form `x + yU` (see `pair`): the same formula,
//!   `exp V = C + V φ` with `C = cosh √S` and `φ = sinh √S / √S`, by series and doubling in that ring;
//! - any other: the series of `exp(M/2ᵏ)`, squared k times.
//!
//! In the ring the number of doublings depends only on the angles, not on translations or boosts.

use super::pair::{Pair, Ring, SPLITS};
use super::{Calculus, add_scaled, grade, part, scaled};
use crate::error::MathError;
use crate::g3::values::{norm, scale_of};

/// Beyond this the exponentials in `cosh` and `sinh` do not cancel.
const LARGE: f64 = 1.0;

/// A half of a bivector is small below this fraction of it.
const SMALL_HALF: f64 = 0.25;

/// Beyond this binary logarithm of an angle its rounding may be a turn.
const MOST_HALVINGS: f64 = 52.0;

/// Terms of `exp`: for a size of at most 1/2 the next is below 2⁻⁵³ of the sum.
const TERMS: u32 = 15;

impl Calculus {
    /// `exp M = 1 + M + M²/2 + …`.
    pub fn exp(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let mut m = self.read(m)?;
        let factor = self.balance(&mut m);
        let mut result = self.exp_bits(&m)?;
        self.scale_null(&mut result, 1.0 / factor);
        self.write(&result)
    }

    /// The exponential of balanced components in bit order.
    pub(super) fn exp_bits(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let (s, mut v) = (m[0], m.to_vec());
        v[0] = 0.0;
        let scale = scale_of(&v);
        let square = self.product(&scaled(&v, 1.0 / scale), &scaled(&v, 1.0 / scale));
        let rest = norm(&square[1..]);
        if rest <= 4.0 * f64::EPSILON * (norm(&v) / scale).powi(2) {
            let (c, phi) = cosh_sinhc(s, square[0], scale)?;
            let mut exp = scaled(&v, phi);
            exp[0] = c;
            return Ok(exp);
        }
        if self.generators <= 5 && (0..m.len()).all(|b| grade(b) == 2 || v[b] == 0.0) {
            return self.exp_of_bivector(s, &v);
        }
        Ok(times_exp(self.exp_by_squaring(&v)?, s))
    }

    /// For `V² = S` in the ring of pairs.
    fn exp_of_bivector(&self, s: f64, v: &[f64]) -> Result<Vec<f64>, MathError> {
        let square = self.product(v, v);
        let (unit, y) = unit_of_grade_4(&square);
        let q = self.scalar_product(&unit, &unit);
        let (ring, full) = (Ring { q }, Pair { x: square[0], y });
        let halvings = halvings(0.5 * ring.radius(full).log2())?;
        let mut exp = vec![0.0; v.len()];
        if q > SPLITS {
            for root in [q.sqrt(), -q.sqrt()] {
                let half = self.half(v, &unit, root);
                let (c, phi) = cosh_sinhc(s, 2.0 * self.scalar_product(&half, &half), 1.0)?;
                exp[0] += 0.5 * c;
                add_scaled(&mut exp, &unit, 0.5 * c / root);
                add_scaled(&mut exp, &half, phi);
            }
            return Ok(exp);
        }
        let (c, phi) = cosh_sinhc_of_pair(ring, full, halvings);
        exp[0] = c.x;
        add_scaled(&mut exp, &unit, c.y);
        add_scaled(&mut exp, v, phi.x);
        add_scaled(&mut exp, &part(&self.product(v, &unit), |k| k == 2), phi.y);
        Ok(times_exp(exp, s))
    }

    /// The half `P F` of a bivector, with the idempotent `P = ½(1 + U/root)`, `root² = U²`, for U of
    /// grade 4 that commutes with it. Applying P again to a small half removes the rounding of the first. The halves of
    /// a nearly simple bivector, for which U is uncertain, are not small, and their sum must remain F.
    pub(super) fn half(&self, f: &[f64], unit: &[f64], root: f64) -> Vec<f64> {
        let halve = |f: &[f64]| {
            let mut half = part(&self.product(f, unit), |k| k == 2);
            half.iter_mut().zip(f).for_each(|(h, f)| *h = 0.5 * (f + *h / root));
            half
        };
        let half = halve(f);
        if norm(&half) < SMALL_HALF * norm(f) { halve(&half) } else { half }
    }

    /// By the series of `exp(V/2ᵏ) − 1`; squaring `1 + E` as `2E + E²` keeps small parts exact.
    fn exp_by_squaring(&self, v: &[f64]) -> Result<Vec<f64>, MathError> {
        let size: f64 = v.iter().map(|x| x.abs()).sum();
        let halvings = halvings(size.log2())?;
        let small = scaled(v, (-f64::from(halvings)).exp2());
        // Horner: E = V(1 + V/2(1 + V/3(1 + …))).
        let mut e = small.clone();
        for j in (2..=TERMS).rev() {
            e.iter_mut().for_each(|x| *x /= f64::from(j));
            e[0] += 1.0;
            e = self.product(&small, &e);
        }
        for _ in 0..halvings {
            let square = self.product(&e, &e);
            e.iter_mut().zip(square).for_each(|(x, y)| *x = 2.0 * *x + y);
        }
        e[0] += 1.0;
        Ok(e)
    }
}

/// The part of grade 4 as a unit, and its size.
pub(super) fn unit_of_grade_4(m: &[f64]) -> (Vec<f64>, f64) {
    let four = part(m, |k| k == 4);
    let size = norm(&four);
    (if size > 0.0 { scaled(&four, 1.0 / size) } else { four }, size)
}

/// `e^s cosh √w` and `e^s sinh √w / √w`, given `w / scale²`. For a large root the exponents are added first:
/// `e^(s ± √w)` may be finite where `cosh √w` is not. An error for an angle beyond the precision.
fn cosh_sinhc(s: f64, w: f64, scale: f64) -> Result<(f64, f64), MathError> {
    let root = w.abs().sqrt() * scale;
    if root == 0.0 {
        Ok((s.exp(), s.exp()))
    } else if w < 0.0 {
        halvings(root.log2())?;
        Ok((s.exp() * root.cos(), s.exp() * (root.sin() / root)))
    } else if root > LARGE {
        let (plus, minus) = (0.5 * (s + root).exp(), 0.5 * (s - root).exp());
        Ok((plus + minus, (plus - minus) / root))
    } else {
        Ok((s.exp() * root.cosh(), s.exp() * (root.sinh() / root)))
    }
}

/// The number of halvings to 1/2 from this binary logarithm; an error beyond the precision.
fn halvings(log2: f64) -> Result<u32, MathError> {
    if log2.is_nan() || log2 > MOST_HALVINGS {
        return Err(MathError::AngleTooLarge);
    }
    Ok((log2 + 1.0).ceil().max(0.0) as u32)
}

/// `e^s M`, also if `e^s` alone is out of range.
fn times_exp(mut m: Vec<f64>, s: f64) -> Vec<f64> {
    let root = (0.5 * s).exp();
    m.iter_mut().for_each(|x| *x = *x * root * root);
    m
}

/// `cosh √S` and `sinh √S / √S` by series and doubling.
fn cosh_sinhc_of_pair(ring: Ring, square: Pair, halvings: u32) -> (Pair, Pair) {
    let mut z = square.scale((-2.0 * f64::from(halvings)).exp2());
    let (mut c, mut phi) = (ring.series(&COSH, z), ring.series(&SINHC, z));
    for _ in 0..halvings {
        // cosh 2x = cosh² x + sinh² x, sinh 2x / 2x = cosh x · sinh x / x.
        let sinh_squared = ring.mul(z, ring.mul(phi, phi));
        (c, phi) = (ring.mul(c, c).plus(sinh_squared), ring.mul(c, phi));
        z = z.scale(4.0);
    }
    (c, phi)
}

/// `1/(2j)!`, the series of `cosh √z`; for |z| <= 1/4 the next term is below 2⁻⁵³.
const COSH: [f64; 9] = inverse_factorials(0);

/// `1/(2j + 1)!`, the series of `sinh √z / √z`.
const SINHC: [f64; 9] = inverse_factorials(1);

/// `1/(2j + first)!`; the factorials up to 17! are exact.
const fn inverse_factorials(first: u64) -> [f64; 9] {
    let mut out = [1.0; 9];
    let mut factorial = 1;
    let mut j = 1;
    while j < 9 {
        let k = 2 * j as u64 + first;
        factorial *= k * (k - 1);
        out[j] = 1.0 / factorial as f64;
        j += 1;
    }
    out
}
