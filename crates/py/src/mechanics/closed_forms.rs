//! Closed forms: Lagrange's top, the damped body, the sphere in a field, the free symmetric top.

use super::bodies::{Inertia, rotor};
use crate::support::arrays::{Array, Rows, bad, numbers, one, threads};
use crate::support::facts::dict;
use crate::support::pool;
use numpy::PyArrayMethods;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::exact::damped;
use polhode_rigid::exact::lagrange;
use polhode_rigid::exact::larmor;
use polhode_rigid::exact::symmetric::SymmetricTop;
use polhode_rigid::state::checks::check_horizons;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::Range;

/// States between checks for Ctrl-C.
const PIECE: usize = 1 << 16;

/// Rotors (n, 4) and angular velocities (n, 3) at times (n,).
pub(crate) type States<'py> = PyResult<(Array<'py>, Array<'py>)>;

/// `count` states from a function that fills a range of rows; signals are checked after `piece` rows.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    count: usize,
    piece: usize,
    fill: impl Fn(Range<usize>, &mut [f64], &mut [f64]) + Sync,
) -> States<'py> {
    let (rotors, omegas) = (pool::array(py, &[count, 4])?, pool::array(py, &[count, 3])?);
    let (mut rotor_rows, mut omega_rows) = (rotors.readwrite(), omegas.readwrite());
    let rows = rotor_rows.as_slice_mut()?.chunks_mut(4 * piece);
    let pieces = rows.zip(omega_rows.as_slice_mut()?.chunks_mut(3 * piece));
    for (part, (rotors, omegas)) in pieces.enumerate() {
        let rows = part * piece..part * piece + rotors.len() / 4;
        py.detach(|| fill(rows, rotors, omegas));
        py.check_signals()?;
    }
    drop((rotor_rows, omega_rows));
    Ok((rotors, omegas))
}

pub(crate) fn check_times(times: &[f64]) -> PyResult<()> {
    match times.iter().position(|t| !t.is_finite()) {
        Some(index) => Err(bad(format!("time {} at index {index} is not finite", times[index]))),
        None => Ok(()),
    }
}

/// Checks that an angular velocity is finite.
pub(crate) fn angular_velocity(omega: [f64; 3]) -> PyResult<Bivector> {
    if !omega.iter().all(|x| x.is_finite()) {
        return Err(bad(format!("the angular velocity is {omega:?}; it must be finite")));
    }
    Ok(Bivector(omega))
}

/// The states from a function that fills rows for a chunk of the times, between two horizons.
fn states<'py>(
    py: Python<'py>,
    times: &Rows<'py>,
    horizons: [f64; 2],
    fill: impl Fn(&[f64], &mut [f64], &mut [f64]) + Sync,
) -> States<'py> {
    let times = numbers(times)?;
    check_times(times)?;
    check_horizons(0.0, times, horizons).map_err(bad)?;
    filled(py, times.len(), PIECE, |rows, rotors, omegas| fill(&times[rows], rotors, omegas))
}

/// The same from a function that fills rows in lanes and threads.
fn many_states<'py>(
    py: Python<'py>,
    times: &Rows<'py>,
    horizons: [f64; 2],
    at_many: impl Fn(Threads, &[f64], &mut [f64], &mut [f64]) + Sync,
) -> States<'py> {
    let threads = threads(7 * numbers(times)?.len())?;
    states(py, times, horizons, |times, rotors, omegas| at_many(threads, times, rotors, omegas))
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
        many_states(py, &times, [self.0.horizon(); 2], |threads, t, r, w| self.0.at_many(threads, t, r, w))
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
        many_states(py, &times, self.0.horizons(), |threads, t, r, w| self.0.at_many(threads, t, r, w))
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

/// The free symmetric top.
#[pyfunction]
pub(crate) fn symmetric_top<'py>(
    py: Python<'py>,
    inertia: &Inertia,
    rotor_row: Rows<'py>,
    omega: Rows<'py>,
    times: Rows<'py>,
) -> States<'py> {
    let top = SymmetricTop::new(&inertia.0, rotor(&rotor_row)?, angular_velocity(one(&omega)?)?).ok_or_else(
        || {
            let [a, b, c] = inertia.0.principal_moments();
            bad(format!(
                "the principal moments {a}, {b}, {c} kg m² all differ: not a symmetric top; use FreeMotion"
            ))
        },
    )?;
    states(py, &times, [f64::INFINITY; 2], one_by_one(|t| top.at(t)))
}
