//! What torques depend on.

use super::Torque;
use crate::laws::formula::{Formula, Motion};

/// Dependence of a torque on the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dependence {
    /// On the attitude and time alone: a kick at fixed attitude is exact.
    Attitude,
    /// On the angular velocity too.
    Rate,
}

impl Torque {
    /// The dependence of [`Torque::value`] on the state.
    pub fn dependence(&self) -> Dependence {
        match self {
            Torque::Heavy(_)
            | Torque::GravityGradient(_)
            | Torque::ConstantBody(_)
            | Torque::ConstantSpace(_)
            | Torque::Damping(_)
            | Torque::Magnetic { .. }
            | Torque::TorsionSpring { .. }
            | Torque::Wheel(_)
            | Torque::Tabulated(_) => Dependence::Attitude,
            Torque::Control { damping, .. } if damping.is_zero() => Dependence::Attitude,
            Torque::QuadraticDamping(_)
            | Torque::ViscousDamping(_)
            | Torque::Control { .. }
            | Torque::Larmor(_)
            | Torque::Wheels(_)
            | Torque::Function(_) => Dependence::Rate,
            Torque::Formula(_) | Torque::Registered(_) => match self.needs(Motion::is_rate) {
                true => Dependence::Rate,
                false => Dependence::Attitude,
            },
        }
    }

    fn needs(&self, what: impl Fn(Motion) -> bool) -> bool {
        self.formula().is_some_and(|formula| formula.needs(what))
    }

    /// Whether the torque depends on the mass by itself.
    pub(crate) fn reads_mass(&self) -> bool {
        self.needs(|motion| motion == Motion::Mass)
    }

    /// Whether the torque depends on position or velocity of the centre of mass.
    pub(crate) fn reads_center(&self) -> bool {
        match self {
            Torque::Function(law) => law.reads_center(),
            _ => self.formula().is_some_and(Formula::reads_center),
        }
    }

    /// Whether the torque is known to have kinks, such as `|Ω| Ω` at rest.
    pub(crate) fn has_kinks(&self) -> bool {
        match self {
            Torque::QuadraticDamping(_) => true,
            Torque::Formula(_) | Torque::Registered(_) => self.formula().is_some_and(Formula::has_kinks),
            _ => false,
        }
    }

    /// Whether the torque does not depend on time explicitly.
    pub fn is_autonomous(&self) -> bool {
        match self {
            Torque::GravityGradient(_) | Torque::Tabulated(_) | Torque::Wheels(_) | Torque::Function(_) => {
                false
            }
            _ => !self.needs(|motion| motion == Motion::Time),
        }
    }
}
