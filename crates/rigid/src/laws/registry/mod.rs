//! Registry of laws: for each torque and force its name, arguments, formula and constructor.
//!
//! Scenes, ensembles, Python, JAX, reports, files and the page all read it. The formulas of a law ([`Kernel::Formula`])
//! may define its torque and what it conserves, without other code.

/// A law with code of its own: name, label, formula, arguments, constructor, and the numbers of such a law.
macro_rules! native {
    ($name:expr, $label:expr, $formula:expr, [$($argument:expr),*], $build:expr, $law:pat => $numbers:expr) => {
        Entry {
            name: $name,
            label: $label,
            formula: $formula,
            arguments: &[$($argument),*],
            kernel: Kernel::Native {
                build: $build,
                numbers: |law| match law {
                    $law => Some($numbers),
                    _ => None,
                },
            },
        }
    };
}

mod compiled;
mod forces;
mod torques;

use super::force::Push;
use super::torque::Torque;
use crate::error::TorqueError;
use crate::units::Quantity;
pub use forces::FORCES;
pub use torques::TORQUES;

/// The name of the tabulated torque.
pub const TABLE: &str = "tabulated";

/// A law of the registry.
#[derive(Debug)]
pub struct Entry<T: 'static> {
    /// Its name in scenes and in Python.
    pub name: &'static str,
    /// Its name on the page.
    pub label: &'static str,
    /// The torque in body axes, or the force in space, in the notation of the handout and the names of the arguments.
    pub formula: &'static str,
    /// Its arguments, in the order of Python.
    pub arguments: &'static [Argument],
    /// How it is computed.
    pub kernel: Kernel<T>,
}

/// An argument of a law.
#[derive(Debug)]
pub struct Argument {
    /// Its name in Python and in the formula.
    pub name: &'static str,
    /// Its field in the scene's table of the law; empty if the law has this one value instead of a table.
    pub field: &'static str,
    /// The physical quantity; `None` for pure numbers.
    pub quantity: Option<Quantity>,
    /// Its shape.
    pub shape: Shape,
    /// The allowed numbers.
    pub limit: Limit,
    /// The default numbers; empty for an argument without a default value that may be omitted.
    pub default: Option<&'static [f64]>,
    /// The field for the period of a rate, 2π over it; empty if there is none.
    pub period: &'static str,
}

/// The shape of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One number.
    Scalar,
    /// Three components.
    Vector,
    /// Three components over e2e3, e3e1, e1e2.
    Bivector,
    /// Three factors along the body axes, or one for all axes.
    Gains,
    /// Four components, those of a rotor.
    Rotor,
    /// A list of numbers.
    Numbers,
    /// A list of bivectors.
    Bivectors,
    /// One of these words, the first by default.
    Word(&'static [&'static str]),
}

impl Shape {
    /// Number of numbers; 0 if it varies.
    pub const fn size(self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector | Shape::Bivector | Shape::Gains => 3,
            Shape::Rotor => 4,
            Shape::Numbers | Shape::Bivectors | Shape::Word(_) => 0,
        }
    }

    /// Its name for other languages.
    pub fn name(self) -> &'static str {
        match self {
            Shape::Scalar => "scalar",
            Shape::Vector => "vector",
            Shape::Bivector => "bivector",
            Shape::Gains => "gains",
            Shape::Rotor => "rotor",
            Shape::Numbers => "numbers",
            Shape::Bivectors => "bivectors",
            Shape::Word(_) => "word",
        }
    }
}

/// The allowed numbers of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Finite.
    Finite,
    /// At least 0.
    NotNegative,
    /// Above 0.
    Positive,
    /// At least 0 and below 1.
    Eccentricity,
    /// Not all 0: a direction.
    NotZero,
}

impl Limit {
    /// The reason why a number is not allowed, if it is not.
    pub fn refuses(self, number: f64) -> Option<&'static str> {
        let (allowed, why) = match self {
            Limit::Finite | Limit::NotZero => (true, ""),
            Limit::NotNegative => (number >= 0.0, "must not be negative"),
            Limit::Positive => (number > 0.0, "must be more than 0"),
            Limit::Eccentricity => ((0.0..1.0).contains(&number), "must be at least 0 and below 1"),
        };
        if number.is_finite() { (!allowed).then_some(why) } else { Some("must be finite") }
    }
}

/// How a law is computed.
#[derive(Debug)]
pub enum Kernel<T> {
    /// By its own code.
    Native {
        /// Constructs the law from the numbers of all arguments; the last argument may be missing.
        build: fn(&[f64]) -> Result<T, TorqueError>,
        /// The numbers of all arguments; `None` for another law.
        numbers: fn(&T) -> Option<Vec<f64>>,
    },
    /// By its formula.
    Formula {
        /// The largest torque in N m, and the largest size of the potential in J.
        size: &'static str,
        /// The potential energy in J; empty if there is none.
        potential: &'static str,
        /// The argument that is the axis of space about which there is no torque; empty if there is none.
        axis: &'static str,
    },
    /// By interpolation between rows at times.
    Table,
}

impl<T> Entry<T> {
    /// Checks the numbers of all arguments.
    pub fn check(&self, numbers: &[f64]) -> Result<(), TorqueError> {
        for (argument, own) in self.split(numbers) {
            if let Some((x, why)) = own.iter().find_map(|x| Some((x, argument.limit.refuses(*x)?))) {
                return Err(TorqueError::new(format!("{} is {x:?}; it {why}", argument.name)));
            }
            if argument.limit == Limit::NotZero && own.iter().all(|x| *x == 0.0) {
                return Err(TorqueError::new(format!("{} is {own:?}; it must not be zero", argument.name)));
            }
        }
        Ok(())
    }

    /// Each argument with its numbers, while there are any.
    pub fn split<'n>(&self, mut numbers: &'n [f64]) -> impl Iterator<Item = (&'static Argument, &'n [f64])> {
        self.arguments.iter().map_while(move |argument| {
            let (own, rest) = numbers.split_at_checked(argument.shape.size())?;
            numbers = rest;
            Some((argument, own))
        })
    }
}

impl Entry<Torque> {
    /// Constructs the law from the numbers of all arguments.
    pub fn build(&'static self, numbers: &[f64]) -> Result<Torque, TorqueError> {
        match self.kernel {
            Kernel::Native { build, .. } => build(numbers),
            Kernel::Formula { .. } => compiled::law(self, numbers).map(|law| Torque::Registered(law.into())),
            Kernel::Table => Err(TorqueError::new(format!("{} is given by its rows", self.name))),
        }
    }

    /// The numbers of all arguments; `None` for another law.
    pub fn numbers(&'static self, torque: &Torque) -> Option<Vec<f64>> {
        match (&self.kernel, torque) {
            (Kernel::Native { numbers, .. }, _) => numbers(torque),
            (Kernel::Formula { .. }, Torque::Registered(law)) if law.name == self.name => {
                Some(law.numbers.clone())
            }
            _ => None,
        }
    }
}

impl Entry<Push> {
    /// Constructs the force from the numbers of all arguments.
    pub fn build(&self, numbers: &[f64]) -> Result<Push, TorqueError> {
        match self.kernel {
            Kernel::Native { build, .. } => build(numbers),
            _ => Err(TorqueError::new(format!("{} has no code of its own", self.name))),
        }
    }

    /// The numbers of all arguments; `None` for another force.
    pub fn numbers(&self, push: &Push) -> Option<Vec<f64>> {
        if let Kernel::Native { numbers, .. } = self.kernel { numbers(push) } else { None }
    }
}

const fn argument(name: &'static str, field: &'static str, quantity: Quantity, shape: Shape) -> Argument {
    let (limit, default) = (Limit::Finite, None);
    Argument { name, field, quantity: Some(quantity), shape, limit, default, period: "" }
}

/// An argument of pure numbers.
const fn pure(name: &'static str, shape: Shape) -> Argument {
    Argument { quantity: None, ..argument(name, name, Quantity::Angle, shape) }
}

impl Argument {
    const fn not_negative(self) -> Argument {
        Argument { limit: Limit::NotNegative, ..self }
    }

    const fn or(self, default: &'static [f64]) -> Argument {
        Argument { default: Some(default), ..self }
    }
}

/// The k-th group of three numbers.
fn three(numbers: &[f64], k: usize) -> [f64; 3] {
    std::array::from_fn(|i| numbers[3 * k + i])
}

/// The torque law of this name.
pub fn torque(name: &str) -> Option<&'static Entry<Torque>> {
    TORQUES.iter().find(|entry| entry.name == name)
}

/// The force of this name.
pub fn force(name: &str) -> Option<&'static Entry<Push>> {
    FORCES.iter().find(|entry| entry.name == name)
}

impl Torque {
    /// The entry of this law and the numbers of its arguments, if it is in the registry.
    pub fn registered(&self) -> Option<(&'static Entry<Torque>, Vec<f64>)> {
        TORQUES.iter().find_map(|entry| Some((entry, entry.numbers(self)?)))
    }
}

impl Push {
    /// The entry of this force and the numbers of its arguments, if it is in the registry.
    pub fn registered(&self) -> Option<(&'static Entry<Push>, Vec<f64>)> {
        FORCES.iter().find_map(|entry| Some((entry, entry.numbers(self)?)))
    }
}
