//! Orbit of a heavy top: roots, periods, rates and phases.
//!
//! Near the vertical the roots differ from ±1, and from each other, by squares of the tilt. They are [`Wide`] numbers,
//! and no distance is a difference of larger ones.

use super::series::Zero;
use super::start::{Start, square, times_conjugate};
use crate::exact::free::orbit::arguments;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::{Means, first_kind};
use crate::numerics::wide::Wide;
use std::ops::{Add, Mul, Sub};

/// A motion in which the tilt is defined by the cubic, in units of the start's scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    pub lambda: DoubleDouble,
    pub k2: f64,
    /// k'.
    pub kc: Wide,
    /// AGM(1, k') = π/2K; None on the separatrix.
    pub mean: Option<DoubleDouble>,
    /// u at time 0: a multiple of K, and the rest.
    pub start: (f64, f64),
    /// μ_α, μ_β and μ_w in rad per time.
    pub rates: [DoubleDouble; 3],
    /// Zeros of α, β and w.
    pub zeros: [Zero; 3],
    /// |α| at the upper bound, |β| and |w| at the lower one.
    pub sizes: [f64; 3],
    /// The sign κ between the three phases.
    pub kappa: f64,
    /// 1 − r1, 1 − r2 and 1 + r1, 1 + r2.
    pub below: [Wide; 2],
    pub above: [Wide; 2],
    /// b − ℓ, b + ℓ, and the energy that an upright top with this spin lacks, A.
    pub delta: Wide,
    pub sigma: Wide,
    pub surplus: Wide,
}

/// The positive x and y with given `x y` and `y − x`.
fn factors(product: Wide, difference: Wide) -> [Wide; 2] {
    let root = (difference * difference + product * 4.0.into()).sqrt();
    let large = (root + difference.abs()) * 0.5.into();
    let small = if large.is_positive() { product / large } else { Wide::ZERO };
    if difference.is_negative() { [large, small] } else { [small, large] }
}

/// The largest root of a cubic with real roots by Newton's method from a start above it; the other roots are all >= 0 or
/// all <= 0. `f` gives the value and two derivatives: while all three have the sign of the leading coefficient, there is
/// no root above (Budan). `floats` is the same in floats: the method begins beside the root that they find, if that is above
/// the root.
fn root_below(
    start: Wide,
    leading: f64,
    f: impl Fn(Wide) -> [Wide; 3],
    floats: impl Fn(f64) -> [f64; 3],
) -> Wide {
    const STRIDE: f64 = 1.0 / (1u64 << 32) as f64;
    /// Above the rounding of the root of floats, and below the root of the rounding of [`Wide`].
    const MARGIN: f64 = 1e-12;
    let is_above = |x: Wide| f(x).iter().all(|&d| (d * leading.into()).is_positive());
    let near = root_of_floats(start.value(), floats).map(|x| Wide::from(x * (1.0 + MARGIN)));
    let mut x = start;
    if let Some(near) = near.filter(|&near| is_above(near)) {
        x = near;
    } else {
        for _ in 0..100 {
            let next = x * STRIDE.into();
            if !is_above(next) {
                break;
            }
            x = next;
        }
    }
    for _ in 0..200 {
        let [value, slope, _] = f(x);
        let step = if slope.is_zero() { Wide::ZERO } else { value / slope };
        if !step.is_finite() || step <= x * 1e-31.into() {
            break;
        }
        x = x - step;
    }
    x
}

/// The same in floats, to a few roundings of a simple root; None beyond their range.
fn root_of_floats(start: f64, f: impl Fn(f64) -> [f64; 3]) -> Option<f64> {
    /// Terms of this size are far from underflow.
    const LEAST: f64 = 1e-200;
    let mut x = start;
    for _ in 0..60 {
        let [value, slope, _] = f(x);
        let step = value / slope;
        if !step.is_finite() || (slope * x).abs() < LEAST {
            return None;
        }
        x -= step;
        if step.abs() <= 1e-9 * x {
            return Some(x);
        }
    }
    None
}

/// Numbers in which roots are computed.
trait Real: Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl Real for f64 {}
impl Real for Wide {}

/// The numbers of the start on which the roots depend.
#[derive(Clone, Copy)]
struct Cubic<T> {
    gravity: T,
    spin: T,
    delta: T,
    surplus: T,
}

impl<T: Real> Cubic<T> {
    /// Half the second derivative by 2ĉ(u − 1), and by 1 − u, at u = 1.
    fn bend(self) -> T {
        T::from(2.0) * self.gravity - self.surplus - self.spin * self.spin
    }

    /// By y = 2ĉ(u − 1): the cubic, its derivative and half the second.
    fn above(self, y: T) -> [T; 3] {
        let Cubic { gravity, spin, delta, surplus } = self;
        let two = T::from(2.0);
        let (p, q, r) = (y * (two * gravity + y), y - surplus, gravity * delta - spin * y);
        let slope = two * (gravity + y) * q + p + two * spin * r;
        [p * q - r * r, slope, self.bend() + y * 3.0.into()]
    }

    /// The same by w = 1 − u.
    fn below(self, w: T) -> [T; 3] {
        let Cubic { gravity, spin, delta, surplus } = self;
        let two = T::from(2.0);
        let (p, q, r) = (w * (two - w), surplus + gravity * w, delta + spin * w);
        let third = gravity * w * 3.0.into();
        let slope = two * (surplus - delta * spin) + two * self.bend() * w - third * w;
        [p * q - r * r, slope, self.bend() - third]
    }
}

impl Cubic<Wide> {
    fn values(self) -> Cubic<f64> {
        let Cubic { gravity, spin, delta, surplus } = self;
        Cubic { gravity: gravity.value(), spin: spin.value(), delta: delta.value(), surplus: surplus.value() }
    }
}

/// Distances of a point p between r2 and r3 from the roots, up to a factor.
struct Point {
    to: [Wide; 3],
    /// `(p − r2)/(p − r1)` and `(r2 − r1)/(p − r1)`, without the factor, which may vanish.
    ratio: Wide,
    rest: Wide,
    /// `N(p) = b − ℓp`, times the same factor.
    n: Wide,
}

/// λ, k', k² and the distances of the roots from each other.
struct Modulus {
    kc: Wide,
    k2: f64,
    lambda: DoubleDouble,
    /// r2 − r1, r3 − r1 and r3 − r2 times 2ĉ.
    gaps: [Wide; 3],
}

fn sign(x: Wide) -> f64 {
    if x.is_negative() { -1.0 } else { 1.0 }
}

impl Orbit {
    /// None if the roots are not resolved.
    pub fn new(start: &Start) -> Option<Orbit> {
        let Start { gravity, spin, below: w0, above: z0, g, w, .. } = *start;
        let two = Wide::from(2.0);
        // w g* = h + i u'.
        let [h, rise] = times_conjugate(w, g);
        let (w_w, g_g) = (square(w), square(g));
        let (delta, sigma) = (h - spin * w0, h + spin * z0);
        let surplus = w_w - gravity * w0;
        let first = rise * rise;
        let second = two * spin * h - gravity * g_g - two * (z0 - Wide::ONE) * w_w;
        // Distances of u0 from r1 and r2, given that from r3 times 2ĉ.
        let beside = |x3: Wide| {
            let product = first / x3;
            factors(product, (second + gravity * product) / x3)
        };
        // 1 − r2 and 2ĉ(r3 − 1), given 1 − r1.
        let p1 = two * (surplus - delta * spin);
        let astride = |w1: Wide| {
            let product = delta * delta / w1;
            let [v, w2_scaled] = factors(gravity * product, (product - p1) / w1);
            // One of the two by the other, so that no factor 2ĉ is divided by.
            let w2 = if v > w2_scaled { product / v } else { w2_scaled / gravity };
            (w2, v)
        };
        let cubic = Cubic { gravity, spin, delta, surplus };
        let floats = cubic.values();
        let highest = surplus + spin * spin + two * gravity;
        let v = root_below(highest, 1.0, |y| cubic.above(y), |y| floats.above(y));
        let x3 = gravity * w0 + v;
        let [x1, x2] = beside(x3);
        let w1 = if gravity * (x1 + x2) > x3 - gravity * x2 {
            root_below(two, -1.0, |w| cubic.below(w), |w| floats.below(w))
        } else {
            w0 + x1
        };
        let (w2, v) = astride(w1);
        let [x1, x2] = beside(gravity * w0 + v);
        let w1 = w0 + x1;
        let gap = x1 + x2;
        // The last one times 2ĉ.
        let z3 = two * gravity + v;
        let [z1, z2] = factors(sigma * sigma / z3, gap);

        let gaps = [gravity * gap, gravity * w1 + v, gravity * w2 + v];
        if !(gaps[1].is_positive() && gaps[1].is_finite()) {
            return None;
        }
        let modulus = Modulus {
            kc: (gaps[2] / gaps[1]).sqrt(),
            k2: (gaps[0] / gaps[1]).value().min(1.0),
            lambda: (gaps[1].sqrt() * 0.5.into()).narrow(),
            gaps,
        };
        let to1 = gravity * w1;
        let up = Point { to: [to1, gravity * w2, v], ratio: w2 / w1, rest: gap / w1, n: gravity * delta };
        let across = {
            // |w|² at u = r2: from that at the start, or with |g|² from `b − ℓ r2`.
            let less = gravity * x2;
            let direct = w_w - less;
            let cancelled = direct <= (w_w + less) * 1e-2.into();
            let turning = if w2 < Wide::ONE { delta + spin * w2 } else { sigma - spin * z2 };
            let both = w2 * z2;
            let to2 = if cancelled && both.is_positive() { turning * turning / both } else { direct };
            let to1 = to2 + gaps[0];
            let n = gravity * h - spin * w_w;
            let direct = v - surplus;
            let cancelled = direct <= (v + surplus.abs()) * 1e-2.into();
            let to3 = if cancelled && to2.is_positive() { n * n / (to1 * to2) } else { direct };
            Point { to: [to1, to2, to3], ratio: to2 / to1, rest: gaps[0] / to1, n }
        };
        let sides = [sign(sigma), sign(delta), -sign(across.n)];
        let half: DoubleDouble = 0.5.into();
        let on_separatrix = gaps[2].is_zero();
        let axial = half * spin.narrow();
        let (rates, mean) = if on_separatrix {
            ([axial, DoubleDouble::ZERO, -axial], None)
        } else {
            let means = Means::new(modulus.kc);
            let alpha = modulus.rate_below(&means, [z1, z2, z3], gap, gravity, sigma);
            let [beta, across] = [&up, &across].map(|p| modulus.rate_above(&means, p));
            ([alpha, beta, -(axial + across)], Some(means.single_mean()))
        };
        let integral = |squares: [f64; 2]| first_kind(squares.map(|x| [x]), &[modulus.k2])[0];
        let zero = |k: usize, [eta, rest]: [[f64; 2]; 2]| Zero {
            side: sides[k],
            eta: integral(eta),
            rest: integral(rest),
        };
        let zeros = [
            zero(0, modulus.amplitudes_below([z1, z2, z3], gap, gravity)),
            zero(1, modulus.amplitudes_above(&up)),
            zero(2, modulus.amplitudes_above(&across)),
        ];
        let lowest = if w1 < Wide::ONE { delta + spin * w1 } else { sigma - spin * z1 };
        let part = |x: Wide| if gap.is_positive() { (x / gap).sqrt() } else { Wide::ZERO };
        let sn = if rise.is_negative() { -part(x1) } else { part(x1) };
        let cn = if gap.is_positive() { part(x2) } else { Wide::ONE };
        let half: Wide = 0.5.into();
        let [[whole], [rest]] = arguments(cn, sn, modulus.kc);
        Some(Orbit {
            lambda: modulus.lambda,
            k2: modulus.k2,
            kc: modulus.kc,
            mean,
            start: (whole, rest),
            rates,
            zeros,
            sizes: [z2 * half, w1 * half, across.to[0]].map(|x| x.sqrt().value()),
            kappa: sides[0] * sign(lowest),
            below: [w1, w2],
            above: [z1, z2],
            delta,
            sigma,
            surplus,
        })
    }
}

impl Modulus {
    /// μ(−1), from 1 + r1, 1 + r2, 2ĉ(1 + r3), r2 − r1 and b + ℓ.
    fn rate_below(
        &self,
        means: &Means<1, false>,
        [z1, z2, z3]: [Wide; 3],
        gap: Wide,
        gravity: Wide,
        n: Wide,
    ) -> DoubleDouble {
        /// Beyond this `1 − n` the means take long to meet.
        const FAR: f64 = 1e12;
        let p2 = z3 / self.gaps[1];
        if p2 <= FAR.into() {
            let sum = means.single_sum(p2.narrow());
            return (gravity * n * sum.into() / (z3 * 4.0.into())).narrow();
        }
        let sum = means.single_sum((z2 / z1).narrow());
        let less = (gap / z2).narrow() * sum * 0.5.into();
        let whole = (n / (z1 * 2.0.into())).narrow() * (DoubleDouble::ONE - less);
        whole - self.lambda * means.single_mean() * sign(n).into()
    }

    /// μ(p) for p between r2 and r3, by whichever of the two parameters is smaller.
    fn rate_above(&self, means: &Means<1, false>, p: &Point) -> DoubleDouble {
        let half: DoubleDouble = 0.5.into();
        let [_, to2, to3] = p.to;
        if to2 * to2 <= to3 * to3 * self.k2.into() {
            let sum = means.single_sum(((to2 + to3) / to3).narrow());
            (p.n / to3).narrow() * half * (half * sum - DoubleDouble::ONE)
        } else {
            let [_, whole, long] = self.gaps;
            let sum = means.single_sum((long / whole / p.ratio).narrow());
            let less = p.rest.narrow() * sum * half;
            let whole = (p.n / to2).narrow() * half * (DoubleDouble::ONE - less);
            whole - self.lambda * means.single_mean() * sign(p.n).into()
        }
    }

    /// Squared sine and cosine of the amplitudes of η and of K' − η for p = −1.
    fn amplitudes_below(&self, [z1, z2, z3]: [Wide; 3], gap: Wide, gravity: Wide) -> [[f64; 2]; 2] {
        let eta = [z1 / z2, gap / z2];
        [eta, [self.gaps[1] / z3, gravity * z1 / z3]].map(|pair| pair.map(Wide::value))
    }

    /// The same for p between r2 and r3; arbitrary if r2 = r3.
    fn amplitudes_above(&self, p: &Point) -> [[f64; 2]; 2] {
        let [_, to2, to3] = p.to;
        let [_, whole, long] = self.gaps;
        if long.is_zero() {
            return [[0.0, 1.0]; 2];
        }
        let eta = [p.ratio * whole / long, p.rest * to3 / long];
        [eta, [to3 / long, to2 / long]].map(|pair| pair.map(Wide::value))
    }
}
