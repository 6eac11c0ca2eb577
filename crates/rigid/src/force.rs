//! Forces on the centre of mass, and its motion `x' = v`, `v' = F/m` (handout eq. 4.1: `y = R x ~R + x0`).

use crate::phase::Phase;
use crate::torque::TorqueError;
use polhode_ga::{Rotor, Vector};

/// A force on the centre of mass. Vectors of the body are in body axes.
#[derive(Clone, Debug)]
pub enum Force {
    /// Constant in space, in N.
    Constant(Vector),
    /// Constant in body axes, in N: a thruster's. Where it does not act along a line through the centre of mass it
    /// exerts a torque too, [`crate::torque::Torque::ConstantBody`].
    Body(Vector),
    /// `−k v`, k in N s/m.
    Drag(f64),
    /// `−k |v| v`, k in N s²/m².
    QuadraticDrag(f64),
    /// `−k (x − anchor)`, k in N/m.
    Spring(f64, Vector),
    /// `−μ m x/|x|³`, attraction by a centre at the origin of space, μ in m³/s².
    Central(f64),
}

/// The centre of mass in space: m and m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Center {
    /// In m.
    pub position: Vector,
    /// In m/s.
    pub velocity: Vector,
}

/// A mass in kg and what moves it.
#[derive(Clone, Debug)]
pub struct Translation {
    /// In kg.
    pub mass: f64,
    /// The forces.
    pub forces: Vec<Force>,
}

impl Force {
    /// The same force with its body components seen from other body axes: `x' = ~F x F`.
    pub fn in_axes(self, frame: Rotor) -> Force {
        match self {
            Force::Body(force) => Force::Body(frame.reverse().apply(force)),
            other => other,
        }
    }

    /// The force in space, in N, on a body of this mass.
    pub fn value(&self, mass: f64, state: &Phase, center: &Center) -> Result<Vector, TorqueError> {
        Ok(match self {
            Force::Constant(force) => *force,
            Force::Body(force) => state.rotor.apply(*force),
            Force::Drag(k) => center.velocity * -k,
            Force::QuadraticDrag(k) => center.velocity * (-k * center.velocity.norm()),
            Force::Spring(k, anchor) => (center.position - *anchor) * -k,
            Force::Central(mu) => {
                let distance = center.position.norm();
                if distance == 0.0 {
                    return Err(TorqueError(
                        "the body is at the centre of attraction, where the force is infinite".into(),
                    ));
                }
                center.position * (-mu * mass / distance / distance / distance)
            }
        })
    }
}

impl Translation {
    /// v', in m/s².
    pub fn acceleration(&self, state: &Phase, center: &Center) -> Result<Vector, TorqueError> {
        let mut force = Vector::default();
        for law in &self.forces {
            force += law.value(self.mass, state, center)?;
        }
        Ok(force / self.mass)
    }
}
