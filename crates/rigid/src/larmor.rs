//! A sphere with the torque `N = L x b`, b fixed in space: a magnetic moment along the spin in a uniform field.
//!
//! With `L = iω` the angular velocity in space turns about −b, `ω' = ω x b`: `Ω_S(t) = A Ω_S(0) ~A` with
//! `A = exp(½ I b t)`. In axes that turn with A the sphere is free and its angular velocity is `ω + b`, hence
//!
//! ```text
//! R(t) = exp(½ I b t) exp(−½ I (ω(0) + b) t) R(0),
//! ```
//!
//! ω(0) in space; `R' = ½ I b R − ½ A I(ω(0) + b) ~A R = −½ Ω_S R`. Both rates are known in twice the precision.

use crate::double_double::DoubleDouble;
use crate::free::MOST_TURNS;
use crate::free::lanes::{Phase, sin_cos_turns};
use crate::inertia::Inertia;
use crate::simulate::check_moments;
use crate::simulate_error::SimulateError;
use crate::symmetric_top::equal;
use polhode_ga::{Bivector, Rotor, Vector};

/// The motion of a sphere in a field: rotor and angular velocity at any time up to its
/// [`LarmorSphere::horizon`].
#[derive(Clone, Copy, Debug)]
pub struct LarmorSphere {
    rotor: Rotor,
    omega: Bivector,
    field: Turn,
    spin: Turn,
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
        if !(equal(moments[0], moments[1]) && equal(moments[1], moments[2]) && equal(moments[2], moments[0]))
        {
            return Err(SimulateError::NotSpherical { moments });
        }
        for (what, values) in [("the angular velocity", omega.0), ("the field b", b.0)] {
            // Squares must be numbers.
            if let Some(&value) = values.iter().find(|x| !(x.abs() * x.abs()).is_finite()) {
                return Err(SimulateError::BadValue { what, value });
            }
        }
        let field = b.0.map(DoubleDouble::from);
        let space = in_space(rotor, omega);
        let sum = std::array::from_fn(|k| space[k] + field[k]);
        Ok(LarmorSphere { rotor, omega, field: Turn::new(field.map(|x| -x)), spin: Turn::new(sum) })
    }

    /// How far in time, in s, the phases are known: to 1e17 turns.
    pub fn horizon(&self) -> f64 {
        MOST_TURNS / self.field.phase.rate.hi.max(self.spin.phase.rate.hi)
    }

    /// Rotor and body angular velocity at time `t` in s.
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        let spin = self.spin.at(t);
        let rotor = self.field.at(t) * spin * self.rotor;
        // Ω_B = ~R A Ω_S(0) ~A R, where A is all of R but this.
        let back = self.rotor.reverse() * spin.reverse() * self.rotor;
        (rotor.renormalized(), back.apply_bivector(self.omega))
    }
}

/// The uniform turn `exp(−½ I ω t)`.
#[derive(Clone, Copy, Debug)]
struct Turn {
    plane: Bivector,
    /// Half the angle.
    phase: Phase,
}

impl Turn {
    fn new(omega: [DoubleDouble; 3]) -> Turn {
        let [x, y, z] = omega;
        let size = (x * x + y * y + z * z).sqrt();
        let part = |x: DoubleDouble| if size.hi > 0.0 { (x / size).value() } else { 0.0 };
        let rate = size * DoubleDouble::OVER_TWO_PI * 0.5.into();
        Turn { plane: Bivector(omega.map(part)), phase: Phase { rate, start: [0.0; 2] } }
    }

    fn at(&self, t: f64) -> Rotor {
        let (turns, rest) = self.phase.turns::<false>(t);
        let (sin, cos) = sin_cos_turns::<false>(turns, rest);
        let [x, y, z] = (self.plane * -sin).0;
        Rotor::from_unit_components([cos, x, y, z])
    }
}

/// `R Ω ~R` in twice the precision.
fn in_space(rotor: Rotor, omega: Bivector) -> [DoubleDouble; 3] {
    use crate::quaternion::{quaternion, turned_back};
    turned_back(quaternion(rotor.reverse()), omega.0.map(DoubleDouble::from))
}
