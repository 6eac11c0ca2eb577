//! A sphere with the torque `N = L x b`, b fixed in space: a magnetic moment along the spin in a uniform field.
//!
//! With `L = iω` the angular velocity in space turns about −b, `ω' = ω x b`: `Ω_S(t) = A Ω_S(0) ~A` with
//! `A = exp(½ I b t)`. In axes that turn with A the sphere is free and its angular velocity is `ω + b`, hence
//!
//! ```text
//! R(t) = exp(½ I b t) exp(−½ I (ω(0) + b) t) R(0),
//! ```
//!
//! ω(0) in space; `R' = ½ I b R − ½ A I(ω(0) + b) ~A R = −½ Ω_S R`. The second factor is `R(0) exp(−½ I β t) ~R(0)`, β
//! that sum in body axes, where the angular velocity turns about −β. Rates and phases have double-double precision: the
//! error does not grow with time. Moments with a relative difference d by rounding count as equal, which neglects an
//! angle of about `d |ω| t` ([`LarmorSphere::neglected`]).

pub(super) mod flow;

use super::flow::{Flow, Form};
use super::free::{MOST_TURNS, power_of_two};
use super::lanes::Phases;
use crate::body::inertia::{Inertia, apart, is_sphere};
use crate::error::SimulateError;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::Phase;
use crate::numerics::quaternion::{quaternion, turned_back};
use crate::numerics::wide::Wide;
use crate::state::checks::check_moments;
use flow::{Flow as LarmorFlow, Turn};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};

/// The motion of a sphere in a field: rotor and angular velocity at any time up to its
/// [`LarmorSphere::horizon`].
#[derive(Clone, Copy, Debug)]
pub struct LarmorSphere {
    pub(super) flow: Flow,
    horizon: f64,
    /// |ω| times the relative difference of the moments.
    neglected: f64,
}

impl LarmorSphere {
    /// The motion that starts at `rotor` (body axes to space) with angular velocity `omega` in body axes, in
    /// the field `b` in rad/s, in space. An error unless all principal moments are equal to rounding.
    pub fn new(
        inertia: &Inertia,
        rotor: Rotor,
        omega: Bivector,
        b: Vector,
    ) -> Result<LarmorSphere, SimulateError> {
        let moments = inertia.principal_moments();
        check_moments(moments)?;
        if !is_sphere(moments) {
            return Err(SimulateError::NotSpherical { moments });
        }
        for (what, values) in [("the angular velocity", omega.0), ("the field b", b.0)] {
            // Squares must be finite.
            if let Some(&value) = values.iter().find(|x| !(x.abs() * x.abs()).is_finite()) {
                return Err(SimulateError::BadValue { what, value });
            }
        }
        // The sum of both in body axes: its turn is about the same axis there and in space.
        let (field, rates) = (b.0.map(Wide::from), omega.0.map(Wide::from));
        let seen = turned_back(quaternion(rotor), field);
        let field = Uniform::new(field.map(|x| -x));
        let spin = Uniform::new(std::array::from_fn(|k| seen[k] + rates[k]));
        let [least, most] = [f64::min, f64::max].map(|of| moments.into_iter().reduce(of).unwrap_or(0.0));
        Ok(LarmorSphere {
            flow: Flow(Form::Larmor(LarmorFlow {
                turns: [field.turn, spin.turn],
                rotor: rotors(rotor, &field, &spin),
                omega: rates_about(spin.axis, omega.0),
            })),
            horizon: MOST_TURNS / field.rate().max(spin.rate()),
            neglected: apart(least, most) * omega.norm(),
        })
    }

    /// How far in time, in s, the phases are accurate: 1e17 turns.
    pub fn horizon(&self) -> f64 {
        self.horizon
    }

    /// Estimated angle in rad at time `t` between the body's motion and this one, which takes its moments as equal.
    pub fn neglected(&self, t: f64) -> f64 {
        self.neglected * t.abs()
    }

    /// Rotor and body angular velocity at time `t` in s, the same bits as [`LarmorSphere::at_many`].
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        self.flow.at(t)
    }

    /// The same at many times: rows of four rotor components and of three components of the angular velocity.
    ///
    /// # Panics
    /// If the numbers of rows and times differ.
    pub fn at_many(&self, threads: Threads, times: &[f64], rotors: &mut [f64], omegas: &mut [f64]) {
        self.flow.at_many(threads, times, rotors, omegas);
    }
}

/// The components of `R(t)` for the four products of cosines and sines: with the planes P of the turns,
/// `(cos − sin P_field) R(0) (cos − sin P_spin)`, P_spin in body axes.
fn rotors(start: Rotor, field: &Uniform, spin: &Uniform) -> [[[f64; 1]; 4]; 4] {
    let (before, after) = (field.half_turn(), spin.half_turn());
    let columns = [start, start * after, before * start, before * start * after].map(|r| r.components());
    std::array::from_fn(|i| columns.map(|column| [column[i]]))
}

/// The components of `~A ω A` with `A = exp(−½ I u θ)`, u a unit vector or 0, for cos θ, sin θ and 1.
fn rates_about(u: [f64; 3], omega: [f64; 3]) -> [[[f64; 1]; 3]; 3] {
    let along = (u[0] * omega[0] + u[1] * omega[1]) + u[2] * omega[2];
    let across = Vector(omega).cross(Vector(u)).0;
    std::array::from_fn(|k| [[omega[k] - along * u[k]], [across[k]], [along * u[k]]])
}

/// The uniform turn `exp(−½ I ω t)`.
struct Uniform {
    /// The direction of ω; 0 for no turn.
    axis: [f64; 3],
    turn: Turn,
}

impl Uniform {
    fn new(omega: [Wide; 3]) -> Uniform {
        let [x, y, z] = omega;
        let size = (x * x + y * y + z * z).sqrt();
        let part = |x: Wide| if size.is_zero() { 0.0 } else { (x / size).value() };
        let scale = power_of_two([size.value(), 0.0, 0.0]);
        let rate = (size / scale.into()).narrow() * DoubleDouble::OVER_TWO_PI * 0.5.into();
        let phase = Phases::from(Phase { rate, start: [0.0; 2] });
        Uniform { axis: omega.map(part), turn: Turn { scale: [scale], phase } }
    }

    /// In turns of the phase per s.
    fn rate(&self) -> f64 {
        self.turn.phase.of(0).rate.hi * self.turn.scale[0]
    }

    /// The rotor of half a turn, −P.
    fn half_turn(&self) -> Rotor {
        let [x, y, z] = self.axis.map(|x| -x);
        Rotor::from_unit_components([0.0, x, y, z])
    }
}
