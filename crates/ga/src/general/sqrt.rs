//! Logarithms with more than five generators, by square roots in the algebra.

use super::log::{ARCOSH, MOST_HALVINGS, NEAR};
use super::{Calculus, add_scaled, grade, reverse, scaled};
use crate::g3::values::norm;

/// Steps of [`Calculus::root_and_inverse`]: each halves the distance of the exponents, then squares it.
const MOST_STEPS: u32 = 40;

impl Calculus {
    /// The bivector logarithm of a rotor by the halvings of `log`, with C and F as elements of the algebra; None if the
    /// principal logarithm is not a bivector.
    pub(super) fn log_by_roots(&self, r: &[f64]) -> Option<Vec<f64>> {
        let mut c = r.to_vec();
        add_scaled(&mut c, &reverse(r), 1.0);
        let mut f = r.to_vec();
        add_scaled(&mut f, &reverse(r), -1.0);
        let (mut c, mut f) = (scaled(&c, 0.5), scaled(&f, 0.5));
        let one_minus = |c: &[f64]| {
            let mut z = scaled(c, -1.0);
            z[0] += 1.0;
            z
        };
        let mut halvings = 0;
        while one_minus(&c).iter().map(|x| x.abs()).sum::<f64>() > NEAR {
            c[0] += 1.0;
            let (root, inverse) = self.root_and_inverse(&scaled(&c, 0.5))?;
            c = root;
            f = self.product(&f, &inverse);
            halvings += 1;
            if halvings > MOST_HALVINGS {
                return None;
            }
        }
        let z = scaled(&one_minus(&c), 0.5);
        let mut g = vec![0.0; r.len()];
        for t in ARCOSH.iter().rev() {
            g = self.product(&g, &z);
            g[0] += t;
        }
        let mut log = self.product(&f, &g);
        let size = norm(&log);
        for (_, x) in log.iter_mut().enumerate().filter(|(bits, _)| grade(*bits) != 2) {
            if x.abs() > self.tolerances.versor * (1.0 + size) {
                return None;
            }
            *x = 0.0;
        }
        Some(log)
    }

    /// `√A` and its inverse by the iteration of Denman and Beavers, `Y ← ½(Y + Z⁻¹)`, `Z ← ½(Z + Y⁻¹)`,
    /// from `Y = A`, `Z = 1`; None if it does not converge, for A with numbers on the negative axis.
    fn root_and_inverse(&self, a: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let (mut y, mut z) = (a.to_vec(), self.scalar(1.0));
        for _ in 0..MOST_STEPS {
            let (y_inverse, z_inverse) = (self.inverse_bits(&y).ok()?, self.inverse_bits(&z).ok()?);
            let half_way =
                |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect() };
            let last = y;
            (y, z) = (half_way(&last, &z_inverse), half_way(&z, &y_inverse));
            // The next step would be the square of this one.
            if distance(&last, &y) <= 1e-9 * norm(&y) {
                return Some((y, z));
            }
        }
        None
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}
