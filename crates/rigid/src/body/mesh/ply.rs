//! PLY: a header that declares elements and properties, then the rows of each element, as text or in binary.
//!
//! Reads the properties `x`, `y`, `z` of the element `vertex` and the list `vertex_indices` (or `vertex_index`) of the
//! element `face`, and skips the others.

use super::error::Place;
use super::text::{finite, lines, number, quoted, words};
use super::{Parsed, fan};
use std::array::from_fn;

pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, String> {
    let (elements, mut data) = header(bytes)?;
    let total = elements.iter().filter(|e| e.name == b"vertex").map(|e| e.rows).sum();
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let mut row = Row::default();
    // Rows without properties are empty, however many are declared.
    for element in elements.iter().filter(|e| !e.properties.is_empty()) {
        let (coordinates, corners) = (element.coordinates(), element.corners());
        for index in 0..element.rows {
            let place = data.read(element, index, &mut row)?;
            match (element.name, coordinates, corners) {
                (b"vertex", [Some(x), Some(y), Some(z)], _) => {
                    let position = [x, y, z].map(|column| row.list(column)[0]);
                    vertices.push(finite(position, vertices.len(), place)?);
                }
                (b"face", _, Some(column)) => {
                    let corners = row.list(column).iter().map(|&x| vertex_index(x, total, place));
                    faces.extend(fan(corners, place)?);
                }
                _ => {}
            }
        }
    }
    Ok((vertices, faces))
}

/// The index of one of the vertices.
fn vertex_index(x: f64, vertices: u64, place: Place) -> Result<u32, String> {
    // The cast saturates; an index must survive it unchanged.
    let i = x as u32;
    let exists = f64::from(i) == x && u64::from(i) < vertices;
    exists.then_some(i).ok_or_else(|| {
        place.corrupt(format!("vertex {x} does not exist: there are {vertices} vertices, numbered from 0"))
    })
}

/// The type of a number.
#[derive(Clone, Copy)]
struct Scalar {
    size: usize,
    /// From little-endian bytes, of which those beyond the size are ignored.
    decode: fn([u8; 8]) -> f64,
}

impl Scalar {
    fn named(name: &[u8], place: Place) -> Result<Scalar, String> {
        macro_rules! scalar {
            ($type:ty) => {
                Ok(Scalar {
                    size: size_of::<$type>(),
                    decode: |bytes| <$type>::from_le_bytes(from_fn(|k| bytes[k])).into(),
                })
            };
        }
        match name {
            b"char" | b"int8" => scalar!(i8),
            b"uchar" | b"uint8" => scalar!(u8),
            b"short" | b"int16" => scalar!(i16),
            b"ushort" | b"uint16" => scalar!(u16),
            b"int" | b"int32" => scalar!(i32),
            b"uint" | b"uint32" => scalar!(u32),
            b"float" | b"float32" => scalar!(f32),
            b"double" | b"float64" => scalar!(f64),
            _ => Err(place.corrupt(format!("{} is not a number type", quoted(name)))),
        }
    }
}

/// A column of an element: a number, or a list with a count before it.
struct Property<'a> {
    name: &'a [u8],
    count: Option<Scalar>,
    value: Scalar,
}

struct Element<'a> {
    name: &'a [u8],
    rows: u64,
    properties: Vec<Property<'a>>,
}

impl Element<'_> {
    /// The columns of a vertex's coordinates.
    fn coordinates(&self) -> [Option<usize>; 3] {
        [b"x", b"y", b"z"]
            .map(|name| self.properties.iter().position(|p| p.name == name && p.count.is_none()))
    }

    /// The column of the list of a face's corners.
    fn corners(&self) -> Option<usize> {
        let wanted = |p: &Property| matches!(p.name, b"vertex_indices" | b"vertex_index");
        self.properties.iter().position(|p| wanted(p) && p.count.is_some())
    }

    /// Checks that vertices have coordinates, and faces corners.
    fn check(&self, place: Place) -> Result<(), String> {
        let missing = self.coordinates().iter().position(Option::is_none);
        match (self.name, missing) {
            (b"vertex", Some(k)) => {
                Err(place.corrupt(format!("the vertices have no property '{}'", ["x", "y", "z"][k])))
            }
            (b"face", _) if self.corners().is_none() => {
                Err(place.corrupt("the faces have no list property 'vertex_indices'"))
            }
            _ => Ok(()),
        }
    }
}

enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

fn header(bytes: &[u8]) -> Result<(Vec<Element<'_>>, Data<'_>), String> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let (mut line, mut rest) = (0, bytes);
    while let Some(length) = rest.iter().position(|&b| b == b'\n') {
        let text = rest[..length].trim_ascii_end();
        rest = &rest[length + 1..];
        line += 1;
        let place = Place::Line(line);
        let statement: Vec<&[u8]> = words(text).collect();
        match statement.as_slice() {
            [b"ply"] if line == 1 => {}
            _ if line == 1 => return Err(place.corrupt(format!("expected 'ply', got {}", quoted(text)))),
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", name, ..] => encoding = Some(encoding_named(name, place)?),
            &[b"element", name, count] => {
                elements.push(Element { name, rows: rows_of(count, place)?, properties: Vec::new() });
            }
            [b"property", property @ ..] => match elements.last_mut() {
                Some(element) => element.properties.push(property_of(property, place)?),
                None => return Err(place.corrupt("a property before the first element")),
            },
            [b"end_header"] => {
                let encoding = encoding.ok_or_else(|| place.corrupt("the header has no line 'format'"))?;
                elements.iter().try_for_each(|element| element.check(place))?;
                return Ok((elements, Data::new(encoding, bytes.len(), line, rest)));
            }
            _ => return Err(place.corrupt(format!("{} is not a header line", quoted(text)))),
        }
    }
    Err(Place::Byte(bytes.len()).truncated("the header's 'end_header' is missing"))
}

fn encoding_named(name: &[u8], place: Place) -> Result<Encoding, String> {
    match name {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        _ => {
            let formats = "ascii, binary_little_endian, binary_big_endian";
            Err(place.corrupt(format!("unknown format {}, expected one of {formats}", quoted(name))))
        }
    }
}

fn rows_of(count: &[u8], place: Place) -> Result<u64, String> {
    let parsed = std::str::from_utf8(count).ok().and_then(|text| text.parse::<u32>().ok());
    let what = || format!("{} is not a number of rows (0 to 4294967295)", quoted(count));
    parsed.map(u64::from).ok_or_else(|| place.corrupt(what()))
}

fn property_of<'a>(words: &[&'a [u8]], place: Place) -> Result<Property<'a>, String> {
    match *words {
        [b"list", count @ (b"float" | b"float32" | b"double" | b"float64"), _, _] => {
            Err(place.corrupt(format!("a list cannot be counted by {}", quoted(count))))
        }
        [b"list", count, value, name] => {
            let count = Some(Scalar::named(count, place)?);
            Ok(Property { name, count, value: Scalar::named(value, place)? })
        }
        [value, name] => Ok(Property { name, count: None, value: Scalar::named(value, place)? }),
        _ => Err(place.corrupt("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'")),
    }
}

/// The numbers of one row, column after column.
#[derive(Default)]
struct Row {
    numbers: Vec<f64>,
    /// Where each column ends.
    ends: Vec<usize>,
}

impl Row {
    /// The list in a column, or its single number.
    fn list(&self, column: usize) -> &[f64] {
        let start = if column == 0 { 0 } else { self.ends[column - 1] };
        &self.numbers[start..self.ends[column]]
    }

    /// Reads the properties one number after another.
    fn read(
        &mut self,
        properties: &[Property],
        place: Place,
        mut next: impl FnMut(Scalar) -> Result<f64, String>,
    ) -> Result<(), String> {
        self.numbers.clear();
        self.ends.clear();
        for property in properties {
            let count = property.count.map_or(Ok(1.0), &mut next)?;
            // The file's size bounds the reading.
            let length = count as u32;
            if f64::from(length) != count {
                return Err(place.corrupt(format!("invalid list length {count:?}")));
            }
            for _ in 0..length {
                self.numbers.push(next(property.value)?);
            }
            self.ends.push(self.numbers.len());
        }
        Ok(())
    }
}

/// The data after the header, read in order.
enum Data<'a> {
    /// Each line that is not blank is a row.
    Text { lines: Box<dyn Iterator<Item = (usize, &'a [u8])> + 'a>, line: usize },
    /// Rows without separators, in a file of this many bytes.
    Binary { rest: &'a [u8], end: usize, big_endian: bool },
}

impl<'a> Data<'a> {
    fn new(encoding: Encoding, end: usize, line: usize, rest: &'a [u8]) -> Data<'a> {
        match encoding {
            Encoding::LittleEndian => Data::Binary { rest, end, big_endian: false },
            Encoding::BigEndian => Data::Binary { rest, end, big_endian: true },
            Encoding::Ascii => {
                let rows = lines(rest).filter(|(_, text)| !text.trim_ascii().is_empty());
                Data::Text { lines: Box::new(rows.map(move |(after, text)| (line + after, text))), line }
            }
        }
    }

    /// Reads a row of an element and returns its place.
    fn read(&mut self, element: &Element, index: u64, row: &mut Row) -> Result<Place, String> {
        let missing = |end: Place| {
            let (name, rows) = (String::from_utf8_lossy(element.name), element.rows);
            end.truncated(format!(
                "row {index} (counted from 0) of {rows} of the element '{name}' is missing"
            ))
        };
        match self {
            Data::Text { lines, line } => {
                let (next, text) = lines.next().ok_or_else(|| missing(Place::Line(*line)))?;
                *line = next;
                let (place, mut words) = (Place::Line(next), words(text));
                row.read(&element.properties, place, |_| match words.next() {
                    Some(word) => number(word, place),
                    None => Err(place.corrupt("the row has fewer numbers than the element has properties")),
                })?;
                match words.next() {
                    Some(_) => Err(place.corrupt("the row has more numbers than the element has properties")),
                    None => Ok(place),
                }
            }
            Data::Binary { rest, end, big_endian } => {
                let place = Place::Byte(*end - rest.len());
                row.read(&element.properties, place, |kind| {
                    let (bytes, after) =
                        rest.split_at_checked(kind.size).ok_or_else(|| missing(Place::Byte(*end)))?;
                    *rest = after;
                    let mut little = [0; 8];
                    little[..kind.size].copy_from_slice(bytes);
                    if *big_endian {
                        little[..kind.size].reverse();
                    }
                    Ok((kind.decode)(little))
                })?;
                Ok(place)
            }
        }
    }
}
