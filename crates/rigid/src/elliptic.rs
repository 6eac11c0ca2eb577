//! Elliptic integrals in Carlson's symmetric form, which loses no digits in any limit.
//!
//! B. C. Carlson, *Numerical computation of real or complex elliptic integrals*, Numer. Algorithms 10
//! (1995) 13–26: duplication brings the arguments together, a Taylor series about their mean ends it. Complete
//! integrals and elliptic functions by Bulirsch's means.

use crate::double_double::DoubleDouble;

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

/// `R_C(1, 1 + e) = arctan(√e)/√e`, for e > −1.
fn r_c1(e: f64) -> f64 {
    if e.abs() < 1e-4 {
        return 1.0 - e * (1.0 / 3.0 - e * (1.0 / 5.0 - e * (1.0 / 7.0 - e / 9.0)));
    }
    let root = e.abs().sqrt();
    if e > 0.0 { root.atan() / root } else { root.atanh() / root }
}

/// Bulirsch's `cel(k', p, 1, 1) = ∫₀^{π/2} dφ / ((cos²φ + p sin²φ) √(cos²φ + k'² sin²φ))`, for positive k'
/// and p, in twice the precision: `K` for p = 1 and `Π(n)` for p = 1 − n.
///
/// R. Bulirsch, Numer. Math. 13 (1969) 305–315. Arithmetic–geometric means; only positive numbers are added.
pub(crate) fn complete(kc: DoubleDouble, p: DoubleDouble) -> DoubleDouble {
    let (mut qc, mut e, mut em) = (kc, kc, DoubleDouble::ONE);
    let mut p = p.sqrt();
    let (mut a, mut b) = (DoubleDouble::ONE, DoubleDouble::ONE / p);
    loop {
        let (f, g) = (a, e / p);
        a = a + b / p;
        b = b + f * g;
        b = b + b;
        p = p + g;
        let previous = em;
        em = em + qc;
        // Convergence is quadratic: a difference of 1e-17 leaves one of 1e-34.
        if (previous - qc).abs().hi <= 1e-17 * previous.hi || !previous.hi.is_finite() {
            let half_pi = DoubleDouble::PI * 0.5.into();
            return half_pi * (b + a * em) / (em * (em + p));
        }
        qc = e.sqrt();
        qc = qc + qc;
        e = qc * em;
    }
}

/// Incomplete integral of the third kind, `Π(n; φ|k²) = ∫₀^φ dφ' / ((1 − n sin²φ') √(1 − k² sin²φ'))`, for
/// `n <= 0` and |φ| <= π/2, from sine, cosine and `Δ = √(1 − k² sin²φ)` of the amplitude, k² and `k'² = 1 − k²`.
///
/// Carlson's `sin φ R_F + (n/3) sin³φ R_J` cancels for n < 0. The interchange of parameters (Byrd & Friedman
/// 117.02; Boost's `ellint_3`) leads to `N = (k² − n)/(1 − n)` in [k², 1), and adds positive terms only.
pub(crate) fn incomplete_pi(n: f64, sin: f64, cos: f64, delta: f64, k2: f64, kc2: f64) -> f64 {
    let (s2, c2, d2) = (sin * sin, cos * cos, delta * delta);
    let first = sin * r_f(c2, d2, 1.0);
    if n == 0.0 {
        return first;
    }
    let big = (k2 - n) / (1.0 - n);
    let one_minus_big = kc2 / (1.0 - n);
    let third = first + big / 3.0 * sin * s2 * r_j(c2, d2, 1.0, c2 + one_minus_big * s2);
    let p = (-n * big).sqrt();
    let angle = (p * sin * cos / delta).atan();
    let root = (-n / ((k2 - n) * (1.0 - n))).sqrt();
    third * (-n / (1.0 - n)) * (kc2 / (k2 - n)) + first * (k2 / (k2 - n)) + angle * root
}

/// `Π(n; φ|k²) − F(φ|k²) = (n/3) sin³φ R_J`, arguments as for [`incomplete_pi`]: exact for small n, where the
/// difference would cancel.
pub(crate) fn incomplete_pi_excess(n: f64, sin: f64, cos: f64, delta: f64) -> f64 {
    let s2 = sin * sin;
    n / 3.0 * sin * s2 * r_j(cos * cos, delta * delta, 1.0, 1.0 - n * s2)
}

/// `sn`, `cn`, `dn` of u, from `k'²`, by descending Landen steps (Bulirsch 1965); `k'² = 0` is allowed.
pub(crate) fn jacobi(u: f64, kc2: f64) -> [f64; 3] {
    if kc2 <= 0.0 {
        let sech = 1.0 / u.cosh();
        return [u.tanh(), sech, sech];
    }
    // At most 7 steps for k'² of 1e-300.
    let mut steps = [(0.0, 0.0); 16];
    let (mut a, mut emc, mut mean, mut count) = (1.0, kc2, 1.0, 0);
    for step in &mut steps {
        emc = f64::sqrt(emc);
        *step = (a, emc);
        count += 1;
        mean = 0.5 * (a + emc);
        if (a - emc).abs() <= 1e-9 * a {
            break;
        }
        emc *= a;
        a = mean;
    }
    let (sin, cos) = (mean * u).sin_cos();
    if sin == 0.0 {
        return [0.0, cos, 1.0];
    }
    let mut ratio = cos / sin;
    let (mut c, mut dn) = (mean * ratio, 1.0);
    for &(a, root) in steps[..count].iter().rev() {
        ratio *= c;
        c *= dn;
        dn = (root + ratio) / (a + ratio);
        ratio = c / a;
    }
    let sn = (1.0 / c.hypot(1.0)).copysign(sin);
    [sn, c * sn, dn]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn complete_k(kc2: f64) -> f64 {
        complete(DoubleDouble::from(kc2).sqrt(), DoubleDouble::ONE).value()
    }

    fn complete_pi(_: f64, one_minus_n: f64, _: f64, kc2: f64) -> f64 {
        complete(DoubleDouble::from(kc2).sqrt(), one_minus_n.into()).value()
    }

    fn close(a: f64, b: f64) {
        assert!((a / b - 1.0).abs() < 1e-15 * 8.0, "{a} {b}");
    }

    /// Carlson's published check values (1995, section 4).
    #[test]
    fn published_values() {
        close(r_f(1.0, 2.0, 0.0), 1.311_028_777_146_06);
        close(r_f(2.0, 3.0, 4.0), 0.584_082_841_677_153_5);
        close(r_j(0.0, 1.0, 2.0, 3.0), 0.776_886_237_785_823_3);
        close(r_j(2.0, 3.0, 4.0, 5.0), 0.142_975_796_671_567_5);
    }

    #[test]
    fn circular_limits() {
        close(complete_k(1.0), FRAC_PI_2);
        // Π(n|0) = π / (2√(1 − n)).
        for n in [-3.0, -1e-7, 0.5, 0.999] {
            close(complete_pi(n, 1.0 - n, 0.0, 1.0), PI / (2.0 * (1.0f64 - n).sqrt()));
        }
        close(complete_pi(-1e12, 1e12 + 1.0, 0.0, 1.0), PI / (2.0 * (1e12f64 + 1.0).sqrt()));
    }

    /// `K → ln(4/k')` as k' → 0 (DLMF 19.9.1).
    #[test]
    fn near_the_separatrix() {
        for kc in [1e-9, 1e-100, 1e-150] {
            close(complete_k(kc * kc), (4.0f64 / kc).ln());
        }
    }

    /// Legendre-type relation between Π's of n and k²/n at k² = 1/2, by DLMF 19.7.8 rearranged:
    /// `Π(n) + Π(k²/n) = K + ½π √(n / ((1 − n)(n − k²)))` for k² < n < 1.
    #[test]
    fn third_kind_relation() {
        let (m, n) = (0.5, 0.7);
        let left = complete_pi(n, 1.0 - n, m, 1.0 - m) + complete_pi(m / n, 1.0 - m / n, m, 1.0 - m);
        let right = complete_k(1.0 - m) + FRAC_PI_2 * (n / ((1.0 - n) * (n - m))).sqrt();
        close(left, right);
    }
}
