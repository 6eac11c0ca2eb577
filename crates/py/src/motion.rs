//! Free motion in closed form.

use crate::arrays::{Array, Rows, bad, numbers, one, table, threads};
use crate::bodies::{Inertia, rotor};
use crate::pool;
use numpy::PyArrayMethods;
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::free::FreeMotion;
use polhode_rigid::simulate::check_horizon;
use polhode_rigid::symmetric_top::SymmetricTop;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Free states between looks for Ctrl-C.
const PIECE: usize = 1 << 19;

pub(crate) fn check_times(times: &[f64]) -> PyResult<()> {
    match times.iter().position(|t| !t.is_finite()) {
        Some(index) => Err(bad(format!("time {} at index {index} is not finite", times[index]))),
        None => Ok(()),
    }
}

/// Rotors (n, 4) and angular velocities (n, 3) at times (n,).
type States<'py> = PyResult<(Array<'py>, Array<'py>)>;

fn states<'py>(py: Python<'py>, times: &[f64], at: impl Fn(f64) -> (Rotor, Bivector) + Sync) -> States<'py> {
    check_times(times)?;
    let states: Vec<_> = py.detach(|| times.iter().map(|&t| at(t)).collect());
    let rotors = table(py, states.iter().map(|s| s.0.components()))?;
    Ok((rotors, table(py, states.iter().map(|s| s.1.0))?))
}

fn angular_velocity(omega: &Rows<'_>) -> PyResult<Bivector> {
    let omega: [f64; 3] = one(omega)?;
    if !omega.iter().all(|x| x.is_finite()) {
        return Err(bad(format!("the angular velocity {omega:?} is not finite")));
    }
    Ok(Bivector(omega))
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
    let top =
        SymmetricTop::new(&inertia.0, rotor(&rotor_row)?, angular_velocity(&omega)?).ok_or_else(|| {
            let [a, b, c] = inertia.0.principal_moments();
            bad(format!(
                "the principal moments {a}, {b}, {c} kg m² all differ: not a symmetric top; use FreeMotion"
            ))
        })?;
    states(py, numbers(&times)?, |t| top.at(t))
}

/// The free top. Threads share large batches; Python may interrupt between pieces of some milliseconds.
#[pyfunction]
pub(crate) fn free_motion<'py>(
    py: Python<'py>,
    inertia: &Inertia,
    rotor_row: Rows<'py>,
    omega: Rows<'py>,
    times: Rows<'py>,
) -> States<'py> {
    let motion = FreeMotion::new(&inertia.0, rotor(&rotor_row)?, angular_velocity(&omega)?).map_err(bad)?;
    let times = numbers(&times)?;
    check_times(times)?;
    check_horizon(times, motion.horizon()).map_err(bad)?;
    let (rotors, omegas) = (pool::array(py, &[times.len(), 4])?, pool::array(py, &[times.len(), 3])?);
    let (mut rotor_rows, mut omega_rows) = (rotors.readwrite(), omegas.readwrite());
    let rows = rotor_rows.as_slice_mut()?.chunks_mut(4 * PIECE);
    let pieces = times.chunks(PIECE).zip(rows.zip(omega_rows.as_slice_mut()?.chunks_mut(3 * PIECE)));
    let threads = threads(7 * times.len())?;
    for (times, (rotors, omegas)) in pieces {
        py.detach(|| motion.at_many(threads, times, rotors, omegas));
        py.check_signals()?;
    }
    drop((rotor_rows, omega_rows));
    Ok((rotors, omegas))
}

/// What the invariants of a free motion tell, as a dict.
#[pyfunction]
pub(crate) fn describe_free<'py>(
    py: Python<'py>,
    inertia: &Inertia,
    omega: Rows<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let d = FreeMotion::new(&inertia.0, Rotor::IDENTITY, angular_velocity(&omega)?).map_err(bad)?.describe();
    let result = PyDict::new(py);
    result.set_item("regime", d.regime.to_string())?;
    result.set_item("axis", d.axis + 1)?;
    result.set_item("modulus", d.modulus)?;
    result.set_item("energy", d.energy)?;
    result.set_item("angular_momentum", d.angular_momentum)?;
    result.set_item("period", d.period)?;
    result.set_item("precession_rate", d.precession_rate)?;
    result.set_item("precession_period", d.precession_period())?;
    result.set_item("flip_time", d.flip_time())?;
    Ok(result)
}
