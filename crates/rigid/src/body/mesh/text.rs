//! Lines, words and numbers of the text formats.

use super::error::{self, Place};
use polhode_ga::Vector;

/// The lines of a file, numbered from 1. They end with LF, CR LF, or CR alone in a file without LF.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    (1..).zip(bytes.split(move |&b| b == end).map(|line| line.strip_suffix(b"\r").unwrap_or(line)))
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A word quoted and shortened for a message.
pub(super) fn quoted(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(160)]);
    let short: String = text.chars().take(40).collect();
    let dots = if short.len() < word.len() && text.chars().count() > 40 { "…" } else { "" };
    format!("'{short}{dots}'")
}

/// A word read as a number, which may be infinite or NaN.
pub(super) fn number(word: &[u8], place: Place) -> Result<f64, String> {
    let value = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
    value.ok_or_else(|| place.corrupt(format!("{} is not a number", quoted(word))))
}

/// The position of a vertex, or an error if it is not finite.
pub(super) fn finite(position: [f64; 3], vertex: usize, place: Place) -> Result<Vector, String> {
    error::finite(vertex, Vector(position)).map_err(|message| format!("{place}: {message}"))
}
