//! Closed forms with torque: Lagrange's top, the damped body, the sphere in a field.

use super::bodies::{Inertia, rotor};
use crate::support::arrays::{Array, Rows, bad, numbers, one, threads};
use crate::support::facts::dict;
use crate::support::pool;
use numpy::PyArrayMethods;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::SimulateError;
use polhode_rigid::exact::damped;
use polhode_rigid::exact::lagrange;
use polhode_rigid::exact::larmor;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// States between checks for Ctrl-C.
const PIECE: usize = 1 << 16;

/// Rotors (n, 4) and angular velocities (n, 3) at times (n,).
type States<'py> = PyResult<(Array<'py>, Array<'py>)>;

/// The states from a function that fills rows for a chunk of the times, between two horizons.
fn states<'py>(
    py: Python<'py>,
    times: &Rows<'py>,
    horizons: [f64; 2],
    fill: impl Fn(&[f64], &mut [f64], &mut [f64]) + Sync,
) -> States<'py> {
    let times = numbers(times)?;
    for (index, &time) in times.iter().enumerate() {
        if !time.is_finite() {
            return Err(bad(format!("time {time} at index {index} is not finite")));
        }
        let horizon = horizons[usize::from(time > 0.0)];
        if time.abs() > horizon {
            return Err(bad(SimulateError::BeyondHorizon { index, time, start: 0.0, horizon }));
        }
    }
    let (rotors, omegas) = (pool::array(py, &[times.len(), 4])?, pool::array(py, &[times.len(), 3])?);
    let (mut rotor_rows, mut omega_rows) = (rotors.readwrite(), omegas.readwrite());
    let rows = rotor_rows.as_slice_mut()?.chunks_mut(4 * PIECE);
    let pieces = times.chunks(PIECE).zip(rows.zip(omega_rows.as_slice_mut()?.chunks_mut(3 * PIECE)));
    for (times, (rotors, omegas)) in pieces {
        py.detach(|| fill(times, rotors, omegas));
        py.check_signals()?;
    }
    drop((rotor_rows, omega_rows));
    Ok((rotors, omegas))
}

/// Fills the rows one by one.
fn one_by_one(at: impl Fn(f64) -> (Rotor, Bivector)) -> impl Fn(&[f64], &mut [f64], &mut [f64]) {
    move |times, rotors, omegas| {
        let rows = rotors.as_chunks_mut::<4>().0.iter_mut().zip(omegas.as_chunks_mut::<3>().0);
        for (&t, (r, w)) in times.iter().zip(rows) {
            let (rotor, omega) = at(t);
            (*r, *w) = (rotor.components(), omega.0);
        }
    }
}

/// Lagrange's heavy top.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct LagrangeTop(lagrange::LagrangeTop);

#[pymethods]
impl LagrangeTop {
    #[new]
    fn new(inertia: &Inertia, rotor_row: Rows<'_>, omega: Rows<'_>, c: Rows<'_>) -> PyResult<LagrangeTop> {
        let (omega, c) = (Bivector(one(&omega)?), Vector(one(&c)?));
        lagrange::LagrangeTop::new(&inertia.0, rotor(&rotor_row)?, omega, c).map(LagrangeTop).map_err(bad)
    }

    fn at<'py>(&self, py: Python<'py>, times: Rows<'py>) -> States<'py> {
        let threads = threads(7 * numbers(&times)?.len())?;
        let fill = |times: &[f64], r: &mut [f64], w: &mut [f64]| self.0.at_many(threads, times, r, w);
        states(py, &times, [self.0.horizon(); 2], fill)
    }

    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict(py, self.0.describe().facts())
    }
}

/// A body with the torque −g L.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct DampedTop(damped::DampedTop);

#[pymethods]
impl DampedTop {
    #[new]
    fn new(inertia: &Inertia, rotor_row: Rows<'_>, omega: Rows<'_>, g: f64) -> PyResult<DampedTop> {
        let omega = Bivector(one(&omega)?);
        damped::DampedTop::new(&inertia.0, rotor(&rotor_row)?, omega, g).map(DampedTop).map_err(bad)
    }

    fn at<'py>(&self, py: Python<'py>, times: Rows<'py>) -> States<'py> {
        states(py, &times, self.0.horizons(), one_by_one(|t| self.0.at(t)))
    }
}

/// A sphere with the torque L x b.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct LarmorSphere(larmor::LarmorSphere);

#[pymethods]
impl LarmorSphere {
    #[new]
    fn new(inertia: &Inertia, rotor_row: Rows<'_>, omega: Rows<'_>, b: Rows<'_>) -> PyResult<LarmorSphere> {
        let (omega, b) = (Bivector(one(&omega)?), Vector(one(&b)?));
        larmor::LarmorSphere::new(&inertia.0, rotor(&rotor_row)?, omega, b).map(LarmorSphere).map_err(bad)
    }

    fn at<'py>(&self, py: Python<'py>, times: Rows<'py>) -> States<'py> {
        states(py, &times, [self.0.horizon(); 2], one_by_one(|t| self.0.at(t)))
    }
}
