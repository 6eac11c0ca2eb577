//! Explicit Runge–Kutta steps on the group of rotors.
//!
//! Within a step from the rotor `R0` the attitude is `R = exp(−½σ) R0` with a bivector σ of space, and
//! `R' = −½Ω_S R` becomes, with the axial vectors of σ and `ω = Ω_S` (the inverse of the exponential's differential,
//! in closed form for rotations),
//!
//! ```text
//! σ' = ω − ½ σ x ω + c(θ) σ x (σ x ω),   c(θ) = (1 − ½θ cot ½θ)/θ²,   θ = |σ|,
//! L' = N_S,   Ω_S = R I⁻¹(~R L R) ~R.
//! ```
//!
//! σ and the angular momentum L *in space* live in vector spaces, where any Runge–Kutta method has its full order
//! (Munthe-Kaas 1999). For any step |R| = 1, a steady rotation is exact, and linear invariants of L are conserved: L
//! itself without a torque, L about e3 under gravity. Ω_S and L of a fast top change slowly, which allows long steps.
//!
//! Where forces act, the centre of mass is stepped too: `x' = v`, `v' = F/m`. Bodies are stepped in lanes, each by its
//! own step; a single body is one lane.

mod dop853;
mod exponential;
mod points;

use super::classical::{Bodies, renormalize};
use crate::error::SimulateError;
use crate::laws::driven_wheels::driven;
use crate::laws::force::Translation;
use crate::laws::forcing::{BodyForcing, Forcing, Place};
use crate::laws::torque::{Torque, damping_rate};
use crate::state::carried::Carried;
use crate::state::phase::Gyrostat;
pub(crate) use dop853::STAGES;
use dop853::{FIFTH, NODES, ROWS, THIRD, WEIGHTS};
use exponential::exponential;
pub(crate) use points::Points;
use polhode_ga::simd::lanes::{Lanes, One, PerLane, composed, cross, dot, mapped, mapped_back, matrix};

/// Largest angle of one step in rad; the exponential's differential has a pole at 2π.
const LARGEST_TURN: f64 = 3.0;

/// σ and the change of L, six numbers; twelve with the changes of position and velocity.
#[derive(Clone, Copy)]
struct Change<const N: usize, const W: usize, const F: bool>([Lanes<W, F>; N]);

/// One step of lengths `h`, which may be negative, and an estimate of its error: half the angle of a turn, or the
/// angular velocity relative to `fastest` (rad/s), whichever is larger; with N = 12 also the relative errors of velocity
/// and position. NaN if the step is too long for an estimate.
#[inline(always)]
pub(crate) fn step<const N: usize, const W: usize, const F: bool, E: Forcing<W, F>>(
    bodies: &Bodies<W, F>,
    forcing: &mut E,
    from: &Points<W, F>,
    h: Lanes<W, F>,
    fastest: Lanes<W, F>,
) -> (Points<W, F>, Lanes<W, F>) {
    let nothing = Lanes::all(f64::NAN);
    let mut slopes = [Change([Lanes::ZERO; N]); STAGES];
    let mut widest = Lanes::ZERO;
    forcing.begin(h.times_plus(Lanes::all(0.5), from.time));
    for stage in 0..STAGES {
        let change = Change::combined(ROWS[stage], &slopes, h);
        let turned = change.part(0);
        let square = dot(&turned, &turned);
        widest = square.max(widest);
        if !any_within(&square) {
            return (*from, nothing);
        }
        let dt = Lanes::all(NODES[stage]) * h;
        slopes[stage] = change.slope(bodies, forcing, from, square, dt);
    }
    let change = Change::combined(WEIGHTS, &slopes, h);
    let mut to = change.moved(from, h);
    for k in 0..3 {
        // Kahan's sum (1965), since a steady torque would be rounded alike in every step.
        let kick = change.0[3 + k] + from.lost[k];
        to.momentum[k] = from.momentum[k] + kick;
        to.lost[k] = kick - (to.momentum[k] - from.momentum[k]);
    }
    let turned = change.part(0);
    let square = dot(&turned, &turned);
    widest = square.max(widest);
    to.rotor = composed(&exponential(&turned, square).0, &from.rotor);
    renormalize(&mut to.rotor);
    let least = [fastest, forcing.least_speed()];
    let fifth = Change::combined(FIFTH, &slopes, h).size(bodies, [from, &to], h, least);
    let third = Change::combined(THIRD, &slopes, h).size(bodies, [from, &to], h, least);
    // Weighted as in Hairer's code: of order 8 where both are small.
    let square = fifth * fifth;
    let weighed = (third * third).times_plus(Lanes::all(0.01), square).sqrt();
    let mut error = square / weighed;
    for l in 0..W {
        if fifth.0[l] == 0.0 {
            error.0[l] = 0.0;
        }
        if widest.0[l] > LARGEST_TURN * LARGEST_TURN {
            error.0[l] = f64::NAN;
        }
    }
    (to, error)
}

/// Whether any turn, given by its square, is short enough.
#[inline(always)]
fn any_within<const W: usize, const F: bool>(square: &Lanes<W, F>) -> bool {
    let mut any = false;
    for l in 0..W {
        any |= square.0[l] <= LARGEST_TURN * LARGEST_TURN;
    }
    any
}

impl<const N: usize, const W: usize, const F: bool> Change<N, W, F> {
    /// `h Σ a_j k_j`.
    #[inline(always)]
    fn combined(row: &[(usize, f64)], slopes: &[Self; STAGES], h: Lanes<W, F>) -> Self {
        let mut sum = [Lanes::ZERO; N];
        for &(stage, a) in row {
            let (slope, a) = (&slopes[stage].0, Lanes::all(a));
            for k in 0..N {
                sum[k] = slope[k].times_plus(a, sum[k]);
            }
        }
        for k in 0..N {
            sum[k] = h * sum[k];
        }
        Change(sum)
    }

    /// Three components from an index on.
    #[inline(always)]
    fn part(&self, from: usize) -> [Lanes<W, F>; 3] {
        [self.0[from], self.0[from + 1], self.0[from + 2]]
    }

    /// All but the rotor a time dt after `from`.
    #[inline(always)]
    fn moved(&self, from: &Points<W, F>, dt: Lanes<W, F>) -> Points<W, F> {
        let mut to = *from;
        to.time = from.time + dt;
        for k in 0..3 {
            to.momentum[k] = from.momentum[k] + self.0[3 + k];
        }
        if N == 12 {
            for k in 0..3 {
                to.center[k] = from.center[k] + from.center[3 + k].times_plus(dt, self.0[6 + k]);
                to.center[3 + k] = from.center[3 + k] + self.0[9 + k];
            }
        }
        to
    }

    /// σ' and L' at `from` changed by σ, whose square is given, and ΔL.
    #[inline(always)]
    fn slope<E: Forcing<W, F>>(
        &self,
        bodies: &Bodies<W, F>,
        forcing: &mut E,
        from: &Points<W, F>,
        square: Lanes<W, F>,
        dt: Lanes<W, F>,
    ) -> Self {
        let turned = self.part(0);
        let (turn, cotangent) = exponential(&turned, square);
        let rotor = composed(&turn, &from.rotor);
        let at = self.moved(from, dt);
        let axes = matrix(&rotor);
        let momentum = mapped_back(&axes, &at.momentum);
        let wheel = forcing.wheel(&bodies.wheel, &at.time);
        let omega = bodies.omega_with_wheel(&momentum, &wheel);
        let place = Place { rotor, omega, time: PerLane::Each(at.time.0) };
        let omega = mapped(&axes, &omega);
        let first = cross(&turned, &omega);
        let second = cross(&turned, &first);
        let mut slope = [Lanes::ZERO; N];
        for k in 0..3 {
            let straight = first[k].times_plus(Lanes::all(-0.5), omega[k]);
            slope[k] = cotangent.times_plus(second[k], straight);
        }
        if E::ACTS {
            let mut torque = forcing.torque(&place, &at.center);
            for k in 0..3 {
                let carried = momentum[k] - wheel[k];
                torque[k] = bodies.damping.times_from(carried, torque[k]);
            }
            slope[3..6].copy_from_slice(&mapped(&axes, &torque));
        }
        if N == 12 {
            // The position relative to uniform motion from the start of the step.
            slope[6..9].copy_from_slice(&self.part(9));
            slope[9..12].copy_from_slice(&forcing.acceleration(&place, &at.center));
        }
        Change(slope)
    }

    /// The size: of attitude, of angular velocity relative to `fastest`, of velocity relative to the speed, of position
    /// relative to the distance or the path of the step. Speed and distance are the larger of both ends: a body may start
    /// at rest. The speed has a lower bound, too.
    #[inline(always)]
    fn size(
        &self,
        bodies: &Bodies<W, F>,
        [at, to]: [&Points<W, F>; 2],
        h: Lanes<W, F>,
        [fastest, least_speed]: [Lanes<W, F>; 2],
    ) -> Lanes<W, F> {
        let mut omega = mapped_back(&matrix(&at.rotor), &self.part(3));
        for k in 0..3 {
            omega[k] = omega[k] * bodies.inverse[k];
        }
        let rotation = larger(Lanes::all(0.5) * norm(&self.part(0)), relative(norm(&omega), fastest));
        if N < 12 {
            return rotation;
        }
        let sizes = |[x, y, z, u, v, w]: [Lanes<W, F>; 6]| [norm(&[u, v, w]), norm(&[x, y, z])];
        let ([slow, near], [fast, far]) = (sizes(at.center), sizes(to.center));
        let (speed, distance) = (larger(larger(slow, fast), least_speed), larger(near, far));
        let way = distance.max(speed * h.abs());
        let place = relative(norm(&self.part(6)), way);
        let velocity = relative(norm(&self.part(9)), speed.max(way / h.abs()));
        larger(rotation, larger(place, velocity))
    }
}

/// `part/whole`, 0 where `whole` is 0, NaN where it is not finite.
#[inline(always)]
fn relative<const W: usize, const F: bool>(part: Lanes<W, F>, whole: Lanes<W, F>) -> Lanes<W, F> {
    let mut ratio = part / whole;
    for l in 0..W {
        ratio.0[l] = if whole.0[l] == f64::INFINITY { f64::NAN } else { ratio.0[l] };
        ratio.0[l] = if whole.0[l] == 0.0 { 0.0 } else { ratio.0[l] };
    }
    ratio
}

/// The larger of two; NaN if either is NaN.
#[inline(always)]
fn larger<const W: usize, const F: bool>(a: Lanes<W, F>, b: Lanes<W, F>) -> Lanes<W, F> {
    let mut larger = b;
    for l in 0..W {
        // Comparisons with NaN are false.
        larger.0[l] = if a.0[l] <= b.0[l] || b.0[l].is_nan() { b.0[l] } else { a.0[l] };
    }
    larger
}

#[inline(always)]
fn norm<const W: usize, const F: bool>(a: &[Lanes<W, F>; 3]) -> Lanes<W, F> {
    dot(a, a).sqrt()
}

/// A single body and its laws, stepped by the method.
#[derive(Clone, Debug)]
pub struct RungeKutta {
    body: Gyrostat,
    /// All laws but the wheels with motors: their momentum is carried with that of the body.
    torques: Vec<Torque>,
    wheels: Vec<Torque>,
    translation: Option<Translation>,
    /// Lower bound of the scale of speeds.
    least_speed: f64,
    alone: Bodies<1, false>,
}

impl RungeKutta {
    /// Moments must be positive; torques and forces in principal axes. Without a translation the centre of mass stays.
    pub fn new(body: Gyrostat, torques: Vec<Torque>, translation: Option<Translation>) -> RungeKutta {
        let alone = Bodies::new([(body, damping_rate(&torques))]);
        let (wheels, torques) = torques.into_iter().partition(|law| matches!(law, Torque::Wheels(_)));
        RungeKutta { body, torques, wheels, translation, least_speed: 0.0, alone }
    }

    /// The same with a lower bound of the scale of speeds, for estimates of errors.
    pub fn with_least_speed(self, least_speed: f64) -> RungeKutta {
        RungeKutta { least_speed, ..self }
    }

    /// One step of length `h`, which may be negative, and an estimate of its error: half the angle of a turn, or the
    /// angular velocity relative to `fastest` (rad/s), whichever is larger; NaN if the step is too long.
    pub fn step(&self, from: &Carried, h: f64, fastest: f64) -> Result<(Carried, f64), SimulateError> {
        let fastest = Lanes([fastest.max(self.body.least_rate())]);
        let mut at = Points::NONE;
        at.set(0, from);
        let mut acting = BodyForcing::new(&self.body, &self.torques, self.translation.as_ref())
            .with_wheels(&self.wheels)
            .with_least_speed(self.least_speed);
        let (alone, h) = (&self.alone, One::each([h])[0]);
        let (to, error) = match self.translation {
            None => step::<6, 1, false, _>(alone, &mut acting, &at, h, fastest),
            Some(_) => step::<12, 1, false, _>(alone, &mut acting, &at, h, fastest),
        };
        acting.finish()?;
        let mut to = to.get(0);
        if let Some(driven) = driven(&self.wheels, to.phase.time) {
            (to.driven, to.phase.momentum) = (driven, to.phase.momentum - driven);
        }
        Ok((to, error.0[0]))
    }
}
