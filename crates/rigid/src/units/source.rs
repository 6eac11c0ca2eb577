//! Source: a formula with quantities replaced by SI numbers, and the map to its text.

use super::{WithinError, quantities};
use std::ops::Range;

/// A formula as it is read, `(0.7853981633974483) e1∧e2` for `45 deg e1∧e2`.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Without units.
    pub text: String,
    /// Where a piece ends in the text that is read, where it stood, and whether it stood there in other words.
    pieces: Vec<(usize, Range<usize>, bool)>,
}

impl Source {
    /// Replaces the quantities of a formula whose other names are those that `is_name` knows.
    ///
    /// # Errors
    /// Where a quantity has no value or two readings.
    pub fn read(written: &str, is_name: impl Fn(&str) -> bool) -> Result<Source, WithinError> {
        let mut source = Source { text: String::new(), pieces: Vec::new() };
        let mut at = 0;
        for quantity in quantities(written, is_name)? {
            source.push(&written[at..quantity.span.start], at..quantity.span.start, false);
            source.push(&format!("({:?})", quantity.value).replace('e', "E"), quantity.span.clone(), true);
            at = quantity.span.end;
        }
        source.push(&written[at..], at..written.len(), false);
        Ok(source)
    }

    fn push(&mut self, piece: &str, from: Range<usize>, reworded: bool) {
        self.text.push_str(piece);
        self.pieces.push((self.text.len(), from, reworded));
    }

    /// The place in the formula as it was written, in bytes.
    pub fn place(&self, span: Range<usize>) -> Range<usize> {
        let written = |at: usize, end: bool| {
            let inside =
                |piece: &&(usize, Range<usize>, bool)| if end { at <= piece.0 } else { at < piece.0 };
            match self.pieces.iter().find(inside) {
                Some((_, from, true)) => {
                    if end {
                        from.end
                    } else {
                        from.start
                    }
                }
                Some((last, from, false)) => from.end.saturating_sub(last - at),
                None => self.pieces.last().map_or(0, |(_, from, _)| from.end),
            }
        };
        let start = written(span.start, false);
        start..written(span.end, true).max(start)
    }
}
