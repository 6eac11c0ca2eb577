//! STL: a list of triangles with their corners written out.
//!
//! Binary: an 80-byte header, the number of triangles as a little-endian u32, then 50 bytes for each:
//! twelve f32 (normal and corners) and a 16-bit attribute. Text: `solid`, then for each triangle
//! `facet normal … outer loop vertex … vertex … vertex … endloop endfacet`, then `endsolid`. A binary header may also
//! begin with "solid", but only binary files contain zero bytes. Normals are ignored: they follow from the order of the
//! corners. Corners with equal coordinates become one vertex.

use super::error::Place;
use super::text::{finite, lines, number, quoted, words};
use super::{Parsed, Welder};
use std::array::from_fn;
use std::iter::Peekable;

const HEADER: usize = 84;
const RECORD: usize = 50;

pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, String> {
    if is_solid(bytes) && !bytes.contains(&0) { parse_text(bytes) } else { parse_binary(bytes) }
}

/// Whether the file begins as a text STL.
fn is_solid(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

fn parse_binary(bytes: &[u8]) -> Result<Parsed, String> {
    let end = Place::Byte(bytes.len());
    let Some(&[a, b, c, d]) = bytes.get(HEADER - 4..HEADER) else {
        let what = "neither a text STL nor long enough for the 84-byte header of a binary one";
        return Err(end.truncated(what));
    };
    let count = u32::from_le_bytes([a, b, c, d]);
    let expected = HEADER as u64 + RECORD as u64 * u64::from(count);
    if bytes[..HEADER].iter().all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace()) {
        return Err(match bytes.iter().position(|&b| b == 0) {
            Some(at) if is_solid(bytes) => Place::Byte(at).corrupt("a zero byte in a text STL"),
            _ => {
                let what = "not an STL file: a text STL begins with 'solid', a binary one has zero bytes";
                Place::Byte(0).corrupt(what)
            }
        });
    }
    let what = format!("{count} triangles need {expected} bytes, but there are {}", bytes.len());
    if (bytes.len() as u64) < expected {
        return Err(end.truncated(what));
    }
    if bytes.len() as u64 > expected {
        return Err(Place::Byte(HEADER - 4).corrupt(format!("wrong number of triangles: {what}")));
    }
    let mut welder = Welder::default();
    let mut faces = Vec::new();
    for (record, offset) in bytes[HEADER..].chunks_exact(RECORD).zip((HEADER..).step_by(RECORD)) {
        let mut face = [0; 3];
        for (k, corner) in face.iter_mut().enumerate() {
            let at = 12 + 12 * k;
            let coordinates = from_fn(|i| {
                let bytes = from_fn(|byte| record[at + 4 * i + byte]);
                f64::from(f32::from_le_bytes(bytes))
            });
            let position = finite(coordinates, 3 * faces.len() + k, Place::Byte(offset + at))?;
            *corner = welder.number(position);
        }
        faces.push(face);
    }
    Ok((welder.vertices, faces))
}

fn parse_text(bytes: &[u8]) -> Result<Parsed, String> {
    let each = lines(bytes).flat_map(|(line, text)| words(text).map(move |word| (line, word)));
    let mut words = Words { words: each.peekable(), line: 1, last: lines(bytes).count() };
    let mut welder = Welder::default();
    let mut faces = Vec::new();
    let mut in_solid = false;
    while let Some(word) = words.next() {
        match (word.to_ascii_lowercase().as_slice(), in_solid) {
            (b"solid", false) | (b"endsolid", true) => {
                // The rest of the line is a name.
                words.skip_line();
                in_solid = !in_solid;
            }
            (b"facet", true) => faces.push(facet(&mut words, faces.len(), &mut welder)?),
            (_, true) => return Err(words.unexpected(word, "'facet' or 'endsolid'")),
            (_, false) => return Err(words.unexpected(word, "'solid'")),
        }
    }
    if in_solid { Err(words.truncated("'endsolid'")) } else { Ok((welder.vertices, faces)) }
}

/// The rest of a facet.
fn facet<'a>(
    words: &mut Words<impl Iterator<Item = (usize, &'a [u8])>>,
    index: usize,
    welder: &mut Welder,
) -> Result<[u32; 3], String> {
    words.expect("normal")?;
    for _ in 0..3 {
        words.required("a normal")?;
    }
    words.expect("outer")?;
    words.expect("loop")?;
    let mut face = [0; 3];
    for (k, corner) in face.iter_mut().enumerate() {
        words.expect("vertex")?;
        let mut position = [0.0; 3];
        for x in &mut position {
            let word = words.required("a coordinate")?;
            *x = number(word, words.place())?;
        }
        *corner = welder.number(finite(position, 3 * index + k, words.place())?);
    }
    words.expect("endloop")?;
    words.expect("endfacet")?;
    Ok(face)
}

/// The words of a text with their lines.
struct Words<I: Iterator> {
    words: Peekable<I>,
    /// That of the last word read.
    line: usize,
    /// The number of lines.
    last: usize,
}

impl<'a, I: Iterator<Item = (usize, &'a [u8])>> Words<I> {
    fn next(&mut self) -> Option<&'a [u8]> {
        let (line, word) = self.words.next()?;
        self.line = line;
        Some(word)
    }

    fn skip_line(&mut self) {
        while self.words.next_if(|(line, _)| *line == self.line).is_some() {}
    }

    fn place(&self) -> Place {
        Place::Line(self.line)
    }

    fn required(&mut self, what: &str) -> Result<&'a [u8], String> {
        self.next().ok_or_else(|| self.truncated(what))
    }

    fn expect(&mut self, keyword: &str) -> Result<(), String> {
        let wanted = format!("'{keyword}'");
        let word = self.required(&wanted)?;
        if word.eq_ignore_ascii_case(keyword.as_bytes()) {
            Ok(())
        } else {
            Err(self.unexpected(word, &wanted))
        }
    }

    fn unexpected(&self, word: &[u8], wanted: &str) -> String {
        self.place().corrupt(format!("expected {wanted}, got {}", quoted(word)))
    }

    fn truncated(&self, wanted: &str) -> String {
        Place::Line(self.last).truncated(format!("expected {wanted}"))
    }
}
