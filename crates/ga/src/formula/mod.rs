//! Formulas in the notation of the handout, for the shell, Python, scenes and the browser.
//!
//! ```text
//! equation = sum { "=" sum }
//! sum      = [ "-" ] product { ( "+" | "-" ) product }
//! product  = tight { [ "*" ] tight | "/" prefix }     juxtaposition is the geometric product
//! tight    = prefix { ( "∧" "^" | "·" "|" | "×" | "⨯" | "⌋" | "⌊" ) prefix }
//! prefix   = { "~" | "-" } postfix
//! postfix  = primary { "^" integer | superscript | "~" | "†" | "'" }
//! primary  = number | name | name "(" sum { "," sum } ")" | "(" sum ")" | "⟨" sum "⟩" [ "_" grades ]
//!          | "Σ" [ "_" index ] product
//! ```
//!
//! The products of the third line of operators bind tighter than the geometric product, as in the handout:
//! `I a∧b` is `I (a∧b)`. They are not associative with each other, so `a·b∧c` is an error; `a∧b∧c` is not.
//! One-letter names, with subscripts, primes and tildes, may run together: `RaR̃` is `R a ~R`. A longer word
//! is one name where that name is bound. So the meaning of names decides how a text is parsed, and [`parse`] takes
//! the [`Names`].
//!
//! Text becomes a [`Tree`] with spans, the tree a [`Program`] of steps whose grades are known ([`compile`]). Every
//! formula is parsed and compiled in bounded time, memory and stack: see [`MAX_NODES`] and [`MAX_DEPTH`].

mod agreement;
mod code;
mod compile;
mod print;
mod run;
pub mod session;
mod syntax;

pub use agreement::{Agreement, Arithmetic, Magnitude, term_size, tolerance};
pub use code::{Language, is_function_name};
pub use compile::define::{define, heading};
pub use compile::program::{Id, Input, InputKind, Op, Program, Step};
pub use compile::{compile, types};
pub use print::Style;
pub use run::RowError;
pub use run::general::RowRunner;
pub use run::side_by_side::SideBySide;
pub use run::single::Runner;
pub use run::steps::Given;
pub use syntax::names::{Definition, Meaning, Names, Type};
pub use syntax::number::Number;
pub use syntax::parser::parse;
pub use syntax::token::canonical;
pub use syntax::tree::{Kind, Named, Node, Span, Tight, Tree};

use crate::diagnostic::marked;
use crate::g3::functions::Function;
use crate::general::Calculus;
use crate::product::Grades;
use crate::table::{self, G3};
use std::fmt;

/// Maximum number of names, numbers and operations in a formula with its definitions expanded.
pub const MAX_NODES: usize = 10_000;

/// Maximum depth of nested brackets.
pub const MAX_DEPTH: usize = 100;

/// An error in a formula, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// What is wrong, and what to do.
    pub message: String,
    /// Where in the text, in bytes.
    pub span: Span,
}

impl Error {
    pub(crate) fn new(span: Span, message: impl Into<String>) -> Error {
        Error { message: message.into(), span }
    }

    /// The message, and the line of the text with carets under the place.
    pub fn shown(&self, text: &str) -> String {
        format!("{}{}", self.message, marked(text, self.span.start..self.span.end))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// The algebra of a formula.
#[derive(Clone, Copy)]
pub struct Space<'a> {
    /// Its table.
    pub algebra: &'a table::Algebra,
    /// Its functions; none for 3-d space, which has its own.
    calculus: Option<&'a Calculus>,
}

impl<'a> Space<'a> {
    /// 3-d space.
    pub fn g3() -> Space<'static> {
        Space { algebra: &G3, calculus: None }
    }

    /// Any algebra, with its functions.
    pub fn new(algebra: &'a table::Algebra, calculus: &'a Calculus) -> Space<'a> {
        let own = algebra.signature() == G3.signature();
        Space { algebra, calculus: (!own).then_some(calculus) }
    }

    /// Whether it is 3-d space.
    pub fn is_g3(self) -> bool {
        self.calculus.is_none()
    }

    /// The grades of a function's values.
    pub(crate) fn grades(self, f: Function, g: Grades) -> Grades {
        self.calculus.map_or_else(|| f.grades(g), |calculus| calculus.grades(f, g))
    }
}

#[cfg(test)]
mod tests;
