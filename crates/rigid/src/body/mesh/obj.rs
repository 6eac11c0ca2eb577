//! Wavefront OBJ: a line for each vertex (`v x y z`, optionally a weight or a colour) and each polygon
//! (`f 1 2 3`, `f 1/1 2/2 3/3`, `f 1//1 …`, `f 1/1/1 …`).
//!
//! Vertices are numbered from 1, or backwards from −1, the last one so far. A line that ends in `\` continues on the
//! next; `#` begins a comment. Texture, normals, groups and materials are skipped.

use super::error::Place;
use super::text::{finite, lines, number, quoted, words};
use super::{Parsed, fan};
use polhode_ga::Vector;

pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, String> {
    let mut file = File::default();
    // The words of a continued line, and the number of its first line.
    let mut begun: Option<(usize, Vec<&[u8]>)> = None;
    for (line, text) in lines(bytes) {
        let text = text.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii_end();
        let continued = text.strip_suffix(b"\\");
        let (first, mut statement) = begun.take().unwrap_or((line, Vec::new()));
        statement.extend(words(continued.unwrap_or(text)));
        match continued {
            Some(_) => begun = Some((first, statement)),
            None => file.statement(&statement, first)?,
        }
    }
    if let Some((line, statement)) = begun {
        file.statement(&statement, line)?;
    }
    if let (true, Some((line, word))) = (file.vertices.is_empty() && file.faces.is_empty(), &file.skipped) {
        let what =
            format!("{word} begins neither a vertex, `v x y z`, nor a face, `f 1 2 3`, and no line does");
        return Err(Place::Line(*line).corrupt(what));
    }
    // Faces may come before their vertices.
    for (face, &line) in file.faces.iter().zip(&file.lines) {
        if let Some(&i) = face.iter().find(|&&i| i as usize >= file.vertices.len()) {
            return Err(file.no_vertex(i64::from(i) + 1, Place::Line(line)));
        }
    }
    Ok((file.vertices, file.faces))
}

#[derive(Default)]
struct File {
    vertices: Vec<Vector>,
    faces: Vec<[u32; 3]>,
    /// The line of each face, for errors.
    lines: Vec<usize>,
    /// The first other statement: its line and its first word.
    skipped: Option<(usize, String)>,
}

impl File {
    fn statement(&mut self, statement: &[&[u8]], line: usize) -> Result<(), String> {
        let place = Place::Line(line);
        match statement {
            [b"v", coordinates @ ..] => {
                let numbers = coordinates.iter().map(|word| number(word, place));
                let numbers = numbers.collect::<Result<Vec<f64>, String>>()?;
                let &[x, y, z, ..] = numbers.as_slice() else {
                    return Err(place.corrupt(format!("a vertex needs 3 coordinates, got {}", numbers.len())));
                };
                self.vertices.push(finite([x, y, z], self.vertices.len(), place)?);
            }
            [b"f", corners @ ..] => {
                let corners = corners.iter().map(|word| self.index(word, place));
                self.faces.extend(fan(corners, place)?);
                self.lines.resize(self.faces.len(), line);
            }
            [word, ..] if self.skipped.is_none() => self.skipped = Some((line, quoted(word))),
            _ => {}
        }
        Ok(())
    }

    /// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 0.
    fn index(&self, word: &[u8], place: Place) -> Result<u32, String> {
        let integer = |part: &[u8]| std::str::from_utf8(part).ok().and_then(|text| text.parse::<i64>().ok());
        let mut parts = word.split(|&b| b == b'/');
        let vertex = parts.next().and_then(integer);
        let others = parts.clone().count() <= 2 && parts.all(|p| p.is_empty() || integer(p).is_some());
        let Some(vertex) = vertex.filter(|_| others) else {
            let what = format!("{} is not a corner of a face, such as 7, 7/1, 7//1 or 7/1/1", quoted(word));
            return Err(place.corrupt(what));
        };
        let index = match vertex {
            0 => None,
            1.. => vertex.checked_sub(1),
            _ => vertex.checked_add(self.vertices.len() as i64),
        };
        let index = index.and_then(|i| u32::try_from(i).ok());
        index.ok_or_else(|| self.no_vertex(vertex, place))
    }

    fn no_vertex(&self, index: i64, place: Place) -> String {
        let count = self.vertices.len();
        place.corrupt(format!("vertex {index} does not exist: there are {count} vertices, numbered from 1"))
    }
}
