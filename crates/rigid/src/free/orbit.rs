//! What is known of a free motion at the start: invariants, periods and phases.

use super::power_of_two;
use crate::double_double::DoubleDouble;
use crate::elliptic::{first_kind, mean_and_sum, r_f};
use crate::exact::Exact;

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
    pub kc: f64,
    /// ν, in rad/s.
    pub precession: DoubleDouble,
    /// AGM(1, k') = π/2K; None on the separatrix.
    pub mean: Option<DoubleDouble>,
    /// u at time 0: so many K, and the rest.
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

/// Moments and invariants in twice the precision, differences and all else positive.
struct Invariants {
    a: DoubleDouble,
    b: DoubleDouble,
    c: DoubleDouble,
    /// |b − a|, |c − a| and |c − b|.
    ab: DoubleDouble,
    ac: DoubleDouble,
    bc: DoubleDouble,
    p: DoubleDouble,
    q: DoubleDouble,
    /// G².
    g2: DoubleDouble,
}

impl Orbit {
    /// From principal moments and the angular velocity. None if the rotation is steady, `I(Ω)` parallel to Ω.
    pub fn new(i: [f64; 3], w: [f64; 3]) -> Option<Orbit> {
        if (0..3).all(|k| (i[(k + 1) % 3] - i[(k + 2) % 3]) * w[(k + 1) % 3] * w[(k + 2) % 3] == 0.0) {
            return None;
        }
        let mut order = [0, 1, 2];
        order.sort_by(|&x, &y| i[x].total_cmp(&i[y]));
        let [small, b, large] = order;
        let (d, scale) = difference(i, w, order);
        let (a, c) = if d.hi >= 0.0 { (small, large) } else { (large, small) };
        let s = if c == large { 1.0 } else { -1.0 };
        let inv = Invariants::new([a, b, c].map(|k| i[k]), [a, b, c].map(|k| w[k]));
        // A wobble of 1e-140, or so slow a turn about the axis of a symmetric body, is none up to any horizon.
        if inv.p.hi.min(inv.q.hi) < 1e-280 {
            return None;
        }
        let bcq = inv.bc * inv.q;
        let lambda = (bcq / (inv.a * inv.b * inv.c)).sqrt();
        let kc = (inv.ac * d.abs() / bcq).sqrt() * scale.into();
        let k2 = (inv.ab * inv.p / bcq).value().min(1.0);

        // The order (a, b, c) is even if it is a cyclic one.
        let parity = if (b + 3 - a) % 3 == 1 { 1.0 } else { -1.0 };
        let sigma = 1f64.copysign(w[c]);
        let on_separatrix = d.hi == 0.0;
        // cn keeps its sign on the separatrix: ω_a < 0 is the half turn about c of a motion with ω_a > 0.
        let half_turn = if on_separatrix { 1f64.copysign(w[a]) } else { 1.0 };
        let signs = [half_turn, half_turn * sigma * parity, sigma];
        let sizes = inv.amplitudes();
        let amplitudes = [signs[0] * sizes[0], signs[1] * s * sizes[1], signs[2] * sizes[2]];
        let (precession, mean) = if on_separatrix {
            (inv.g2.sqrt() / inv.b, None)
        } else {
            let (precession, mean) = inv.precession(s, k2, kc, lambda);
            (precession, Some(mean))
        };
        let kc = kc.value();
        let start = argument(w[a] / amplitudes[0], w[b] / amplitudes[1], kc);
        let amplitudes_of_eta = inv.amplitudes_of_eta();
        Some(Orbit {
            axes: [a, b, c],
            s,
            signs,
            amplitudes,
            lambda,
            k2,
            kc,
            precession,
            mean,
            start,
            amplitudes_of_eta,
        })
    }
}

impl Invariants {
    /// From the moments a, b, c and the rates about their axes.
    fn new(i: [f64; 3], w: [f64; 3]) -> Invariants {
        let [a, b, c] = i.map(DoubleDouble::from);
        let [wa, wb, wc] = w.map(|w| DoubleDouble::from(w) * w.into());
        let (ab, ac, bc) = ((b - a).abs(), (c - a).abs(), (c - b).abs());
        let (p, q) = (a * ac * wa + b * bc * wb, b * ab * wb + c * ac * wc);
        Invariants { a, b, c, ab, ac, bc, p, q, g2: a * a * wa + b * b * wb + c * c * wc }
    }

    /// Sizes of A_a, A_b and A_c.
    fn amplitudes(&self) -> [f64; 3] {
        let Invariants { a, b, c, ac, bc, p, q, .. } = *self;
        [p / (a * ac), p / (b * bc), q / (c * ac)].map(|square| square.value().sqrt())
    }

    /// ν and AGM(1, k'), by whichever of n and k²/n is smaller.
    fn precession(
        &self,
        s: f64,
        k2: f64,
        kc: DoubleDouble,
        lambda: DoubleDouble,
    ) -> (DoubleDouble, DoubleDouble) {
        let Invariants { a, b, c, ab, ac, bc, p, q, g2 } = *self;
        let (g, s, two) = (g2.sqrt(), DoubleDouble::from(s), DoubleDouble::from(2.0));
        let minus_n = c * ab / (a * bc);
        if minus_n.hi * minus_n.hi <= k2 {
            // 1 − n = b(c−a)/(a(c−b)).
            let (mean, sum) = mean_and_sum(kc, b * ac / (a * bc));
            (g / a - s * (g * ab * sum / (a * b * two) + lambda * mean), mean)
        } else {
            // 1 − k²/n = |c−a| G²/(cQ).
            let (mean, sum) = mean_and_sum(kc, ac * g2 / (c * q));
            (g / c + s * p * sum / (c * g * two), mean)
        }
    }

    /// Squared sine and cosine for η and for K' − η.
    fn amplitudes_of_eta(&self) -> [[f64; 2]; 2] {
        let [a, b, c, p, q] = [self.a, self.b, self.c, self.p, self.q].map(|x| x.hi);
        let (whole, other) = (b * self.ac.hi, self.ac.hi * self.g2.hi);
        [[a * self.bc.hi / whole, c * self.ab.hi / whole], [c * q / other, a * p / other]]
    }
}

/// `D/x²` and x, a power of two near the rates in D: no square underflows. Where the two terms of D nearly
/// cancel, without any rounding but the last.
fn difference(i: [f64; 3], w: [f64; 3], [small, b, large]: [usize; 3]) -> (DoubleDouble, f64) {
    /// A difference of no more than this times its terms.
    const CANCELLED: f64 = 1e-2;
    let scale = power_of_two([w[small], w[large], 0.0]);
    // i_x (i_x − i_b) ω_x²
    let term = |x: usize| {
        let [ix, ib, wx] = [i[x], i[b], w[x] / scale].map(DoubleDouble::from);
        ix * (ix - ib) * wx * wx
    };
    let (high, low) = (term(large), term(small));
    let d = high + low;
    if d.hi.abs() > CANCELLED * (high.hi - low.hi) {
        return (d, scale);
    }
    let term = |x: usize| {
        let (ix, wx) = (i[x], w[x] / scale);
        Exact::ZERO.plus(ix).plus(-i[b]).times(ix).times(wx).times(wx)
    };
    (term(large).add(term(small)).value(), scale)
}

/// The u in [−2K, 2K] with given cn u and sn u, up to a factor, as so many K and a rest of at most K/2. On the
/// separatrix, where `k' = 0`, all is rest.
pub(crate) fn argument(cn: f64, sn: f64, kc: f64) -> (f64, f64) {
    // Beyond K/2 tan am(u − K) = −cn u / (k' sn u).
    let (whole, sin, cos) = if cn * cn >= kc * (sn * sn) {
        (if cn < 0.0 { 2.0 } else { 0.0 }, sn.copysign(sn * cn), cn.abs())
    } else {
        (1f64.copysign(sn), (-cn).copysign(-cn * sn), kc * sn.abs())
    };
    let size = cos.hypot(sin);
    let (cos, sin) = (cos / size, sin / size);
    if kc == 0.0 {
        return (whole, (sin / cos).asinh());
    }
    // Δ² = 1 − k² sin² = cos² + k'² sin², and cos² >= k'/2.
    let first = sin * r_f(cos * cos, cos * cos + (kc * sin) * (kc * sin), 1.0);
    (whole, first)
}
