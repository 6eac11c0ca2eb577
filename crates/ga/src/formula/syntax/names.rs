//! Names of formulas and their meanings.

use super::tree::Node;
use crate::product::Grades;
use std::collections::BTreeMap;

/// The type of a value: what is known before evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Type {
    /// The grades it holds.
    pub grades: Grades,
    /// Whether it is a rotor: even, of norm 1.
    pub unit: bool,
}

impl Type {
    /// A value of some grades that is not a rotor.
    pub fn of(grades: Grades) -> Type {
        Type { grades, unit: false }
    }

    /// A number.
    pub const SCALAR: Type = Type { grades: Grades::SCALAR, unit: false };

    /// A rotor.
    pub const ROTOR: Type = Type { grades: Grades::EVEN, unit: true };
}

/// The meaning of a name.
#[derive(Clone, Debug)]
pub enum Meaning {
    /// A value.
    Value(Type),
    /// A linear map: of vectors (grade 1), which reaches every grade as an outermorphism, or of bivectors
    /// (grade 2).
    Map {
        /// 1 or 2.
        grade: u8,
    },
    /// A function defined by a formula.
    Function(Definition),
}

/// A function defined by a formula in its parameters, parsed with the names bound at that time, so that it
/// cannot call itself.
#[derive(Clone, Debug)]
pub struct Definition {
    /// The canonical names of its parameters.
    pub parameters: Vec<String>,
    /// Its value.
    pub body: Node,
}

/// The names a formula may use, each canonical (see [`crate::formula::canonical`]).
#[derive(Clone, Debug, Default)]
pub struct Names {
    meanings: BTreeMap<String, Meaning>,
    /// Whether any other name may get a value later.
    open: bool,
}

impl Names {
    /// These names, and no others.
    pub fn new(meanings: impl IntoIterator<Item = (String, Meaning)>) -> Names {
        Names { meanings: meanings.into_iter().collect(), open: false }
    }

    /// Open names: every word is one name, of a value of any grades.
    pub fn open() -> Names {
        Names { meanings: BTreeMap::new(), open: true }
    }

    /// Whether any other name may get a value later.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// The meaning of a canonical name, if it is bound.
    pub fn get(&self, name: &str) -> Option<&Meaning> {
        self.meanings.get(name)
    }

    /// Binds a name and returns its earlier meaning, if any.
    pub fn bind(&mut self, name: String, meaning: Meaning) -> Option<Meaning> {
        self.meanings.insert(name, meaning)
    }

    /// Removes a name and returns its meaning, if any.
    pub fn forget(&mut self, name: &str) -> Option<Meaning> {
        self.meanings.remove(name)
    }

    /// Restores an earlier meaning of a name, or removes it.
    pub(crate) fn restore(&mut self, name: &str, meaning: Option<Meaning>) {
        match meaning {
            Some(meaning) => self.meanings.insert(name.to_owned(), meaning),
            None => self.forget(name),
        };
    }

    /// Every bound name, in order.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.meanings.keys().map(String::as_str)
    }
}
