//! What can be wrong with a mesh or its file.

use crate::error::BodyError;
use polhode_ga::Vector;
use std::fmt;

/// What is wrong with which mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshError {
    /// The file's path, or "mesh".
    pub name: String,
    /// What is wrong with it.
    pub problem: MeshProblem,
}

/// Where in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of a text file, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
    Byte(usize),
}

/// What is wrong with a mesh or its file. Triangles and vertices are counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshProblem {
    /// The file cannot be read; the system's reason.
    Unreadable(String),
    /// The file has no bytes.
    Empty,
    /// The extension names no format that is read.
    UnknownExtension(String),
    /// Something else than the format asks for.
    Corrupt {
        /// Where.
        place: Place,
        /// What is there and what should be.
        what: String,
    },
    /// The file ends too early.
    Truncated {
        /// The end.
        place: Place,
        /// What is missing.
        what: String,
    },
    /// No triangle to enclose anything.
    NoTriangles,
    /// A coordinate that is NaN or infinite.
    NotFinite {
        /// Which vertex of the file, from 0.
        vertex: usize,
        /// Its coordinates.
        position: Vector,
        /// Where it is in the file, if it is from one.
        place: Option<Place>,
    },
    /// More vertices or triangles than can be numbered.
    TooMany {
        /// How many there are of the one of which there are more.
        count: usize,
    },
    /// A triangle refers to a vertex that is not there.
    NoSuchVertex {
        /// Which triangle, from 0.
        triangle: usize,
        /// The index it has.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A scale factor that is zero, negative or not finite.
    Factor(f64),
    /// An extent with which the integrals would leave the range of floating point.
    Extent(f64),
    /// Triangles with two corners at the same place, or all in a line.
    Degenerate {
        /// How many.
        count: usize,
        /// The first of them.
        triangle: usize,
        /// Its corners.
        corners: [Vector; 3],
    },
    /// Triangles that are there twice: the body would count twice.
    Repeated {
        /// How many.
        count: usize,
        /// The first of them.
        triangle: usize,
        /// The one that it repeats.
        original: usize,
    },
    /// Edges with a triangle on one side only.
    Open {
        /// How many.
        count: usize,
        /// The first in the order of the triangles.
        edge: Edge,
    },
    /// Edges that two triangles run along in the same direction.
    Winding {
        /// How many.
        count: usize,
        /// The first in the order of the triangles.
        edge: Edge,
        /// The other triangle.
        other: usize,
    },
    /// Edges of three or more triangles that run unequally often in the two directions.
    NonManifold {
        /// How many.
        count: usize,
        /// The first in the order of the triangles.
        edge: Edge,
        /// How many triangles run along it in its direction.
        along: usize,
        /// How many run against it.
        against: usize,
    },
    /// The enclosed volume is zero to rounding.
    NoVolume {
        /// What comes out.
        volume: f64,
    },
    /// The faces are wound inwards.
    InsideOut {
        /// The negative volume.
        volume: f64,
    },
    /// The mass or the moments are impossible.
    Body(BodyError),
}

/// An edge of a triangle, in the direction in which the triangle runs along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Where it starts.
    pub from: Vector,
    /// Where it ends.
    pub to: Vector,
    /// The triangle, from 0.
    pub triangle: usize,
}

impl From<BodyError> for MeshProblem {
    fn from(e: BodyError) -> MeshProblem {
        MeshProblem::Body(e)
    }
}

/// A position as a person reads it.
struct Point(Vector);

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.0;
        write!(f, "({x:?}, {y:?}, {z:?})")
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(n) => write!(f, "line {n}"),
            Place::Byte(n) => write!(f, "byte {n}"),
        }
    }
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Edge { from, to, triangle } = *self;
        write!(f, "from {} to {} of triangle {triangle} (counted from 0)", Point(from), Point(to))
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, self.problem)
    }
}

/// `1 edge`, `2 edges`.
fn edges(count: usize) -> String {
    format!("{count} {}", if count == 1 { "edge" } else { "edges" })
}

impl fmt::Display for MeshProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MeshProblem::Unreadable(reason) => write!(f, "cannot be read: {reason}; check the path"),
            MeshProblem::Empty => write!(f, "the file is empty; export the mesh again"),
            MeshProblem::UnknownExtension(extension) => write!(
                f,
                "the extension '{extension}' is none of stl, obj, ply; convert the mesh to one of these"
            ),
            MeshProblem::Corrupt { place, what } => {
                write!(f, "{place}: {what}; correct it or export the mesh again")
            }
            MeshProblem::Truncated { place, what } => {
                write!(f, "{place}: the file ends early, {what}; copy or export it again")
            }
            MeshProblem::NoTriangles => {
                write!(f, "there are no triangles; a body needs a closed surface of them")
            }
            MeshProblem::NotFinite { vertex, position, place } => {
                if let Some(place) = place {
                    write!(f, "{place}: ")?;
                }
                let position = Point(*position);
                write!(
                    f,
                    "vertex {vertex} (counted from 0) at {position} is not finite; correct its coordinates"
                )
            }
            MeshProblem::TooMany { count } => write!(
                f,
                "{count} vertices or triangles are more than the 4294967295 that can be numbered; simplify the mesh"
            ),
            MeshProblem::NoSuchVertex { triangle, index, vertices } => write!(
                f,
                "triangle {triangle} (counted from 0) has the vertex {index}, but there are only {vertices}, counted from 0; correct the index"
            ),
            MeshProblem::Factor(factor) => {
                write!(f, "a scale factor of {factor:?} is impossible; give a positive, finite one")
            }
            MeshProblem::Extent(extent) => write!(
                f,
                "the mesh is {extent:?} m across, beyond the range of the integrals (1e-50 to 1e50); check the unit"
            ),
            MeshProblem::Degenerate { count, triangle, corners: [a, b, c] } => write!(
                f,
                "{count} degenerate {}, the first is triangle {triangle} (counted from 0) with corners {}, {}, {}, which has no area; remove {}",
                if *count == 1 { "triangle" } else { "triangles" },
                Point(*a),
                Point(*b),
                Point(*c),
                if *count == 1 { "it" } else { "them" },
            ),
            MeshProblem::Repeated { count, triangle, original } => write!(
                f,
                "{count} repeated {}, the first is triangle {triangle} (counted from 0), which is triangle {original} again; remove the copies",
                if *count == 1 { "triangle" } else { "triangles" },
            ),
            MeshProblem::Open { count, edge } => write!(
                f,
                "the mesh is open: {} with a triangle on one side only, the first {edge}; close the holes",
                edges(*count)
            ),
            MeshProblem::Winding { count, edge, other } => write!(
                f,
                "the winding is inconsistent: {} traversed twice in the same direction, the first {edge} and of triangle {other}; reorient the faces, counterclockwise seen from outside",
                edges(*count)
            ),
            MeshProblem::NonManifold { count, edge, along, against } => write!(
                f,
                "the mesh is not a closed surface: {} of three or more triangles traversed unequally often in the two directions, the first {edge}, {along} times this way and {against} times back; remove the extra faces or reorient them",
                edges(*count)
            ),
            MeshProblem::NoVolume { volume } => write!(
                f,
                "the enclosed volume is zero to rounding ({volume:e} m³); give the surface an inside"
            ),
            MeshProblem::InsideOut { volume } => write!(
                f,
                "the mesh is inside-out: its winding is consistent but the volume is {volume:?} m³; reverse the faces, counterclockwise seen from outside"
            ),
            MeshProblem::Body(
                BodyError::ImpossibleMoments { moments: [a, b, c], .. }
                | BodyError::NegativeMoment { moments: [a, b, c], .. },
            ) => write!(
                f,
                "the moments come out as {a:?}, {b:?}, {c:?} kg m², which no body has: a part is inside-out or parts overlap; reverse the faces of that part or unite the parts"
            ),
            MeshProblem::Body(e) => write!(f, "{e}"),
        }
    }
}

impl std::error::Error for MeshError {}
