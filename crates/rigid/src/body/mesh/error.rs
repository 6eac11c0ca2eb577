//! Errors of meshes and mesh files.

use crate::error::BodyError;
use polhode_ga::Vector;
use std::fmt;

/// An error of a mesh, with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshError {
    /// The file's path, or "mesh".
    pub name: String,
    /// The error.
    pub problem: MeshProblem,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of a text file, from 1.
    Line(usize),
    /// A byte of a binary file, from 0.
    Byte(usize),
}

/// Errors of a mesh or its file. Triangles and vertices are counted from 0.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum MeshProblem {
    /// The file cannot be read, with the reason given by the system.
    Unreadable(String),
    /// The file has no bytes.
    Empty,
    /// The extension of an unsupported format.
    UnknownExtension(String),
    /// A violation of the format.
    Corrupt { place: Place, what: String },
    /// The file ends too early.
    Truncated { place: Place, what: String },
    /// No triangles.
    NoTriangles,
    /// A coordinate that is NaN or infinite.
    NotFinite { vertex: usize, position: Vector, place: Option<Place> },
    /// More vertices or triangles than an index can count.
    TooMany { count: usize },
    /// A triangle refers to a vertex that does not exist.
    NoSuchVertex { triangle: usize, index: u32, vertices: usize },
    /// A scale factor that is zero, negative or not finite.
    Factor(f64),
    /// An extent for which the integrals exceed the range of floating point.
    Extent(f64),
    /// Triangles with coincident or collinear corners.
    Degenerate { count: usize, triangle: usize, corners: [Vector; 3] },
    /// Duplicate triangles, which the integrals would count twice.
    Repeated { count: usize, triangle: usize, original: usize },
    /// Edges of one triangle only.
    Open { count: usize, edge: Edge },
    /// Edges that two triangles traverse in the same direction.
    Winding { count: usize, edge: Edge, other: usize },
    /// Edges of three or more triangles, traversed unequally often in the two directions.
    NonManifold { count: usize, edge: Edge, along: usize, against: usize },
    /// The enclosed volume is zero to rounding.
    NoVolume { volume: f64 },
    /// The faces are wound inwards.
    InsideOut { volume: f64 },
    /// The mass or the moments are invalid.
    Body(BodyError),
}

/// An edge of a triangle, in the direction in which the triangle traverses it.
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

/// A position in messages.
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
            MeshProblem::UnknownExtension(extension) => {
                write!(f, "unknown extension '{extension}', expected stl, obj or ply; convert the mesh")
            }
            MeshProblem::Corrupt { place, what } => {
                write!(f, "{place}: {what}; correct it or export the mesh again")
            }
            MeshProblem::Truncated { place, what } => {
                write!(f, "{place}: the file is truncated, {what}; copy or export it again")
            }
            MeshProblem::NoTriangles => {
                write!(f, "the mesh has no triangles; a body needs a closed surface")
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
            MeshProblem::TooMany { count } => {
                write!(f, "{count} vertices or triangles exceed the limit of 4294967295; simplify the mesh")
            }
            MeshProblem::NoSuchVertex { triangle, index, vertices } => write!(
                f,
                "triangle {triangle} (counted from 0) refers to vertex {index}, but there are {vertices} vertices, counted from 0; correct the index"
            ),
            MeshProblem::Factor(factor) => {
                write!(f, "scale must be positive and finite, got {factor:?}")
            }
            MeshProblem::Extent(extent) => write!(
                f,
                "the mesh extends over {extent:?} m, outside the supported range of 1e-50 to 1e50 m; check the unit"
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
                "{count} repeated {}, the first is triangle {triangle} (counted from 0), a copy of triangle {original}; remove the copies",
                if *count == 1 { "triangle" } else { "triangles" },
            ),
            MeshProblem::Open { count, edge } => write!(
                f,
                "the mesh is open: {} of one triangle only, the first {edge}; close the holes",
                edges(*count)
            ),
            MeshProblem::Winding { count, edge, other } => write!(
                f,
                "the winding is inconsistent: {} traversed twice in the same direction, the first {edge} and of triangle {other}; reorient the faces, counterclockwise seen from outside",
                edges(*count)
            ),
            MeshProblem::NonManifold { count, edge, along, against } => write!(
                f,
                "the mesh is not a closed surface: {} of three or more triangles traversed unequally often in the two directions, the first {edge}, {along} times in this direction and {against} times in the other; remove the extra faces or reorient them",
                edges(*count)
            ),
            MeshProblem::NoVolume { volume } => write!(
                f,
                "the enclosed volume is zero to rounding ({volume:e} m³); the mesh must enclose a volume"
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
                "no body has the moments {a:?}, {b:?}, {c:?} kg m²: a part is inside-out or parts overlap; reverse the faces of that part or merge the parts"
            ),
            MeshProblem::Body(e) => write!(f, "{e}"),
        }
    }
}

impl std::error::Error for MeshError {}
