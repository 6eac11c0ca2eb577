//! Wavefront OBJ: a line for each vertex (`v x y z`, optionally a weight or a colour) and each polygon
//! (`f 1 2 3`, `f 1/1 2/2 3/3`, `f 1//1 …`, `f 1/1/1 …`).
//!
//! Vertices are numbered from 1, or backwards from −1, the last one so far. A line that ends in `\` continues on the
//! next; `#` begins a comment. Texture, normals, groups and materials are skipped.

use super::error::{MeshProblem, Place};
use super::text::{corrupt, finite, lines, number, quoted, words};
use super::{Parsed, fan};
use polhode_ga::Vector;

pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, MeshProblem> {
    let mut file = File::default();
    // The words of a continued line, and the number of its first line.
    let mut begun: Option<(usize, Vec<&[u8]>)> = None;
    for (line, text) in lines(bytes) {
        let text = text.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii_end();
        let (first, mut statement) = begun.take().unwrap_or((line, Vec::new()));
        match text.strip_suffix(b"\\") {
            Some(text) => {
                statement.extend(words(text));
                begun = Some((first, statement));
            }
            None => {
                statement.extend(words(text));
                file.statement(&statement, first)?;
            }
        }
    }
    if let Some((line, statement)) = begun {
        file.statement(&statement, line)?;
    }
    file.finish()
}

#[derive(Default)]
struct File {
    vertices: Vec<Vector>,
    faces: Vec<[u32; 3]>,
    /// The line of each face, for errors.
    lines: Vec<usize>,
}

impl File {
    fn statement(&mut self, statement: &[&[u8]], line: usize) -> Result<(), MeshProblem> {
        match statement {
            [b"v", coordinates @ ..] => self.vertex(coordinates, line),
            [b"f", corners @ ..] => self.face(corners, line),
            _ => Ok(()),
        }
    }

    fn vertex(&mut self, coordinates: &[&[u8]], line: usize) -> Result<(), MeshProblem> {
        let place = Place::Line(line);
        let numbers = coordinates.iter().map(|word| number(word, place));
        let numbers = numbers.collect::<Result<Vec<f64>, MeshProblem>>()?;
        let &[x, y, z, ..] = numbers.as_slice() else {
            return Err(corrupt(place, format!("a vertex needs 3 coordinates, got {}", numbers.len())));
        };
        self.vertices.push(finite([x, y, z], self.vertices.len(), place)?);
        Ok(())
    }

    fn face(&mut self, corners: &[&[u8]], line: usize) -> Result<(), MeshProblem> {
        if corners.len() < 3 {
            let what = format!("a face needs at least 3 corners, got {}", corners.len());
            return Err(corrupt(Place::Line(line), what));
        }
        let corners = corners.iter().map(|word| self.index(word, line));
        let polygon = corners.collect::<Result<Vec<u32>, MeshProblem>>()?;
        self.faces.extend(fan(&polygon));
        self.lines.resize(self.faces.len(), line);
        Ok(())
    }

    /// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 0.
    fn index(&self, word: &[u8], line: usize) -> Result<u32, MeshProblem> {
        let place = Place::Line(line);
        let integer = |part: &[u8]| std::str::from_utf8(part).ok().and_then(|text| text.parse::<i64>().ok());
        let mut parts = word.split(|&b| b == b'/');
        let vertex = parts.next().and_then(integer);
        let others = parts.clone().count() <= 2 && parts.all(|p| p.is_empty() || integer(p).is_some());
        let Some(vertex) = vertex.filter(|_| others) else {
            let what = format!("{} is not a corner of a face, such as 7, 7/1, 7//1 or 7/1/1", quoted(word));
            return Err(corrupt(place, what));
        };
        let index = match vertex {
            0 => None,
            1.. => vertex.checked_sub(1),
            _ => vertex.checked_add(self.vertices.len() as i64),
        };
        let index = index.and_then(|i| u32::try_from(i).ok());
        index.ok_or_else(|| no_vertex(vertex, self.vertices.len(), line))
    }

    /// Checks indices at the end, because faces may come before their vertices.
    fn finish(self) -> Result<Parsed, MeshProblem> {
        for (face, &line) in self.faces.iter().zip(&self.lines) {
            if let Some(&i) = face.iter().find(|&&i| i as usize >= self.vertices.len()) {
                return Err(no_vertex(i64::from(i) + 1, self.vertices.len(), line));
            }
        }
        Ok((self.vertices, self.faces))
    }
}

fn no_vertex(index: i64, vertices: usize, line: usize) -> MeshProblem {
    let what = format!("vertex {index} does not exist: there are {vertices} vertices, numbered from 1");
    corrupt(Place::Line(line), what)
}
