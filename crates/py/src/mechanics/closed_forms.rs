//! Closed forms: Lagrange's top, the damped body, the sphere in a field, the free symmetric top.

use super::bodies::{Inertia, Inertias, rotor};
use super::closed_form::{ClosedForm, Given, Started, States, check_times, filled, pieces};
use crate::support::arrays::{Rows, bad, numbers, one};
use crate::support::facts::{columns, dict};
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::body::inertia;
use polhode_rigid::exact::damped::DampedTop;
use polhode_rigid::exact::lagrange::{self, HeavyTop, LagrangeDescription};
use polhode_rigid::exact::larmor::LarmorSphere;
use polhode_rigid::exact::many::Tile;
use polhode_rigid::exact::symmetric::SymmetricTop;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// States between checks for Ctrl-C.
const PIECE: usize = 1 << 16;

/// Lagrange's heavy tops.
#[pyclass(frozen, extends = ClosedForm, module = "polhode._native")]
pub(crate) struct LagrangeTop {
    /// A single top.
    one: Option<Box<lagrange::LagrangeTop>>,
}

fn heavy_top(&Started { inertia, rotor, omega, law }: &Started<'_, 3>) -> Result<HeavyTop, String> {
    HeavyTop::new(inertia, rotor, omega, Vector(law)).map_err(|error| error.to_string())
}

fn heavy(body: &Started<'_, 3>) -> Result<lagrange::LagrangeTop, String> {
    heavy_top(body)?.motion().map_err(|error| error.to_string())
}

fn damped(&Started { inertia, rotor, omega, law: [g] }: &Started<'_, 1>) -> Result<DampedTop, String> {
    DampedTop::new(inertia, rotor, omega, g).map_err(|error| error.to_string())
}

fn larmor(&Started { inertia, rotor, omega, law }: &Started<'_, 3>) -> Result<LarmorSphere, String> {
    LarmorSphere::new(inertia, rotor, omega, Vector(law)).map_err(|error| error.to_string())
}

#[pymethods]
impl LagrangeTop {
    #[new]
    fn new(
        py: Python<'_>,
        inertias: Inertias,
        rotors: Rows<'_>,
        omegas: Rows<'_>,
        c: Rows<'_>,
    ) -> PyResult<PyClassInitializer<LagrangeTop>> {
        let given = Given { inertias, rotors, omegas, parameters: Some(c) };
        let (tops, one) =
            ClosedForm::new(py, given, heavy, |bodies| Tile::lagrange(bodies.map(|body| heavy_top(&body?))))?;
        Ok(PyClassInitializer::from(tops).add_subclass(LagrangeTop { one: one.map(Box::new) }))
    }

    /// The description as a dict; for a batch with lists and arrays, NaN for None.
    fn describe<'py>(this: PyRef<'_, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        if let Some(top) = &this.one {
            return dict(py, top.describe().facts());
        }
        let tops: &ClosedForm = this.as_super();
        let rows = pieces(py, tops.count(), 1, |row| {
            let (inertia, (rotor, omega), c) = tops.given(row);
            let rotor = Rotor::from_components(*rotor).map_err(|error| error.to_string())?;
            let law = c.try_into().unwrap_or([f64::NAN; 3]);
            heavy(&Started { inertia, rotor, omega: Bivector(*omega), law }).map(|top| top.describe())
        })?;
        let rows: Vec<LagrangeDescription> = rows.into_iter().collect::<Result<_, _>>().map_err(bad)?;
        let sphere = inertia::Inertia::from_principal_moments([1.0; 3]).map_err(bad)?;
        let (rotor, omega) = (Rotor::IDENTITY, Bivector::default());
        let at_rest = heavy(&Started { inertia: &sphere, rotor, omega, law: [0.0; 3] }).map_err(bad)?;
        columns(py, at_rest.describe().facts(), rows.iter().map(LagrangeDescription::facts))
    }
}

/// Bodies with the torque −g L.
#[pyfunction]
pub(crate) fn damped_tops(
    py: Python<'_>,
    inertias: Inertias,
    rotors: Rows<'_>,
    omegas: Rows<'_>,
    g: Rows<'_>,
) -> PyResult<ClosedForm> {
    let given = Given { inertias, rotors, omegas, parameters: Some(g) };
    let (tops, _) = ClosedForm::new(py, given, damped, |bodies| {
        Tile::damped(bodies.map(|body| {
            let Started { inertia, rotor, omega, law: [g] } = body?;
            let body = DampedTop::body(inertia, rotor, omega, g).map_err(|error| error.to_string())?;
            Ok((body, g))
        }))
    })?;
    Ok(tops)
}

/// Spheres with the torque L x b.
#[pyfunction]
pub(crate) fn larmor_spheres(
    py: Python<'_>,
    inertias: Inertias,
    rotors: Rows<'_>,
    omegas: Rows<'_>,
    b: Rows<'_>,
) -> PyResult<ClosedForm> {
    let given = Given { inertias, rotors, omegas, parameters: Some(b) };
    let (spheres, _) =
        ClosedForm::new(py, given, larmor, |bodies| Tile::new(bodies.map(|body| larmor(&body?))))?;
    Ok(spheres)
}

/// The free symmetric top.
#[pyfunction]
pub(crate) fn symmetric_top<'py>(
    py: Python<'py>,
    inertia: &Inertia,
    rotor_row: Rows<'py>,
    omega: Rows<'py>,
    times: Rows<'py>,
) -> States<'py> {
    let omega = Bivector(one(&omega)?);
    let top = SymmetricTop::new(&inertia.0, rotor(&rotor_row)?, omega).ok_or_else(|| {
        let [a, b, c] = inertia.0.principal_moments();
        bad(format!(
            "the principal moments {a}, {b}, {c} kg m² all differ: not a symmetric top; use FreeMotion"
        ))
    })?;
    let times = numbers(&times)?;
    check_times(times)?;
    filled(py, times.len(), PIECE, |rows, rotors, omegas| {
        let states = rotors.as_chunks_mut::<4>().0.iter_mut().zip(omegas.as_chunks_mut::<3>().0);
        for (&t, (r, w)) in times[rows].iter().zip(states) {
            let (rotor, omega) = top.at(t);
            (*r, *w) = (rotor.components(), omega.0);
        }
    })
}
