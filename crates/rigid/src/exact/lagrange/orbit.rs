//! Orbits of heavy tops, one in each lane: roots, periods, rates and phases.
//!
//! Near the vertical the roots differ from ±1, and from each other, by squares of the tilt. They are in double-double
//! precision, and no distance is a difference of larger ones.

use super::roots::{Cubic, factors};
use super::series::{Zero, Zeros};
use super::start::{Starts, square, times_conjugate};
use crate::exact::free::orbit::arguments;
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::elliptic::{Means, first_kind, mean};
use crate::numerics::precise::Precise;
use crate::numerics::wide::Wide;
use std::f64::consts::PI;

/// A motion in which the tilt is defined by the cubic, in units of the start's scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    pub lambda: DoubleDouble,
    pub k2: f64,
    /// k'.
    pub kc: Wide,
    /// AGM(1, k') = π/2K; None on the separatrix.
    pub mean: Option<DoubleDouble>,
    /// μ_α, μ_β and μ_w in rad per time.
    pub rates: [DoubleDouble; 3],
    /// Zeros of α, β and w.
    pub zeros: [Zero; 3],
    /// 1 − r1, 1 − r2 and 1 + r1, 1 + r2.
    pub below: [Wide; 2],
    pub above: [Wide; 2],
    /// b − ℓ, b + ℓ, and the energy that an upright top with this spin lacks, A.
    pub delta: Wide,
    pub sigma: Wide,
    pub surplus: Wide,
}

/// The numbers of [`Orbit`], and what the series need besides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbits<N, const W: usize, const FMA: bool> {
    pub lambda: DoubleDoubles<W, FMA>,
    pub k2: [f64; W],
    pub kc: N,
    /// Arbitrary on the separatrix.
    pub mean: DoubleDoubles<W, FMA>,
    pub on_separatrix: [bool; W],
    /// AGM(1, k) = π/2K'.
    pub other: [f64; W],
    /// u at time 0: a multiple of K, and the rest.
    pub start: [[f64; W]; 2],
    pub rates: [DoubleDoubles<W, FMA>; 3],
    pub zeros: [Zeros<W>; 3],
    /// |α| at the upper bound, |β| and |w| at the lower one.
    pub sizes: [[f64; W]; 3],
    /// The sign κ between the three phases.
    pub kappa: [f64; W],
    pub below: [N; 2],
    pub above: [N; 2],
    pub delta: N,
    pub sigma: N,
    pub surplus: N,
    /// Whether the roots are resolved; without them nothing is valid.
    pub resolved: [bool; W],
}

/// Distances of a point p between r2 and r3 from the roots, up to a factor.
struct Point<N, const W: usize, const FMA: bool> {
    to: [N; 3],
    /// `(p − r2)/(p − r1)` and `(r2 − r1)/(p − r1)`, without the factor, which may vanish.
    ratio: N,
    rest: N,
    /// `N(p) = b − ℓp`, times the same factor.
    n: N,
}

/// λ, k', k² and the distances of the roots from each other.
struct Modulus<N, const W: usize, const FMA: bool> {
    kc: N,
    k2: [f64; W],
    lambda: DoubleDoubles<W, FMA>,
    /// AGM(1, k).
    other: [f64; W],
    /// r2 − r1, r3 − r1 and r3 − r2 times 2ĉ.
    gaps: [N; 3],
}

/// Roots by their distances.
struct Roots<N, const W: usize, const FMA: bool> {
    /// From u at the start to r1 and r2.
    x: [N; 2],
    /// 1 − r1 and 1 − r2; 2ĉ(r3 − 1).
    w: [N; 2],
    v: N,
    /// 1 + r1, 1 + r2; 2ĉ(r3 + 1).
    z: [N; 3],
    /// r2 − r1.
    gap: N,
}

/// What all numbers follow from, in units of the scale.
struct Invariants<N, const W: usize, const FMA: bool> {
    cubic: Cubic<N>,
    /// b + ℓ.
    sigma: N,
    /// `w g* = h + i u'`.
    h: N,
    rise: N,
    /// |w|² and |g|².
    w_w: N,
    g_g: N,
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Invariants<N, W, FMA> {
    #[inline(always)]
    fn new(start: &Starts<N, W, FMA>) -> Self {
        let Starts { gravity, spin, below, above, g, w, .. } = *start;
        let [h, rise] = times_conjugate(w, g);
        let (delta, sigma, w_w) = (h - spin * below, h + spin * above, square(w));
        let surplus = w_w - gravity * below;
        let cubic = Cubic { gravity, spin, delta, surplus };
        Invariants { cubic, sigma, h, rise, w_w, g_g: square(g) }
    }

    #[inline(always)]
    fn roots(&self, start: &Starts<N, W, FMA>) -> Roots<N, W, FMA> {
        let (w0, z0) = (start.below, start.above);
        let Cubic { gravity, spin, delta, surplus } = self.cubic;
        let highest = surplus + spin * spin + gravity.twice();
        let v = self.cubic.largest_root::<true, W, FMA>(highest, &[true; W]);
        let x3 = gravity * w0 + v;
        let second = (spin * self.h - (z0 - N::all(1.0)) * self.w_w).twice() - gravity * self.g_g;
        let [x1, x2] = self.other_distances(second, x3);
        let far = (gravity * (x1 + x2)).exceeds(x3 - gravity * x2);
        let mut w1 = w0 + x1;
        if far != [false; W] {
            w1 = self.cubic.largest_root::<false, W, FMA>(N::all(2.0), &far).or(&far, w1);
        }
        // 1 − r2 and 2ĉ(r3 − 1), given 1 − r1.
        let product = delta * delta / w1;
        let p1 = (surplus - delta * spin).twice();
        let [v, w2_scaled] = factors(gravity * product, (product - p1) / w1);
        // One of the two by the other, so that no factor 2ĉ is divided by.
        let by_v = v.exceeds(w2_scaled);
        let w2 = product.or(&by_v, w2_scaled) / v.or(&by_v, gravity);
        let [x1, x2] = self.other_distances(second, gravity * w0 + v);
        let gap = x1 + x2;
        let z3 = gravity.twice() + v;
        let [z1, z2] = factors(self.sigma * self.sigma / z3, gap);
        Roots { x: [x1, x2], w: [w0 + x1, w2], v, z: [z1, z2, z3], gap }
    }

    /// Distances of u0 from r1 and r2, given that from r3 times 2ĉ.
    #[inline(always)]
    fn other_distances(&self, second: N, x3: N) -> [N; 2] {
        let product = self.rise * self.rise / x3;
        factors(product, (second + self.cubic.gravity * product) / x3)
    }

    /// The upright, u = 1.
    #[inline(always)]
    fn up(&self, roots: &Roots<N, W, FMA>) -> Point<N, W, FMA> {
        let Roots { w: [w1, w2], v, gap, .. } = *roots;
        let Cubic { gravity, delta, .. } = self.cubic;
        let to = [gravity * w1, gravity * w2, v];
        Point { to, ratio: w2 / w1, rest: gap / w1, n: gravity * delta }
    }

    /// u = e.
    #[inline(always)]
    fn across(&self, roots: &Roots<N, W, FMA>) -> Point<N, W, FMA> {
        /// A difference cancels if it is at most this times the sum of its terms.
        const CANCELLED: f64 = 1e-2;
        let Roots { x: [_, x2], v, z: [_, z2, _], .. } = *roots;
        let Cubic { gravity, spin, surplus, .. } = self.cubic;
        let w2 = roots.w[1];
        // |w|² at u = r2: from that at the start, or with |g|² from `b − ℓ r2`.
        let less = gravity * x2;
        let direct = self.w_w - less;
        let (turning, both) = (self.numerator(w2, z2), w2 * z2);
        let cancelled = direct.at_most((self.w_w + less) * N::all(CANCELLED));
        let by_turning = both_of(&cancelled, &both.positive());
        let to2 = (turning * turning / both).or(&by_turning, direct);
        let apart = gravity * roots.gap;
        let to1 = to2 + apart;
        let n = gravity * self.h - spin * self.w_w;
        let direct = v - surplus;
        let cancelled = direct.at_most((v + surplus.abs()) * N::all(CANCELLED));
        let by_product = both_of(&cancelled, &to2.positive());
        let to3 = (n * n / (to1 * to2)).or(&by_product, direct);
        Point { to: [to1, to2, to3], ratio: to2 / to1, rest: apart / to1, n }
    }

    /// `b − ℓu`, from 1 − u and 1 + u.
    #[inline(always)]
    fn numerator(&self, below: N, above: N) -> N {
        let Cubic { spin, delta, .. } = self.cubic;
        let upper = N::all(1.0).exceeds(below);
        (delta + spin * below).or(&upper, self.sigma - spin * above)
    }
}

#[inline(always)]
fn both_of<const W: usize>(a: &[bool; W], b: &[bool; W]) -> [bool; W] {
    let mut both = [false; W];
    for l in 0..W {
        both[l] = a[l] & b[l];
    }
    both
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Modulus<N, W, FMA> {
    /// And whether the roots are resolved.
    #[inline(always)]
    fn new(gravity: N, roots: &Roots<N, W, FMA>) -> (Self, [bool; W]) {
        let [w1, w2] = roots.w;
        let gaps = [gravity * roots.gap, gravity * w1 + roots.v, gravity * w2 + roots.v];
        let (mut k2, mut resolved) = ((gaps[0] / gaps[1]).values(), [false; W]);
        for l in 0..W {
            k2[l] = k2[l].min(1.0);
            let whole = gaps[1].signs()[l];
            resolved[l] = (whole > 0.0) & (whole < f64::INFINITY);
        }
        let mut k = [0.0; W];
        for l in 0..W {
            k[l] = k2[l].sqrt();
        }
        let (kc, lambda) = ((gaps[2] / gaps[1]).sqrt(), gaps[1].sqrt().half().narrowed());
        (Modulus { kc, k2, lambda, other: mean(k), gaps }, resolved)
    }

    /// μ(−1), by the parameter for which the sum converges quickly.
    #[inline(always)]
    fn rate_below(
        &self,
        means: &Means<W, FMA>,
        [z1, z2, z3]: [N; 3],
        gap: N,
        n: N,
        gravity: N,
    ) -> DoubleDoubles<W, FMA> {
        /// Beyond this `1 − n` the means take long to meet.
        const FAR: f64 = 1e12;
        let p2 = z3 / self.gaps[1];
        let near = p2.at_most(N::all(FAR));
        let sum = means.sum(p2.or(&near, z2 / z1).narrowed());
        let direct = (gravity * n * N::from(sum) / z3.twice().twice()).narrowed();
        let whole = (n / z1.twice()).narrowed();
        let other = self.complement(means, n, whole, (gap / z2).narrowed() * sum);
        direct.or(&near, other)
    }

    /// μ(p) for p between r2 and r3, by whichever of the two parameters is smaller.
    #[inline(always)]
    fn rate_above(&self, means: &Means<W, FMA>, p: &Point<N, W, FMA>) -> DoubleDoubles<W, FMA> {
        let [_, to2, to3] = p.to;
        let [_, whole, long] = self.gaps;
        let by_n = (to2 * to2).at_most(to3 * to3 * N::from(self.k2));
        let p2 = ((to2 + to3) / to3).or(&by_n, long / whole / p.ratio);
        let sum = means.sum(p2.narrowed());
        let slope = (p.n / to3.or(&by_n, to2)).narrowed().half();
        let direct = slope * (sum.half() - DoubleDoubles::all(DoubleDouble::ONE));
        direct.or(&by_n, self.complement(means, p.n, slope, p.rest.narrowed() * sum))
    }

    /// A rate by the other parameter: `whole (1 − ½ less) − s λ π/2K`.
    #[inline(always)]
    fn complement(
        &self,
        means: &Means<W, FMA>,
        n: N,
        whole: DoubleDoubles<W, FMA>,
        less: DoubleDoubles<W, FMA>,
    ) -> DoubleDoubles<W, FMA> {
        let part = DoubleDoubles::all(DoubleDouble::ONE) - less.half();
        whole * part - (self.lambda * means.mean()).scaled(&n.unit_signs())
    }

    /// η and K' − η for p = −1.
    #[inline(always)]
    fn zeros_below(&self, side: [f64; W], [z1, z2, z3]: [N; 3], gap: N, gravity: N) -> Zeros<W> {
        let eta = [z1 / z2, gap / z2];
        self.zeros(side, [eta, [self.gaps[1] / z3, gravity * z1 / z3]])
    }

    /// The same for p between r2 and r3; arbitrary if r2 = r3.
    #[inline(always)]
    fn zeros_above(&self, side: [f64; W], p: &Point<N, W, FMA>) -> Zeros<W> {
        let [_, to2, to3] = p.to;
        let [_, whole, long] = self.gaps;
        let none = long.zeros();
        let (zero, one) = (N::all(0.0), N::all(1.0));
        let eta = [zero.or(&none, p.ratio * whole / long), one.or(&none, p.rest * to3 / long)];
        self.zeros(side, [eta, [zero.or(&none, to3 / long), one.or(&none, to2 / long)]])
    }

    /// From the squared sines and cosines of the amplitudes: the smaller of the two integrals, and the rest of K', which
    /// does not cancel.
    #[inline(always)]
    fn zeros(&self, side: [f64; W], [eta, rest]: [[N; 2]; 2]) -> Zeros<W> {
        let [eta, rest] = [[eta[0].values(), eta[1].values()], [rest[0].values(), rest[1].values()]];
        let (mut sin2, mut cos2, mut begins) = ([0.0; W], [0.0; W], [false; W]);
        for l in 0..W {
            begins[l] = eta[0][l] <= rest[0][l];
            sin2[l] = if begins[l] { eta[0][l] } else { rest[0][l] };
            cos2[l] = if begins[l] { eta[1][l] } else { rest[1][l] };
        }
        let small = first_kind([sin2, cos2], &self.k2);
        let [mut eta, mut rest] = [[0.0; W]; 2];
        for l in 0..W {
            let large = 0.5 * PI / self.other[l] - small[l];
            (eta[l], rest[l]) = if begins[l] { (small[l], large) } else { (large, small[l]) };
        }
        Zeros { side, eta, rest }
    }
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Orbits<N, W, FMA> {
    #[inline(always)]
    pub fn new(start: &Starts<N, W, FMA>) -> Self {
        let of = Invariants::new(start);
        let Cubic { gravity, spin, delta, surplus } = of.cubic;
        let roots = of.roots(start);
        let (modulus, resolved) = Modulus::new(gravity, &roots);
        let (up, across) = (of.up(&roots), of.across(&roots));

        let on_separatrix = modulus.gaps[2].zeros();
        // Any means, which are not used there.
        let means = Means::new(N::all(1.0).or(&on_separatrix, modulus.kc));
        let axial = spin.narrowed().half();
        let zero = DoubleDoubles::all(DoubleDouble::ZERO);
        let alpha = modulus.rate_below(&means, roots.z, roots.gap, of.sigma, gravity);
        let beta = modulus.rate_above(&means, &up);
        let of_w = zero.or(&on_separatrix, modulus.rate_above(&means, &across));
        let rates = [axial.or(&on_separatrix, alpha), zero.or(&on_separatrix, beta), -(axial + of_w)];

        let mut sides = [of.sigma.unit_signs(), delta.unit_signs(), across.n.unit_signs()];
        let mut kappa = of.numerator(roots.w[0], roots.z[0]).unit_signs();
        for l in 0..W {
            sides[2][l] = -sides[2][l];
            kappa[l] *= sides[0][l];
        }
        let zeros = [
            modulus.zeros_below(sides[0], roots.z, roots.gap, gravity),
            modulus.zeros_above(sides[1], &up),
            modulus.zeros_above(sides[2], &across),
        ];
        let moves = roots.gap.positive();
        let part = [roots.x[0] / roots.gap, roots.x[1] / roots.gap];
        let sn = part[0].sqrt().or(&moves, N::all(0.0)).signed(&of.rise.unit_signs());
        let cn = part[1].sqrt().or(&moves, N::all(1.0));
        let [z1, z2, _] = roots.z;
        Orbits {
            lambda: modulus.lambda,
            k2: modulus.k2,
            kc: modulus.kc,
            mean: means.mean(),
            on_separatrix,
            other: modulus.other,
            start: arguments(cn, sn, modulus.kc),
            rates,
            zeros,
            sizes: [
                z2.half().sqrt().values(),
                roots.w[0].half().sqrt().values(),
                across.to[0].sqrt().values(),
            ],
            kappa,
            below: roots.w,
            above: [z1, z2],
            delta,
            sigma: of.sigma,
            surplus,
            resolved,
        }
    }

    /// That of lane l.
    pub fn lane(&self, l: usize) -> Orbit {
        Orbit {
            lambda: self.lambda.lane(l),
            k2: self.k2[l],
            kc: self.kc.lane(l),
            mean: (!self.on_separatrix[l]).then(|| self.mean.lane(l)),
            rates: self.rates.map(|rate| rate.lane(l)),
            zeros: [0, 1, 2].map(|k| self.zeros[k].lane(l)),
            below: self.below.map(|x| x.lane(l)),
            above: self.above.map(|x| x.lane(l)),
            delta: self.delta.lane(l),
            sigma: self.sigma.lane(l),
            surplus: self.surplus.lane(l),
        }
    }
}
