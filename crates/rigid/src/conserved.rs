//! What a set of laws leaves constant.

use crate::phase::{Gyrostat, Phase};
use crate::torque::{Torque, radial};

/// A quantity that the motion conserves exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conserved {
    /// Kinetic plus potential energy, in J.
    Energy,
    /// |L|, that of a wheel included, in kg m²/s.
    AngularMomentum,
    /// The component of L in the plane e1e2 of space (about e3), in kg m²/s.
    VerticalAngularMomentum,
    /// `½ω·Iω − n L·N + (3/2) n² u·I(u)` of a satellite on a circular orbit, N the orbit normal, in J.
    Jacobi,
}

impl Conserved {
    /// What a set of laws leaves constant.
    pub fn under(_body: &Gyrostat, torques: &[Torque]) -> Vec<Conserved> {
        let torques: Vec<&Torque> = torques.iter().filter(|t| !matches!(t, Torque::Wheel(_))).collect();
        match torques[..] {
            [] => vec![Conserved::Energy, Conserved::AngularMomentum],
            [Torque::GravityGradient(_)] => vec![Conserved::Jacobi],
            _ if torques.iter().all(|t| matches!(t, Torque::Heavy(_))) => {
                vec![Conserved::Energy, Conserved::VerticalAngularMomentum]
            }
            _ => Vec::new(),
        }
    }

    /// Its name in reports and files.
    pub fn name(self) -> &'static str {
        match self {
            Conserved::Energy => "energy",
            Conserved::AngularMomentum => "angular_momentum",
            Conserved::VerticalAngularMomentum => "vertical_angular_momentum",
            Conserved::Jacobi => "jacobi_integral",
        }
    }

    /// Its value, in principal axes.
    pub fn value(self, body: &Gyrostat, torques: &[Torque], state: &Phase) -> f64 {
        match self {
            Conserved::Energy => energy(body, torques, state),
            Conserved::AngularMomentum => state.momentum.norm(),
            Conserved::VerticalAngularMomentum => state.rotor.apply_bivector(state.momentum).0[2],
            Conserved::Jacobi => {
                let n = torques.iter().find_map(|t| match t {
                    Torque::GravityGradient(n) => Some(*n),
                    _ => None,
                });
                let n = n.unwrap_or(0.0);
                let u = state.rotor.reverse().apply(radial(n, state.time));
                let vertical = state.rotor.apply_bivector(state.momentum).0[2];
                body.kinetic(state.momentum) - n * vertical + 1.5 * n * n * u.dot(body.stretched(u))
            }
        }
    }

    /// The size against which a change counts: that of the terms that make it up, at the start.
    pub fn scale(self, body: &Gyrostat, torques: &[Torque], start: &Phase) -> f64 {
        match self {
            Conserved::Energy | Conserved::Jacobi => {
                body.kinetic(start.momentum) + torques.iter().map(|t| t.size(body)).sum::<f64>()
            }
            Conserved::AngularMomentum | Conserved::VerticalAngularMomentum => start.momentum.norm(),
        }
    }
}

/// Kinetic energy, and the potential energy of the laws that have one, in J.
pub fn energy(body: &Gyrostat, torques: &[Torque], state: &Phase) -> f64 {
    body.kinetic(state.momentum) + torques.iter().filter_map(|t| t.potential(body, state)).sum::<f64>()
}
