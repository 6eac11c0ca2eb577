//! Elliptic integrals in Carlson's symmetric form, accurate in all limits.
//!
//! B. C. Carlson, *Numerical computation of real or complex elliptic integrals*, Numer. Algorithms 10 (1995) 13–26:
//! duplication, then a Taylor series about the mean of the arguments. Complete integrals by arithmetic-geometric means.
//!
//! Lanes go on together until all have converged. One that has converged does not change any more, so it has the bits that
//! it has alone.

use super::double_double::{DoubleDouble, DoubleDoubles};
use super::precise::{Precise, Real};

/// The series' next term is below rounding once the arguments agree to this relative spread: for `R_F`, with terms up to the
/// seventh degree (DLMF 19.36.1), and for `R_J`, up to the fifth.
const SPREAD_OF_FIRST: f64 = 4.8e-3;
const SPREAD: f64 = 1.2e-3;

/// `R_F(x, y, z) = ½ ∫₀^∞ dt / √((t+x)(t+y)(t+z))`; arguments >= 0, at most one 0.
#[inline(always)]
pub fn r_f<const W: usize>(mut x: [f64; W], mut y: [f64; W], mut z: [f64; W]) -> [f64; W] {
    const THIRD: f64 = 1.0 / 3.0;
    let mut open = [1.0; W];
    while open != [0.0; W] {
        for l in 0..W {
            let mean = (x[l] + y[l] + z[l]) * THIRD;
            let least = SPREAD_OF_FIRST * mean;
            let apart = ((mean - x[l]).abs() >= least)
                | ((mean - y[l]).abs() >= least)
                | ((mean - z[l]).abs() >= least);
            // Neither 0, infinite nor NaN.
            let positive = (mean > 0.0) & (mean < f64::INFINITY);
            open[l] = if apart & positive { open[l] } else { 0.0 };
            let (sx, sy, sz) = (x[l].sqrt(), y[l].sqrt(), z[l].sqrt());
            let lambda = sx * sy + sx * sz + sy * sz;
            x[l] = if open[l] > 0.0 { 0.25 * (x[l] + lambda) } else { x[l] };
            y[l] = if open[l] > 0.0 { 0.25 * (y[l] + lambda) } else { y[l] };
            z[l] = if open[l] > 0.0 { 0.25 * (z[l] + lambda) } else { z[l] };
        }
    }
    let mut value = [0.0; W];
    for l in 0..W {
        let mean = (x[l] + y[l] + z[l]) / 3.0;
        let (dx, dy) = ((mean - x[l]) / mean, (mean - y[l]) / mean);
        let dz = -dx - dy;
        let e2 = dx * dy - dz * dz;
        let e3 = dx * dy * dz;
        let low = e2 * (-1.0 / 10.0 + e2 * (1.0 / 24.0 - e2 * (5.0 / 208.0)));
        let series = 1.0 + (low + e3 * (1.0 / 14.0 + e3 * (3.0 / 104.0) + e2 * (e2 / 16.0 - 3.0 / 44.0)));
        value[l] = series / mean.sqrt();
    }
    value
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
#[inline(always)]
pub(crate) fn first_kind<const W: usize>([sin2, cos2]: [[f64; W]; 2], k2: &[f64; W]) -> [f64; W] {
    let (mut delta2, mut infinite) = ([0.0; W], [false; W]);
    for l in 0..W {
        let square = cos2[l] + k2[l] * sin2[l];
        infinite[l] = square == 0.0;
        delta2[l] = if infinite[l] { 1.0 } else { square };
    }
    let mut value = r_f(cos2, delta2, [1.0; W]);
    for l in 0..W {
        value[l] = if infinite[l] { f64::INFINITY } else { sin2[l].sqrt() * value[l] };
    }
    value
}

/// The arithmetic-geometric mean of 1 and a number in [0, 1].
#[inline(always)]
pub(crate) fn mean<const W: usize>(mut g: [f64; W]) -> [f64; W] {
    let (mut a, mut open) = ([1.0; W], [1.0; W]);
    for l in 0..W {
        a[l] = if g[l] > 0.0 { 1.0 } else { 0.0 };
        g[l] = if g[l] > 0.0 { g[l] } else { 0.0 };
    }
    while open != [0.0; W] {
        for l in 0..W {
            open[l] = if a[l] - g[l] > 1e-8 * a[l] { 1.0 } else { 0.0 };
            let (next, root) = (0.5 * (a[l] + g[l]), (a[l] * g[l]).sqrt());
            a[l] = if open[l] > 0.0 { next } else { a[l] };
            g[l] = if open[l] > 0.0 { root } else { g[l] };
        }
    }
    for l in 0..W {
        a[l] = 0.5 * (a[l] + g[l]);
    }
    a
}

/// Most steps of a mean: the exponent of k' halves with each until convergence is quadratic, 16 steps from k' = 1e-600.
const STEPS: usize = 20;

/// Most steps of a sum: p halves with each until it is near the mean, then convergence is quadratic. 35 steps from p² = 1e12
/// and k' = 1e-600.
const SUMMED: usize = 40;

/// The steps of `M = AGM(1, k')` for positive k', in double-double precision: `K = π/2M`, and with the sum over them
/// `Π(n) − K = (K/2) (n/(1 − n)) Σ Q_n`.
pub(crate) struct Means<const W: usize, const FMA: bool> {
    mean: DoubleDoubles<W, FMA>,
    /// `a_j g_j`; once the means are equal, their square.
    products: [DoubleDoubles<W, FMA>; STEPS],
    /// The steps of each lane until the two means are equal, and of all.
    own: [f64; W],
    count: usize,
}

impl<const W: usize, const FMA: bool> Means<W, FMA> {
    #[inline(always)]
    pub fn new(kc: impl Precise<W, FMA>) -> Self {
        // The root of any k' is in the range of floats.
        let (mut a, mut g) = (DoubleDoubles::all(DoubleDouble::ONE), kc.narrowed());
        let mut root = kc.sqrt().narrowed();
        let mut products = [DoubleDoubles::all(DoubleDouble::ZERO); STEPS];
        let (mut open, mut own, mut count) = ([true; W], [0.0; W], 0);
        for product in &mut products {
            *product = (root * root).or(&open, a * a);
            a = a.plus(g).half().or(&open, a);
            let between = (a - g).abs();
            count += 1;
            for l in 0..W {
                own[l] += if open[l] { 1.0 } else { 0.0 };
                // Half the difference of the last two means.
                open[l] &= between.hi[l] > 0.5e-17 * a.hi[l];
            }
            if open == [false; W] {
                break;
            }
            g = root;
            root = (a * g).sqrt();
        }
        Means { mean: a, products, own, count }
    }

    /// M.
    #[inline(always)]
    pub fn mean(&self) -> DoubleDoubles<W, FMA> {
        self.mean
    }

    /// `Σ Q_n`, for `p² = 1 − n >= 1`. With `p_0 = p`, `Q_0 = 1` and the means `a_j, g_j` (DLMF 19.8.6)
    /// `p_{j+1} = (p_j² + a_j g_j) / 2p_j`, `Q_{j+1} = ½ Q_j (p_j² − a_j g_j) / (p_j² + a_j g_j)`.
    #[inline(always)]
    pub fn sum(&self, p2: DoubleDoubles<W, FMA>) -> DoubleDoubles<W, FMA> {
        let zero = DoubleDoubles::all(DoubleDouble::ZERO);
        let (mut p2, mut p) = (p2, p2.sqrt());
        let (mut term, mut sum) = (DoubleDoubles::all(DoubleDouble::ONE), zero);
        for step in 0..SUMMED {
            sum = sum + term;
            let product = if step < self.count { self.products[step] } else { self.mean * self.mean };
            let whole = p2.plus(product);
            term = term * (p2 - product) / whole.twice();
            let mut open = [false; W];
            for l in 0..W {
                open[l] = (((step + 1) as f64) < self.own[l]) | (term.hi[l].abs() > 1e-33);
            }
            if open == [false; W] {
                break;
            }
            term = term.or(&open, zero);
            p = whole / p.twice();
            p2 = p * p;
        }
        sum
    }
}

impl Means<1, false> {
    /// `Σ Q_n` for a single p².
    pub fn single_sum(&self, p2: DoubleDouble) -> DoubleDouble {
        self.sum(DoubleDoubles::all(p2)).lane(0)
    }
}

#[cfg(test)]
mod tests;
