//! One line of a session: whether it assigns, what is parsed, and where its errors are.

use super::source::{Source, number};
use crate::formula::{Error, Span, canonical, heading};
use std::ops::Range;

/// The name under which `_`, the last value, is parsed.
pub const LAST_VALUE: &str = "last_value";

/// How a session reads quantities with units.
#[derive(Clone, Copy)]
pub struct Units {
    /// The quantities in a formula with their values in SI units, from left to right; a unit that `is_name` knows is
    /// ambiguous.
    pub quantities: fn(&str, is_name: &dyn Fn(&str) -> bool) -> Result<Vec<(Range<usize>, f64)>, Error>,
    /// The unit that a word is or may stand for.
    pub near: fn(&str) -> Option<String>,
}

/// What a line may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// An assignment if it looks like one, else a formula.
    Any,
    /// An assignment.
    Assignment,
    /// A formula or an equation.
    Formula,
}

/// What a line does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Statement {
    /// Evaluates a formula, or compares the sides of an equation.
    Evaluate,
    /// Gives a value to a canonical name.
    Assign {
        /// As written.
        head: String,
        /// Canonical.
        name: String,
    },
    /// Defines a function.
    Define {
        /// As written, `V(x)`.
        head: String,
        /// Canonical.
        name: String,
        /// Canonical.
        parameters: Vec<String>,
    },
}

/// Why a line has no outcome although its formula is well formed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// A name cannot have an equation as its value.
    EquationAsValue,
    /// `_` before there is a value.
    NoLastValue,
    /// The value is infinite or NaN.
    NotFinite,
    /// A function calls itself.
    Recursion,
}

/// A line, ready to be parsed.
#[derive(Clone)]
pub struct Line {
    /// What it does.
    pub statement: Statement,
    /// Whether the formula uses the last value.
    pub uses_last: bool,
    written: String,
    source: Source,
    /// The formula as written, without the spaces around it.
    body: Range<usize>,
    head: Range<usize>,
    units: Units,
}

impl Line {
    /// Reads `written[start..]`. Units are read in assignments; `is_name` knows the canonical names that are bound.
    ///
    /// # Errors
    /// If an assignment is expected and the head is not a name or function, or a quantity is invalid.
    pub fn read(
        written: &str,
        start: usize,
        expected: Expected,
        is_name: impl Fn(&str) -> bool,
        units: Units,
    ) -> Result<Line, Error> {
        let (statement, head, begin) = statement(written, start, expected)?;
        let parameters = match &statement {
            Statement::Define { parameters, .. } => &parameters[..],
            _ => &[],
        };
        let is_name =
            |word: &str| canonical(word).is_some_and(|word| is_name(&word) || parameters.contains(&word));
        let quantities = match &statement {
            Statement::Evaluate => Vec::new(),
            _ => (units.quantities)(&written[begin..], &is_name).map_err(|error| Error {
                span: Span { start: begin + error.span.start, end: begin + error.span.end },
                ..error
            })?,
        };
        let place = |place: Range<usize>| begin + place.start..begin + place.end;
        let mut replaced: Vec<(Range<usize>, String)> =
            quantities.into_iter().map(|(at, value)| (place(at), number(value))).collect();
        let last = last_values(written, begin);
        let body = trimmed(written, begin..written.len());
        let uses_last = !last.is_empty();
        if uses_last && matches!(statement, Statement::Define { .. }) {
            let message = "a function cannot use `_`, the last value".to_owned();
            return Err(Error { message, span: span(body) });
        }
        replaced.extend(last.into_iter().map(|at| (at..at + 1, LAST_VALUE.to_owned())));
        replaced.sort_by_key(|(place, _)| place.start);
        let source = Source::new(written, begin..written.len(), replaced);
        Ok(Line { statement, uses_last, written: written.to_owned(), source, body, head, units })
    }

    /// The formula as it is parsed: with numbers for quantities and a name for `_`.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// An error about the whole formula.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error { message: message.into(), span: span(self.body.clone()) }
    }

    /// The error for a formula without an outcome.
    pub fn refuse(&self, why: Refusal) -> Error {
        let (head, name) = match &self.statement {
            Statement::Evaluate => ("", ""),
            Statement::Assign { head, name } | Statement::Define { head, name, .. } => (&head[..], &name[..]),
        };
        self.error(match why {
            Refusal::EquationAsValue => {
                format!("`{head}` cannot have an equation as its value; compare with `==`")
            }
            Refusal::NoLastValue => "`_` is the last value; there is none yet".to_owned(),
            Refusal::NotFinite => "the value is beyond the range of floating point, about 1.8e308".to_owned(),
            Refusal::Recursion => format!("`{name}` would call itself; formulas have no recursion"),
        })
    }

    /// An error about a formula of the session, with its place in the line: about [`Line::text`], about the head of the
    /// definition, or about an earlier definition.
    pub fn place(&self, text: &str, error: Error) -> Error {
        let about = error.span;
        if let Statement::Define { head, name, .. } = &self.statement {
            let word = text.get(about.start..about.end).and_then(canonical);
            if word.is_some_and(|word| word == *name) {
                return self.refuse(Refusal::Recursion);
            }
            if text == head {
                return Error { message: error.message, span: span(self.head.clone()) };
            }
        }
        if text != self.source.text {
            return self.error(format!("{}, in the definition `{text}`", error.message));
        }
        let Range { start, end } = self.source.place(about.start..about.end);
        // What is missing after the last word is missing right after it, not after the spaces that follow.
        let start = start.clamp(self.body.start, self.body.end);
        let place = start..end.clamp(start, self.body.end);
        let hint = self.unit_hint(&error.message, place.clone());
        Error { message: error.message + &hint, span: span(place) }
    }

    /// What to add where a word without a value may be a unit.
    fn unit_hint(&self, message: &str, place: Range<usize>) -> String {
        let word = &self.written[place.clone()];
        let letters = !word.is_empty() && word.chars().all(char::is_alphabetic);
        let Some(unit) =
            (letters && message.contains("has no value")).then(|| (self.units.near)(word)).flatten()
        else {
            return String::new();
        };
        let reads_units = self.statement != Statement::Evaluate;
        let after_number = self.written[..place.start].trim_end().ends_with(char::is_numeric);
        match (unit == word, reads_units) {
            (true, true) => format!(". The unit `{unit}` stands right after a number, as in `0.5 {unit}`"),
            (true, false) if after_number => {
                format!(". Units are read where a name gets a value, as in `x = 2 {word}`")
            }
            (false, true) if after_number => format!(". Is the unit `{unit}` meant?"),
            _ => String::new(),
        }
    }
}

/// What `written[start..]` does, its head, and where the formula begins.
pub(super) fn statement(
    written: &str,
    start: usize,
    expected: Expected,
) -> Result<(Statement, Range<usize>, usize), Error> {
    let equals = written[start..].find('=').map(|at| start + at);
    let head = trimmed(written, start..equals.unwrap_or(written.len()));
    if let (Some(equals), true) = (equals, expected != Expected::Formula)
        && (expected == Expected::Assignment || !written[equals + 1..].starts_with('='))
        && let Some(statement) = assigned(&written[head.clone()])
    {
        return Ok((statement, head, equals + 1));
    }
    if expected != Expected::Assignment {
        return Ok((Statement::Evaluate, head, start));
    }
    let problem = match equals {
        Some(_) => format!("`{}` is not a name", &written[head.clone()]),
        None => "expected `name = value`".to_owned(),
    };
    let message = format!("{problem}; names are letters with subscripts and primes, `Ω_B`, `R'`, or words");
    Err(Error { message, span: span(head) })
}

/// What `head = …` does; `None` if the head is neither a name nor a function of names.
fn assigned(head: &str) -> Option<Statement> {
    let written = head.to_owned();
    if let Ok((name, parameters)) = heading(head) {
        return Some(match parameters.is_empty() {
            true => Statement::Assign { head: written, name },
            false => Statement::Define { head: written, name, parameters },
        });
    }
    // A parameter that occurs twice is an error of the definition.
    if let Some((name, parameters)) = head.strip_suffix(')').and_then(|head| head.split_once('('))
        && let Some(name) = canonical(name)
        && let Some(parameters) = parameters.split(',').map(canonical).collect()
    {
        return Some(Statement::Define { head: written, name, parameters });
    }
    canonical(head).map(|name| Statement::Assign { head: written, name })
}

/// Where `_` stands alone from `start` on: neither as a subscript, `a_1`, nor before the grade of a part, `⟨M⟩_2`.
fn last_values(line: &str, start: usize) -> Vec<usize> {
    let continues = |c: char| c.is_alphanumeric() || c == '_';
    let ends = |c: char| continues(c) || matches!(c, '\u{300}'..='\u{36f}') || "⟩〉>})]'′’∥⊥".contains(c);
    let alone = |&(at, _): &(usize, &str)| {
        let before = line[..at].chars().next_back();
        let after = line[at + 1..].chars().next();
        !before.is_some_and(ends) && !after.is_some_and(|c| continues(c) || c == '{')
    };
    let found = line.match_indices('_').filter(|(at, _)| *at >= start);
    found.filter(alone).map(|(at, _)| at).collect()
}

fn span(place: Range<usize>) -> Span {
    Span { start: place.start, end: place.end }
}

/// A place without the spaces around it.
fn trimmed(line: &str, place: Range<usize>) -> Range<usize> {
    let text = &line[place.clone()];
    let start = place.end - text.trim_start().len();
    start..start.max(place.start + text.trim_end().len())
}
