//! The inverse: `M X = 1` is a linear system for the components of X.
//!
//! In a finite algebra a right inverse is also the left one. Multiplication by X inverts multiplication by M, so the
//! condition number of the system is at most `‖M‖ ‖X‖` with the sum of magnitudes as norm.

use super::{Calculus, clifford_conjugate, grade, reverse, scaled};
use crate::error::MathError;
use crate::g3::values::scale_of;

/// The deviation of `M̄M` from a number up to which `M̄/(M̄M)` is used: the refinement squares it.
const NEARLY_A_NUMBER: f64 = 1e-8;

impl Calculus {
    /// `M⁻¹`, with `M M⁻¹ = M⁻¹ M = 1`.
    pub fn inverse(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let mut m = self.read(m)?;
        // The part without null generators decides invertibility and sets the scale.
        let scale = scale_of(&self.without_null(&m));
        m.iter_mut().for_each(|x| *x /= scale);
        // Scaled up, small parts with null generators would count in the condition.
        let factor = self.balance_down(&mut m);
        let mut x = self.inverse_bits(&m)?;
        self.scale_null(&mut x, 1.0 / factor);
        x.iter_mut().for_each(|x| *x /= scale);
        self.write(&x)
    }

    /// The components of blades without a generator of square 0.
    pub(super) fn without_null(&self, m: &[f64]) -> Vec<f64> {
        m.iter().enumerate().map(|(bits, &x)| if bits & self.null == 0 { x } else { 0.0 }).collect()
    }

    /// The inverse of components of about size 1, refined once: `X + X(1 − MX)` squares the error.
    pub(super) fn inverse_bits(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        let singular = |rcond| MathError::IllConditioned { reciprocal_condition: rcond };
        if self.without_null(m).iter().all(|&x| x == 0.0) {
            return Err(singular(0.0));
        }
        let mut x = match self.conjugate_inverse(m) {
            Some(x) => x,
            None => self.solve(m).ok_or(singular(0.0))?,
        };
        let size = |m: &[f64]| m.iter().map(|x| x.abs()).sum::<f64>();
        let reciprocal_condition = 1.0 / (size(m) * size(&x));
        // Rounding of a sum of 2ⁿ products.
        if reciprocal_condition.is_nan() || reciprocal_condition <= self.size() as f64 * f64::EPSILON {
            return Err(singular(reciprocal_condition.max(0.0)));
        }
        let mut residual = scaled(&self.product(m, &x), -1.0);
        residual[0] += 1.0;
        // A residual of rounding errors alone would spoil the side `X M`, which may be exact.
        if size(&residual) <= self.size() as f64 * f64::EPSILON * size(m) * size(&x) {
            return Ok(x);
        }
        let correction = self.product(&x, &residual);
        x.iter_mut().zip(correction).for_each(|(x, c)| *x += c);
        Ok(x)
    }

    /// `M̄/(M̄M)` for a conjugate with which the product is a number, as the reverse of a versor or blade.
    fn conjugate_inverse(&self, m: &[f64]) -> Option<Vec<f64>> {
        [reverse(m), clifford_conjugate(m)].into_iter().find_map(|conjugate| {
            let p = self.product(&conjugate, m);
            let rest: f64 = p[1..].iter().map(|x| x.abs()).sum();
            (rest < NEARLY_A_NUMBER * p[0].abs()).then(|| conjugate.iter().map(|x| x / p[0]).collect())
        })
    }

    /// Solves `M X = 1` by elimination with row pivots, in half the unknowns for an even or odd element.
    fn solve(&self, m: &[f64]) -> Option<Vec<f64>> {
        let holds = |parity: u32| (0..m.len()).any(|b| m[b] != 0.0 && grade(b) % 2 == parity);
        let unknowns: Vec<usize> = match (holds(0), holds(1)) {
            (true, true) => (0..m.len()).collect(),
            (even, _) => (0..m.len()).filter(|&b| grade(b).is_multiple_of(2) == even).collect(),
        };
        // The product is even: its blades are the unknown ones, or each of these times a generator.
        let flip = usize::from(!holds(0));
        let n = unknowns.len();
        let mut a: Vec<Vec<f64>> = unknowns
            .iter()
            .map(|row| {
                let k = row ^ flip;
                let coefficient = |&j: &usize| self.sign(k ^ j, j) * m[k ^ j];
                let right = if k == 0 { 1.0 } else { 0.0 };
                unknowns.iter().map(coefficient).chain([right]).collect()
            })
            .collect();
        for c in 0..n {
            let pivot = (c..n).max_by(|&i, &j| a[i][c].abs().total_cmp(&a[j][c].abs()))?;
            a.swap(c, pivot);
            if a[c][c] == 0.0 {
                return None;
            }
            let (upper, lower) = a.split_at_mut(c + 1);
            let top = &upper[c];
            for row in lower.iter_mut().filter(|row| row[c] != 0.0) {
                let ratio = row[c] / top[c];
                for (x, t) in row[c..].iter_mut().zip(&top[c..]) {
                    *x -= ratio * t;
                }
            }
        }
        let mut x = vec![0.0; m.len()];
        for c in (0..n).rev() {
            let known: f64 = (c + 1..n).map(|j| a[c][j] * x[unknowns[j]]).sum();
            x[unknowns[c]] = (a[c][n] - known) / a[c][c];
        }
        Some(x)
    }
}
