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
//! (Munthe-Kaas 1999). Whatever the step, |R| = 1, a steady rotation is exact, and what is linear in L is conserved as
//! by the law: L itself without a torque, L about e3 under gravity. A fast top spins in R but its Ω_S and L change
//! slowly, which lets the steps be long.
//!
//! The centre of mass is stepped along where forces move it: `x' = v`, `v' = F/m`.

mod tableau;

use crate::force::{Center, Translation};
use crate::phase::{Gyrostat, Phase};
use crate::simulate_error::SimulateError;
use crate::torque::{Torque, TorqueError, exerted};
use polhode_ga::{Bivector, Rotor, Vector};
pub use tableau::{DOP853, RK4, Tableau};

type Axial = [f64; 3];

/// Beyond this angle in rad of one step the exponential's differential comes near its pole at 2π.
const LARGEST_TURN: f64 = 3.0;

/// A point of the motion as the steps carry it.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// The point.
    pub phase: Phase,
    /// L in space, kg m²/s.
    pub momentum_space: Bivector,
    /// The centre of mass, where forces move it.
    pub center: Center,
}

impl Carried {
    /// From a point of the motion.
    pub fn new(phase: Phase, center: Center) -> Carried {
        Carried { phase, momentum_space: phase.rotor.apply_bivector(phase.momentum), center }
    }
}

/// σ, the change of L, and those of place and velocity.
#[derive(Clone, Copy, Debug, Default)]
struct Change {
    turn: Axial,
    momentum: Axial,
    position: Axial,
    velocity: Axial,
}

/// A body, what turns it, and how it is stepped.
#[derive(Clone, Debug)]
pub struct RungeKutta {
    body: Gyrostat,
    torques: Vec<Torque>,
    damping: f64,
    translation: Option<Translation>,
    tableau: &'static Tableau,
}

impl RungeKutta {
    /// Moments must be positive; torques and forces in principal axes. Without a translation the centre of mass stays.
    pub fn new(
        body: Gyrostat,
        torques: Vec<Torque>,
        translation: Option<Translation>,
        tableau: &'static Tableau,
    ) -> RungeKutta {
        let damping = torques.iter().map(Torque::damping_rate).sum();
        RungeKutta { body, torques, damping, translation, tableau }
    }

    /// The method.
    pub fn tableau(&self) -> &'static Tableau {
        self.tableau
    }

    /// One step of length `h`, which may be negative, and an estimate of its error: half the angle of a turn, or the
    /// angular velocity relative to `fastest` (rad/s), whichever is larger; NaN where the step is too long to tell.
    pub fn step(&self, from: &Carried, h: f64, fastest: f64) -> Result<(Carried, f64), SimulateError> {
        let tableau = self.tableau;
        let mut slopes = [Change::default(); 12];
        for (stage, (row, node)) in tableau.rows.iter().zip(tableau.nodes).enumerate() {
            let change = self.combined(row, &slopes, h);
            if norm(&change.turn) > LARGEST_TURN {
                return Ok((*from, f64::NAN));
            }
            slopes[stage] = self.slope(from, &change, node * h)?;
        }
        let change = self.combined(tableau.weights, &slopes, h);
        let rotor = (exponential(&change.turn).0 * from.phase.rotor).renormalized();
        let momentum_space = from.momentum_space + Bivector(change.momentum);
        let momentum = rotor.reverse().apply_bivector(momentum_space);
        let phase = Phase { rotor, momentum, time: from.phase.time + h };
        let error = if tableau.fifth.is_empty() {
            0.0
        } else {
            let size = |row| self.size(from, &self.combined(row, &slopes, h), h, fastest);
            let (fifth, third) = (size(tableau.fifth), size(tableau.third));
            // As Hairer's code weighs the two: of order 8 where both are small.
            if fifth == 0.0 { 0.0 } else { fifth * fifth / (fifth * fifth + 0.01 * third * third).sqrt() }
        };
        Ok((Carried { phase, momentum_space, center: self.moved(&from.center, &change, h) }, error))
    }

    /// σ' and L' at `from` changed by σ and ΔL.
    fn slope(&self, from: &Carried, change: &Change, dt: f64) -> Result<Change, SimulateError> {
        let (turn, cotangent) = exponential(&change.turn);
        let rotor = turn * from.phase.rotor;
        let momentum = from.momentum_space + Bivector(change.momentum);
        let axes = rotor.to_matrix();
        let into_space =
            |b: &Axial| [0, 1, 2].map(|i| axes[i][0] * b[0] + axes[i][1] * b[1] + axes[i][2] * b[2]);
        let into_body =
            |b: &Axial| [0, 1, 2].map(|i| axes[0][i] * b[0] + axes[1][i] * b[1] + axes[2][i] * b[2]);
        let state = Phase { rotor, momentum: Bivector(into_body(&momentum.0)), time: from.phase.time + dt };
        let omega = self.body.omega(state.momentum);
        let mut torque = exerted(&self.torques, &self.body, &state)?;
        if self.damping != 0.0 {
            torque += self.body.carried(omega) * -self.damping;
        }
        let omega = into_space(&omega.0);
        let first = cross(&change.turn, &omega);
        let second = cross(&change.turn, &first);
        let turn = [0, 1, 2].map(|k| omega[k] - 0.5 * first[k] + cotangent * second[k]);
        let momentum = if self.torques.is_empty() { [0.0; 3] } else { into_space(&torque.0) };
        let Some(translation) = &self.translation else {
            return Ok(Change { turn, momentum, ..Change::default() });
        };
        let center = self.moved(&from.center, change, dt);
        let failed = |error: TorqueError| SimulateError::Torque { time: state.time, message: error.0 };
        let acceleration = translation.acceleration(&self.body, &state, &center).map_err(failed)?;
        // The place beside that of the uniform motion from the start of the step.
        Ok(Change { turn, momentum, position: change.velocity, velocity: acceleration.0 })
    }

    /// The centre of mass a time dt after `from`.
    fn moved(&self, from: &Center, change: &Change, dt: f64) -> Center {
        if self.translation.is_none() {
            return *from;
        }
        let position = from.position + (from.velocity * dt + Vector(change.position));
        Center { position, velocity: from.velocity + Vector(change.velocity) }
    }

    /// How large a change is: in attitude, in angular velocity relative to `fastest`, in velocity relative to the
    /// velocity, in place relative to the distance or the way of the step.
    fn size(&self, at: &Carried, change: &Change, h: f64, fastest: f64) -> f64 {
        let momentum = at.phase.rotor.reverse().apply_bivector(Bivector(change.momentum)).0;
        let omega = [0, 1, 2].map(|k| momentum[k] / self.body.moments[k]);
        let relative = if fastest > 0.0 { norm(&omega) / fastest } else { 0.0 };
        let turn = 0.5 * norm(&change.turn);
        let (speed, distance) = (at.center.velocity.norm(), at.center.position.norm());
        let way = distance.max(speed * h.abs());
        let of = |change: &Axial, whole: f64| if whole > 0.0 { norm(change) / whole } else { 0.0 };
        let moved = of(&change.position, way).max(of(&change.velocity, speed.max(way / h.abs())));
        // f64::max would lose a NaN.
        [relative, moved].into_iter().fold(turn, |a, b| if a >= b { a } else { b })
    }

    /// `h Σ a_j k_j`.
    fn combined(&self, row: &[(usize, f64)], slopes: &[Change; 12], h: f64) -> Change {
        let sum = |part: fn(&Change) -> &Axial| {
            let mut sum = [0.0; 3];
            for &(stage, a) in row {
                let slope = part(&slopes[stage]);
                (0..3).for_each(|k| sum[k] += a * slope[k]);
            }
            sum.map(|x| h * x)
        };
        let rotation = Change { turn: sum(|c| &c.turn), momentum: sum(|c| &c.momentum), ..Change::default() };
        match self.translation {
            None => rotation,
            Some(_) => Change { position: sum(|c| &c.position), velocity: sum(|c| &c.velocity), ..rotation },
        }
    }
}

/// `exp(−½σ)` and `c(θ)`.
fn exponential(turn: &Axial) -> (Rotor, f64) {
    let square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    // sin ½θ/θ, cos ½θ, c(θ).
    let (sinc, cos, cotangent) = if square < 1e-3 {
        // The next terms are below rounding.
        let sinc = 0.5 - square * (1.0 / 48.0 - square * (1.0 / 3840.0 - square / 645_120.0));
        let cos = 1.0
            - square
                * (1.0 / 8.0 - square * (1.0 / 384.0 - square * (1.0 / 46_080.0 - square / 10_321_920.0)));
        (sinc, cos, 1.0 / 12.0 + square * (1.0 / 720.0 + square * (1.0 / 30_240.0 + square / 1_209_600.0)))
    } else {
        let angle = square.sqrt();
        let (sin, cos) = (0.5 * angle).sin_cos();
        (sin / angle, cos, (1.0 - 0.5 * angle * cos / sin) / square)
    };
    let [x, y, z] = turn.map(|b| -sinc * b);
    (Rotor::from_unit_components([cos, x, y, z]), cotangent)
}

fn cross(a: &Axial, b: &Axial) -> Axial {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn norm(a: &Axial) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}
