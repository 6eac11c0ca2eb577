//! The numbers of laws that may differ from body to body, by their names in a scene.

use crate::error::TorqueError;
use crate::laws::torque::{Gains, Orbit, Torque};
use crate::units::Quantity;
use polhode_ga::{Bivector, Vector};
use std::f64::consts::TAU;

/// A parameter of a law: one number, or three.
#[derive(Debug, PartialEq)]
pub struct Parameter {
    /// The law, as `[torque]` calls it, or `gravity`.
    pub law: &'static str,
    /// The field of the law; empty where the law is the parameter.
    pub field: &'static str,
    /// What its numbers measure; none is a pure number.
    pub quantity: Option<Quantity>,
    /// How many numbers it may have.
    pub size: usize,
    /// Which numbers it may have.
    pub limit: Limit,
}

/// Which numbers a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// All that are finite.
    Finite,
    /// None below 0.
    NotNegative,
    /// Those above 0.
    Positive,
    /// Those of an ellipse.
    Eccentricity,
}

impl Limit {
    /// Why it may not be this number, if it may not.
    pub fn refuses(self, number: f64) -> Option<&'static str> {
        let (allowed, why) = match self {
            Limit::Finite => (true, ""),
            Limit::NotNegative => (number >= 0.0, "it must not be negative"),
            Limit::Positive => (number > 0.0, "it must be more than 0"),
            Limit::Eccentricity => ((0.0..1.0).contains(&number), "it must be at least 0 and below 1"),
        };
        if number.is_finite() { (!allowed).then_some(why) } else { Some("it must be finite") }
    }
}

const fn row(
    law: &'static str,
    field: &'static str,
    quantity: Quantity,
    size: usize,
    limit: Limit,
) -> Parameter {
    Parameter { law, field, quantity: Some(quantity), size, limit }
}

/// Every parameter that may vary.
pub static PARAMETERS: [Parameter; 18] = [
    row("gravity", "acceleration", Quantity::Acceleration, 1, Limit::Finite),
    row("damping", "", Quantity::DecayRate, 1, Limit::Finite),
    row("quadratic_damping", "", Quantity::QuadraticRotaryDamping, 1, Limit::NotNegative),
    row("viscous_damping", "", Quantity::RotaryDamping, 3, Limit::NotNegative),
    row("gravity_gradient", "rate", Quantity::AngularRate, 1, Limit::Finite),
    row("gravity_gradient", "period", Quantity::Time, 1, Limit::Positive),
    Parameter {
        law: "gravity_gradient",
        field: "eccentricity",
        quantity: None,
        size: 1,
        limit: Limit::Eccentricity,
    },
    row("gravity_gradient", "mean_anomaly", Quantity::Angle, 1, Limit::Finite),
    row("constant_body", "", Quantity::Torque, 3, Limit::Finite),
    row("constant_space", "", Quantity::Torque, 3, Limit::Finite),
    row("magnetic", "dipole", Quantity::MagneticDipole, 3, Limit::Finite),
    row("magnetic", "field", Quantity::MagneticField, 3, Limit::Finite),
    row("torsion_spring", "stiffness", Quantity::TorsionalStiffness, 1, Limit::Finite),
    row("gyrostat", "", Quantity::AngularMomentum, 3, Limit::Finite),
    row("pd_control", "kp", Quantity::TorsionalStiffness, 3, Limit::NotNegative),
    row("pd_control", "kd", Quantity::RotaryDamping, 3, Limit::NotNegative),
    row("larmor", "", Quantity::AngularRate, 3, Limit::Finite),
    row("heavy", "", Quantity::Torque, 3, Limit::Finite),
];

impl Parameter {
    /// `torque.magnetic.dipole`.
    pub fn name(&self) -> String {
        let table = if self.law == "gravity" { "" } else { "torque." };
        let dot = if self.field.is_empty() { "" } else { "." };
        format!("{table}{}{dot}{}", self.law, self.field)
    }

    /// The place in a scene of the law.
    pub fn place(&self) -> String {
        if self.law == "gravity" { "[gravity]".to_owned() } else { format!("`{}` in [torque]", self.law) }
    }

    /// Its numbers in a law, 0 where it has but one, and whether it is one number for all axes. None in another law;
    /// the acceleration of gravity is no number of the law that gravity makes.
    pub fn of(&self, torque: &Torque) -> Option<([f64; 3], bool)> {
        let one = |x: f64| ([x, 0.0, 0.0], true);
        let gains = |gains: &Gains| {
            let [a, b, c] = gains.along();
            ([a, b, c], a == b && b == c)
        };
        Some(match (torque, self.field) {
            (Torque::Damping(x) | Torque::QuadraticDamping(x), "") => one(*x),
            (Torque::ViscousDamping(d), "") => gains(d),
            (Torque::GravityGradient(orbit), "rate") => one(orbit.rate()),
            (Torque::GravityGradient(orbit), "period") => one(TAU / orbit.rate()),
            (Torque::GravityGradient(orbit), "eccentricity") => one(orbit.eccentricity()),
            (Torque::GravityGradient(orbit), "mean_anomaly") => one(orbit.anomaly()),
            (Torque::ConstantBody(b) | Torque::ConstantSpace(b) | Torque::Wheel(b), "") => (b.0, false),
            (Torque::Larmor(v) | Torque::Heavy(v), "") => (v.0, false),
            (Torque::Magnetic { dipole, .. }, "dipole") => (dipole.0, false),
            (Torque::Magnetic { field, .. }, "field") => (field.0, false),
            (Torque::TorsionSpring { stiffness, .. }, "stiffness") => one(*stiffness),
            (Torque::Control { stiffness, .. }, "kp") => gains(stiffness),
            (Torque::Control { damping, .. }, "kd") => gains(damping),
            _ => return None,
        })
    }

    /// The law with other numbers for it.
    pub fn set(&self, torque: &Torque, numbers: [f64; 3]) -> Result<Torque, TorqueError> {
        let [x, ..] = numbers;
        Ok(match torque.clone() {
            Torque::Damping(_) => Torque::Damping(x),
            Torque::QuadraticDamping(_) => Torque::QuadraticDamping(x),
            Torque::ViscousDamping(_) => Torque::ViscousDamping(Gains::new(numbers)),
            Torque::GravityGradient(orbit) => {
                let (rate, eccentricity, anomaly) = (orbit.rate(), orbit.eccentricity(), orbit.anomaly());
                Torque::GravityGradient(match self.field {
                    "rate" => Orbit::new(x, eccentricity, anomaly)?,
                    "period" => Orbit::new(TAU / x, eccentricity, anomaly)?,
                    "eccentricity" => Orbit::new(rate, x, anomaly)?,
                    _ => Orbit::new(rate, eccentricity, x)?,
                })
            }
            Torque::ConstantBody(_) => Torque::ConstantBody(Bivector(numbers)),
            Torque::ConstantSpace(_) => Torque::ConstantSpace(Bivector(numbers)),
            Torque::Wheel(_) => Torque::Wheel(Bivector(numbers)),
            Torque::Larmor(_) => Torque::Larmor(Vector(numbers)),
            Torque::Heavy(_) => Torque::Heavy(Vector(numbers)),
            Torque::Magnetic { dipole, field } => match self.field {
                "dipole" => Torque::Magnetic { dipole: Vector(numbers), field },
                _ => Torque::Magnetic { dipole, field: Vector(numbers) },
            },
            Torque::TorsionSpring { rest, .. } => Torque::TorsionSpring { stiffness: x, rest },
            Torque::Control { stiffness, damping, target } => match self.field {
                "kp" => Torque::Control { stiffness: Gains::new(numbers), damping, target },
                _ => Torque::Control { stiffness, damping: Gains::new(numbers), target },
            },
            same @ (Torque::Tabulated(_) | Torque::Formula(_) | Torque::Function(_)) => same,
        })
    }
}
