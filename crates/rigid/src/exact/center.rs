//! The centre of mass under constant forces, drag and springs, in closed form.
//!
//! `x'' = a − γ x' − κ (x − x_a)` with the constant force, the drag and the stiffness over the mass and the anchor `x_a`.
//! From the start `x₀, v₀` with the acceleration `f = a − κ (x₀ − x_a)` of a body at rest there,
//!
//! ```text
//! x(t) = x₀ + v₀ S(t) + f Q(t) = x_a + (x₀ − x_a) K(t) + v₀ S(t) + a Q(t),    v(t) = v₀ S'(t) + f S(t),
//! S'' + γ S' + κ S = 0,  S(0) = 0,  S'(0) = 1,    Q(t) = ∫₀ᵗ S,    K = 1 − κ Q = S' + γ S.
//! ```
//!
//! with a the acceleration by the constant force. The second form keeps the digits of a distance from the anchor that decays.
//!
//! With the roots `λ± = −γ/2 ± √(γ²/4 − κ)`, `α = λ₊t` and `β = λ₋t`, these are divided differences of the exponential:
//! `S = t exp[α, β]` and `Q = t² exp[0, α, β]`. No form of them is accurate everywhere:
//!
//! - For short times, by the series `exp[0, α, β] = Σ hₙ/(n + 2)!` and `exp[α, β] = Σ hₙ/(n + 1)!` with the complete
//!   homogeneous polynomials `h₀ = 1`, `hₙ = (α + β) hₙ₋₁ − αβ hₙ₋₂`, which are real for all roots.
//! - For real roots, `S = e^α (1 − e^(β − α))/(λ₊ − λ₋)` and `S' = e^β + λ₊S`. Where one of them is slow, Q is the difference
//!   of `(e^z − 1)/z`, which are apart; else `κ Q = 1 − e^β + λ₋S`, whose terms are not nearly equal.
//! - For complex roots, `S = e^(−γt/2) sin(ωt)/ω`, `S' = e^(−γt/2) cos(ωt) − ½γ S` and `κ Q = 1 − S' − γ S`. ω has
//!   double-double precision and whole turns of ωt are subtracted, so that the error does not grow with time.

use super::free::MOST_TURNS;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::{Phase, sin_cos_turns};
use crate::state::center::Center;
use polhode_ga::Vector;

/// Up to this time, in units of the shorter of `1/|γ|` and `1/√|κ|`, the series are used. The roots are then at most
/// `1 + √5`, and the first term left out, `(1 + √5)³² 33/33!`, is below 1e-19.
const LONGEST_SERIES: f64 = 2.0;
const TERMS: usize = 32;

/// A root whose exponent is at least this decays or grows so far that `κ Q` loses less than a digit.
const FAR: f64 = 0.75;

/// An exponential from the least to the largest number has the exponent `ln 2²¹⁰⁰`.
const RANGE: f64 = 1456.0;

/// The law of motion of a centre of mass: `x'' = a − γ x' − κ (x − x_a)`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CenterLaw {
    /// a, in m/s².
    acceleration: Vector,
    /// γ, in 1/s.
    drag: f64,
    /// κ, in 1/s².
    spring: f64,
    /// x_a, in m.
    anchor: Vector,
    roots: Roots,
}

#[derive(Clone, Copy, Debug, Default)]
enum Roots {
    /// Without drag and springs both are 0.
    #[default]
    Zero,
    /// λ₊, λ₋ and their difference, in 1/s.
    Real { upper: DoubleDouble, lower: DoubleDouble, apart: f64 },
    /// `−γ/2 ± iω`: −γ/2 in 1/s, ω in rad/s, and ωt in turns.
    Complex { growth: DoubleDouble, omega: f64, phase: Phase },
}

/// S, S', Q and K at a time.
struct Response {
    impulse: f64,
    rate: f64,
    step: f64,
    kept: f64,
}

impl CenterLaw {
    /// With a constant force in N, the drag in N s/m, and the stiffness in N/m of a spring with this anchor, of a mass in kg.
    pub fn new(force: Vector, drag: f64, (stiffness, anchor): (f64, Vector), mass: f64) -> CenterLaw {
        let [gamma, kappa] = [drag, stiffness].map(|k| divided(k, mass));
        let roots = roots(gamma, kappa);
        CenterLaw { acceleration: force / mass, drag: gamma.hi, spring: kappa.hi, anchor, roots }
    }

    /// Whether the path is a parabola: nothing but a constant force acts.
    pub fn is_uniform(&self) -> bool {
        matches!(self.roots, Roots::Zero)
    }

    /// Whether nothing acts.
    pub fn is_zero(&self) -> bool {
        self.is_uniform() && self.acceleration == Vector::default()
    }

    /// The fastest rate of change in 1/s.
    pub fn rate(&self) -> f64 {
        self.drag.abs().max(self.spring.abs().sqrt())
    }

    /// The rate of change in 1/s a time after the start in s: the sum of those of the modes that are within the range of
    /// numbers.
    pub fn rate_after(&self, elapsed: f64) -> f64 {
        let within = |growth: f64| if (growth * elapsed).abs() <= RANGE { 1.0 } else { 0.0 };
        match &self.roots {
            Roots::Zero => 0.0,
            Roots::Real { upper, lower, .. } => {
                [upper.hi, lower.hi].map(|root| root.abs() * within(root)).iter().sum()
            }
            Roots::Complex { growth, omega, .. } => (omega + growth.hi.abs()) * within(growth.hi),
        }
    }

    /// How many radians it oscillates in a time in s.
    pub fn oscillates(&self, time: f64) -> f64 {
        match &self.roots {
            Roots::Complex { growth, omega, .. } => omega * time.min(RANGE / growth.hi.abs()),
            _ => 0.0,
        }
    }

    /// How far in time, in s, the phase of an oscillation is accurate.
    pub fn horizon(&self) -> f64 {
        match &self.roots {
            Roots::Complex { growth, phase, .. } => {
                let horizon = MOST_TURNS / phase.rate.hi;
                // A decay ends before.
                if growth.hi.abs() * horizon > RANGE { f64::INFINITY } else { horizon }
            }
            _ => f64::INFINITY,
        }
    }

    /// The centre of mass after a time in s, which may be negative.
    pub fn after(&self, start: &Center, time: DoubleDouble) -> Center {
        let t = time.hi;
        if self.is_uniform() {
            let Center { position, velocity } = *start;
            // t² may overflow where no force needs it.
            let fallen = |a: f64| if a == 0.0 { 0.0 } else { 0.5 * a * t * t };
            return Center {
                position: position + velocity * t + Vector(self.acceleration.0.map(fallen)),
                velocity: velocity + self.acceleration * t,
            };
        }
        let Response { impulse, rate, step, kept } = self.response(time);
        let mut end = Center::default();
        for k in 0..3 {
            let (x, v) = (start.position.0[k], start.velocity.0[k]);
            let (a, anchor) = (self.acceleration.0[k], self.anchor.0[k]);
            let f = a - times(x - anchor, self.spring);
            end.position.0[k] = if kept < 0.5 {
                anchor + (times(x - anchor, kept) + times(v, impulse) + times(a, step))
            } else {
                x + (times(v, impulse) + times(f, step))
            };
            end.velocity.0[k] = times(v, rate) + times(f, impulse);
        }
        end
    }

    /// Backwards the motion is that with the opposite drag, and the opposite velocity.
    fn response(&self, time: DoubleDouble) -> Response {
        if time.hi >= 0.0 {
            return self.forwards(time);
        }
        let roots = match self.roots {
            Roots::Real { upper, lower, apart } => Roots::Real { upper: -lower, lower: -upper, apart },
            Roots::Complex { growth, omega, phase } => Roots::Complex { growth: -growth, omega, phase },
            Roots::Zero => Roots::Zero,
        };
        let found = CenterLaw { drag: -self.drag, roots, ..*self }.forwards(-time);
        Response { impulse: -found.impulse, ..found }
    }

    fn forwards(&self, time: DoubleDouble) -> Response {
        let t = time.hi;
        let CenterLaw { drag, spring, .. } = *self;
        if self.rate() * t <= LONGEST_SERIES {
            return self.series(t);
        }
        match &self.roots {
            &Roots::Real { upper, lower, apart } => {
                let (alpha, beta) = (Exponential::new(upper, time), Exponential::new(lower, time));
                let parted = if apart > 0.0 { -f64::exp_m1(-apart * t) / apart } else { t };
                let impulse = alpha.value() * parted;
                let step = if alpha.exponent <= -FAR || beta.exponent >= FAR {
                    (lower.hi * impulse - beta.less_one()) / spring
                } else {
                    (alpha.mean() - beta.mean()) * (t / apart)
                };
                let (rate, kept) = (beta.value() + upper.hi * impulse, beta.value() - lower.hi * impulse);
                Response { impulse, rate, step, kept }
            }
            Roots::Complex { growth, omega, phase } => {
                let (turns, rest) = phase.turns_at_pair::<false>((t, time.lo));
                let (sin, cos) = sin_cos_turns::<false>(turns, rest);
                let size = Exponential::new(*growth, time).value();
                let impulse = size * sin / omega;
                let (even, half) = (size * cos, 0.5 * drag * impulse);
                let step = (1.0 - even - half) / spring;
                Response { impulse, rate: even - half, step, kept: even + half }
            }
            Roots::Zero => self.series(t),
        }
    }

    fn series(&self, t: f64) -> Response {
        let (sum, product) = (-self.drag * t, self.spring * t * t);
        let (mut before, mut h) = (0.0, 1.0);
        let (mut first, mut second) = (0.0, 0.0);
        let mut factorial = 1.0;
        for n in 0..TERMS {
            factorial *= (n + 1) as f64;
            first += h / factorial;
            second += h / (factorial * (n + 2) as f64);
            (before, h) = (h, sum * h - product * before);
        }
        let kept = 1.0 - product * second;
        Response { impulse: t * first, rate: kept + sum * first, step: t * t * second, kept }
    }
}

/// A quotient in double-double precision; where its rest is not a number, the rounded one.
fn divided(k: f64, mass: f64) -> DoubleDouble {
    let quotient = DoubleDouble::from(k) / mass.into();
    if quotient.lo.is_finite() { quotient } else { (k / mass).into() }
}

/// The roots of `λ² + γλ + κ`, in units of a power of two in which their squares neither overflow nor vanish.
fn roots(gamma: DoubleDouble, kappa: DoubleDouble) -> Roots {
    let size = gamma.hi.abs().max(kappa.hi.abs().sqrt());
    if size == 0.0 {
        return Roots::Zero;
    }
    let unit = f64::from_bits(size.to_bits() & f64::INFINITY.to_bits()).max(f64::MIN_POSITIVE);
    let scaled = |x: DoubleDouble, by: f64| DoubleDouble { hi: x.hi * by, lo: x.lo * by };
    let half = scaled(gamma, 0.5 / unit);
    let kappa = scaled(kappa, 1.0 / unit);
    let square = half * half - scaled(kappa, 1.0 / unit);
    if square.hi < 0.0 {
        let omega = scaled((-square).sqrt(), unit);
        let phase = Phase { rate: omega * DoubleDouble::OVER_TWO_PI, start: [0.0; 2] };
        return Roots::Complex { growth: -scaled(half, unit), omega: omega.hi, phase };
    }
    let root = square.sqrt();
    // The root without cancellation, and the other one by the product of both.
    let far = if half.hi >= 0.0 { -(half + root) } else { root - half };
    let near = if far.hi == 0.0 { far } else { kappa / far };
    let far = scaled(far, unit);
    let [upper, lower] = if half.hi >= 0.0 { [near, far] } else { [far, near] };
    Roots::Real { upper, lower, apart: 2.0 * root.hi * unit }
}

/// `e^z`, the exponent z in two parts: its rounding would be an error of `ε|z|`.
struct Exponential {
    exponent: f64,
    rest: f64,
}

impl Exponential {
    fn new(root: DoubleDouble, time: DoubleDouble) -> Exponential {
        let product = root * time;
        if product.lo.is_finite() {
            Exponential { exponent: product.hi, rest: product.lo }
        } else {
            Exponential { exponent: root.hi * time.hi, rest: 0.0 }
        }
    }

    fn value(&self) -> f64 {
        let value = self.exponent.exp();
        value + times(self.rest, value)
    }

    /// `e^z − 1`.
    fn less_one(&self) -> f64 {
        self.exponent.exp_m1() + times(self.rest, self.exponent.exp())
    }

    /// `(e^z − 1)/z`.
    fn mean(&self) -> f64 {
        if self.exponent == 0.0 { 1.0 } else { self.less_one() / self.exponent }
    }
}

/// A product that is zero where the first factor is, even if the second is infinite.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a * b }
}

#[cfg(test)]
mod tests;
