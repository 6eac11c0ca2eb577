//! Setup of a rotation: inertia, start and torques.

use crate::body::inertia::Inertia;
use crate::laws::torque::Torque;
use polhode_ga::{Bivector, Rotor};

/// Inertia, start and torques of a rotating body, in body axes.
#[derive(Clone, Debug)]
pub struct Setup {
    /// About the centre of mass, or about the fixed point if there is one.
    pub inertia: Inertia,
    /// From body axes to space at the start.
    pub rotor: Rotor,
    /// The angular velocity at the start, in rad/s.
    pub omega: Bivector,
    /// The time of the start, in s.
    pub time: f64,
    /// The torques, those of off-centre thrusts included.
    pub torques: Vec<Torque>,
    /// Whether forces move the centre of mass.
    pub has_forces: bool,
}
