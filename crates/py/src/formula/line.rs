//! Lines of a session in Python.

use super::program::{Place, characters, span};
use polhode_ga::formula::session::{Expected, Line, Refusal, Statement};
use polhode_ga::formula::{self, Error};
use polhode_rigid::units::UNITS;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::HashSet;

/// An error and its place in the line, in characters.
type Wrong = (String, usize, usize);

/// A line of a session, read from character `start` on.
#[pyclass(frozen, name = "Line", module = "polhode._native")]
pub(crate) struct SessionLine {
    written: String,
    line: Line,
}

#[pymethods]
impl SessionLine {
    /// Reads `"any"` line, an `"assignment"` or a `"formula"`; the arguments of a ValueError are the message and its place.
    #[new]
    fn new(written: String, start: usize, expected: &str, names: HashSet<String>) -> PyResult<SessionLine> {
        let expected = match expected {
            "assignment" => Expected::Assignment,
            "formula" => Expected::Formula,
            _ => Expected::Any,
        };
        let start = span(&written, (start, start)).start;
        match Line::read(&written, start, expected, |name| names.contains(name), UNITS) {
            Ok(line) => Ok(SessionLine { line, written }),
            Err(error) => Err(PyValueError::new_err(placed(&written, error))),
        }
    }

    /// The name that gets a value or becomes a function; None for a formula.
    #[getter]
    fn name(&self) -> Option<&str> {
        match &self.line.statement {
            Statement::Evaluate => None,
            Statement::Assign { name, .. } | Statement::Define { name, .. } => Some(name),
        }
    }

    /// The head of a function, `V(x)`; None where none is defined.
    #[getter]
    fn function(&self) -> Option<&str> {
        match &self.line.statement {
            Statement::Define { head, .. } => Some(head),
            _ => None,
        }
    }

    /// The formula as it is parsed: with numbers for quantities and `last_value` for `_`.
    #[getter]
    fn text(&self) -> &str {
        self.line.text()
    }

    /// Whether the formula uses the last value.
    #[getter]
    fn uses_last(&self) -> bool {
        self.line.uses_last
    }

    /// An error about the whole formula.
    fn error(&self, message: String) -> Wrong {
        placed(&self.written, self.line.error(message))
    }

    /// The error for an `"equation"` as a value, `"no last value"`, or a value that is `"not finite"`.
    fn refuse(&self, why: &str) -> Wrong {
        let why = match why {
            "equation" => Refusal::EquationAsValue,
            "no last value" => Refusal::NoLastValue,
            _ => Refusal::NotFinite,
        };
        placed(&self.written, self.line.refuse(why))
    }

    /// An error about characters of a formula of the session, with its place in this line.
    fn place(&self, message: String, text: &str, place: Place) -> Wrong {
        placed(&self.written, self.line.place(text, Error { message, span: span(text, place) }))
    }
}

fn placed(written: &str, error: formula::Error) -> Wrong {
    let (start, end) = characters(written, error.span);
    (error.message, start, end.max(start))
}
