//! Lines of text that people write to the command: places in them, and quantities with units.

use polhode_rigid::{Diagnostic, units};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::HashSet;
use std::path::Path;

/// An error as compilers show it, about characters of a line of some source.
#[pyfunction]
pub(crate) fn diagnostic(
    source: &str,
    number: usize,
    line: &str,
    start: usize,
    end: usize,
    message: &str,
) -> String {
    let span = byte(line, start)..byte(line, end);
    Diagnostic::in_line(Path::new(source), number, line, span, message).to_string()
}

/// The unit that a word is, or may stand for.
#[pyfunction]
pub(crate) fn near_unit(word: &str) -> Option<String> {
    units::near(word)
}

/// The quantities in a formula, each with where it starts and ends in characters and its value in SI units.
///
/// A ValueError's arguments are the message, and where the mistake starts and ends.
#[pyfunction]
pub(crate) fn quantities(text: &str, names: HashSet<String>) -> PyResult<Vec<(usize, usize, f64)>> {
    let mut place = (0, 0);
    // Places come in rising order, so that the text is counted through once.
    let mut character = |at: usize| {
        place = (at, place.1 + text[place.0..at].chars().count());
        place.1
    };
    match units::quantities(text, |name| names.contains(name)) {
        Ok(found) => {
            Ok(found.iter().map(|q| (character(q.span.start), character(q.span.end), q.value)).collect())
        }
        Err(units::WithinError { message, span }) => {
            Err(PyValueError::new_err((message, character(span.start), character(span.end))))
        }
    }
}

/// The place in bytes of the character of this number.
pub(crate) fn byte(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(at, _)| at)
}
