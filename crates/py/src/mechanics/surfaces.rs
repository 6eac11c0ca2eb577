//! Triangle meshes of files, and surfaces of solids.

use crate::support::arrays::{Array, bad, table};
use crate::support::interrupts::in_background;
use polhode_ga::Vector;
use polhode_rigid::{Amount, Solid, Surface, TriangleMesh};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Vertices (n, 3) in m, and triangles (m, 3), counterclockwise seen from outside.
pub(crate) type Triangles<'py> = (Array<'py>, Vec<[u32; 3]>);

pub(crate) fn triangles<'py>(
    py: Python<'py>,
    vertices: &[Vector],
    faces: Vec<[u32; 3]>,
) -> PyResult<Triangles<'py>> {
    Ok((table(py, vertices.iter().map(|v| v.0))?, faces))
}

/// The mesh in a file whose unit of length is `scale` metres. Only a mesh that encloses a body is returned.
#[pyfunction]
pub(crate) fn read_mesh(py: Python<'_>, path: PathBuf, scale: f64) -> PyResult<Triangles<'_>> {
    let read = move || -> Result<TriangleMesh, _> {
        let mesh = TriangleMesh::read(&path)?.scaled(scale)?;
        mesh.body(Amount::Mass(1.0)).map(|_| mesh)
    };
    let mesh = in_background(py, read)?.map_err(bad)?;
    triangles(py, mesh.vertices(), mesh.faces().to_vec())
}

/// The outer surface of a solid in its own axes.
#[pyfunction]
pub(crate) fn solid_surface<'py>(py: Python<'py>, kind: &str, sizes: Vec<f64>) -> PyResult<Triangles<'py>> {
    let count = sizes.len();
    let wrong =
        || bad(format!("{kind:?} with {count} lengths is not a solid; kinds and sizes are those of Body"));
    let solid = Solid::from_lengths(kind, &sizes).ok_or_else(wrong)?;
    solid.body(Amount::Mass(1.0)).map_err(bad)?;
    let surface = Surface::of_solid(solid);
    triangles(py, &surface.vertices, surface.faces)
}
