//! Orbits of free motions, one in each lane: invariants, periods and phases.

use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::elliptic::{Means, first_kind, r_f};
use crate::numerics::exact_sum::Exact;
use crate::numerics::precise::Precise;
use crate::numerics::wide::{Wide, exp2};

/// A motion that is not steady, in principal axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    /// a, b and c.
    pub axes: [usize; 3],
    /// sign(c − a).
    pub s: f64,
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
}

/// Motions that are not steady: the numbers of [`Orbit`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbits<N, const W: usize, const FMA: bool> {
    pub axes: [[usize; 3]; W],
    pub s: [f64; W],
    /// e1, e2 and d along the axes a, b and c: their signs.
    pub signs: [[f64; W]; 3],
    pub amplitudes: [[f64; W]; 3],
    pub lambda: DoubleDoubles<W, FMA>,
    pub k2: [f64; W],
    pub kc: N,
    pub precession: DoubleDoubles<W, FMA>,
    /// Arbitrary on the separatrix.
    pub mean: DoubleDoubles<W, FMA>,
    pub on_separatrix: [bool; W],
    pub start: [[f64; W]; 2],
    /// Squared sine and cosine of the amplitudes of η and of K' − η.
    amplitudes_of_eta: [[[f64; W]; 2]; 2],
}

/// Positive moments and invariants in double-double precision. Those of a needle or a nearly steady rotation are beyond
/// the range of floats.
pub(super) struct Invariants<N, const W: usize, const FMA: bool> {
    pub a: N,
    pub b: N,
    pub c: N,
    /// |b − a|, |c − a| and |c − b|.
    pub ab: N,
    pub ac: N,
    pub bc: N,
    pub p: N,
    pub q: N,
    /// G².
    pub g2: N,
}

/// Whether a body with these principal moments and rates about its axes turns steadily, `I(Ω)` parallel to Ω.
pub(super) fn is_steady(i: [f64; 3], w: [f64; 3]) -> bool {
    (0..3).all(|k| {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        i[x] == i[y] || w[x] == 0.0 || w[y] == 0.0
    })
}

/// Axes by ascending moments; those of equal moments in their order.
#[inline(always)]
fn ascending(i: [f64; 3]) -> [usize; 3] {
    let mut order = [0, 1, 2];
    for k in [0, 1, 0] {
        let [x, y] = [order[k], order[k + 1]];
        (order[k], order[k + 1]) = if i[x] > i[y] { (y, x) } else { (x, y) };
    }
    order
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Orbits<N, W, FMA> {
    /// From principal moments and rates about their axes, in units of two powers of two, of bodies that do not turn
    /// steadily.
    #[inline(always)]
    pub fn new(moments: &[[f64; 3]; W], rates: &[[f64; 3]; W], [size, scale]: [&[f64; W]; 2]) -> Self {
        let (mut orders, mut i, mut w) = ([[0; 3]; W], [[0.0; W]; 3], [[0.0; W]; 3]);
        for l in 0..W {
            orders[l] = ascending(moments[l]);
            for k in 0..3 {
                (i[k][l], w[k][l]) = (moments[l][orders[l][k]], rates[l][orders[l][k]]);
            }
        }
        // Not mapped: a function without the target features of this one would be called for each.
        let i = [N::from(i[0]).in_units(size), N::from(i[1]).in_units(size), N::from(i[2]).in_units(size)];
        let [x, y, z] = w;
        let w = [N::from(x).in_units(scale), N::from(y).in_units(scale), N::from(z).in_units(scale)];
        let d = differences(i, w);
        // Whether c is the axis of the largest moment.
        let (mut short, mut s, on_separatrix) = ([false; W], [0.0; W], d.zeros());
        let mut axes = [[0; 3]; W];
        for l in 0..W {
            short[l] = d.signs()[l] >= 0.0;
            s[l] = if short[l] { 1.0 } else { -1.0 };
            let [small, middle, large] = orders[l];
            axes[l] = if short[l] { [small, middle, large] } else { [large, middle, small] };
        }
        let [wa, wb, wc] = [w[0].or(&short, w[2]), w[1], w[2].or(&short, w[0])];
        let inv = Invariants::new([i[0].or(&short, i[2]), i[1], i[2].or(&short, i[0])], [wa, wb, wc]);
        let bcq = inv.bc * inv.q;
        let lambda = (bcq / (inv.a * inv.b * inv.c)).sqrt().narrowed();
        let kc = (inv.ac * d.abs() / bcq).sqrt();
        let mut k2 = (inv.ab * inv.p / bcq).values();

        let (mut signs, mut signed) = ([[1.0; W]; 3], [[1.0; W]; 3]);
        for l in 0..W {
            k2[l] = if k2[l] < 1.0 { k2[l] } else { 1.0 };
            let [a, b, _] = axes[l];
            // The order (a, b, c) is even if it is a cyclic one.
            let parity = if (b + 3 - a) % 3 == 1 { 1.0 } else { -1.0 };
            let sigma = if wc.signs()[l] < 0.0 { -1.0 } else { 1.0 };
            // cn keeps its sign on the separatrix: ω_a < 0 is the half turn about c of a motion with ω_a > 0.
            let half_turn = if on_separatrix[l] && wa.signs()[l] < 0.0 { -1.0 } else { 1.0 };
            (signs[0][l], signs[1][l], signs[2][l]) = (half_turn, half_turn * sigma * parity, sigma);
            (signed[0][l], signed[1][l], signed[2][l]) = (signs[0][l], signs[1][l] * s[l], sigma);
        }
        let sizes = inv.amplitudes();
        let (mut precession, mean) = inv.precession(&s, &k2, N::all(1.0).or(&on_separatrix, kc), lambda);
        precession = (inv.g2.sqrt() / inv.b).narrowed().or(&on_separatrix, precession);
        let [cn, sn] = [(wa / sizes[0]).signed(&signed[0]), (wb / sizes[1]).signed(&signed[1])];
        let mut amplitudes = [sizes[0].values(), sizes[1].values(), sizes[2].values()];
        for k in 0..3 {
            for l in 0..W {
                amplitudes[k][l] *= signed[k][l];
            }
        }
        let start = arguments(cn, sn, kc);
        let amplitudes_of_eta = inv.amplitudes_of_eta();
        Orbits {
            axes,
            s,
            signs,
            amplitudes,
            lambda,
            k2,
            kc,
            precession,
            mean,
            on_separatrix,
            start,
            amplitudes_of_eta,
        }
    }

    /// η in each lane, finite unless k = 0.
    #[inline(always)]
    pub fn eta(&self) -> [f64; W] {
        first_kind(self.amplitudes_of_eta[0], &self.k2)
    }

    /// K' − η.
    #[inline(always)]
    pub fn rest_of_eta(&self) -> [f64; W] {
        first_kind(self.amplitudes_of_eta[1], &self.k2)
    }

    /// That of lane l.
    pub fn lane(&self, l: usize) -> Orbit {
        Orbit {
            axes: self.axes[l],
            s: self.s[l],
            amplitudes: self.amplitudes.map(|each| each[l]),
            lambda: self.lambda.lane(l),
            k2: self.k2[l],
            kc: self.kc.lane(l),
            precession: self.precession.lane(l),
            mean: (!self.on_separatrix[l]).then(|| self.mean.lane(l)),
            start: (self.start[0][l], self.start[1][l]),
        }
    }
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Invariants<N, W, FMA> {
    /// From the moments a, b, c and the rates about their axes.
    #[inline(always)]
    pub fn new([a, b, c]: [N; 3], [wa, wb, wc]: [N; 3]) -> Self {
        let (wa, wb, wc) = (wa * wa, wb * wb, wc * wc);
        let (ab, ac, bc) = ((b - a).abs(), (c - a).abs(), (c - b).abs());
        let (p, q) = (a * ac * wa + b * bc * wb, b * ab * wb + c * ac * wc);
        Invariants { a, b, c, ab, ac, bc, p, q, g2: a * a * wa + b * b * wb + c * c * wc }
    }

    /// Sizes of A_a, A_b and A_c.
    #[inline(always)]
    fn amplitudes(&self) -> [N; 3] {
        let Invariants { a, b, c, ac, bc, p, q, .. } = *self;
        [(p / (a * ac)).sqrt(), (p / (b * bc)).sqrt(), (q / (c * ac)).sqrt()]
    }

    /// ν and AGM(1, k'), by whichever of n and k²/n is smaller.
    #[inline(always)]
    fn precession(
        &self,
        s: &[f64; W],
        k2: &[f64; W],
        kc: N,
        lambda: DoubleDoubles<W, FMA>,
    ) -> (DoubleDoubles<W, FMA>, DoubleDoubles<W, FMA>) {
        let Invariants { a, b, c, ab, ac, bc, p, q, g2 } = *self;
        let g = g2.sqrt();
        let minus_n = c * ab / (a * bc);
        let by_n = (minus_n * minus_n).at_most(N::from(*k2));
        // 1 − n = b(c−a)/(a(c−b)), and 1 − k²/n = |c−a| G²/(cQ).
        let p2 = (b * ac).or(&by_n, ac * g2) / (a * bc).or(&by_n, c * q);
        let means = Means::new(kc);
        let (mean, sum) = (means.mean(), means.sum(p2.narrowed()));
        // ν = G/a − s (½ G|b−a|/ab S + λ M), and G/c + s P/2cG S.
        let whole = (g / a.or(&by_n, c)).narrowed();
        let factor = ((g * ab).or(&by_n, p) / (a * b).or(&by_n, c * g)).half().narrowed();
        let mut signs = *s;
        for l in 0..W {
            signs[l] = if by_n[l] { -s[l] } else { s[l] };
        }
        let turns = (lambda * mean).or(&by_n, DoubleDoubles::all(DoubleDouble::ZERO));
        (whole + (factor * sum + turns).scaled(&signs), mean)
    }

    /// Squared sine and cosine for η and for K' − η.
    #[inline(always)]
    fn amplitudes_of_eta(&self) -> [[[f64; W]; 2]; 2] {
        let Invariants { a, b, c, ab, ac, bc, p, q, g2 } = *self;
        let (whole, other) = (b * ac, ac * g2);
        [
            [(a * bc / whole).values(), (c * ab / whole).values()],
            [(c * q / other).values(), (a * p / other).values()],
        ]
    }
}

/// D, rounded once if its two terms nearly cancel, from moments in ascending order.
#[inline(always)]
fn differences<N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    [small, b, large]: [N; 3],
    [w_small, _, w_large]: [N; 3],
) -> N {
    /// The terms cancel if their difference is at most this times them.
    const CANCELLED: f64 = 1e-2;
    // i_x (i_x − i_b) ω_x²
    let high = large * (large - b) * w_large * w_large;
    let low = small * (small - b) * w_small * w_small;
    let mut d = high + low;
    let cancelled = d.abs().at_most((high - low) * N::all(CANCELLED));
    for l in 0..W {
        if cancelled[l] {
            let [i_large, i_b, i_small] = [large, b, small].map(|each| each.lane(l));
            d.put(l, difference([i_large, i_b, i_small], [w_large.lane(l), w_small.lane(l)]));
        }
    }
    d
}

/// D, rounded once, of terms that are nearly equal.
#[cold]
fn difference([large, b, small]: [Wide; 3], [w_large, w_small]: [Wide; 2]) -> Wide {
    let term = |i: Wide, w: Wide| {
        let [(i, m), (ib, n), (w, e)] = [i, b, w].map(Wide::parts);
        let most = m.max(n);
        // Shifts beyond 1000 bits are below the last digit of a nonzero difference.
        let shifted = |x: f64, n: i64| if most - n > 1000 { 0.0 } else { x * exp2(n - most) };
        let difference = Exact::ZERO.plus(shifted(i.hi, m)).plus(-shifted(ib.hi, n));
        (difference.times(i.hi).times(w.hi).times(w.hi), most + m + 2 * e)
    };
    let ((high, m), (low, n)) = (term(large, w_large), term(small, w_small));
    // The terms are nearly equal, so that their exponents are not far apart.
    Wide::of(high.add(low.times(exp2(n - m))).value(), m)
}

/// The u in [−2K, 2K] with given cn u and sn u, up to a factor, as a multiple of K and a rest of at most K/2. On the
/// separatrix, `k' = 0`, only the rest is nonzero.
#[inline(always)]
pub(crate) fn arguments<N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    cn: N,
    sn: N,
    kc: N,
) -> [[f64; W]; 2] {
    // Beyond K/2 tan am(u − K) = −cn u / (k' sn u).
    let near = (kc * (sn * sn)).at_most(cn * cn);
    let (mut whole, mut signs) = ([0.0; W], [0.0; W]);
    for l in 0..W {
        let (below, left) = (sn.signs()[l] < 0.0, cn.signs()[l] < 0.0);
        let side = if below { -1.0 } else { 1.0 };
        let opposite = if below == left { 1.0 } else { -1.0 };
        whole[l] = if !near[l] {
            side
        } else if left {
            2.0
        } else {
            0.0
        };
        signs[l] = if near[l] { opposite } else { -opposite };
    }
    let (sin, cos) = (sn.abs().or(&near, cn.abs()).signed(&signs), cn.abs().or(&near, kc * sn.abs()));
    let size = (cos * cos + sin * sin).sqrt();
    let [part, cosines, sines] = [(kc * sin / size).values(), (cos / size).values(), (sin / size).values()];
    let (mut cos2, mut delta2) = ([0.0; W], [0.0; W]);
    for l in 0..W {
        // Δ² = 1 − k² sin² = cos² + k'² sin², and cos² >= k'/2.
        cos2[l] = cosines[l] * cosines[l];
        delta2[l] = cos2[l] + part[l] * part[l];
    }
    let mut rest = r_f(cos2, delta2, [1.0; W]);
    let on_separatrix = kc.zeros();
    for l in 0..W {
        rest[l] *= sines[l];
    }
    for l in 0..W {
        if on_separatrix[l] {
            rest[l] = (sin.lane(l) / cos.lane(l)).value().asinh();
        }
    }
    [whole, rest]
}
