//! Orbit of a free motion: invariants, periods and phases.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::{first_kind, mean_and_sum, r_f};
use crate::numerics::exact_sum::Exact;
use crate::numerics::wide::{Wide, exp2};
use std::cmp::Ordering;

/// A motion that is not steady, in principal axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    /// a, b and c.
    pub axes: [usize; 3],
    /// sign(c − a).
    pub s: f64,
    /// e1, e2 and d along the axes a, b and c: their signs.
    pub signs: [f64; 3],
    /// A_a, τ A_b and σ A_c; A_a is negative on half of the separatrix.
    pub amplitudes: [f64; 3],
    pub lambda: DoubleDouble,
    pub k2: f64,
    /// k'.
    pub kc: Wide,
    /// ν, in rad/s.
    pub precession: DoubleDouble,
    /// AGM(1, k') = π/2K; None on the separatrix.
    pub mean: Option<DoubleDouble>,
    /// u at time 0: a multiple of K, and the rest.
    pub start: (f64, f64),
    /// Squared sine and cosine of the amplitudes of η and of K' − η.
    amplitudes_of_eta: [[f64; 2]; 2],
}

impl Orbit {
    /// η, finite unless k = 0.
    pub fn eta(&self) -> f64 {
        first_kind(self.amplitudes_of_eta[0], self.k2)
    }

    /// K' − η.
    pub fn rest_of_eta(&self) -> f64 {
        first_kind(self.amplitudes_of_eta[1], self.k2)
    }
}

/// Positive moments and invariants in double-double precision. Those of a needle or a nearly steady rotation are beyond
/// the range of floats.
pub(super) struct Invariants {
    pub a: Wide,
    pub b: Wide,
    pub c: Wide,
    /// |b − a|, |c − a| and |c − b|.
    pub ab: Wide,
    pub ac: Wide,
    pub bc: Wide,
    pub p: Wide,
    pub q: Wide,
    /// G².
    pub g2: Wide,
}

impl Orbit {
    /// From principal moments and the angular velocity. None if the rotation is steady, `I(Ω)` parallel to Ω.
    pub fn new(i: [Wide; 3], w: [Wide; 3]) -> Option<Orbit> {
        let steady = |k: usize| {
            let (x, y) = ((k + 1) % 3, (k + 2) % 3);
            i[x] == i[y] || w[x].is_zero() || w[y].is_zero()
        };
        if (0..3).all(steady) {
            return None;
        }
        let mut order = [0, 1, 2];
        order.sort_by(|&x, &y| i[x].partial_cmp(&i[y]).unwrap_or(Ordering::Equal));
        let [small, b, large] = order;
        let d = difference(i, w, order);
        let (a, c) = if d.is_negative() { (large, small) } else { (small, large) };
        let s = if c == large { 1.0 } else { -1.0 };
        let inv = Invariants::new([a, b, c].map(|k| i[k]), [a, b, c].map(|k| w[k]));
        let bcq = inv.bc * inv.q;
        let lambda = (bcq / (inv.a * inv.b * inv.c)).sqrt().narrow();
        let kc = (inv.ac * d.abs() / bcq).sqrt();
        let k2 = (inv.ab * inv.p / bcq).value().min(1.0);

        // The order (a, b, c) is even if it is a cyclic one.
        let parity = if (b + 3 - a) % 3 == 1 { 1.0 } else { -1.0 };
        let sign = |k: usize| if w[k].is_negative() { -1.0 } else { 1.0 };
        let sigma = sign(c);
        let on_separatrix = d.is_zero();
        // cn keeps its sign on the separatrix: ω_a < 0 is the half turn about c of a motion with ω_a > 0.
        let half_turn = if on_separatrix { sign(a) } else { 1.0 };
        let signs = [half_turn, half_turn * sigma * parity, sigma];
        let sizes = inv.amplitudes();
        let signed = [signs[0], signs[1] * s, signs[2]];
        let (precession, mean) = if on_separatrix {
            ((inv.g2.sqrt() / inv.b).narrow(), None)
        } else {
            let (precession, mean) = inv.precession(s, k2, kc, lambda);
            (precession, Some(mean))
        };
        let [cn, sn] = [(a, 0), (b, 1)].map(|(axis, k)| w[axis] / sizes[k] * signed[k].into());
        Some(Orbit {
            axes: [a, b, c],
            s,
            signs,
            amplitudes: [0, 1, 2].map(|k| signed[k] * sizes[k].value()),
            lambda,
            k2,
            kc,
            precession,
            mean,
            start: argument(cn, sn, kc),
            amplitudes_of_eta: inv.amplitudes_of_eta(),
        })
    }
}

impl Invariants {
    /// From the moments a, b, c and the rates about their axes.
    pub fn new([a, b, c]: [Wide; 3], w: [Wide; 3]) -> Invariants {
        let [wa, wb, wc] = w.map(|w| w * w);
        let (ab, ac, bc) = ((b - a).abs(), (c - a).abs(), (c - b).abs());
        let (p, q) = (a * ac * wa + b * bc * wb, b * ab * wb + c * ac * wc);
        Invariants { a, b, c, ab, ac, bc, p, q, g2: a * a * wa + b * b * wb + c * c * wc }
    }

    /// Sizes of A_a, A_b and A_c.
    fn amplitudes(&self) -> [Wide; 3] {
        let Invariants { a, b, c, ac, bc, p, q, .. } = *self;
        [p / (a * ac), p / (b * bc), q / (c * ac)].map(Wide::sqrt)
    }

    /// ν and AGM(1, k'), by whichever of n and k²/n is smaller.
    fn precession(&self, s: f64, k2: f64, kc: Wide, lambda: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
        let Invariants { a, b, c, ab, ac, bc, p, q, g2 } = *self;
        let (g, s, half) = (g2.sqrt(), DoubleDouble::from(s), Wide::from(0.5));
        let minus_n = c * ab / (a * bc);
        if minus_n * minus_n <= k2.into() {
            // 1 − n = b(c−a)/(a(c−b)).
            let (mean, sum) = mean_and_sum(kc, (b * ac / (a * bc)).narrow());
            ((g / a).narrow() - s * ((g * ab / (a * b) * half).narrow() * sum + lambda * mean), mean)
        } else {
            // 1 − k²/n = |c−a| G²/(cQ).
            let (mean, sum) = mean_and_sum(kc, (ac * g2 / (c * q)).narrow());
            ((g / c).narrow() + s * (p / (c * g) * half).narrow() * sum, mean)
        }
    }

    /// Squared sine and cosine for η and for K' − η.
    fn amplitudes_of_eta(&self) -> [[f64; 2]; 2] {
        let Invariants { a, b, c, ab, ac, bc, p, q, g2 } = *self;
        let (whole, other) = (b * ac, ac * g2);
        [[a * bc / whole, c * ab / whole], [c * q / other, a * p / other]].map(|pair| pair.map(Wide::value))
    }
}

/// D, rounded once if its two terms nearly cancel.
fn difference(i: [Wide; 3], w: [Wide; 3], [small, b, large]: [usize; 3]) -> Wide {
    /// The terms cancel if their difference is at most this times them.
    const CANCELLED: f64 = 1e-2;
    // i_x (i_x − i_b) ω_x²
    let term = |x: usize| i[x] * (i[x] - i[b]) * w[x] * w[x];
    let (high, low) = (term(large), term(small));
    let d = high + low;
    if d.abs() > (high - low) * CANCELLED.into() {
        return d;
    }
    let term = |x: usize| {
        let [(ix, m), (ib, n), (wx, e)] = [i[x], i[b], w[x]].map(Wide::parts);
        let most = m.max(n);
        // Shifts beyond 1000 bits are below the last digit of a nonzero difference.
        let shifted = |x: f64, n: i64| if most - n > 1000 { 0.0 } else { x * exp2(n - most) };
        let difference = Exact::ZERO.plus(shifted(ix.hi, m)).plus(-shifted(ib.hi, n));
        (difference.times(ix.hi).times(wx.hi).times(wx.hi), most + m + 2 * e)
    };
    let ((high, m), (low, n)) = (term(large), term(small));
    // The terms are nearly equal, so that their exponents are not far apart.
    Wide::normal(high.add(low.times(exp2(n - m))).value(), m)
}

/// The u in [−2K, 2K] with given cn u and sn u, up to a factor, as a multiple of K and a rest of at most K/2. On the
/// separatrix, `k' = 0`, only the rest is nonzero.
pub(crate) fn argument(cn: Wide, sn: Wide, kc: Wide) -> (f64, f64) {
    let side = |x: Wide| if x.is_negative() { -1.0 } else { 1.0 };
    // Beyond K/2 tan am(u − K) = −cn u / (k' sn u).
    let (whole, sin, cos) = if cn * cn >= kc * (sn * sn) {
        (if cn.is_negative() { 2.0 } else { 0.0 }, sn.abs() * (side(sn) * side(cn)).into(), cn.abs())
    } else {
        (side(sn), cn.abs() * (-side(cn) * side(sn)).into(), kc * sn.abs())
    };
    let size = (cos * cos + sin * sin).sqrt();
    if kc.is_zero() {
        return (whole, (sin / cos).value().asinh());
    }
    // Δ² = 1 − k² sin² = cos² + k'² sin², and cos² >= k'/2.
    let [cos, sin, part] = [cos / size, sin / size, kc * sin / size].map(Wide::value);
    (whole, sin * r_f(cos * cos, cos * cos + part * part, 1.0))
}
