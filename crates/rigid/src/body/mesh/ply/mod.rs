//! PLY: a header that declares elements and properties, then the rows of each element, as text or in binary.
//!
//! Reads the properties `x`, `y`, `z` of the element `vertex` and the list `vertex_indices` (or `vertex_index`) of the
//! element `face`, and skips the others.

mod header;
mod rows;

use super::error::{MeshProblem, Place};
use super::text::{corrupt, finite};
use super::{Parsed, fan};
use header::{coordinate, corners, header};
use rows::Rows;

pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, MeshProblem> {
    let header = header(bytes)?;
    let mut rows = Rows::after(&header, bytes);
    let total = header.elements.iter().filter(|e| e.name == b"vertex").map(|e| e.rows).sum();
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for element in &header.elements {
        let coordinates = [b"x", b"y", b"z"].map(|name| coordinate(element, name));
        let corners = corners(element);
        rows.each(element, |row, place| {
            match (element.name.as_slice(), coordinates, corners) {
                (b"vertex", [Some(x), Some(y), Some(z)], _) => {
                    let position = [x, y, z].map(|column| row.number(column));
                    vertices.push(finite(position, vertices.len(), place)?);
                }
                (b"face", _, Some(column)) => faces.extend(fan(&polygon(row.list(column), total, place)?)),
                _ => {}
            }
            Ok(())
        })?;
    }
    Ok((vertices, faces))
}

/// The corners of a face, each one of the vertices.
fn polygon(corners: &[f64], vertices: u64, place: Place) -> Result<Vec<u32>, MeshProblem> {
    if corners.len() < 3 {
        return Err(corrupt(place, format!("a face needs at least 3 corners, got {}", corners.len())));
    }
    let index = |&x: &f64| {
        // The cast saturates; an index must survive it unchanged.
        let i = x as u32;
        let exists = f64::from(i) == x && u64::from(i) < vertices;
        exists.then_some(i).ok_or_else(|| {
            let what = format!("vertex {x:?} does not exist: there are {vertices} vertices, numbered from 0");
            corrupt(place, what)
        })
    };
    corners.iter().map(index).collect()
}
