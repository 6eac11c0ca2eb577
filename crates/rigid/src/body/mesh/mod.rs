//! Triangle meshes: reading, checks, and mass, centre of mass and inertia.
//!
//! Faces are counterclockwise seen from outside. An integral over the body is a sum over the signed tetrahedra between
//! the triangles and any one point; cavities, wound the other way, are subtracted. [`TriangleMesh::body`] first checks
//! that the mesh encloses a volume, and reports what is wrong and where.
//!
//! Files: STL, OBJ, PLY ([`MeshFormat`]).

mod check;
mod error;
mod integrals;
mod obj;
mod ply;
mod stl;
mod text;

pub use error::{MeshError, MeshProblem};

use super::Body;
use super::inertia::Inertia;
use super::solids::Amount;
use error::Place;
use integrals::integrals;
use polhode_ga::Vector;
use std::collections::HashMap;
use std::path::Path;

/// Supported file formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// STL, text or binary.
    Stl,
    /// Wavefront OBJ.
    Obj,
    /// PLY, ASCII or binary of either byte order.
    Ply,
}

/// Finite vertices and valid triangles between them, counterclockwise seen from outside; [`TriangleMesh::body`] checks
/// that the surface is closed.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    name: String,
    vertices: Vec<Vector>,
    faces: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// A mesh of these vertices and triangles, the indices counted from 0.
    pub fn new(vertices: Vec<Vector>, faces: Vec<[u32; 3]>) -> Result<TriangleMesh, MeshError> {
        TriangleMesh::named("mesh", vertices, faces)
    }

    fn named(name: &str, vertices: Vec<Vector>, faces: Vec<[u32; 3]>) -> Result<TriangleMesh, MeshError> {
        let mesh = TriangleMesh { name: name.to_owned(), vertices, faces };
        check::numbers(&mesh.vertices, &mesh.faces).map_err(|problem| mesh.error(problem))?;
        Ok(mesh)
    }

    /// The mesh in a file whose extension is `stl`, `obj` or `ply`, in upper or lower case.
    pub fn read(path: &Path) -> Result<TriangleMesh, MeshError> {
        TriangleMesh::read_with(path, || match std::fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() => Err("it is not a regular file".to_owned()),
            _ => std::fs::read(path).map_err(|e| e.to_string()),
        })
    }

    /// The mesh in a file with these contents, or the reason why they cannot be read.
    pub fn read_with<B: AsRef<[u8]>>(
        path: &Path,
        contents: impl FnOnce() -> Result<B, String>,
    ) -> Result<TriangleMesh, MeshError> {
        let name = path.display().to_string();
        let fail = |message: String| MeshError { name: name.clone(), problem: message.into() };
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let format = match extension.to_ascii_lowercase().as_str() {
            "stl" => MeshFormat::Stl,
            "obj" => MeshFormat::Obj,
            "ply" => MeshFormat::Ply,
            _ => {
                let found = match &*extension {
                    "" => "no extension".to_owned(),
                    other => format!("unknown extension '{other}'"),
                };
                return Err(fail(format!("{found}, expected stl, obj or ply; convert the mesh")));
            }
        };
        let bytes = contents().map_err(|reason| fail(format!("cannot be read: {reason}; check the path")))?;
        TriangleMesh::parse(bytes.as_ref(), format, &name)
    }

    /// The mesh in the bytes of a file; `name` appears in errors.
    pub fn parse(bytes: &[u8], format: MeshFormat, name: &str) -> Result<TriangleMesh, MeshError> {
        // Some editors write a UTF-8 byte order mark.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let parsed = match format {
            _ if bytes.is_empty() => Err("the file is empty; export the mesh again".to_owned()),
            MeshFormat::Stl => stl::parse(bytes),
            MeshFormat::Obj => obj::parse(bytes),
            MeshFormat::Ply => ply::parse(bytes),
        };
        match parsed {
            Ok((_, faces)) if faces.is_empty() => Err(check::no_triangles()),
            parsed => parsed,
        }
        .map_err(|message| MeshError { name: name.to_owned(), problem: message.into() })
        .and_then(|(vertices, faces)| TriangleMesh::named(name, vertices, faces))
    }

    /// The positions, in metres unless the file had another unit: see [`TriangleMesh::scaled`].
    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    /// The triangles, as indices of vertices.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The mesh with all positions times a positive factor, such as 0.001 for a file in millimetres.
    pub fn scaled(&self, factor: f64) -> Result<TriangleMesh, MeshError> {
        if !(factor > 0.0 && factor.is_finite()) {
            return Err(self.error(format!("scale must be positive and finite, got {factor:?}")));
        }
        let vertices = self.vertices.iter().map(|&x| x * factor).collect();
        TriangleMesh::named(&self.name, vertices, self.faces.clone())
    }

    /// The enclosed volume, negative if the faces are wound inwards. The mesh must be closed, which is not checked.
    pub fn volume(&self) -> f64 {
        integrals(self, check::middle(self)).volume
    }

    /// The uniform body inside the mesh; an error if the mesh is not valid.
    pub fn body(&self, amount: Amount) -> Result<Body, MeshError> {
        self.checked_body(amount).map_err(|problem| self.error(problem))
    }

    fn checked_body(&self, amount: Amount) -> Result<Body, MeshProblem> {
        check::size(self)?;
        check::triangles(self)?;
        let (faces, vertices) = self.welded();
        check::repetitions(&faces)?;
        check::edges(&faces, &vertices)?;
        let middle = check::middle(self);
        let rough = integrals(self, middle);
        check::volume(&rough)?;
        // About the centre of mass itself the second moment is not a difference of large numbers.
        let center = middle + rough.first / rough.volume;
        let exact = integrals(self, center);
        let mass = amount.mass(Some(exact.volume), "mesh")?;
        let density = mass / exact.volume;
        let second = exact.second.map(|row| row.map(|x| density * x));
        let center = center + exact.first / exact.volume;
        Ok(Body::extended(mass, Inertia::from_second_moment(second)?, center)?)
    }

    /// The triangles between vertices of which no two have equal coordinates, and these vertices.
    fn welded(&self) -> (Vec<[u32; 3]>, Vec<Vector>) {
        let mut welder = Welder::default();
        let corners = |face: &[u32; 3]| face.map(|i| welder.number(self.vertices[i as usize]));
        (self.faces.iter().map(corners).collect(), welder.vertices)
    }

    fn error(&self, problem: impl Into<MeshProblem>) -> MeshError {
        MeshError { name: self.name.clone(), problem: problem.into() }
    }
}

/// Positions and triangles of a file.
type Parsed = (Vec<Vector>, Vec<[u32; 3]>);

/// Merges vertices with equal coordinates, which closes seams. `−0 = 0`.
#[derive(Default)]
struct Welder {
    numbers: HashMap<[u64; 3], u32>,
    vertices: Vec<Vector>,
}

impl Welder {
    /// The number of the vertex at this position; a mesh of more than u32::MAX vertices is rejected later.
    fn number(&mut self, position: Vector) -> u32 {
        let next = u32::try_from(self.vertices.len()).unwrap_or(u32::MAX);
        // Adding 0 turns −0 into 0.
        let number = *self.numbers.entry(position.0.map(|x| (x + 0.0).to_bits())).or_insert(next);
        if number == next {
            self.vertices.push(position);
        }
        number
    }
}

/// The fan of triangles from a polygon's first corner.
fn fan(
    corners: impl ExactSizeIterator<Item = Result<u32, String>>,
    place: Place,
) -> Result<Vec<[u32; 3]>, String> {
    if corners.len() < 3 {
        return Err(place.corrupt(format!("a face needs at least 3 corners, got {}", corners.len())));
    }
    let corners: Vec<u32> = corners.collect::<Result<_, _>>()?;
    Ok(corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]).collect())
}
