//! Errors about lines of text, with places in characters.

use polhode_rigid::Diagnostic;
use pyo3::prelude::*;
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

/// The place in bytes of the character of this number.
pub(crate) fn byte(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(at, _)| at)
}
