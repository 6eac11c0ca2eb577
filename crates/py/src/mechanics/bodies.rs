//! Inertia and bodies.

use crate::support::arrays::{Array, Out, Rows, bad, line, map_rows, numbers, one, place, table, threads};
use crate::support::interrupts::{in_background, in_pieces};
use numpy::PyUntypedArrayMethods;
use polhode_ga::simd::threads::for_each;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::body::inertia;
use polhode_rigid::{Amount, BodyError, Solid, TriangleMesh, body};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyType};
use std::convert::Infallible;
use std::path::PathBuf;

/// The inertia map.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Inertia(pub(crate) inertia::Inertia);

/// Inertias from a list of objects of the Python class.
pub(crate) struct Inertias(pub(crate) Vec<inertia::Inertia>);

impl FromPyObject<'_, '_> for Inertias {
    type Error = PyErr;

    fn extract(list: Borrowed<'_, '_, PyAny>) -> PyResult<Inertias> {
        let core = intern!(list.py(), "_core");
        let list = list.cast::<PyList>()?;
        let mut inertias = Vec::with_capacity(list.len());
        for one in list.iter() {
            inertias.push(one.getattr(core)?.cast::<Inertia>()?.get().0);
        }
        Ok(Inertias(inertias))
    }
}

/// The types of the objects in a list, each at least once.
#[pyfunction]
pub(crate) fn types_of<'py>(objects: Bound<'py, PyList>) -> Vec<Bound<'py, PyType>> {
    let mut types: Vec<Bound<'py, PyType>> = Vec::new();
    for object in objects {
        if types.last().is_none_or(|last| object.get_type_ptr() != last.as_type_ptr()) {
            types.push(object.get_type());
        }
    }
    types
}

fn points(masses: &Rows<'_>, positions: &Rows<'_>) -> PyResult<(Vec<f64>, Vec<Vector>)> {
    let positions = numbers(positions)?.as_chunks::<3>().0.iter().map(|x| Vector(*x)).collect();
    Ok((numbers(masses)?.to_vec(), positions))
}

/// A 3x3 matrix from nine numbers, row by row.
fn square(matrix: &Rows<'_>) -> PyResult<[[f64; 3]; 3]> {
    let m: [f64; 9] = one(matrix)?;
    Ok([0, 3, 6].map(|i| [m[i], m[i + 1], m[i + 2]]))
}

/// The inertias of rows of N numbers, computed in threads without the GIL. An error names the place of the first wrong row
/// in the batch.
fn of_rows<const N: usize>(
    py: Python<'_>,
    rows: &Rows<'_>,
    inertia: impl Fn([f64; N]) -> Result<inertia::Inertia, BodyError> + Sync,
) -> PyResult<Vec<Inertia>> {
    let batch = rows.shape().split_last().map_or(&[][..], |(_, batch)| batch);
    let all = numbers(rows)?.as_chunks::<N>().0;
    let threads = threads(all.len() * N)?;
    let mut inertias = Vec::with_capacity(all.len());
    in_pieces(py, all.len(), 16 * LEAST, |piece| {
        let first = piece.start;
        let ranges = threads.ranges(piece.len(), LEAST);
        let mut shares: Vec<_> = ranges.map(|rows| (rows, Ok(Vec::new()))).collect();
        py.detach(|| {
            for_each(shares.iter_mut(), |(rows, made)| {
                let row = |row: usize| inertia(all[first + row]).map(Inertia).map_err(|error| (row, error));
                *made = rows.clone().map(row).collect::<Result<Vec<Inertia>, _>>();
            });
        });
        for (_, made) in shares {
            let failed = |(row, error)| bad(format!("{}{error}", place(first + row, batch)));
            inertias.extend(made.map_err(failed)?);
        }
        Ok(())
    })?;
    Ok(inertias)
}

/// Fewer inertias take less time than a thread.
const LEAST: usize = 1 << 10;

/// A rotor from its row of components.
pub(crate) fn rotor(row: &Rows<'_>) -> PyResult<Rotor> {
    Rotor::from_components(one(row)?).map_err(bad)
}

#[pymethods]
impl Inertia {
    #[staticmethod]
    fn from_principal_moments(moments: Rows<'_>) -> PyResult<Inertia> {
        inertia::Inertia::from_principal_moments(one(&moments)?).map(Inertia).map_err(bad)
    }

    #[staticmethod]
    fn from_matrix(matrix: Rows<'_>) -> PyResult<Inertia> {
        inertia::Inertia::from_matrix(square(&matrix)?).map(Inertia).map_err(bad)
    }

    /// From moments (…, 3), in their order.
    #[staticmethod]
    fn all_from_principal_moments(py: Python<'_>, moments: Rows<'_>) -> PyResult<Vec<Inertia>> {
        of_rows(py, &moments, inertia::Inertia::from_principal_moments)
    }

    /// From matrices (…, 9), in their order.
    #[staticmethod]
    fn all_from_matrices(py: Python<'_>, matrices: Rows<'_>) -> PyResult<Vec<Inertia>> {
        of_rows(py, &matrices, |m: [f64; 9]| {
            inertia::Inertia::from_matrix([0, 3, 6].map(|i| [m[i], m[i + 1], m[i + 2]]))
        })
    }

    #[staticmethod]
    fn restored(matrix: Rows<'_>, moments: Rows<'_>, frame: Rows<'_>) -> PyResult<Inertia> {
        let restored = inertia::Inertia::restored(square(&matrix)?, one(&moments)?, rotor(&frame)?);
        restored.map(Inertia).map_err(bad)
    }

    #[staticmethod]
    fn from_points(masses: Rows<'_>, positions: Rows<'_>) -> PyResult<Inertia> {
        let (masses, positions) = points(&masses, &positions)?;
        inertia::Inertia::from_points(&masses, &positions).map(Inertia).map_err(bad)
    }

    fn apply<'py>(&self, py: Python<'py>, b: Rows<'py>) -> Out<'py> {
        map_rows(py, &b, |c| Ok::<_, Infallible>(self.0.apply(Bivector(c)).0))
    }

    fn inverse<'py>(&self, py: Python<'py>, l: Rows<'py>) -> Out<'py> {
        map_rows(py, &l, |c| self.0.inverse(Bivector(c)).map(|b| b.0))
    }

    fn matrix<'py>(&self, py: Python<'py>) -> Out<'py> {
        table(py, self.0.matrix().into_iter())
    }

    /// The matrices of n inertias, (3n, 3).
    #[staticmethod]
    fn matrices(py: Python<'_>, inertias: Inertias) -> Out<'_> {
        let rows: Vec<[f64; 3]> = inertias.0.iter().flat_map(|inertia| inertia.matrix()).collect();
        table(py, rows.into_iter())
    }

    fn principal_moments<'py>(&self, py: Python<'py>) -> Array<'py> {
        line(py, self.0.principal_moments().to_vec())
    }

    fn principal_frame<'py>(&self, py: Python<'py>) -> Array<'py> {
        line(py, self.0.principal_frame().components().to_vec())
    }
}

/// A rigid body.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Body(pub(crate) body::Body);

/// Exactly one of the two is given, which Python checks.
fn amount(mass: Option<f64>, density: Option<f64>) -> PyResult<Amount> {
    match (mass, density) {
        (Some(mass), None) => Ok(Amount::Mass(mass)),
        (None, Some(density)) => Ok(Amount::Density(density)),
        _ => Err(bad("give exactly one of mass and density")),
    }
}

#[pymethods]
impl Body {
    #[new]
    fn new(mass: f64, inertia: &Inertia, center_of_mass: Rows<'_>) -> PyResult<Body> {
        body::Body::new(mass, inertia.0, Vector(one(&center_of_mass)?)).map(Body).map_err(bad)
    }

    #[staticmethod]
    #[pyo3(signature = (kind, sizes, mass, density))]
    fn solid(kind: &str, sizes: Vec<f64>, mass: Option<f64>, density: Option<f64>) -> PyResult<Body> {
        let wrong = || bad(format!("no {kind} has {} sizes", sizes.len()));
        let solid = Solid::from_lengths(kind, &sizes).ok_or_else(wrong)?;
        solid.body(amount(mass, density)?).map(Body).map_err(bad)
    }

    #[staticmethod]
    fn from_points(masses: Rows<'_>, positions: Rows<'_>) -> PyResult<Body> {
        let (masses, positions) = points(&masses, &positions)?;
        body::Body::from_points(&masses, &positions).map(Body).map_err(bad)
    }

    #[staticmethod]
    #[pyo3(signature = (path, scale, mass, density))]
    fn from_mesh(
        py: Python<'_>,
        path: PathBuf,
        scale: f64,
        mass: Option<f64>,
        density: Option<f64>,
    ) -> PyResult<Body> {
        let amount = amount(mass, density)?;
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(bad(format!("scale is {scale}; it must be positive and finite")));
        }
        in_background(py, move || TriangleMesh::read(&path)?.scaled(scale)?.body(amount))?
            .map(Body)
            .map_err(bad)
    }

    fn mass(&self) -> f64 {
        self.0.mass
    }

    fn center_of_mass<'py>(&self, py: Python<'py>) -> Array<'py> {
        line(py, self.0.center_of_mass.0.to_vec())
    }

    fn inertia(&self) -> Inertia {
        Inertia(self.0.inertia)
    }

    fn inertia_about(&self, point: Rows<'_>) -> PyResult<Inertia> {
        self.0.inertia_about(Vector(one(&point)?)).map(Inertia).map_err(bad)
    }

    /// The first of some moments of the weight about the origin, rows (n, 3), that contradicts the centre of mass.
    fn other_weight(&self, moments: Rows<'_>) -> PyResult<Option<usize>> {
        let rows = numbers(&moments)?.as_chunks::<3>().0;
        Ok(rows.iter().position(|c| !self.0.has_weight_moment(Vector(*c))))
    }

    fn moved(&self, rotor_row: Rows<'_>, position: Rows<'_>) -> PyResult<Body> {
        self.0.moved(rotor(&rotor_row)?, Vector(one(&position)?)).map(Body).map_err(bad)
    }

    fn combine(&self, other: &Body) -> PyResult<Body> {
        self.0.combine(&other.0).map(Body).map_err(bad)
    }
}
