//! Checks that a mesh encloses a volume.
//!
//! Its boundary must vanish: triangles traverse every edge equally often in both directions. Usually two triangles
//! share an edge; two bodies that touch along an edge have four. Vertices with equal coordinates are the same vertex,
//! so texture seams are closed.

use super::error::{Edge, MeshProblem};
use super::integrals::Integrals;
use super::{TriangleMesh, Welder};
use polhode_ga::Vector;
use std::array::from_fn;
use std::collections::HashMap;

/// Extents in this range keep fifth powers of lengths, down to 1e-10 of the extent, in range.
const EXTENTS: std::ops::RangeInclusive<f64> = 1e-50..=1e50;

/// Checks the number of vertices, that they are finite, and the indices.
pub(super) fn numbers(vertices: &[Vector], faces: &[[u32; 3]]) -> Result<(), MeshProblem> {
    let count = vertices.len().max(faces.len());
    if u32::try_from(count).is_err() {
        return Err(MeshProblem::TooMany { count });
    }
    if let Some(vertex) = vertices.iter().position(|x| !x.0.iter().all(|c| c.is_finite())) {
        return Err(MeshProblem::NotFinite { vertex, position: vertices[vertex], place: None });
    }
    for (triangle, face) in faces.iter().enumerate() {
        if let Some(&index) = face.iter().find(|&&i| i as usize >= vertices.len()) {
            return Err(MeshProblem::NoSuchVertex { triangle, index, vertices: vertices.len() });
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

/// Checks that there are triangles, of a supported extent.
pub(super) fn size(mesh: &TriangleMesh) -> Result<(), MeshProblem> {
    let (least, greatest) = bounds(mesh).ok_or(MeshProblem::NoTriangles)?;
    let extent = (greatest - least).norm();
    // A mesh in a single point passes here and is reported as degenerate.
    if extent == 0.0 || EXTENTS.contains(&extent) { Ok(()) } else { Err(MeshProblem::Extent(extent)) }
}

/// Checks that every triangle has an area.
pub(super) fn triangles(mesh: &TriangleMesh) -> Result<(), MeshProblem> {
    let corners = |face: &[u32; 3]| face.map(|i| mesh.vertices[i as usize]);
    let mut flat = mesh.faces.iter().map(corners).enumerate().filter(|(_, c)| is_flat(*c));
    match flat.next() {
        None => Ok(()),
        Some((triangle, corners)) => {
            Err(MeshProblem::Degenerate { count: 1 + flat.count(), triangle, corners })
        }
    }
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
pub(super) fn repetitions(mesh: &TriangleMesh) -> Result<(), MeshProblem> {
    let mut welder = Welder::default();
    let mut seen = HashMap::with_capacity(mesh.faces.len());
    let (mut count, mut first) = (0, None);
    for (triangle, face) in mesh.faces.iter().enumerate() {
        let [a, b, c] = face.map(|i| welder.number(mesh.vertices[i as usize]));
        let smallest_first = match a.min(b).min(c) {
            least if least == a => [a, b, c],
            least if least == b => [b, c, a],
            _ => [c, a, b],
        };
        let original = *seen.entry(smallest_first).or_insert(triangle);
        if original != triangle {
            count += 1;
            first.get_or_insert((triangle, original));
        }
    }
    match first {
        Some((triangle, original)) => Err(MeshProblem::Repeated { count, triangle, original }),
        None => Ok(()),
    }
}

/// A triangle's edge between two welded vertices; sorting groups the edges between the same vertices.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    low: u32,
    high: u32,
    triangle: u32,
    /// Whether the triangle runs from low to high.
    upward: bool,
}

/// Number of edges with a fault, and the first.
struct Fault<T> {
    count: usize,
    first: Option<(u32, T)>,
}

impl<T> Fault<T> {
    const NONE: Fault<T> = Fault { count: 0, first: None };

    fn add(&mut self, triangle: u32, found: T) {
        self.count += 1;
        if self.first.as_ref().is_none_or(|(earliest, _)| triangle < *earliest) {
            self.first = Some((triangle, found));
        }
    }
}

/// Checks that every edge is traversed equally often in both directions.
pub(super) fn edges(mesh: &TriangleMesh) -> Result<(), MeshProblem> {
    let (sides, welder) = sides(mesh);
    let (mut open, mut winding, mut tangle) = (Fault::NONE, Fault::NONE, Fault::NONE);
    for group in sides.chunk_by(|s, t| (s.low, s.high) == (t.low, t.high)) {
        let first = group[0];
        let along = group.iter().filter(|s| s.upward == first.upward).count();
        let against = group.len() - along;
        match (group, along == against) {
            (_, true) => {}
            ([_], _) => open.add(first.triangle, first),
            ([_, other], _) => winding.add(first.triangle, (first, other.triangle)),
            _ => tangle.add(first.triangle, (first, along, against)),
        }
    }
    let edge = |side: Side| {
        let (low, high) = (welder.vertices[side.low as usize], welder.vertices[side.high as usize]);
        let (from, to) = if side.upward { (low, high) } else { (high, low) };
        Edge { from, to, triangle: side.triangle as usize }
    };
    if let Some((_, side)) = open.first {
        return Err(MeshProblem::Open { count: open.count, edge: edge(side) });
    }
    if let Some((_, (side, other))) = winding.first {
        let other = other as usize;
        return Err(MeshProblem::Winding { count: winding.count, edge: edge(side), other });
    }
    if let Some((_, (side, along, against))) = tangle.first {
        return Err(MeshProblem::NonManifold { count: tangle.count, edge: edge(side), along, against });
    }
    Ok(())
}

/// The sides of all triangles, sorted, and the welded vertices that they refer to.
fn sides(mesh: &TriangleMesh) -> (Vec<Side>, Welder) {
    let mut welder = Welder::default();
    let mut sides = Vec::with_capacity(3 * mesh.faces.len());
    for (triangle, face) in (0..).zip(&mesh.faces) {
        let [a, b, c] = face.map(|i| welder.number(mesh.vertices[i as usize]));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            sides.push(Side { low: from.min(to), high: from.max(to), triangle, upward: from < to });
        }
    }
    sides.sort_unstable();
    (sides, welder)
}

/// Checks that the volume is positive.
pub(super) fn volume(integrals: &Integrals) -> Result<(), MeshProblem> {
    let volume = integrals.volume;
    if volume.abs() <= integrals.rounding {
        Err(MeshProblem::NoVolume { volume })
    } else if volume < 0.0 {
        Err(MeshProblem::InsideOut { volume })
    } else {
        Ok(())
    }
}
