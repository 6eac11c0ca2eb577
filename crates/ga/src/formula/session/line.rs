//! One line of a session: whether it assigns, the text that is parsed, and where its errors are.

use crate::formula::compile::define::named;
use crate::formula::{Error, Span, canonical};
use std::ops::Range;

/// Finds the quantities in a formula, from left to right: their places, and their values in SI units. A unit that the
/// function knows as a name is ambiguous.
pub type Quantities = fn(&str, &dyn Fn(&str) -> bool) -> Result<Vec<(Range<usize>, f64)>, Error>;

/// How a session reads quantities with units.
#[derive(Clone, Copy)]
pub struct Units {
    /// Finds quantities.
    pub quantities: Quantities,
    /// The unit that a word is or may stand for.
    pub near: fn(&str) -> Option<String>,
}

/// The name under which `_`, the last value, is parsed.
pub const LAST_VALUE: &str = "last_value";

/// The error for `_` before there is a value.
pub const NO_LAST_VALUE: &str = "`_` is the last value; there is none yet";

/// The error for an infinite value or NaN.
pub const NOT_FINITE: &str = "the value is beyond the range of floating point, about 1.8e308";

/// The error for `name = lhs == rhs`.
pub const EQUATION_AS_VALUE: &str = "an equation is not a value that a name can have; compare with `==`";

/// The left side of `a = …` or `V(x) = …`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// As written.
    pub text: String,
    /// The canonical name.
    pub name: String,
    /// The canonical parameters of a function; none of a value.
    pub parameters: Vec<String>,
    place: Range<usize>,
}

/// A line, ready to be parsed.
#[derive(Clone)]
pub struct Line {
    /// Of an assignment or definition; none of a formula.
    pub head: Option<Head>,
    /// Whether the formula uses the last value.
    pub uses_last: bool,
    written: String,
    source: Source,
    /// The formula as written, without the spaces around it.
    body: Range<usize>,
    units: Units,
}

impl Line {
    /// Reads `written[start..]`: an assignment or a formula if `assigns` says so, else either. Units are read in
    /// assignments; `is_name` knows the canonical names that are bound.
    ///
    /// # Errors
    /// If an assignment has no head, a quantity is invalid, or a function uses `_`.
    pub fn read(
        written: &str,
        start: usize,
        assigns: Option<bool>,
        is_name: impl Fn(&str) -> bool,
        units: Units,
    ) -> Result<Line, Error> {
        let (head, begin) = head(written, start, assigns)?;
        let parameters = head.as_ref().map_or(&[][..], |head| &head.parameters);
        let is_name =
            |word: &str| canonical(word).is_some_and(|word| is_name(&word) || parameters.contains(&word));
        let within = |Span { start, end }| span(begin + start..begin + end);
        let quantities = match &head {
            None => Vec::new(),
            Some(_) => (units.quantities)(&written[begin..], &is_name)
                .map_err(|error| Error { span: within(error.span), ..error })?,
        };
        let mut replaced: Vec<(Range<usize>, String)> =
            quantities.into_iter().map(|(at, x)| (begin + at.start..begin + at.end, number(x))).collect();
        let body = trimmed(written, begin..written.len());
        let last = last_values(written, begin);
        let uses_last = !last.is_empty();
        if uses_last && !parameters.is_empty() {
            return Err(Error::new(span(body), "a function cannot use `_`, the last value"));
        }
        replaced.extend(last.into_iter().map(|at| (at..at + 1, LAST_VALUE.to_owned())));
        replaced.sort_by_key(|(place, _)| place.start);
        let source = Source::new(written, begin..written.len(), replaced);
        Ok(Line { head, uses_last, written: written.to_owned(), source, body, units })
    }

    /// The formula as it is parsed: with numbers for quantities and a name for `_`.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// An error about the whole formula.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::new(span(self.body.clone()), message)
    }

    /// An error about a formula of the session, with its place in the line: about [`Line::text`], about the head of the
    /// definition, or about an earlier definition.
    pub fn place(&self, text: &str, error: Error) -> Error {
        let Error { message, span: about } = error;
        if let Some(Head { text: head, name, place, .. }) =
            self.head.as_ref().filter(|head| head.is_function())
        {
            let word = text.get(about.start..about.end).and_then(canonical);
            if word.is_some_and(|word| word == *name) {
                return self.error(format!("`{name}` would call itself; formulas have no recursion"));
            }
            if text == head {
                return Error::new(span(place.clone()), message);
            }
        }
        if text != self.source.text {
            return self.error(format!("{message}, in the definition `{text}`"));
        }
        let Range { start, end } = self.source.place(about.start..about.end);
        // An error after the last word is right after it, not after the spaces that follow.
        let start = start.clamp(self.body.start, self.body.end);
        let place = start..end.clamp(start, self.body.end);
        let hint = self.unit_hint(&message, place.clone()).unwrap_or_default();
        Error::new(span(place), message + &hint)
    }

    /// What to add where a word without a value may be a unit.
    fn unit_hint(&self, message: &str, place: Range<usize>) -> Option<String> {
        let word = &self.written[place.clone()];
        let letters = !word.is_empty() && word.chars().all(char::is_alphabetic);
        let unit = (letters && message.contains("has no value")).then(|| (self.units.near)(word))??;
        let after_number = self.written[..place.start].trim_end().ends_with(char::is_numeric);
        match (unit == word, self.head.is_some()) {
            (true, true) => {
                Some(format!(". The unit `{unit}` stands right after a number, as in `0.5 {unit}`"))
            }
            (true, false) if after_number => {
                Some(format!(". Units are read where a name gets a value, as in `x = 2 {word}`"))
            }
            (false, true) if after_number => Some(format!(". Did you mean the unit `{unit}`?")),
            _ => None,
        }
    }
}

impl Head {
    /// Whether it is that of a function.
    pub fn is_function(&self) -> bool {
        !self.parameters.is_empty()
    }

    /// `a` or `V(x)`; none for anything else. A parameter that occurs twice is an error of the definition.
    fn new(text: &str, place: Range<usize>) -> Option<Head> {
        let (name, parameters) = named(text).or_else(|| Some((canonical(text)?, Vec::new())))?;
        Some(Head { text: text.to_owned(), name, parameters, place })
    }
}

/// The head of `written[start..]` if it assigns, and where the formula begins.
pub(super) fn head(
    written: &str,
    start: usize,
    assigns: Option<bool>,
) -> Result<(Option<Head>, usize), Error> {
    let equals = written[start..].find('=').map(|at| start + at);
    let place = trimmed(written, start..equals.unwrap_or(written.len()));
    let text = &written[place.clone()];
    if let (Some(equals), None | Some(true)) = (equals, assigns)
        && (assigns.is_some() || !written[equals + 1..].starts_with('='))
        && let Some(head) = Head::new(text, place.clone())
    {
        return Ok((Some(head), equals + 1));
    }
    if assigns != Some(true) {
        return Ok((None, start));
    }
    let problem = equals.map_or("expected `name = value`".to_owned(), |_| format!("`{text}` is not a name"));
    let names = "names are letters with subscripts and primes, `Ω_B`, `R'`, or words";
    Err(Error::new(span(place), format!("{problem}; {names}")))
}

/// Where `_` stands alone from `start` on: neither as a subscript, `a_1`, nor before the grade of a part, `⟨M⟩_2`.
fn last_values(line: &str, start: usize) -> Vec<usize> {
    let continues = |c: char| c.is_alphanumeric() || c == '_';
    let ends = |c: char| continues(c) || matches!(c, '\u{300}'..='\u{36f}') || "⟩〉>})]'′’∥⊥".contains(c);
    let alone = |&at: &usize| {
        let after = line[at + 1..].chars().next();
        !line[..at].ends_with(ends) && !after.is_some_and(|c| continues(c) || c == '{')
    };
    line.match_indices('_').map(|(at, _)| at).filter(|&at| at >= start).filter(alone).collect()
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

/// A formula as it is parsed, `(0.7853981633974483) e1∧e2` for `45 deg e1∧e2`.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// The text with its replacements.
    pub text: String,
    /// Of each piece: its end in `text`, its original place, and whether it is a replacement.
    pieces: Vec<(usize, Range<usize>, bool)>,
}

impl Source {
    /// The part `written[part]` with replacements of places in it, from left to right.
    pub fn new(
        written: &str,
        part: Range<usize>,
        replacements: impl IntoIterator<Item = (Range<usize>, String)>,
    ) -> Source {
        let mut source = Source { text: String::new(), pieces: Vec::new() };
        let mut at = part.start;
        for (place, text) in replacements {
            source.push(&written[at..place.start], at..place.start, false);
            at = place.end;
            source.push(&text, place, true);
        }
        source.push(&written[at..part.end], at..part.end, false);
        source
    }

    /// A formula with numbers in SI units for its quantities; `is_name` knows the names that are bound.
    ///
    /// # Errors
    /// If a quantity is invalid or ambiguous.
    pub fn read(written: &str, is_name: impl Fn(&str) -> bool, units: Units) -> Result<Source, Error> {
        let found = (units.quantities)(written, &is_name)?;
        let numbers = found.into_iter().map(|(place, value)| (place, number(value)));
        Ok(Source::new(written, 0..written.len(), numbers))
    }

    fn push(&mut self, piece: &str, place: Range<usize>, replaced: bool) {
        self.text.push_str(piece);
        self.pieces.push((self.text.len(), place, replaced));
    }

    /// The original place of a span of `text`, in bytes.
    pub fn place(&self, span: Range<usize>) -> Range<usize> {
        let written = |at: usize, end: bool| {
            let inside =
                |piece: &&(usize, Range<usize>, bool)| if end { at <= piece.0 } else { at < piece.0 };
            match self.pieces.iter().find(inside) {
                Some((_, place, true)) if end => place.end,
                Some((_, place, true)) => place.start,
                Some((last, place, false)) => place.end.saturating_sub(last - at),
                None => self.pieces.last().map_or(0, |(_, place, _)| place.end),
            }
        };
        let start = written(span.start, false);
        start..written(span.end, true).max(start)
    }
}

/// A number in brackets; `E`, since `e20` is a blade.
fn number(value: f64) -> String {
    format!("({value:?})").replace('e', "E")
}
