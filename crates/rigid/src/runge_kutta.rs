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
use crate::turn::cosine_and_sinc;
use polhode_ga::lanes::Lanes;
use polhode_ga::{Bivector, Rotor, Vector};
pub use tableau::{DOP853, Tableau};

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

/// σ and the change of L, of six numbers; of twelve with those of place and velocity.
type Change<const N: usize> = [f64; N];

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
        match self.translation {
            None => self.step_of::<6>(from, h, fastest),
            Some(_) => self.step_of::<12>(from, h, fastest),
        }
    }

    fn step_of<const N: usize>(
        &self,
        from: &Carried,
        h: f64,
        fastest: f64,
    ) -> Result<(Carried, f64), SimulateError> {
        let tableau = self.tableau;
        let mut slopes = [[0.0; N]; 12];
        for (stage, (row, node)) in tableau.rows.iter().zip(tableau.nodes).enumerate() {
            let change = combined(row, &slopes, h);
            if norm(&part(&change, 0)) > LARGEST_TURN {
                return Ok((*from, f64::NAN));
            }
            slopes[stage] = self.slope(from, &change, node * h)?;
        }
        let change = combined(tableau.weights, &slopes, h);
        let rotor = (exponential(&part(&change, 0)).0 * from.phase.rotor).renormalized();
        let momentum_space = from.momentum_space + Bivector(part(&change, 3));
        let momentum = rotor.reverse().apply_bivector(momentum_space);
        let phase = Phase { rotor, momentum, time: from.phase.time + h };
        let size = |row| self.size(from, &combined(row, &slopes, h), h, fastest);
        let (fifth, third) = (size(tableau.fifth), size(tableau.third));
        // As Hairer's code weighs the two: of order 8 where both are small.
        let error =
            if fifth == 0.0 { 0.0 } else { fifth * fifth / (fifth * fifth + 0.01 * third * third).sqrt() };
        Ok((Carried { phase, momentum_space, center: moved(&from.center, &change, h) }, error))
    }

    /// σ' and L' at `from` changed by σ and ΔL.
    #[inline]
    fn slope<const N: usize>(
        &self,
        from: &Carried,
        change: &Change<N>,
        dt: f64,
    ) -> Result<Change<N>, SimulateError> {
        let turned = part(change, 0);
        let (turn, cotangent) = exponential(&turned);
        let rotor = turn * from.phase.rotor;
        let momentum = from.momentum_space + Bivector(part(change, 3));
        let momentum = rotor.reverse().apply_bivector(momentum);
        let state = Phase { rotor, momentum, time: from.phase.time + dt };
        let omega = self.body.omega(state.momentum);
        let mut torque = exerted(&self.torques, &self.body, &state)?;
        if self.damping != 0.0 {
            torque += self.body.carried(omega) * -self.damping;
        }
        let omega = rotor.apply_bivector(omega).0;
        let first = cross(&turned, &omega);
        let second = cross(&turned, &first);
        let mut slope = [0.0; N];
        for k in 0..3 {
            slope[k] = omega[k] - 0.5 * first[k] + cotangent * second[k];
        }
        if !self.torques.is_empty() {
            slope[3..6].copy_from_slice(&rotor.apply_bivector(torque).0);
        }
        if let Some(translation) = &self.translation {
            let center = moved(&from.center, change, dt);
            let failed = |error: TorqueError| SimulateError::Torque { time: state.time, message: error.0 };
            let acceleration = translation.acceleration(&self.body, &state, &center).map_err(failed)?;
            // The place beside that of the uniform motion from the start of the step.
            slope[6..9].copy_from_slice(&part(change, 9));
            slope[9..12].copy_from_slice(&acceleration.0);
        }
        Ok(slope)
    }

    /// How large a change is: in attitude, in angular velocity relative to `fastest`, in velocity relative to the
    /// velocity, in place relative to the distance or the way of the step.
    fn size<const N: usize>(&self, at: &Carried, change: &Change<N>, h: f64, fastest: f64) -> f64 {
        let momentum = at.phase.rotor.reverse().apply_bivector(Bivector(part(change, 3))).0;
        let omega = [0, 1, 2].map(|k| momentum[k] / self.body.moments[k]);
        let fastest = fastest.max(self.body.least_rate());
        let relative = if fastest > 0.0 { norm(&omega) / fastest } else { 0.0 };
        let turn = 0.5 * norm(&part(change, 0));
        // f64::max would lose a NaN.
        let larger = |a: f64, b: f64| if a >= b { a } else { b };
        let rotation = larger(turn, relative);
        if self.translation.is_none() {
            return rotation;
        }
        let (speed, distance) = (at.center.velocity.norm(), at.center.position.norm());
        let way = distance.max(speed * h.abs());
        let of = |change: &Axial, whole: f64| if whole > 0.0 { norm(change) / whole } else { 0.0 };
        let place = of(&part(change, 6), way);
        larger(rotation, larger(place, of(&part(change, 9), speed.max(way / h.abs()))))
    }
}

/// Three of the numbers.
#[inline]
fn part<const N: usize>(change: &Change<N>, from: usize) -> Axial {
    [change[from], change[from + 1], change[from + 2]]
}

/// The centre of mass a time dt after `from`.
fn moved<const N: usize>(from: &Center, change: &Change<N>, dt: f64) -> Center {
    if N < 12 {
        return *from;
    }
    let position = from.position + (from.velocity * dt + Vector(part(change, 6)));
    Center { position, velocity: from.velocity + Vector(part(change, 9)) }
}

/// `h Σ a_j k_j`.
#[inline]
fn combined<const N: usize>(row: &[(usize, f64)], slopes: &[Change<N>; 12], h: f64) -> Change<N> {
    let mut sum = [0.0; N];
    for &(stage, a) in row {
        let slope = &slopes[stage];
        for k in 0..N {
            sum[k] += a * slope[k];
        }
    }
    sum.map(|x| h * x)
}

/// `exp(−½σ)` and `c(θ)`.
#[inline]
fn exponential(turn: &Axial) -> (Rotor, f64) {
    let square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    // Of x = ½θ.
    let z = 0.25 * square;
    let (Lanes([cos]), Lanes([sinc])) = cosine_and_sinc(Lanes::<1, false>([z]));
    let cotangent = if z < 0.0625 {
        // (1 − x cot x)/4x²; the next term is below rounding beside the 1 that it is added to.
        1.0 / 12.0
            + z * (1.0 / 180.0
                + z * (1.0 / 1890.0
                    + z * (1.0 / 18_900.0 + z * (1.0 / 187_110.0 + z * (691.0 / 1_277_025_750.0)))))
    } else {
        (1.0 - cos / sinc) / square
    };
    let [x, y, z] = turn.map(|b| -0.5 * sinc * b);
    (Rotor::from_unit_components([cos, x, y, z]), cotangent)
}

fn cross(a: &Axial, b: &Axial) -> Axial {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn norm(a: &Axial) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}
