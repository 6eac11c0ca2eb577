//! What the names of a formula stand for.

use super::tree::Node;
use crate::product::Grades;
use std::collections::BTreeMap;

/// What is known of a value before it is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Type {
    /// The grades it holds.
    pub grades: Grades,
    /// Whether it is a rotor: even, of norm 1.
    pub unit: bool,
}

impl Type {
    /// A value of some grades, no rotor.
    pub fn of(grades: Grades) -> Type {
        Type { grades, unit: false }
    }

    /// A number.
    pub const SCALAR: Type = Type { grades: Grades::SCALAR, unit: false };

    /// A rotor.
    pub const ROTOR: Type = Type { grades: Grades::EVEN, unit: true };
}

/// What a name stands for.
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

/// A function defined by a formula in its parameters. It knows the names there were when it was defined, so
/// that no function can call itself.
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
    /// Those that are bound, and no others.
    pub fn new(meanings: impl IntoIterator<Item = (String, Meaning)>) -> Names {
        Names { meanings: meanings.into_iter().collect(), open: false }
    }

    /// As yet unknown: every word is one name, of a value of any grades.
    pub fn open() -> Names {
        Names { meanings: BTreeMap::new(), open: true }
    }

    /// Whether any other name may get a value later.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// What a canonical name stands for, if it is bound.
    pub fn get(&self, name: &str) -> Option<&Meaning> {
        self.meanings.get(name)
    }

    /// Binds a name; what it stood for before, if anything.
    pub fn bind(&mut self, name: String, meaning: Meaning) -> Option<Meaning> {
        self.meanings.insert(name, meaning)
    }

    /// Takes its meaning from a name; what it stood for, if anything.
    pub fn forget(&mut self, name: &str) -> Option<Meaning> {
        self.meanings.remove(name)
    }

    /// Gives a name back what it stood for, or nothing.
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
