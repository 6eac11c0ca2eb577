//! Parameters of laws that may vary in an ensemble.

use crate::error::TorqueError;
use crate::laws::registry::{Argument, Limit, Shape, TORQUES, torque};
use crate::laws::torque::Torque;
use crate::units::Quantity;
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// A parameter of a law: one number, or three.
#[derive(Debug, PartialEq)]
pub struct Parameter {
    /// The law, as `[torque]` calls it, or `gravity`.
    pub law: &'static str,
    /// The field of the law; empty if the law has a single value.
    pub field: &'static str,
    /// The physical quantity; `None` for pure numbers.
    pub quantity: Option<Quantity>,
    /// Number of numbers.
    pub size: usize,
    /// The allowed numbers.
    pub limit: Limit,
    /// Index of its first number among those of the law.
    pub at: usize,
    /// Whether one number may stand for all axes.
    is_one: bool,
    /// Whether it is a period, and the number of the law is 2π over it.
    is_period: bool,
}

/// Every parameter that may vary.
pub static PARAMETERS: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
    let acceleration = Parameter {
        law: "gravity",
        field: "acceleration",
        quantity: Some(Quantity::Acceleration),
        size: 1,
        limit: Limit::Finite,
        at: 0,
        is_one: true,
        is_period: false,
    };
    let mut all = vec![acceleration];
    for entry in &TORQUES {
        let mut at = 0;
        for argument in entry.arguments {
            let Argument { field, quantity, shape, limit, period, .. } = *argument;
            let (law, size, is_period) = (entry.name, shape.size(), false);
            let is_one = matches!(shape, Shape::Scalar | Shape::Gains);
            let own = Parameter { law, field, quantity, size, limit, at, is_one, is_period };
            at += size;
            if is_one || matches!(shape, Shape::Vector | Shape::Bivector) {
                let (quantity, limit) = (Some(Quantity::Time), Limit::Positive);
                let period = Parameter { field: period, quantity, limit, is_period: true, ..own };
                all.push(own);
                all.extend(Some(period).filter(|period| !period.field.is_empty()));
            }
        }
    }
    all
});

impl Parameter {
    /// `torque.magnetic.dipole`.
    pub fn name(&self) -> String {
        let table = if self.law == "gravity" { "" } else { "torque." };
        let dot = if self.field.is_empty() { "" } else { "." };
        format!("{table}{}{dot}{}", self.law, self.field)
    }

    /// The place of the law in a scene.
    pub fn place(&self) -> String {
        if self.law == "gravity" { "[gravity]".to_owned() } else { format!("`{}` in [torque]", self.law) }
    }

    /// Its numbers in a law, padded with 0, and whether all axes share one number. `None` for another law, and for the
    /// acceleration of gravity, which is not an argument of a law.
    pub fn of(&self, law: &Torque) -> Option<([f64; 3], bool)> {
        let all = torque(self.law)?.numbers(law)?;
        let own = &all[self.at..self.at + self.size];
        let mut numbers = [0.0; 3];
        numbers[..self.size].copy_from_slice(own);
        if self.is_period {
            numbers[0] = TAU / numbers[0];
        }
        Some((numbers, self.is_one && own.iter().all(|x| *x == own[0])))
    }

    /// The law with these numbers for the parameter.
    pub fn set(&self, law: &Torque, mut numbers: [f64; 3]) -> Result<Torque, TorqueError> {
        let entry = torque(self.law);
        let Some((entry, mut all)) = entry.and_then(|entry| Some((entry, entry.numbers(law)?))) else {
            return Ok(law.clone());
        };
        if self.is_period {
            numbers[0] = TAU / numbers[0];
        }
        all[self.at..self.at + self.size].copy_from_slice(&numbers[..self.size]);
        entry.build(&all)
    }
}
