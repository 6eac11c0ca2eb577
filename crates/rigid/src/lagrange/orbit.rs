//! What is known of a heavy top at the start: roots, periods, rates and phases.

use super::series::Zero;
use super::start::{Start, square, times_conjugate};
use crate::double_double::DoubleDouble;
use crate::elliptic::{first_kind, mean_and_sum};
use crate::free::orbit::argument;

/// A motion in which the tilt is defined by the cubic, in units of the start's scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    pub lambda: DoubleDouble,
    pub k2: f64,
    /// AGM(1, k') = π/2K; None on the separatrix.
    pub mean: Option<DoubleDouble>,
    /// u at time 0: so many K, and the rest.
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
    pub below: [DoubleDouble; 2],
    pub above: [DoubleDouble; 2],
    /// b − ℓ, b + ℓ, and the energy that an upright top with this spin lacks, A.
    pub delta: DoubleDouble,
    pub sigma: DoubleDouble,
    pub surplus: DoubleDouble,
}

/// The positive x and y with given `x y` and `y − x`.
fn factors(product: DoubleDouble, difference: DoubleDouble) -> [DoubleDouble; 2] {
    let root = (difference * difference + product * 4.0.into()).sqrt();
    let large = (root + difference.abs()) * 0.5.into();
    let small = if large.hi > 0.0 { product / large } else { DoubleDouble::ZERO };
    if difference.hi < 0.0 { [large, small] } else { [small, large] }
}

/// The largest root, by Newton's steps from above it, where function and slope have one sign and bend away.
fn root_below(start: DoubleDouble, f: impl Fn(DoubleDouble) -> [DoubleDouble; 2]) -> DoubleDouble {
    let mut x = start;
    for _ in 0..200 {
        let [value, slope] = f(x);
        let step = if slope.hi == 0.0 { DoubleDouble::ZERO } else { value / slope };
        if step.hi.is_nan() || step.hi <= 1e-31 * x.hi {
            break;
        }
        x = x - step;
    }
    x
}

/// Distances of a point p between r2 and r3 from the roots, up to a factor.
struct Point {
    to: [DoubleDouble; 3],
    /// `(p − r2)/(p − r1)`, which the factor may not have left.
    ratio: DoubleDouble,
    /// `N(p) = b − ℓp`, times the same factor.
    n: DoubleDouble,
}

/// λ, k', k² and the distances of the roots from each other.
struct Modulus {
    kc: DoubleDouble,
    k2: f64,
    lambda: DoubleDouble,
    /// r2 − r1, r3 − r1 and r3 − r2 times 2ĉ.
    gaps: [DoubleDouble; 3],
}

fn sign(x: DoubleDouble) -> f64 {
    if x.hi < 0.0 { -1.0 } else { 1.0 }
}

impl Orbit {
    /// None if the roots could not be told from each other.
    pub fn new(start: &Start) -> Option<Orbit> {
        let Start { gravity, spin, below: w0, above: z0, g, w, .. } = *start;
        let two = DoubleDouble::from(2.0);
        // w g* = h + i u'.
        let [h, rise] = times_conjugate(w, g);
        let (w_w, g_g) = (square(w), square(g));
        let (delta, sigma) = (h - spin * w0, h + spin * z0);
        let surplus = w_w - gravity * w0;
        let first = rise * rise;
        let second = two * spin * h - gravity * g_g - two * (z0 - DoubleDouble::ONE) * w_w;
        // Distances of u0 from r1 and r2, given that from r3 times 2ĉ.
        let beside = |x3: DoubleDouble| {
            let product = first / x3;
            factors(product, (second + gravity * product) / x3)
        };
        // 1 − r2 and 2ĉ(r3 − 1), given 1 − r1.
        let p1 = two * (surplus - delta * spin);
        let astride = |w1: DoubleDouble| {
            let product = delta * delta / w1;
            let [v, w2_scaled] = factors(gravity * product, (product - p1) / w1);
            // One of the two by the other, so that no factor 2ĉ is divided by.
            let w2 = if v.hi > w2_scaled.hi { product / v } else { w2_scaled / gravity };
            (w2, v)
        };
        let bend = two * gravity - surplus - spin * spin;
        let v = root_below(surplus + spin * spin + two * gravity, |y| {
            let (p, q, r) = (y * (two * gravity + y), y - surplus, gravity * delta - spin * y);
            [p * q - r * r, two * (gravity + y) * q + p + two * spin * r]
        });
        let x3 = gravity * w0 + v;
        let [x1, x2] = beside(x3);
        let w1 = if gravity.hi * (x1 + x2).hi > (x3 - gravity * x2).hi {
            // P and its slope, both negative.
            root_below(two, |w| {
                let (p, q, r) = (w * (two - w), surplus + gravity * w, delta + spin * w);
                let slope = two * (surplus - delta * spin) + two * bend * w - gravity * w * w * 3.0.into();
                [p * q - r * r, slope]
            })
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
        if !(gaps[1].hi > 0.0 && gaps[1].hi.is_finite()) {
            return None;
        }
        let modulus = Modulus {
            kc: (gaps[2] / gaps[1]).sqrt(),
            k2: (gaps[0] / gaps[1]).value().min(1.0),
            lambda: gaps[1].sqrt() * 0.5.into(),
            gaps,
        };
        let up = Point { to: [gravity * w1, gravity * w2, v], ratio: w2 / w1, n: gravity * delta };
        let across = {
            let direct = surplus + gravity * w2;
            let cancelled = direct.hi <= 1e-2 * (surplus.hi.abs() + gravity.hi * w2.hi);
            let turning = delta + spin * w2;
            let to2 = if cancelled && w2.hi > 0.0 { turning * turning / (w2 * z2) } else { direct };
            let to1 = to2 + gaps[0];
            let n = gravity * delta - spin * surplus;
            let direct = v - surplus;
            let cancelled = direct.hi <= 1e-2 * (v.hi + surplus.hi.abs());
            let to3 = if cancelled && to2.hi > 0.0 { n * n / (to1 * to2) } else { direct };
            Point { to: [to1, to2, to3], ratio: to2 / to1, n }
        };
        let sides = [sign(sigma), sign(delta), -sign(across.n)];
        let half: DoubleDouble = 0.5.into();
        let on_separatrix = modulus.kc.hi == 0.0;
        let (rates, mean) = if on_separatrix {
            ([half * spin, DoubleDouble::ZERO, -half * spin], None)
        } else {
            let (alpha, mean) = modulus.rate_below([z1, z2, z3], gravity, sigma);
            let (beta, _) = modulus.rate_above(&up);
            let (across, _) = modulus.rate_above(&across);
            ([alpha, beta, -(half * spin + across)], Some(mean))
        };
        let zero = |k: usize, [eta, rest]: [[f64; 2]; 2]| Zero {
            side: sides[k],
            eta: first_kind(eta, modulus.k2),
            rest: first_kind(rest, modulus.k2),
        };
        let zeros = [
            zero(0, modulus.amplitudes_below([z1, z2, z3], gravity)),
            zero(1, modulus.amplitudes_above(&up)),
            zero(2, modulus.amplitudes_above(&across)),
        ];
        let lowest = if w1.hi < 1.0 { delta + spin * w1 } else { sigma - spin * z1 };
        let part = |x: DoubleDouble| if gap.hi > 0.0 { (x / gap).value().max(0.0).sqrt() } else { 0.0 };
        let (sn, cn) = (part(x1).copysign(rise.hi), if gap.hi > 0.0 { part(x2) } else { 1.0 });
        let root = |x: DoubleDouble| x.value().max(0.0).sqrt();
        Some(Orbit {
            lambda: modulus.lambda,
            k2: modulus.k2,
            mean,
            start: argument(cn, sn, modulus.kc.value()),
            rates,
            zeros,
            sizes: [root(z2 * half), root(w1 * half), root(across.to[0])],
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
    /// μ(−1), from 1 + r1, 1 + r2, 2ĉ(1 + r3) and b + ℓ, and M.
    fn rate_below(
        &self,
        [z1, z2, z3]: [DoubleDouble; 3],
        gravity: DoubleDouble,
        n: DoubleDouble,
    ) -> (DoubleDouble, DoubleDouble) {
        /// Beyond this `1 − n` the means take long to meet.
        const FAR: f64 = 1e12;
        let p2 = z3 / self.gaps[1];
        if p2.hi <= FAR {
            let (mean, sum) = mean_and_sum(self.kc, p2);
            return (gravity * n * sum / (z3 * 4.0.into()), mean);
        }
        let (mean, sum) = mean_and_sum(self.kc, z2 / z1);
        let less = (z2 - z1) / z2 * sum * 0.5.into();
        let whole = n / (z1 * 2.0.into()) * (DoubleDouble::ONE - less);
        (whole - self.lambda * mean * sign(n).into(), mean)
    }

    /// μ(p) for p between r2 and r3, by whichever of the two parameters is smaller, and M.
    fn rate_above(&self, p: &Point) -> (DoubleDouble, DoubleDouble) {
        let half: DoubleDouble = 0.5.into();
        let [_, to2, to3] = p.to;
        if to2.hi * to2.hi <= self.k2 * to3.hi * to3.hi {
            let (mean, sum) = mean_and_sum(self.kc, (to2 + to3) / to3);
            (p.n / to3 * half * (half * sum - DoubleDouble::ONE), mean)
        } else {
            let (mean, sum) = mean_and_sum(self.kc, self.kc * self.kc / p.ratio);
            let less = (DoubleDouble::ONE - p.ratio) * sum * half;
            let whole = p.n / to2 * half * (DoubleDouble::ONE - less);
            (whole - self.lambda * mean * sign(p.n).into(), mean)
        }
    }

    /// Squared sine and cosine of the amplitudes of η and of K' − η for p = −1.
    fn amplitudes_below(&self, [z1, z2, z3]: [DoubleDouble; 3], gravity: DoubleDouble) -> [[f64; 2]; 2] {
        let eta = [z1 / z2, (z2 - z1) / z2];
        [eta, [self.gaps[1] / z3, gravity * z1 / z3]].map(|pair| pair.map(|x| x.hi))
    }

    /// The same for p between r2 and r3; any for a point at both.
    fn amplitudes_above(&self, p: &Point) -> [[f64; 2]; 2] {
        let [_, to2, to3] = p.to;
        let [_, whole, long] = self.gaps;
        if long.hi == 0.0 {
            return [[0.0, 1.0]; 2];
        }
        let eta = [p.ratio * whole / long, (DoubleDouble::ONE - p.ratio) * to3 / long];
        [eta, [to3 / long, to2 / long]].map(|pair| pair.map(|x| x.hi))
    }
}
