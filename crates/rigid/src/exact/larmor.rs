//! A sphere with the torque `N = L x b`, b fixed in space: a magnetic moment along the spin in a uniform field.
//!
//! With `L = iω` the angular velocity in space turns about −b, `ω' = ω x b`: `Ω_S(t) = A Ω_S(0) ~A` with
//! `A = exp(½ I b t)`. In axes that turn with A the sphere is free and its angular velocity is `ω + b`, hence
//!
//! ```text
//! R(t) = exp(½ I b t) exp(−½ I (ω(0) + b) t) R(0),
//! ```
//!
//! ω(0) in space; `R' = ½ I b R − ½ A I(ω(0) + b) ~A R = −½ Ω_S R`. Rates and phases have double-double precision: the
//! error does not grow with time. Moments with a relative difference d by rounding count as equal, which neglects an
//! angle of about `d |ω| t` ([`LarmorSphere::neglected`]).

use super::free::{MOST_TURNS, power_of_two};
use crate::body::inertia::{Inertia, apart, is_sphere};
use crate::error::SimulateError;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::{Phase, sin_cos_turns};
use crate::numerics::quaternion::{quaternion, turned_back};
use crate::numerics::wide::Wide;
use crate::state::checks::check_moments;
use polhode_ga::{Bivector, Rotor, Vector};

/// The motion of a sphere in a field: rotor and angular velocity at any time up to its
/// [`LarmorSphere::horizon`].
#[derive(Clone, Copy, Debug)]
pub struct LarmorSphere {
    rotor: Rotor,
    omega: Bivector,
    field: Turn,
    spin: Turn,
    /// Relative difference of the moments.
    apart: f64,
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
        let field = b.0.map(Wide::from);
        // R Ω ~R.
        let space = turned_back(quaternion(rotor.reverse()), omega.0.map(Wide::from));
        let sum = std::array::from_fn(|k| space[k] + field[k]);
        let [least, most] = [f64::min, f64::max].map(|of| moments.into_iter().reduce(of).unwrap_or(0.0));
        Ok(LarmorSphere {
            rotor,
            omega,
            field: Turn::new(field.map(|x| -x)),
            spin: Turn::new(sum),
            apart: apart(least, most),
        })
    }

    /// How far in time, in s, the phases are accurate: 1e17 turns.
    pub fn horizon(&self) -> f64 {
        MOST_TURNS / self.field.rate().max(self.spin.rate())
    }

    /// Estimated angle in rad at time `t` between the body's motion and this one, which takes its moments as equal.
    pub fn neglected(&self, t: f64) -> f64 {
        self.apart * self.omega.norm() * t.abs()
    }

    /// Rotor and body angular velocity at time `t` in s.
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        let spin = self.spin.at(t);
        let rotor = self.field.at(t) * spin * self.rotor;
        // Ω_B = ~R A Ω_S(0) ~A R, where A is the first factor of R.
        let back = self.rotor.reverse() * spin.reverse() * self.rotor;
        (rotor.renormalized(), back.apply_bivector(self.omega))
    }
}

/// The uniform turn `exp(−½ I ω t)`.
#[derive(Clone, Copy, Debug)]
struct Turn {
    plane: Bivector,
    /// A power of two near the rate: that of the phase is near 1.
    scale: f64,
    /// Half the angle.
    phase: Phase,
}

impl Turn {
    fn new(omega: [Wide; 3]) -> Turn {
        let [x, y, z] = omega;
        let size = (x * x + y * y + z * z).sqrt();
        let part = |x: Wide| if size.is_zero() { 0.0 } else { (x / size).value() };
        let scale = power_of_two([size.value(), 0.0, 0.0]);
        let rate = (size / scale.into()).narrow() * DoubleDouble::OVER_TWO_PI * 0.5.into();
        Turn { plane: Bivector(omega.map(part)), scale, phase: Phase { rate, start: [0.0; 2] } }
    }

    /// In turns of the phase per s.
    fn rate(&self) -> f64 {
        self.phase.rate.hi * self.scale
    }

    fn at(&self, t: f64) -> Rotor {
        let (turns, rest) = self.phase.turns::<false>(t * self.scale);
        let (sin, cos) = sin_cos_turns::<false>(turns, rest);
        let [x, y, z] = (self.plane * -sin).0;
        Rotor::from_unit_components([cos, x, y, z])
    }
}
