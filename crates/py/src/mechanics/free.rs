//! Free motion of one body or a batch, with solutions kept in Rust.

use super::bodies::{Inertia, Inertias};
use super::closed_form::{ClosedForm, Given, Started, pieces};
use crate::algebra::value::Multivector;
use crate::support::arrays::{Array, Rows, bad, numbers, place, table};
use crate::support::facts::{columns, dict};
use numpy::PyReadonlyArray1;
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::body::inertia;
use polhode_rigid::exact::free::{self, FlowDerivatives, FreeBody};
use polhode_rigid::exact::many::{TILE, Tile};
use polhode_rigid::exact::regime::FreeDescription;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Free motions.
#[pyclass(frozen, extends = ClosedForm, module = "polhode._native")]
pub(crate) struct FreeMotion {
    /// A single motion.
    one: Option<Box<free::FreeMotion>>,
}

fn body(inertia: &inertia::Inertia, rotor: Rotor, omega: Bivector) -> Result<FreeBody, String> {
    if !omega.0.iter().all(|x| x.is_finite()) {
        return Err(format!("the angular velocity is {:?}; it must be finite", omega.0));
    }
    FreeBody::new(inertia, rotor, omega).map_err(|error| error.to_string())
}

fn motion(inertia: &inertia::Inertia, rotor: Rotor, omega: Bivector) -> Result<free::FreeMotion, String> {
    body(inertia, rotor, omega).map(|body| body.motion())
}

/// A motion of a batch, which was set up successfully before.
fn again(motions: &ClosedForm, row: usize) -> Result<free::FreeMotion, String> {
    let (inertia, &(rotor, omega), _) = motions.given(row);
    let rotor = Rotor::from_components(rotor).map_err(|error| error.to_string())?;
    motion(inertia, rotor, Bivector(omega))
}

/// The components of a single value, if it has just these grades.
pub(crate) fn components<const N: usize>(value: &Bound<'_, PyAny>, grades: Grades) -> Option<[f64; N]> {
    let value = value.cast::<Multivector>().ok()?.get().single()?;
    (value.grades() == grades).then(|| value.components().try_into().ok())?
}

#[pymethods]
impl FreeMotion {
    /// The motion of a single body from a single Rotor and a single bivector, or three floats; None for other
    /// types.
    #[staticmethod]
    fn single(
        inertia: &Inertia,
        rotor: &Bound<'_, PyAny>,
        omega: &Bound<'_, PyAny>,
    ) -> PyResult<Option<Py<FreeMotion>>> {
        let py = rotor.py();
        let is_rotor = rotor.cast::<Multivector>().is_ok_and(|value| value.get().unit);
        let Some(rotor) = components(rotor, Grades::EVEN).filter(|_| is_rotor) else { return Ok(None) };
        let omega = match omega.extract::<PyReadonlyArray1<'_, f64>>() {
            Ok(array) => array.as_array().to_vec().try_into().ok(),
            Err(_) => components(omega, Grades::BIVECTOR),
        };
        let Some(omega) = omega else { return Ok(None) };
        let turn = Rotor::from_components(rotor).map_err(bad)?;
        let one = motion(&inertia.0, turn, Bivector(omega)).map_err(bad)?;
        let base = ClosedForm::single(one, inertia.0, (rotor, omega));
        let one = Some(Box::new(one));
        Py::new(py, PyClassInitializer::from(base).add_subclass(FreeMotion { one })).map(Some)
    }

    /// Motions of a batch from one inertia, or one for each; rotors (…, 4) and angular velocities (…, 3).
    #[staticmethod]
    fn batch(
        py: Python<'_>,
        inertias: Inertias,
        rotors: Rows<'_>,
        omegas: Rows<'_>,
    ) -> PyResult<Py<FreeMotion>> {
        let given = Given { inertias, rotors, omegas, parameters: None };
        let free = |started: &Started<'_, 0>| body(started.inertia, started.rotor, started.omega);
        let one = |started: &Started<'_, 0>| free(started).map(|body| body.motion());
        let (motions, one) =
            ClosedForm::new(py, given, one, |bodies| Tile::free(bodies.map(|started| free(&started?))))?;
        let one = one.map(Box::new);
        Py::new(py, PyClassInitializer::from(motions).add_subclass(FreeMotion { one }))
    }

    /// The description as a dict; for a batch with lists and arrays, NaN for None.
    fn describe<'py>(this: PyRef<'_, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = FreeMotion::each(&this, py, 0..this.as_super().count(), |one| Ok(one.describe()))?;
        if let ([one], []) = (&rows[..], this.as_super().batch()) {
            return dict(py, one.facts());
        }
        let sphere = inertia::Inertia::from_principal_moments([1.0; 3]).map_err(bad)?;
        let at_rest = free::FreeMotion::new(&sphere, Rotor::IDENTITY, Bivector::default()).map_err(bad)?;
        columns(py, at_rest.describe().facts(), rows.iter().map(FreeDescription::facts))
    }

    /// Angular velocities in body axes along the polhode, n for each motion.
    fn polhode<'py>(this: PyRef<'_, Self>, py: Python<'py>, count: usize) -> PyResult<Array<'py>> {
        let curves = FreeMotion::each(&this, py, 0..this.as_super().count(), |one| Ok(one.polhode(count)))?;
        let all: Vec<Bivector> = curves.into_iter().flatten().collect();
        table(py, all.into_iter().map(|omega| omega.0))
    }

    /// The same in space axes, over a number of periods.
    fn herpolhode<'py>(
        this: PyRef<'_, Self>,
        py: Python<'py>,
        count: usize,
        periods: f64,
    ) -> PyResult<Array<'py>> {
        let curves = FreeMotion::each(&this, py, 0..this.as_super().count(), |one| {
            one.herpolhode(count, periods).map_err(|error| error.to_string())
        })?;
        let all: Vec<Bivector> = curves.into_iter().flatten().collect();
        table(py, all.into_iter().map(|omega| omega.0))
    }

    /// Derivatives of all motions at all times, rows motion by motion: of the rotor by attitude, angular velocity
    /// and moments (rows, 12) and by time (rows, 4), of the angular velocity by itself and the moments (rows, 9)
    /// and by time (rows, 3).
    #[allow(clippy::type_complexity)]
    fn derivatives<'py>(
        this: PyRef<'_, Self>,
        py: Python<'py>,
        times: Rows<'py>,
    ) -> PyResult<(Array<'py>, Array<'py>, Array<'py>, Array<'py>, Array<'py>, Array<'py>, Array<'py>)> {
        let times = numbers(&times)?;
        let motions: &ClosedForm = this.as_super();
        motions.check(times)?;
        let mut found: Vec<FlowDerivatives> = Vec::with_capacity(motions.count() * times.len());
        // Data shared by the derivatives of a motion is large, so motions are processed in groups.
        for first in (0..motions.count()).step_by(TILE) {
            let group = first..(first + TILE).min(motions.count());
            let common = FreeMotion::each(&this, py, group, |one| Ok(one.differentiated()))?;
            found.extend(pieces(py, common.len() * times.len(), 1, |row| {
                common[row / times.len()].at(times[row % times.len()])
            })?);
        }
        if let Some(row) = found.iter().position(|one| !one.is_finite()) {
            let (body, index) = (place(row / times.len(), motions.batch()), row % times.len());
            return Err(bad(format!(
                "{body}the derivatives at times[{index}] = {:e} s overflow, because the rotation is \
                 unstable; use times closer to 0",
                times[index]
            )));
        }
        Ok((
            table(py, found.iter().map(|one| flat::<4, 12>(&one.rotor_by_attitude)))?,
            table(py, found.iter().map(|one| flat::<4, 12>(&one.rotor_by_omega)))?,
            table(py, found.iter().map(|one| flat::<4, 12>(&one.rotor_by_moments)))?,
            table(py, found.iter().map(|one| one.rotor_by_time))?,
            table(py, found.iter().map(|one| flat::<3, 9>(&one.omega_by_omega)))?,
            table(py, found.iter().map(|one| flat::<3, 9>(&one.omega_by_moments)))?,
            table(py, found.iter().map(|one| one.omega_by_time))?,
        ))
    }
}

/// A matrix row by row.
pub(crate) fn flat<const N: usize, const ALL: usize>(rows: &[[f64; 3]; N]) -> [f64; ALL] {
    std::array::from_fn(|k| rows[k / 3][k % 3])
}

impl FreeMotion {
    /// The motions of a batch, or a single one.
    fn each<T: Send>(
        this: &PyRef<'_, Self>,
        py: Python<'_>,
        rows: std::ops::Range<usize>,
        work: impl Fn(free::FreeMotion) -> Result<T, String> + Sync,
    ) -> PyResult<Vec<T>> {
        if let Some(one) = &this.one {
            return Ok(vec![py.detach(|| work(**one)).map_err(bad)?]);
        }
        let motions: &ClosedForm = this.as_super();
        let found = pieces(py, rows.len(), 1, |row| again(motions, rows.start + row).and_then(&work))?;
        let failed = |row: usize, error| bad(format!("{}{error}", place(row, motions.batch())));
        found.into_iter().zip(rows).map(|(one, row)| one.map_err(|error| failed(row, error))).collect()
    }
}
