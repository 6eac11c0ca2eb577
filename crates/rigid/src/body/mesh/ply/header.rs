//! The header of a PLY file.

use crate::body::mesh::error::{MeshProblem, Place};
use crate::body::mesh::text::{corrupt, quoted, words};

/// The type of a number.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Scalar> {
        match name {
            b"char" | b"int8" => Some(Scalar::I8),
            b"uchar" | b"uint8" => Some(Scalar::U8),
            b"short" | b"int16" => Some(Scalar::I16),
            b"ushort" | b"uint16" => Some(Scalar::U16),
            b"int" | b"int32" => Some(Scalar::I32),
            b"uint" | b"uint32" => Some(Scalar::U32),
            b"float" | b"float32" => Some(Scalar::F32),
            b"double" | b"float64" => Some(Scalar::F64),
            _ => None,
        }
    }

    pub(super) fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The number in little-endian bytes, as many as its size; the rest is padding.
    pub(super) fn decode(self, b: [u8; 8]) -> f64 {
        let two = [b[0], b[1]];
        let four = [b[0], b[1], b[2], b[3]];
        match self {
            Scalar::I8 => f64::from(i8::from_le_bytes([b[0]])),
            Scalar::U8 => f64::from(b[0]),
            Scalar::I16 => f64::from(i16::from_le_bytes(two)),
            Scalar::U16 => f64::from(u16::from_le_bytes(two)),
            Scalar::I32 => f64::from(i32::from_le_bytes(four)),
            Scalar::U32 => f64::from(u32::from_le_bytes(four)),
            Scalar::F32 => f64::from(f32::from_le_bytes(four)),
            Scalar::F64 => f64::from_le_bytes(b),
        }
    }
}

/// A column of an element: a number, or a list with a count before it.
pub(super) struct Property {
    pub(super) name: Vec<u8>,
    pub(super) count: Option<Scalar>,
    pub(super) value: Scalar,
}

pub(super) struct Element {
    pub(super) name: Vec<u8>,
    pub(super) rows: u64,
    pub(super) properties: Vec<Property>,
}

pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Its length.
    pub(super) lines: usize,
    pub(super) bytes: usize,
}

pub(super) fn header(bytes: &[u8]) -> Result<Header, MeshProblem> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let (mut line, mut read) = (0, 0);
    while let Some(length) = bytes[read..].iter().position(|&b| b == b'\n') {
        let text = bytes[read..read + length].trim_ascii_end();
        read += length + 1;
        line += 1;
        let place = Place::Line(line);
        let statement: Vec<&[u8]> = words(text).collect();
        match statement.as_slice() {
            [b"ply"] if line == 1 => {}
            _ if line == 1 => {
                return Err(corrupt(place, format!("expected 'ply', got {}", quoted(text))));
            }
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", name, ..] => encoding = Some(encoding_named(name, place)?),
            [b"element", name, count] => elements.push(Element {
                name: name.to_vec(),
                rows: rows_of(count, place)?,
                properties: Vec::new(),
            }),
            [b"property", property @ ..] => match elements.last_mut() {
                Some(element) => element.properties.push(property_of(property, place)?),
                None => return Err(corrupt(place, "a property before the first element")),
            },
            [b"end_header"] => {
                let encoding = encoding.ok_or_else(|| corrupt(place, "the header has no line 'format'"))?;
                check_columns(&elements, place)?;
                return Ok(Header { encoding, elements, lines: line, bytes: read });
            }
            _ => return Err(corrupt(place, format!("{} is not a header line", quoted(text)))),
        }
    }
    let what = "the header's 'end_header' is missing".into();
    Err(MeshProblem::Truncated { place: Place::Byte(bytes.len()), what })
}

fn encoding_named(name: &[u8], place: Place) -> Result<Encoding, MeshProblem> {
    match name {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        _ => {
            let formats = "ascii, binary_little_endian, binary_big_endian";
            Err(corrupt(place, format!("unknown format {}, expected one of {formats}", quoted(name))))
        }
    }
}

fn rows_of(count: &[u8], place: Place) -> Result<u64, MeshProblem> {
    let parsed = std::str::from_utf8(count).ok().and_then(|text| text.parse::<u32>().ok());
    let what = || format!("{} is not a number of rows (0 to 4294967295)", quoted(count));
    parsed.map(u64::from).ok_or_else(|| corrupt(place, what()))
}

fn property_of(words: &[&[u8]], place: Place) -> Result<Property, MeshProblem> {
    let scalar = |word: &[u8]| {
        Scalar::named(word).ok_or_else(|| corrupt(place, format!("{} is not a number type", quoted(word))))
    };
    match words {
        [b"list", count, value, name] => {
            let kind = scalar(count)?;
            if matches!(kind, Scalar::F32 | Scalar::F64) {
                return Err(corrupt(place, format!("a list cannot be counted by {}", quoted(count))));
            }
            Ok(Property { name: name.to_vec(), count: Some(kind), value: scalar(value)? })
        }
        [value, name] => Ok(Property { name: name.to_vec(), count: None, value: scalar(value)? }),
        _ => Err(corrupt(place, "expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'")),
    }
}

/// The column of a coordinate among a vertex's properties.
pub(super) fn coordinate(element: &Element, name: &[u8]) -> Option<usize> {
    element.properties.iter().position(|p| p.name == name && p.count.is_none())
}

/// The column of the list of corners among a face's properties.
pub(super) fn corners(element: &Element) -> Option<usize> {
    let wanted = |p: &Property| matches!(p.name.as_slice(), b"vertex_indices" | b"vertex_index");
    element.properties.iter().position(|p| wanted(p) && p.count.is_some())
}

/// Checks that vertices have coordinates, and faces corners.
fn check_columns(elements: &[Element], place: Place) -> Result<(), MeshProblem> {
    for element in elements {
        match element.name.as_slice() {
            b"vertex" => {
                for name in ["x", "y", "z"] {
                    if coordinate(element, name.as_bytes()).is_none() {
                        return Err(corrupt(place, format!("the vertices have no property '{name}'")));
                    }
                }
            }
            b"face" if corners(element).is_none() => {
                return Err(corrupt(place, "the faces have no list property 'vertex_indices'"));
            }
            _ => {}
        }
    }
    Ok(())
}
