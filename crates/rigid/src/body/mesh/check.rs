//! Checks that a mesh encloses a volume.
//!
//! Its boundary must vanish: triangles traverse every edge equally often in both directions. Usually two triangles
//! share an edge; two bodies that touch along an edge have four. Vertices with equal coordinates are the same vertex,
//! so texture seams are closed.

use super::TriangleMesh;
use super::error::{finite, point};
use super::integrals::Integrals;
use polhode_ga::Vector;
use std::array::from_fn;
use std::collections::HashMap;

/// Extents in this range keep fifth powers of lengths, down to 1e-10 of the extent, in range.
const EXTENTS: std::ops::RangeInclusive<f64> = 1e-50..=1e50;

/// Checks the number of vertices, that they are finite, and the indices.
pub(super) fn numbers(vertices: &[Vector], faces: &[[u32; 3]]) -> Result<(), String> {
    let count = vertices.len().max(faces.len());
    if u32::try_from(count).is_err() {
        return Err(format!(
            "{count} vertices or triangles exceed the limit of 4294967295; simplify the mesh"
        ));
    }
    for (vertex, &position) in vertices.iter().enumerate() {
        finite(vertex, position)?;
    }
    for (triangle, face) in faces.iter().enumerate() {
        if let Some(&index) = face.iter().find(|&&i| i as usize >= vertices.len()) {
            return Err(format!(
                "triangle {triangle} (counted from 0) refers to vertex {index}, but there are {} vertices, counted from 0; correct the index",
                vertices.len()
            ));
        }
    }
    Ok(())
}

/// The bounding box of the triangles; unused vertices do not count.
fn bounds(mesh: &TriangleMesh) -> Option<(Vector, Vector)> {
    let mut corners = mesh.faces.iter().flatten().map(|&i| mesh.vertices[i as usize]);
    let first = corners.next()?;
    Some(corners.fold((first, first), |(least, greatest), x| {
        let least = Vector(from_fn(|i| least.0[i].min(x.0[i])));
        (least, Vector(from_fn(|i| greatest.0[i].max(x.0[i]))))
    }))
}

/// The middle of the bounding box.
pub(super) fn middle(mesh: &TriangleMesh) -> Vector {
    bounds(mesh).map_or(Vector::default(), |(least, greatest)| least * 0.5 + greatest * 0.5)
}

pub(super) fn no_triangles() -> String {
    "the mesh has no triangles; a body needs a closed surface".to_owned()
}

/// Checks that there are triangles, of a supported extent.
pub(super) fn size(mesh: &TriangleMesh) -> Result<(), String> {
    let (least, greatest) = bounds(mesh).ok_or_else(no_triangles)?;
    let extent = (greatest - least).norm();
    // A mesh in a single point passes here and is reported as degenerate.
    if extent == 0.0 || EXTENTS.contains(&extent) {
        return Ok(());
    }
    Err(format!(
        "the mesh extends over {extent:?} m, outside the supported range of 1e-50 to 1e50 m; check the unit"
    ))
}

/// Checks that every triangle has an area.
pub(super) fn triangles(mesh: &TriangleMesh) -> Result<(), String> {
    let corners = |face: &[u32; 3]| face.map(|i| mesh.vertices[i as usize]);
    let mut flat = mesh.faces.iter().map(corners).enumerate().filter(|(_, c)| is_flat(*c));
    let Some((triangle, corners)) = flat.next() else { return Ok(()) };
    let count = 1 + flat.count();
    Err(format!(
        "{}, the first is triangle {triangle} (counted from 0) with corners {}, which has no area; remove {}",
        counted(count, "degenerate triangle"),
        corners.map(point).join(", "),
        if count == 1 { "it" } else { "them" },
    ))
}

/// Whether the corners coincide or are collinear. Each component of the cross product of two edges is a difference of
/// two products of rounded differences, off by at most 4 half-ulps of the products.
fn is_flat([a, b, c]: [Vector; 3]) -> bool {
    let (u, v) = ((b - a).0, (c - a).0);
    (0..3).all(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (plus, minus) = (u[j] * v[k], u[k] * v[j]);
        (plus - minus).abs() <= 2.0 * f64::EPSILON * (plus.abs() + minus.abs())
    })
}

/// Checks that no triangle is repeated with the same orientation. (Bodies that touch share triangles of opposite
/// orientation.)
pub(super) fn repetitions(welded: &[[u32; 3]]) -> Result<(), String> {
    let mut seen = HashMap::with_capacity(welded.len());
    let copies = welded.iter().enumerate().filter_map(|(triangle, &face)| {
        let mut smallest_first = face;
        smallest_first.rotate_left((0..3).min_by_key(|&k| face[k]).unwrap_or(0));
        let original = *seen.entry(smallest_first).or_insert(triangle);
        (original != triangle).then_some((triangle, original))
    });
    let copies: Vec<(usize, usize)> = copies.collect();
    let Some((triangle, original)) = copies.first() else { return Ok(()) };
    Err(format!(
        "{}, the first is triangle {triangle} (counted from 0), a copy of triangle {original}; remove the copies",
        counted(copies.len(), "repeated triangle")
    ))
}

/// A triangle's edge between two welded vertices; sorting groups the edges between the same vertices.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    low: u32,
    high: u32,
    triangle: u32,
    /// Whether the triangle runs from low to high.
    upward: bool,
}

/// Checks that every edge is traversed equally often in both directions.
pub(super) fn edges(welded: &[[u32; 3]], vertices: &[Vector]) -> Result<(), String> {
    let mut sides = Vec::with_capacity(3 * welded.len());
    for (triangle, &[a, b, c]) in (0..).zip(welded) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            sides.push(Side { low: from.min(to), high: from.max(to), triangle, upward: from < to });
        }
    }
    sides.sort_unstable();

    let along = |edge: &[Side]| edge.iter().filter(|side| side.upward == edge[0].upward).count();
    let (mut open, mut winding, mut tangle) = (Vec::new(), Vec::new(), Vec::new());
    for edge in sides.chunk_by(|s, t| (s.low, s.high) == (t.low, t.high)) {
        match edge.len() {
            count if 2 * along(edge) == count => {}
            1 => open.push(edge),
            2 => winding.push(edge),
            _ => tangle.push(edge),
        }
    }
    let place = |edge: &[Side]| {
        let Side { low, high, triangle, upward } = edge[0];
        let [low, high] = [low, high].map(|i| point(vertices[i as usize]));
        let (from, to) = if upward { (low, high) } else { (high, low) };
        format!("from {from} to {to} of triangle {triangle} (counted from 0)")
    };
    if let Some(edge) = first(&open) {
        return Err(format!(
            "the mesh is open: {} of one triangle only, the first {}; close the holes",
            counted(open.len(), "edge"),
            place(edge)
        ));
    }
    if let Some(edge) = first(&winding) {
        return Err(format!(
            "the winding is inconsistent: {} traversed twice in the same direction, the first {} and of triangle {}; reorient the faces, counterclockwise seen from outside",
            counted(winding.len(), "edge"),
            place(edge),
            edge[1].triangle
        ));
    }
    if let Some(edge) = first(&tangle) {
        let along = along(edge);
        let against = edge.len() - along;
        return Err(format!(
            "the mesh is not a closed surface: {} of three or more triangles traversed unequally often in the two directions, the first {}, {along} times in this direction and {against} times in the other; remove the extra faces or reorient them",
            counted(tangle.len(), "edge"),
            place(edge)
        ));
    }
    Ok(())
}

/// The edge of the first triangle.
fn first<'a>(edges: &[&'a [Side]]) -> Option<&'a [Side]> {
    edges.iter().copied().min_by_key(|edge| edge[0].triangle)
}

/// `1 edge`, `2 edges`.
fn counted(count: usize, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

/// Checks that the volume is positive.
pub(super) fn volume(&Integrals { volume, rounding, .. }: &Integrals) -> Result<(), String> {
    if volume.abs() <= rounding {
        return Err(format!(
            "the enclosed volume is zero to rounding ({volume:e} m³); the mesh must enclose a volume"
        ));
    }
    if volume < 0.0 {
        return Err(format!(
            "the mesh is inside-out: its winding is consistent but the volume is {volume:?} m³; reverse the faces, counterclockwise seen from outside"
        ));
    }
    Ok(())
}
