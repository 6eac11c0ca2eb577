//! Motions that are known at any time without steps.

use crate::force::Center;
use crate::free::FreeMotion;
use crate::phase::{Gyrostat, Phase};
use crate::runge_kutta::Carried;
use crate::torque::Torque;
use polhode_ga::{Bivector, Rotor, Vector};

/// A rotation in closed form, in principal axes.
#[derive(Clone, Debug)]
pub(crate) enum Rotation {
    Free(FreeMotion),
}

/// Rotation and uniformly accelerated translation in closed form.
#[derive(Clone, Debug)]
pub(crate) struct ClosedForm {
    body: Gyrostat,
    rotation: Rotation,
    center: Center,
    acceleration: Vector,
}

impl ClosedForm {
    /// The closed form of this motion, if it has one; everything in principal axes.
    pub fn of(
        body: Gyrostat,
        rotor: Rotor,
        omega: Bivector,
        torques: &[Torque],
        center: Center,
        acceleration: Vector,
    ) -> Option<ClosedForm> {
        let rotation = match torques {
            [] => Rotation::Free(FreeMotion::in_principal_axes(body.moments, rotor, omega)),
            _ => return None,
        };
        Some(ClosedForm { body, rotation, center, acceleration })
    }

    /// How far in time, in s, the phase is known.
    pub fn horizon(&self) -> f64 {
        match &self.rotation {
            Rotation::Free(motion) => motion.horizon(),
        }
    }

    /// The point of the motion at a time in s.
    pub fn at(&self, time: f64) -> Carried {
        let (rotor, omega) = match &self.rotation {
            Rotation::Free(motion) => motion.at(time),
        };
        let phase = Phase { rotor, momentum: self.body.momentum(omega), time };
        Carried::new(phase, uniformly_accelerated(self.center, self.acceleration, time))
    }
}

/// The centre of mass under a constant force.
pub(crate) fn uniformly_accelerated(start: Center, acceleration: Vector, time: f64) -> Center {
    // t² may overflow where no force needs it.
    let fallen = |a: f64| if a == 0.0 { 0.0 } else { 0.5 * a * time * time };
    let fallen = Vector(acceleration.0.map(fallen));
    Center {
        position: start.position + start.velocity * time + fallen,
        velocity: start.velocity + acceleration * time,
    }
}
