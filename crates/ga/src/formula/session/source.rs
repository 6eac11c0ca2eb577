//! Text of which pieces are replaced before it is parsed, with the original place of each piece.

use crate::formula::Error;
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
pub(super) fn number(value: f64) -> String {
    format!("({value:?})").replace('e', "E")
}
