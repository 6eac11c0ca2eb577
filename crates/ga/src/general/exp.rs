//! The exponential.
//!
//! Three ways, by what V is in `M = s + V`:
//! - `V² = w` a number: `exp V = cosh √w + V sinh √w / √w`, as for vectors, blades and simple bivectors;
//! - a bivector of up to five generators, `V² = S` of the form `x + yU` (see `pair`): the same formula,
//!   `exp V = C + V φ` with `C = cosh √S` and `φ = sinh √S / √S`, by series and doubling in that ring;
//! - any other: the series of `exp(M/2ᵏ)`, squared k times.
//!
//! In the ring nothing mixes the sizes of the parts: how often to double follows from the angles alone,
//! however far a translation or boosted a frame.

use super::pair::{Pair, Ring};
use super::{Calculus, grade, part, scaled};
use crate::functions::MathError;
use crate::values::{norm, scale_of};

/// Beyond this `cosh` and `sinh` are exponentials that no longer nearly cancel.
const LARGE: f64 = 1.0;

/// Beyond this angle, in halvings, the rounding of the argument alone is a whole turn.
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

    /// Of balanced components in bit order.
    pub(super) fn exp_bits(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let (s, mut v) = (m[0], m.to_vec());
        v[0] = 0.0;
        let scale = scale_of(&v);
        let square = self.product(&scaled(&v, 1.0 / scale), &scaled(&v, 1.0 / scale));
        let rest = norm(&square[1..]);
        if rest <= 4.0 * f64::EPSILON * (norm(&v) / scale).powi(2) {
            return Ok(exp_of_simple(s, &v, square[0], scale));
        }
        if self.generators <= 5 && (0..m.len()).all(|b| grade(b) == 2 || v[b] == 0.0) {
            return self.exp_of_bivector(s, &v);
        }
        self.exp_by_squaring(s, &v)
    }

    /// For `V² = S` in the ring of pairs.
    fn exp_of_bivector(&self, s: f64, v: &[f64]) -> Result<Vec<f64>, MathError> {
        let square = self.product(v, v);
        let mut unit = part(&square, |k| k == 4);
        let y = norm(&unit);
        if y > 0.0 {
            unit.iter_mut().for_each(|x| *x /= y);
        }
        let ring = Ring { q: self.scalar_product(&unit, &unit) };
        let full = Pair { x: square[0], y };
        let halvings = (0.5 * ring.radius(full).log2() + 1.0).ceil().max(0.0);
        if halvings.is_nan() || halvings > MOST_HALVINGS {
            return Err(MathError::AngleTooLarge);
        }
        let mut z = full.scale((-2.0 * halvings).exp2());
        let (mut c, mut phi) = (ring.series(&COSH, z), ring.series(&SINHC, z));
        for _ in 0..halvings as u32 {
            // cosh 2x = cosh² x + sinh² x, sinh 2x / 2x = cosh x · sinh x / x.
            let sinh_squared = ring.mul(z, ring.mul(phi, phi));
            (c, phi) = (ring.mul(c, c).plus(sinh_squared), ring.mul(c, phi));
            z = z.scale(4.0);
        }
        let (e, turned) = (s.exp(), self.product(v, &unit));
        let of = |b: usize| match grade(b) {
            0 => c.x,
            2 => phi.x * v[b] + phi.y * turned[b],
            _ => c.y * unit[b],
        };
        Ok((0..v.len()).map(|b| e * of(b)).collect())
    }

    /// By the series of `exp(M/2ᵏ) − 1`; squaring `1 + E` as `2E + E²` keeps small parts exact.
    fn exp_by_squaring(&self, s: f64, v: &[f64]) -> Result<Vec<f64>, MathError> {
        let size: f64 = v.iter().map(|x| x.abs()).sum();
        let halvings = (size.log2() + 1.0).ceil().max(0.0);
        if halvings.is_nan() || halvings > MOST_HALVINGS {
            return Err(MathError::AngleTooLarge);
        }
        let small = scaled(v, (-halvings).exp2());
        // Horner: E = V(1 + V/2(1 + V/3(1 + …))).
        let mut e = small.clone();
        for j in (2..=TERMS).rev() {
            e.iter_mut().for_each(|x| *x /= f64::from(j));
            e[0] += 1.0;
            e = self.product(&small, &e);
        }
        let factor = s * (-halvings).exp2();
        e.iter_mut().for_each(|x| *x *= factor.exp());
        e[0] += factor.exp_m1();
        for _ in 0..halvings as u32 {
            let square = self.product(&e, &e);
            e.iter_mut().zip(square).for_each(|(x, y)| *x = 2.0 * *x + y);
        }
        e[0] += 1.0;
        Ok(e)
    }
}

/// `e^s (cosh √w + V sinh √w / √w)` for `V² = w`, given `w / scale²`. For a large root the exponents are
/// added first: `e^(s ± √w)` may exist where `cosh √w` does not.
fn exp_of_simple(s: f64, v: &[f64], w: f64, scale: f64) -> Vec<f64> {
    let root = w.abs().sqrt() * scale;
    let (c, phi) = if root == 0.0 {
        (s.exp(), s.exp())
    } else if w < 0.0 {
        (s.exp() * root.cos(), s.exp() * (root.sin() / root))
    } else if root > LARGE {
        let (plus, minus) = (0.5 * (s + root).exp(), 0.5 * (s - root).exp());
        (plus + minus, (plus - minus) / root)
    } else {
        (s.exp() * root.cosh(), s.exp() * (root.sinh() / root))
    };
    let mut out = scaled(v, phi);
    out[0] = c;
    out
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
