//! Lines of a session in Python.

use super::program::{Place, characters, span};
use polhode_ga::formula::Error;
use polhode_ga::formula::session::Line;
use polhode_rigid::units::UNITS;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::HashSet;

/// An error and its place in the line, in characters.
type PlacedError = (String, usize, usize);

/// A line of a session, read from character `start` on.
#[pyclass(frozen, name = "Line", module = "polhode._native")]
pub(crate) struct SessionLine {
    written: String,
    line: Line,
    /// The name that gets a value or becomes a function; None for a formula.
    #[pyo3(get)]
    name: Option<String>,
    /// The head of a function, `V(x)`; None where none is defined.
    #[pyo3(get)]
    function: Option<String>,
    /// The formula as it is parsed: with numbers for quantities and `last_value` for `_`.
    #[pyo3(get)]
    text: String,
    /// Whether the formula uses the last value.
    #[pyo3(get)]
    uses_last: bool,
}

#[pymethods]
impl SessionLine {
    /// Reads an assignment or a formula if `assigns` says so, else either. The arguments of a ValueError are the message
    /// and its place.
    #[new]
    fn new(
        written: String,
        start: usize,
        assigns: Option<bool>,
        names: HashSet<String>,
    ) -> PyResult<SessionLine> {
        let start = span(&written, (start, start)).start;
        let line = Line::read(&written, start, assigns, |name| names.contains(name), UNITS)
            .map_err(|error| PyValueError::new_err(placed(&written, error)))?;
        let head = line.head.as_ref();
        let name = head.map(|head| head.name.clone());
        let function = head.filter(|head| head.is_function()).map(|head| head.text.clone());
        let (text, uses_last) = (line.text().to_owned(), line.uses_last);
        Ok(SessionLine { written, line, name, function, text, uses_last })
    }

    /// An error about the whole formula.
    fn error(&self, message: String) -> PlacedError {
        placed(&self.written, self.line.error(message))
    }

    /// An error about characters of a formula of the session, with its place in this line.
    fn place(&self, message: String, text: &str, place: Place) -> PlacedError {
        placed(&self.written, self.line.place(text, Error { message, span: span(text, place) }))
    }
}

fn placed(written: &str, error: Error) -> PlacedError {
    let (start, end) = characters(written, error.span);
    (error.message, start, end.max(start))
}
