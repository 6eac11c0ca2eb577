//! Motion: the closed form of the symmetric top, and simulation.

use crate::arrays::{Array, Rows, bad, line, numbers, one, table, threads};
use crate::bodies::{Inertia, rotor};
use crate::pool;
use crate::torque::{Law, failed};
use numpy::PyArrayMethods;
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::SimulateError;
use polhode_rigid::free::FreeMotion;
use polhode_rigid::simulate::{Options, Problem, Progress, check_horizon};
use polhode_rigid::splitting::{METHODS, Method};
use polhode_rigid::symmetric_top::SymmetricTop;
use polhode_rigid::torque::Torque;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::time::{Duration, Instant};

/// How often a run looks for Ctrl-C and reports where it stands.
const BETWEEN_SIGNALS: Duration = Duration::from_millis(50);

/// Free states between looks for Ctrl-C.
const PIECE: usize = 1 << 19;

/// Names of the methods, by rising order.
#[pyfunction]
pub(crate) fn methods() -> Vec<&'static str> {
    METHODS.iter().map(|m| m.name).collect()
}

fn check_times(times: &[f64]) -> PyResult<()> {
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

/// Calls `progress(pass, fraction)` and looks for Ctrl-C, at most every 50 ms; keeps the error it met.
struct Watcher<'a> {
    progress: Option<&'a Py<PyAny>>,
    last: Instant,
    error: Option<PyErr>,
}

impl Watcher<'_> {
    fn go_on(&mut self, at: Progress) -> bool {
        if self.last.elapsed() < BETWEEN_SIGNALS {
            return true;
        }
        self.last = Instant::now();
        let outcome = Python::attach(|py| {
            py.check_signals()?;
            self.progress.map_or(Ok(()), |call| call.call1(py, (at.pass, at.fraction)).map(drop))
        });
        self.error = outcome.err();
        self.error.is_none()
    }
}

/// Simulates: rotors (n, 4), angular velocities (n, 3) in the body, momenta (n, 3) in space, energies
/// (n,), and the certificate as a dict.
#[pyfunction]
#[pyo3(signature = (inertia, rotor_row, omega, laws, times, method, step, rtol, progress))]
#[allow(clippy::too_many_arguments, clippy::type_complexity)]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    inertia: &Inertia,
    rotor_row: Rows<'py>,
    omega: Rows<'py>,
    laws: Vec<Bound<'py, Law>>,
    times: Rows<'py>,
    method: &str,
    step: Option<f64>,
    rtol: Option<f64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Array<'py>, Array<'py>, Array<'py>, Array<'py>, Bound<'py, PyDict>)> {
    let method = match method {
        "auto" => None,
        name => Some(Method::from_name(name).ok_or_else(|| bad(format!("unknown method {name}")))?),
    };
    let torques: Vec<Torque> = laws.iter().map(|law| law.get().torque.clone()).collect();
    let problem = Problem::new(&inertia.0, rotor(&rotor_row)?, Bivector(one(&omega)?), &torques);
    let times = numbers(&times)?;
    let mut watcher = Watcher { progress: progress.as_ref(), last: Instant::now(), error: None };
    let outcome = py.detach(|| {
        let result = problem.simulate(times, Options { method, step, rtol }, &mut |at| watcher.go_on(at));
        (result, watcher.error)
    });
    let motion = match outcome {
        (Ok(motion), _) => motion,
        (Err(SimulateError::Interrupted), Some(error)) => return Err(error),
        (Err(error @ SimulateError::Torque { .. }), _) => return Err(failed(&laws, error)),
        (Err(error), _) => return Err(bad(error)),
    };
    let proof = &motion.certificate;
    let certificate = PyDict::new(py);
    certificate.set_item("method", proof.method)?;
    certificate.set_item("step", proof.step)?;
    certificate.set_item("steps", proof.steps)?;
    certificate.set_item("error_estimate", proof.error_estimate)?;
    let (conserved, drift) = (PyDict::new(py), PyDict::new(py));
    for (quantity, value, change) in &proof.drifts {
        conserved.set_item(quantity.name(), value)?;
        drift.set_item(quantity.name(), change)?;
    }
    certificate.set_item("conserved", conserved)?;
    certificate.set_item("drift", drift)?;
    certificate.set_item("norm_drift", proof.norm_drift)?;
    Ok((
        table(py, motion.rotors.iter().map(|r| r.components()))?,
        table(py, motion.omegas.iter().map(|w| w.0))?,
        table(py, motion.momenta_space.iter().map(|l| l.0))?,
        line(py, motion.energies),
        certificate,
    ))
}
