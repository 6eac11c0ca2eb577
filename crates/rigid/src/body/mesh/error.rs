//! Errors of meshes and mesh files.

use crate::error::BodyError;
use polhode_ga::Vector;
use std::fmt;

/// An error of a mesh or its file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshError {
    /// The file's path, or "mesh".
    pub name: String,
    /// What is wrong.
    pub problem: MeshProblem,
}

/// What is wrong with a mesh or its file.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshProblem {
    /// The fault, its place, and the remedy. Triangles and vertices are counted from 0.
    Mesh(String),
    /// The mass or the moments are invalid.
    Body(BodyError),
}

impl From<String> for MeshProblem {
    fn from(message: String) -> MeshProblem {
        MeshProblem::Mesh(message)
    }
}

impl From<BodyError> for MeshProblem {
    fn from(e: BodyError) -> MeshProblem {
        MeshProblem::Body(e)
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.name)?;
        match &self.problem {
            MeshProblem::Mesh(message) => f.write_str(message),
            MeshProblem::Body(
                BodyError::ImpossibleMoments { moments: [a, b, c], .. }
                | BodyError::NegativeMoment { moments: [a, b, c], .. },
            ) => write!(
                f,
                "no body has the moments {a:?}, {b:?}, {c:?} kg m²: a part is inside-out or parts overlap; reverse the faces of that part or merge the parts"
            ),
            MeshProblem::Body(e) => e.fmt(f),
        }
    }
}

impl std::error::Error for MeshError {}

/// A place in a file: a line of text, from 1, or a byte, from 0.
#[derive(Clone, Copy)]
pub(super) enum Place {
    Line(usize),
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(n) => write!(f, "line {n}"),
            Place::Byte(n) => write!(f, "byte {n}"),
        }
    }
}

impl Place {
    /// The error for a violation of the format.
    pub fn corrupt(self, what: impl fmt::Display) -> String {
        format!("{self}: {what}; correct it or export the mesh again")
    }

    /// The error for a file that ends too early.
    pub fn truncated(self, what: impl fmt::Display) -> String {
        format!("{self}: the file is truncated, {what}; copy or export it again")
    }
}

/// A position in messages.
pub(super) fn point(Vector([x, y, z]): Vector) -> String {
    format!("({x:?}, {y:?}, {z:?})")
}

/// Checks that the position of a vertex is finite.
pub(super) fn finite(vertex: usize, position: Vector) -> Result<Vector, String> {
    if position.0.iter().all(|x| x.is_finite()) {
        return Ok(position);
    }
    let place = point(position);
    Err(format!("vertex {vertex} (counted from 0) at {place} is not finite; correct its coordinates"))
}
