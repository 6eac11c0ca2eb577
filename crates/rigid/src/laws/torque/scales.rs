//! Scales of torques for steps: their sizes, and the times at which they are not smooth.

use super::Torque;
use crate::state::phase::Gyrostat;
use crate::state::point::Point;

impl Torque {
    /// Largest torque in N m, a scale for steps; 0 if it is unknown or unbounded.
    pub fn size(&self, body: &Gyrostat) -> f64 {
        match self {
            Torque::Heavy(c) => c.norm(),
            Torque::GravityGradient(orbit) => {
                let largest = body.moments.iter().fold(0.0, |m: f64, x| m.max(*x));
                3.0 * orbit.rate() * orbit.rate() * orbit.largest_nearness() * largest
            }
            Torque::ConstantBody(torque) | Torque::ConstantSpace(torque) => torque.norm(),
            Torque::Magnetic { dipole, field } => dipole.norm() * field.norm(),
            Torque::TorsionSpring { stiffness, .. } => stiffness.abs() * std::f64::consts::PI,
            Torque::Control { stiffness, .. } => stiffness.bound() * std::f64::consts::PI,
            Torque::Tabulated(table) => table.largest(),
            Torque::Wheels(wheels) => wheels.sizes()[0],
            Torque::Registered(law) => law.size,
            Torque::Damping(_)
            | Torque::QuadraticDamping(_)
            | Torque::ViscousDamping(_)
            | Torque::Wheel(_)
            | Torque::Larmor(_)
            | Torque::Formula(_)
            | Torque::Function(_) => 0.0,
        }
    }

    /// The larger of [`Torque::size`] and the torque at a point, in N m: a scale for steps.
    pub fn size_at(&self, at: &Point) -> f64 {
        self.size(at.body).max(self.value(at).map_or(0.0, |torque| torque.norm()))
    }

    /// The range of the potential energy in J.
    pub fn potential_range(&self) -> f64 {
        match self {
            Torque::Heavy(c) => 2.0 * c.norm(),
            Torque::Magnetic { dipole, field } => 2.0 * dipole.norm() * field.norm(),
            Torque::TorsionSpring { stiffness, .. } => {
                0.5 * stiffness.abs() * std::f64::consts::PI * std::f64::consts::PI
            }
            Torque::Registered(law) if law.potential.is_some() => 2.0 * law.size,
            _ => 0.0,
        }
    }

    /// Times at which the law is not smooth, in increasing order: steps end there.
    pub fn breaks(&self) -> &[f64] {
        match self {
            Torque::Tabulated(table) => table.times(),
            Torque::Wheels(wheels) => wheels.breaks(),
            _ => &[],
        }
    }

    /// Those of the breaks at which it jumps.
    pub fn jumps(&self) -> &[f64] {
        match self {
            Torque::Tabulated(table) => table.jumps(),
            Torque::Wheels(wheels) => wheels.breaks(),
            _ => &[],
        }
    }
}
