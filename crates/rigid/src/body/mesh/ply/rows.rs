//! The rows of a PLY file's elements.

use super::header::{Element, Encoding, Header, Property, Scalar};
use crate::body::mesh::error::{MeshProblem, Place};
use crate::body::mesh::text::{corrupt, lines, number, words};

/// The numbers of one row, column after column.
#[derive(Default)]
pub(super) struct Row {
    numbers: Vec<f64>,
    /// Where each column ends.
    ends: Vec<usize>,
}

impl Row {
    /// The list in a column.
    pub(super) fn list(&self, column: usize) -> &[f64] {
        let start = if column == 0 { 0 } else { self.ends[column - 1] };
        &self.numbers[start..self.ends[column]]
    }

    /// The number in a column that holds one.
    pub(super) fn number(&self, column: usize) -> f64 {
        self.list(column)[0]
    }
}

/// The data after the header, read in order.
pub(super) enum Rows<'a> {
    /// Each line that is not blank is a row.
    Text { lines: Box<dyn Iterator<Item = (usize, &'a [u8])> + 'a>, line: usize },
    /// Rows without separators.
    Binary { bytes: &'a [u8], at: usize, big_endian: bool },
}

impl<'a> Rows<'a> {
    pub(super) fn after(header: &Header, bytes: &'a [u8]) -> Rows<'a> {
        let before = header.lines;
        let binary = |big_endian| Rows::Binary { bytes, at: header.bytes, big_endian };
        match header.encoding {
            Encoding::LittleEndian => binary(false),
            Encoding::BigEndian => binary(true),
            Encoding::Ascii => {
                let rest = lines(&bytes[header.bytes..]).map(move |(line, text)| (before + line, text));
                let filled = rest.filter(|(_, text)| !text.trim_ascii().is_empty());
                Rows::Text { lines: Box::new(filled), line: before }
            }
        }
    }

    /// Reads the rows of an element and gives each with its place to `take`.
    pub(super) fn each(
        &mut self,
        element: &Element,
        mut take: impl FnMut(&Row, Place) -> Result<(), MeshProblem>,
    ) -> Result<(), MeshProblem> {
        if element.properties.is_empty() {
            // Its rows are empty, however many are declared.
            return Ok(());
        }
        let mut row = Row::default();
        for index in 0..element.rows {
            row.numbers.clear();
            row.ends.clear();
            let missing = || {
                let name = String::from_utf8_lossy(&element.name);
                format!("row {index} (counted from 0) of {} of the element '{name}' is missing", element.rows)
            };
            let place = self.row(&element.properties, &mut row, missing)?;
            take(&row, place)?;
        }
        Ok(())
    }

    /// Reads one row and returns its place.
    fn row(
        &mut self,
        properties: &[Property],
        row: &mut Row,
        missing: impl Fn() -> String,
    ) -> Result<Place, MeshProblem> {
        match self {
            Rows::Text { lines, line } => {
                let Some((next, text)) = lines.next() else {
                    return Err(MeshProblem::Truncated { place: Place::Line(*line), what: missing() });
                };
                *line = next;
                text_row(text, Place::Line(next), properties, row)
            }
            Rows::Binary { bytes, at, big_endian } => {
                let place = Place::Byte(*at);
                let mut data = Binary { rest: &bytes[*at..], big_endian: *big_endian };
                let read = binary_row(&mut data, place, properties, row)?;
                *at = bytes.len() - data.rest.len();
                match read {
                    Some(()) => Ok(place),
                    None => Err(MeshProblem::Truncated { place: Place::Byte(bytes.len()), what: missing() }),
                }
            }
        }
    }
}

fn text_row(text: &[u8], place: Place, properties: &[Property], row: &mut Row) -> Result<Place, MeshProblem> {
    let mut words = words(text);
    let mut next = || match words.next() {
        Some(word) => number(word, place),
        None => Err(corrupt(place, "the row has fewer numbers than the element has properties")),
    };
    for property in properties {
        let length = match property.count {
            Some(_) => length(next()?, place)?,
            None => 1,
        };
        for _ in 0..length {
            row.numbers.push(next()?);
        }
        row.ends.push(row.numbers.len());
    }
    match words.next() {
        Some(_) => Err(corrupt(place, "the row has more numbers than the element has properties")),
        None => Ok(place),
    }
}

/// None if the data end.
fn binary_row(
    data: &mut Binary,
    place: Place,
    properties: &[Property],
    row: &mut Row,
) -> Result<Option<()>, MeshProblem> {
    for property in properties {
        let length = match property.count.map(|kind| data.number(kind)) {
            Some(Some(count)) => length(count, place)?,
            Some(None) => return Ok(None),
            None => 1,
        };
        for _ in 0..length {
            let Some(x) = data.number(property.value) else { return Ok(None) };
            row.numbers.push(x);
        }
        row.ends.push(row.numbers.len());
    }
    Ok(Some(()))
}

/// A list's length; the file's size bounds the reading.
fn length(count: f64, place: Place) -> Result<u32, MeshProblem> {
    let length = count as u32;
    if f64::from(length) == count {
        Ok(length)
    } else {
        Err(corrupt(place, format!("invalid list length {count:?}")))
    }
}

struct Binary<'a> {
    rest: &'a [u8],
    big_endian: bool,
}

impl Binary<'_> {
    fn number(&mut self, kind: Scalar) -> Option<f64> {
        let (bytes, rest) = self.rest.split_at_checked(kind.size())?;
        self.rest = rest;
        let mut little = [0; 8];
        little[..bytes.len()].copy_from_slice(bytes);
        if self.big_endian {
            little[..bytes.len()].reverse();
        }
        Some(kind.decode(little))
    }
}
