//! Torque laws. A torque is a bivector; its components are those of the axial vector.
//!
//! A law is a value: what it needs to know, its torque at a point of the motion, and what it conserves
//! ([`crate::conserved`]). Laws add up.

use crate::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Rotor, Vector};
use std::fmt;

const E1: Vector = Vector([1.0, 0.0, 0.0]);
const E2: Vector = Vector([0.0, 1.0, 0.0]);

/// What turns the body. Vectors and bivectors of the body are in body axes.
#[derive(Clone, Debug)]
pub enum Torque {
    /// Uniform gravity along −e3 on a body held at the origin of its axes: `V = c·γ`, `γ = ~R e3 R`, where
    /// `c = m g (centre of mass)`, in N m. The torque is `γ∧c`.
    Heavy(Vector),
    /// The gradient of a central field on a circular orbit of rate `n` (rad/s) in the plane e1e2: with
    /// `u = cos(nt) e1 + sin(nt) e2` from planet to body, axial torque `3n² u x I(u)`.
    GravityGradient(f64),
    /// Constant in body axes, in N m.
    ConstantBody(Bivector),
    /// Constant in space, in N m.
    ConstantSpace(Bivector),
    /// `−g I(Ω)`, with g in 1/s.
    Damping(f64),
    /// A wheel inside the body with this constant momentum relative to it, kg m²/s: part of the body
    /// ([`Gyrostat`]) rather than a torque.
    Wheel(Bivector),
}

/// What a law's torque depends on besides time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dependence {
    /// On the attitude at most: a kick at fixed attitude solves it exactly.
    Attitude,
    /// On the rate of turning too.
    Rate,
}

/// Why a law has no torque at some point of the motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TorqueError(pub String);

impl fmt::Display for TorqueError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Torque {
    /// The same law with its body components seen from other body axes: `x' = ~F x F`.
    pub fn in_axes(self, frame: Rotor) -> Torque {
        let back = frame.reverse();
        match self {
            Torque::Heavy(c) => Torque::Heavy(back.apply(c)),
            Torque::ConstantBody(n) => Torque::ConstantBody(back.apply_bivector(n)),
            Torque::Wheel(h) => Torque::Wheel(back.apply_bivector(h)),
            other => other,
        }
    }

    /// What [`Torque::value`] depends on.
    pub fn dependence(&self) -> Dependence {
        match self {
            Torque::Heavy(_)
            | Torque::GravityGradient(_)
            | Torque::ConstantBody(_)
            | Torque::ConstantSpace(_)
            | Torque::Damping(_)
            | Torque::Wheel(_) => Dependence::Attitude,
        }
    }

    /// The torque in principal axes, without the part `−g I(Ω)` ([`Torque::damping_rate`]) and that of a wheel.
    pub fn value(&self, body: &Gyrostat, state: &Phase) -> Result<Bivector, TorqueError> {
        let rotor = state.rotor;
        Ok(match self {
            Torque::Heavy(c) => state.vertical().wedge(*c),
            Torque::GravityGradient(n) => {
                let u = rotor.reverse().apply(radial(*n, state.time));
                u.wedge(body.stretched(u)) * (3.0 * n * n)
            }
            Torque::ConstantBody(torque) => *torque,
            Torque::ConstantSpace(torque) => rotor.reverse().apply_bivector(*torque),
            Torque::Damping(_) | Torque::Wheel(_) => Bivector::default(),
        })
    }

    /// The g of the part `−g I(Ω)`, in 1/s.
    pub fn damping_rate(&self) -> f64 {
        if let Torque::Damping(g) = self { *g } else { 0.0 }
    }

    /// Largest torque it can exert, in N m, where that is bounded: a scale for steps.
    pub fn size(&self, body: &Gyrostat) -> f64 {
        match self {
            Torque::Heavy(c) => c.norm(),
            Torque::GravityGradient(n) => 3.0 * n * n * body.moments.iter().fold(0.0, |m: f64, x| m.max(*x)),
            Torque::ConstantBody(torque) | Torque::ConstantSpace(torque) => torque.norm(),
            Torque::Damping(_) | Torque::Wheel(_) => 0.0,
        }
    }

    /// Its potential energy in J, if it has one that does not change with time and with the rate.
    pub fn potential(&self, _body: &Gyrostat, state: &Phase) -> Option<f64> {
        match self {
            Torque::Heavy(c) => Some(state.vertical().dot(*c)),
            Torque::Wheel(_) => Some(0.0),
            Torque::GravityGradient(_)
            | Torque::ConstantBody(_)
            | Torque::ConstantSpace(_)
            | Torque::Damping(_) => None,
        }
    }

    /// Times at which the law is not smooth, rising: steps end there.
    pub fn breaks(&self) -> &[f64] {
        &[]
    }
}

/// The momentum of all wheels together.
pub(crate) fn wheel(torques: &[Torque]) -> Bivector {
    torques.iter().fold(Bivector::default(), |sum, torque| match torque {
        Torque::Wheel(h) => sum + *h,
        _ => sum,
    })
}

/// The direction from planet to body.
pub(crate) fn radial(n: f64, time: f64) -> Vector {
    let (sin, cos) = (n * time).sin_cos();
    E1 * cos + E2 * sin
}
