//! Registry of laws: for each torque and force its name, arguments, formula and constructor.
//!
//! Scenes, ensembles, Python, JAX, reports, files and the page all read it. A law whose formula is cheap needs nothing
//! else: its torque, and what it conserves, follow from the formulas here ([`Kernel::Formula`]).

/// The numbers of one variant of an enum.
macro_rules! numbers {
    ($pattern:pat => $numbers:expr) => {
        |law| match law {
            $pattern => Some($numbers),
            _ => None,
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

/// The name of the law that is given by rows at times.
pub const TABLE: &str = "tabulated";

/// A law as everyone knows it.
#[derive(Debug)]
pub struct Entry<T: 'static> {
    /// Its name in scenes and in Python.
    pub name: &'static str,
    /// Its name on the page.
    pub label: &'static str,
    /// The torque in body axes, or the force in space, in the notation of the handout and the names of the arguments.
    pub formula: &'static str,
    /// What it is given, in the order of Python.
    pub arguments: &'static [Argument],
    /// How it is computed.
    pub kernel: Kernel<T>,
}

/// An argument of a law.
#[derive(Debug)]
pub struct Argument {
    /// Its name in Python and in the formula.
    pub name: &'static str,
    /// Its field in the scene's table of the law; empty where the law has no table but this value.
    pub field: &'static str,
    /// What its numbers measure; `None` for pure numbers.
    pub quantity: Option<Quantity>,
    /// How many numbers it has, and what they are.
    pub shape: Shape,
    /// Which numbers it may have.
    pub limit: Limit,
    /// Its numbers where it is left out: none for an argument that then does not exist.
    pub default: Option<&'static [f64]>,
    /// The field that gives 2π over a rate instead.
    pub period: &'static str,
}

/// What the numbers of an argument are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One number.
    Scalar,
    /// Three components.
    Vector,
    /// Three components over e2e3, e3e1, e1e2.
    Bivector,
    /// Three factors along the body axes; one number stands for three equal ones.
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
    /// How many numbers there are; 0 where that is open.
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

/// Which numbers an argument may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// All that are finite.
    Finite,
    /// None below 0.
    NotNegative,
    /// Those above 0.
    Positive,
    /// Those of an ellipse.
    Eccentricity,
    /// Not all 0: a direction.
    NotZero,
}

impl Limit {
    /// What is wrong with this number, if anything is.
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
    /// By code of its own.
    Native {
        /// The law of the numbers of all arguments; an argument without a default value may be missing at the end.
        build: fn(&[f64]) -> Result<T, TorqueError>,
        /// The numbers of all arguments of such a law; `None` of another.
        numbers: fn(&T) -> Option<Vec<f64>>,
    },
    /// By its formula, which holds what follows from it too.
    Formula {
        /// The largest torque in N m, and of a law with a potential its largest size in J.
        size: &'static str,
        /// The potential energy in J; empty where there is none.
        potential: &'static str,
        /// The argument that is the axis of space about which there is no torque; empty where there is none.
        axis: &'static str,
    },
    /// By rows at times, which are no numbers of a fixed count.
    Table,
}

impl<T> Entry<T> {
    /// Checks the numbers of all arguments.
    pub fn check(&self, numbers: &[f64]) -> Result<(), TorqueError> {
        for (argument, own) in self.split(numbers) {
            if let Some((x, why)) = own.iter().find_map(|x| Some((x, argument.limit.refuses(*x)?))) {
                return Err(TorqueError(format!("{} is {x:?}; it {why}", argument.name)));
            }
            if argument.limit == Limit::NotZero && own.iter().all(|x| *x == 0.0) {
                return Err(TorqueError(format!("{} is {own:?}; it must not be zero", argument.name)));
            }
        }
        Ok(())
    }

    /// Each argument with its numbers, as many as there are.
    pub fn split<'n>(&self, mut numbers: &'n [f64]) -> impl Iterator<Item = (&'static Argument, &'n [f64])> {
        self.arguments.iter().map_while(move |argument| {
            let (own, rest) = numbers.split_at_checked(argument.shape.size())?;
            numbers = rest;
            Some((argument, own))
        })
    }
}

impl Entry<Torque> {
    /// The law of the numbers of all arguments.
    pub fn build(&'static self, numbers: &[f64]) -> Result<Torque, TorqueError> {
        match self.kernel {
            Kernel::Native { build, .. } => build(numbers),
            Kernel::Formula { .. } => compiled::law(self, numbers).map(|law| Torque::Registered(law.into())),
            Kernel::Table => Err(TorqueError(format!("{} is given by its rows", self.name))),
        }
    }

    /// The numbers of all arguments of such a law; `None` of another.
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
    /// The force of the numbers of all arguments.
    pub fn build(&self, numbers: &[f64]) -> Result<Push, TorqueError> {
        match self.kernel {
            Kernel::Native { build, .. } => build(numbers),
            _ => Err(TorqueError(format!("{} has no code of its own", self.name))),
        }
    }

    /// The numbers of all arguments of such a force; `None` of another.
    pub fn numbers(&self, push: &Push) -> Option<Vec<f64>> {
        if let Kernel::Native { numbers, .. } = self.kernel { numbers(push) } else { None }
    }
}

const fn argument(name: &'static str, field: &'static str, quantity: Quantity, shape: Shape) -> Argument {
    let (limit, default) = (Limit::Finite, None);
    Argument { name, field, quantity: Some(quantity), shape, limit, default, period: "" }
}

/// A direction of space; its size is ignored.
const fn direction(name: &'static str) -> Argument {
    let vector = argument(name, name, Quantity::Length, Shape::Vector);
    Argument { quantity: None, limit: Limit::NotZero, ..vector }
}

impl Argument {
    const fn not_negative(self) -> Argument {
        Argument { limit: Limit::NotNegative, ..self }
    }

    const fn or(self, default: &'static [f64]) -> Argument {
        Argument { default: Some(default), ..self }
    }
}

/// Components of the first, second, … three numbers.
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
    /// The entry of this law and the numbers of its arguments, if it is one of numbers alone.
    pub fn registered(&self) -> Option<(&'static Entry<Torque>, Vec<f64>)> {
        TORQUES.iter().find_map(|entry| Some((entry, entry.numbers(self)?)))
    }
}

impl Push {
    /// The entry of this force and the numbers of its arguments, if it is one of numbers alone.
    pub fn registered(&self) -> Option<(&'static Entry<Push>, Vec<f64>)> {
        FORCES.iter().find_map(|entry| Some((entry, entry.numbers(self)?)))
    }
}
