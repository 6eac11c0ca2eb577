//! Elliptic integrals in Carlson's symmetric form, accurate in all limits.
//!
//! B. C. Carlson, *Numerical computation of real or complex elliptic integrals*, Numer. Algorithms 10 (1995) 13–26:
//! duplication, then a Taylor series about the mean of the arguments. Complete integrals by arithmetic-geometric means.

use super::double_double::DoubleDouble;
use super::wide::Wide;

/// The series' next term is below rounding once the arguments agree to this relative spread.
const SPREAD: f64 = 1.2e-3;

/// `R_F(x, y, z) = ½ ∫₀^∞ dt / √((t+x)(t+y)(t+z))`; arguments >= 0, at most one 0.
pub fn r_f(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    loop {
        let mean = (x + y + z) / 3.0;
        let (dx, dy) = ((mean - x) / mean, (mean - y) / mean);
        let dz = -dx - dy;
        if dx.abs().max(dy.abs()).max(dz.abs()) < SPREAD || !mean.is_finite() || mean <= 0.0 {
            let e2 = dx * dy - dz * dz;
            let e3 = dx * dy * dz;
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
            return series / mean.sqrt();
        }
        let (sx, sy, sz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = sx * sy + sx * sz + sy * sz;
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
}

/// `R_J(x, y, z, p) = (3/2) ∫₀^∞ dt / ((t+p) √((t+x)(t+y)(t+z)))`; x, y, z as for [`r_f`], p > 0.
pub fn r_j(mut x: f64, mut y: f64, mut z: f64, mut p: f64) -> f64 {
    let delta = (p - x) * (p - y) * (p - z);
    let (mut sum, mut factor) = (0.0, 1.0);
    loop {
        let mean = (x + y + z + 2.0 * p) / 5.0;
        let (dx, dy, dz) = ((mean - x) / mean, (mean - y) / mean, (mean - z) / mean);
        let dp = -0.5 * (dx + dy + dz);
        let spread = dx.abs().max(dy.abs()).max(dz.abs()).max(dp.abs());
        if spread < SPREAD || !mean.is_finite() || mean <= 0.0 {
            let xyz = dx * dy * dz;
            let e2 = dx * dy + dx * dz + dy * dz - 3.0 * dp * dp;
            let e3 = xyz + 2.0 * e2 * dp + 4.0 * dp * dp * dp;
            let e4 = (2.0 * xyz + e2 * dp + 3.0 * dp * dp * dp) * dp;
            let e5 = xyz * dp * dp;
            let series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0
                - 3.0 * e4 / 22.0
                - 9.0 * e2 * e3 / 52.0
                + 3.0 * e5 / 26.0;
            return factor * series / (mean * mean.sqrt()) + 6.0 * sum;
        }
        let (sx, sy, sz, sp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let d = (sp + sx) * (sp + sy) * (sp + sz);
        let e = factor * factor * factor * delta / (d * d);
        sum += factor / d * r_c1(e);
        let lambda = sx * sy + sx * sz + sy * sz;
        (x, y, z, p) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda), 0.25 * (p + lambda));
        factor *= 0.25;
    }
}

/// `R_D(x, y, z) = R_J(x, y, z, z)`; x, y >= 0, at most one 0, z > 0.
pub fn r_d(x: f64, y: f64, z: f64) -> f64 {
    r_j(x, y, z, z)
}

/// `R_C(1, 1 + e) = arctan(√e)/√e`, for e > −1.
fn r_c1(e: f64) -> f64 {
    if e.abs() < 1e-4 {
        return 1.0 - e * (1.0 / 3.0 - e * (1.0 / 5.0 - e * (1.0 / 7.0 - e / 9.0)));
    }
    let root = e.abs().sqrt();
    if e > 0.0 { root.atan() / root } else { root.atanh() / root }
}

/// `F(φ, k')`, the incomplete integral of the first kind to the complementary modulus, from `sin² φ`, `cos² φ` and
/// k². Infinite for φ = π/2 and k = 0.
pub(crate) fn first_kind([sin2, cos2]: [f64; 2], k2: f64) -> f64 {
    let delta2 = cos2 + k2 * sin2;
    if delta2 == 0.0 { f64::INFINITY } else { sin2.sqrt() * r_f(cos2, delta2, 1.0) }
}

/// The arithmetic-geometric mean of 1 and a number in [0, 1].
pub(crate) fn mean(mut g: f64) -> f64 {
    let mut a = 1.0;
    if g <= 0.0 {
        return 0.0;
    }
    while a - g > 1e-8 * a {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    0.5 * (a + g)
}

/// Most steps of a mean. Convergence is quadratic: 13 steps from k' = 1e-300.
const STEPS: usize = 32;

/// `M = AGM(1, k')` and `Σ Q_n`, of which `K = π/2M` and `Π(n) − K = (K/2) (n/(1 − n)) Σ Q_n`, for positive
/// k', `p² = 1 − n >= 1`, in double-double precision.
pub(crate) fn mean_and_sum(kc: Wide, p2: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let means = Means::new(kc);
    (means.mean(), means.sum(p2))
}

/// The steps of `AGM(1, k')`, for [`mean_and_sum`] with several p².
pub(crate) struct Means {
    mean: DoubleDouble,
    /// `a_j g_j`.
    products: [DoubleDouble; STEPS],
    /// Number of steps until the two means are equal.
    count: usize,
}

impl Means {
    pub fn new(kc: Wide) -> Means {
        // The root of any k' is in the range of floats.
        let (mut a, mut g, mut root) = (DoubleDouble::ONE, kc.narrow(), kc.sqrt().narrow());
        let mut products = [DoubleDouble::ZERO; STEPS];
        let mut count = 0;
        for product in &mut products {
            (*product, count) = (root * root, count + 1);
            let met = (a - g).abs().hi <= 1e-17 * a.hi;
            a = (a + g) * 0.5.into();
            if met {
                break;
            }
            g = root;
            root = (a * g).sqrt();
        }
        Means { mean: a, products, count }
    }

    /// M.
    pub fn mean(&self) -> DoubleDouble {
        self.mean
    }

    /// `Σ Q_n`. With `p_0 = p`, `Q_0 = 1` and the means `a_j, g_j` (DLMF 19.8.6)
    /// `p_{j+1} = (p_j² + a_j g_j) / 2p_j`, `Q_{j+1} = ½ Q_j (p_j² − a_j g_j) / (p_j² + a_j g_j)`.
    pub fn sum(&self, p2: DoubleDouble) -> DoubleDouble {
        let (mut p2, mut p) = (p2, p2.sqrt());
        let (mut term, mut sum) = (DoubleDouble::ONE, DoubleDouble::ZERO);
        for step in 0..STEPS {
            sum = sum + term;
            // Once the means are equal, so are all further ones.
            let product = if step < self.count { self.products[step] } else { self.mean * self.mean };
            let whole = p2 + product;
            term = term * (p2 - product) / (whole * 2.0.into());
            if step + 1 >= self.count && term.hi.abs() <= 1e-33 {
                break;
            }
            p = whole / (p * 2.0.into());
            p2 = p * p;
        }
        sum
    }
}

#[cfg(test)]
mod tests;
