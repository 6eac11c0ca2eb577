//! What acts on a body: its torque, and the vectors that its laws depend on.

use crate::error::TorqueError;
use crate::facts;
use crate::facts::Facts;
use crate::laws::torque::{Torque, external, wheel};
use crate::run::Setup;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::{Point, Seen};
use polhode_ga::{Bivector, Vector};

/// A vector on which a law depends, for display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// What it is: `planet`, `field`, `dipole`, `sun` or `wheel`.
    pub kind: &'static str,
    /// Whether its components are in space; else they are in body axes.
    pub in_space: bool,
    /// The vector; of a wheel, the axial vector of its momentum. Directions have length 1.
    pub along: Vector,
    /// The SI unit of its length; empty for directions.
    pub unit: &'static str,
}

impl Source {
    /// As facts.
    pub fn facts(&self) -> Facts {
        facts! { kind: self.kind, in_space: self.in_space, along: self.along.0, unit: self.unit }
    }
}

impl Setup {
    /// The torque on the body at a state in body axes: the rate of change of L, in space, N m. That of wheels inside the
    /// body, whose momentum is in L, is not part of it.
    pub fn torque_in_space(&self, state: &Seen) -> Result<Bivector, TorqueError> {
        let Seen { time, rotor, omega, position, velocity } = *state;
        let frame = self.inertia.principal_frame();
        let torques: Vec<Torque> = self.torques.iter().map(|torque| torque.clone().in_axes(frame)).collect();
        let body = Gyrostat { moments: self.inertia.principal_moments(), wheel: wheel(&torques) };
        let omega = frame.reverse().apply_bivector(omega);
        let phase = Phase { rotor: rotor * frame, momentum: body.momentum(omega), time };
        let at =
            Point { body: &body, mass: self.mass, phase: &phase, center: &Center { position, velocity } };
        Ok(phase.rotor.apply_bivector(external(&torques, &at)?))
    }

    /// The vectors that the laws depend on, at a time: the direction to the planet and to the sun, fields, dipoles, wheels.
    pub fn sources(&self, time: f64) -> Vec<Source> {
        let of = |kind, in_space, along, unit| Source { kind, in_space, along, unit };
        let each = self.torques.iter().map(|torque| match torque {
            Torque::GravityGradient(orbit) => vec![of("planet", true, -orbit.place(time).0, "")],
            Torque::Magnetic { dipole, field } => {
                vec![of("field", true, *field, "T"), of("dipole", false, *dipole, "A m²")]
            }
            Torque::Larmor(b) => vec![of("field", true, *b, "rad/s")],
            Torque::Wheel(h) => vec![of("wheel", false, h.dual(), "kg m²/s")],
            // The axis of space about which sunlight exerts no torque is the direction to the sun.
            Torque::Registered(law) if law.name == "radiation_pressure" => {
                law.axis.map(|sun| of("sun", true, sun / sun.norm(), "")).into_iter().collect()
            }
            _ => Vec::new(),
        });
        each.flatten().filter(|source| source.along.norm() > 0.0).collect()
    }
}

#[cfg(test)]
mod tests;
