//! Complements, independent of the metric, and the dual, which depends on it.
//!
//! The right complement of a basis blade E is the blade with `E ∧ rc(E) = I`; the left one has
//! `lc(E) ∧ E = I`, and each is the inverse of the other. They also exist in degenerate algebras, where `A I⁻¹` does
//! not.

use super::Calculus;
use crate::error::MathError;

impl Calculus {
    /// The right complement: linear, with `E ∧ rc(E) = I` for basis blades E.
    pub fn right_complement(&self, m: &[f64]) -> Vec<f64> {
        self.to_basis(&self.complement(&self.to_bits(m), |a, b| (a, b)))
    }

    /// The left complement: linear, with `lc(E) ∧ E = I` for basis blades E.
    pub fn left_complement(&self, m: &[f64]) -> Vec<f64> {
        self.to_basis(&self.complement(&self.to_bits(m), |a, b| (b, a)))
    }

    /// The regressive product `A ∨ B`, `rc(A ∨ B) = rc(A) ∧ rc(B)`: of grade a + b − n, where two blades
    /// that together span the whole space meet.
    pub fn vee(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let right = |m: &[f64]| self.complement(&self.to_bits(m), |a, b| (a, b));
        let wedge = self.wedge_bits(&right(a), &right(b));
        self.to_basis(&self.complement(&wedge, |a, b| (b, a)))
    }

    /// `A I⁻¹`, the metric dual; an error if there are null generators.
    pub fn dual(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let last = self.size() - 1;
        let square = self.sign(last, last);
        if square == 0.0 {
            return Err(MathError::DegenerateMetric);
        }
        Ok(self.undual(m).iter().map(|x| x / square).collect())
    }

    /// `A I`.
    pub fn undual(&self, m: &[f64]) -> Vec<f64> {
        let mut pseudoscalar = vec![0.0; self.size()];
        pseudoscalar[self.size() - 1] = 1.0;
        self.to_basis(&self.product(&self.to_bits(m), &pseudoscalar))
    }

    /// Maps each blade to that of the other generators, with the sign of their product in `order`.
    fn complement(&self, m: &[f64], order: impl Fn(usize, usize) -> (usize, usize)) -> Vec<f64> {
        let all = self.size() - 1;
        let mut out = vec![0.0; self.size()];
        for (bits, x) in m.iter().enumerate() {
            let (first, second) = order(bits, all ^ bits);
            out[all ^ bits] = self.sign(first, second) * x;
        }
        out
    }

    /// The wedge in bit order: blades with a common generator vanish.
    pub(super) fn wedge_bits(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        for (i, &x) in a.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            for (j, &y) in b.iter().enumerate().filter(|(j, _)| i & j == 0) {
                out[i | j] += self.sign(i, j) * x * y;
            }
        }
        out
    }
}
