//! Errors with a place in a text file, shown the way compilers show them.
//!
//! ```text
//! top.toml:12:1: error: unknown field `durration`, expected `duration`
//!    |
//! 12 | durration = "10 s"
//!    | ^^^^^^^^^
//! ```

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A longer line is cut around the place.
const LINE_SHOWN: usize = 100;
/// Characters of a cut line before the place.
const BEFORE_PLACE: usize = 30;
/// Characters of input that a message quotes.
const QUOTED: usize = 40;

/// One error in one file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file.
    pub path: PathBuf,
    /// Line and column, from 1, the column in characters; none for an error about the whole file.
    pub position: Option<(usize, usize)>,
    /// What is wrong, and what to do.
    pub message: String,
    excerpt: String,
}

impl Diagnostic {
    /// About the bytes `span` of `text`, the content of the file at `path`.
    pub fn at(path: &Path, text: &str, span: Range<usize>, message: impl Into<String>) -> Diagnostic {
        let start = char_boundary(text, span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let number = text[..line_start].matches('\n').count() + 1;
        let span = start - line_start..span.end.saturating_sub(line_start);
        Diagnostic::in_line(path, number, &text[line_start..line_end], span, message)
    }

    /// About the bytes `span` of a line, of this number, of the file at `path`.
    pub fn in_line(
        path: &Path,
        number: usize,
        line: &str,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> Diagnostic {
        let line = line.trim_end_matches('\r');
        let start = char_boundary(line, span.start);
        let end = char_boundary(line, span.end).max(start);
        let before = line[..start].chars().count();
        let marked = line[start..end].chars().count();
        Diagnostic {
            path: path.to_owned(),
            position: Some((number, before + 1)),
            message: message.into(),
            excerpt: excerpt(line, number, before, marked),
        }
    }

    /// About the file as a whole.
    pub fn of_file(path: &Path, message: impl Into<String>) -> Diagnostic {
        Diagnostic { path: path.to_owned(), position: None, message: message.into(), excerpt: String::new() }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some((line, column)) = self.position {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": error: {}{}", self.message, self.excerpt)
    }
}

impl std::error::Error for Diagnostic {}

/// The largest character boundary of `text` that is at most `index`.
fn char_boundary(text: &str, index: usize) -> usize {
    (0..=index.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

/// The line of `text` where the bytes `span` begin, with carets under them: three lines, each after a newline.
pub fn marked(text: &str, span: Range<usize>) -> String {
    Diagnostic::at(Path::new(""), text, span, "").excerpt
}

/// The line with carets under `marked` characters, at least one, after `before` others.
fn excerpt(line: &str, number: usize, before: usize, marked: usize) -> String {
    let length = line.chars().count();
    let first = if length > LINE_SHOWN { before.saturating_sub(BEFORE_PLACE) } else { 0 };
    let shown = (length - first).min(LINE_SHOWN);

    let mut source = String::new();
    let (mut indent, mut carets) = (0, 0);
    if first > 0 {
        source.push('…');
        indent = 1;
    }
    for (i, c) in line.chars().enumerate().skip(first).take(shown) {
        let (glyph, width) = glyph(c);
        source.extend(glyph);
        if i < before {
            indent += width;
        } else if i < before + marked {
            carets += width;
        }
    }
    if first + shown < length {
        source.push('…');
    }
    let gutter = " ".repeat(number.to_string().len());
    let (indent, carets) = (" ".repeat(indent), "^".repeat(carets.max(1)));
    format!("\n{gutter} |\n{number} | {source}\n{gutter} | {indent}{carets}")
}

/// A character as displayed, and its width in terminal columns.
fn glyph(c: char) -> (std::iter::RepeatN<char>, usize) {
    let (shown, count, width) = match c {
        '\t' => (' ', 4, 4),
        // Control characters, also those that reorder text, would move the caret.
        _ if c.is_control() => ('\u{fffd}', 1, 1),
        '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => ('\u{fffd}', 1, 1),
        // Combining marks and variation selectors.
        '\u{300}'..='\u{36f}' | '\u{20d0}'..='\u{20ff}' | '\u{fe00}'..='\u{fe0f}' => (c, 1, 0),
        // East Asian wide characters and emoji.
        '\u{1100}'..='\u{115f}' | '\u{2e80}'..='\u{a4cf}' | '\u{ac00}'..='\u{d7a3}' => (c, 1, 2),
        '\u{f900}'..='\u{faff}' | '\u{fe30}'..='\u{fe6f}' | '\u{ff00}'..='\u{ff60}' => (c, 1, 2),
        '\u{ffe0}'..='\u{ffe6}' | '\u{1f300}'..='\u{1faff}' | '\u{20000}'..='\u{3fffd}' => (c, 1, 2),
        _ => (c, 1, 1),
    };
    (std::iter::repeat_n(shown, count), width)
}

/// Input in backticks for a message: cut when long, control characters escaped.
pub fn quote(text: &str) -> String {
    let cut: String = text.chars().take(QUOTED).flat_map(visible).collect();
    let rest = if text.chars().nth(QUOTED).is_some() { "…" } else { "" };
    format!("`{cut}{rest}`")
}

/// The character, or its escape when it is a control character.
fn visible(c: char) -> impl Iterator<Item = char> {
    let (plain, escaped) = if c.is_control() { (None, Some(c.escape_default())) } else { (Some(c), None) };
    plain.into_iter().chain(escaped.into_iter().flatten())
}

/// `` `a`, `b`, `c` ``.
pub fn list(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

/// `` `a` `` alone, otherwise `` one of `a`, `b`, `c` ``.
pub fn alternatives(names: &[&str]) -> String {
    let several = if names.len() > 1 { "one of " } else { "" };
    several.to_owned() + &list(names)
}

/// The name that `word` probably means: equal up to case, or within one edit per three letters.
pub fn nearest<'n>(word: &str, names: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let letters = word.chars().count();
    if letters > QUOTED {
        return None;
    }
    let lower = word.to_lowercase();
    let distances = names.into_iter().map(|name| (edits(&lower, &name.to_lowercase()), name));
    let (distance, name) = distances.min_by_key(|&(distance, _)| distance)?;
    (distance <= letters / 3).then_some(name)
}

/// Levenshtein's distance: the fewest insertions, deletions and replacements of one character.
///
/// `row[j]` is the distance from the part of `a` read so far to the first j characters of `b`.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests;
