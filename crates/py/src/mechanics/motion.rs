//! The symmetric top in closed form.

use super::bodies::{Inertia, rotor};
use crate::support::arrays::{Array, Rows, bad, numbers, one, table};
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::exact::symmetric::SymmetricTop;
use pyo3::prelude::*;

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

/// Checks that an angular velocity is finite.
pub(crate) fn angular_velocity(omega: [f64; 3]) -> PyResult<Bivector> {
    if !omega.iter().all(|x| x.is_finite()) {
        return Err(bad(format!("the angular velocity is {omega:?}; it must be finite")));
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
    let top = SymmetricTop::new(&inertia.0, rotor(&rotor_row)?, angular_velocity(one(&omega)?)?).ok_or_else(
        || {
            let [a, b, c] = inertia.0.principal_moments();
            bad(format!(
                "the principal moments {a}, {b}, {c} kg m² all differ: not a symmetric top; use FreeMotion"
            ))
        },
    )?;
    states(py, numbers(&times)?, |t| top.at(t))
}
