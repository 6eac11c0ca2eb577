//! Motion: the closed form of the symmetric top, and simulation.

use crate::arrays::{Array, Rows, bad, line, numbers, one, table};
use crate::bodies::{Inertia, rotor};
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::SimulateError;
use polhode_rigid::simulate::{Options, Problem, Progress};
use polhode_rigid::splitting::{METHODS, Method};
use polhode_rigid::symmetric_top::SymmetricTop;
use polhode_rigid::torque::Torque;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::time::{Duration, Instant};

/// How often a run looks for Ctrl-C and reports where it stands.
const BETWEEN_SIGNALS: Duration = Duration::from_millis(50);

/// Names of the methods, by rising order.
#[pyfunction]
pub(crate) fn methods() -> Vec<&'static str> {
    METHODS.iter().map(|m| m.name).collect()
}

fn torque(name: &str, values: &[f64]) -> PyResult<Torque> {
    match (name, values) {
        ("heavy", &[x, y, z]) => Ok(Torque::Heavy(Vector([x, y, z]))),
        ("gravity_gradient", &[n]) => Ok(Torque::GravityGradient(n)),
        ("constant_body", &[x, y, z]) => Ok(Torque::ConstantBody(Bivector([x, y, z]))),
        ("constant_space", &[x, y, z]) => Ok(Torque::ConstantSpace(Bivector([x, y, z]))),
        ("damping", &[g]) => Ok(Torque::Damping(g)),
        _ => Err(bad(format!("no torque law {name} with {} numbers", values.len()))),
    }
}

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

/// Finite.
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
    laws: Vec<(String, Vec<f64>)>,
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
    let laws = laws.iter().map(|(name, values)| torque(name, values)).collect::<PyResult<Vec<_>>>()?;
    let problem = Problem::new(&inertia.0, rotor(&rotor_row)?, Bivector(one(&omega)?), &laws);
    let times = numbers(&times)?;
    let mut watcher = Watcher { progress: progress.as_ref(), last: Instant::now(), error: None };
    let outcome = py.detach(|| {
        let result = problem.simulate(times, Options { method, step, rtol }, &mut |at| watcher.go_on(at));
        (result, watcher.error)
    });
    let motion = match outcome {
        (Ok(motion), _) => motion,
        (Err(SimulateError::Interrupted), Some(error)) => return Err(error),
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
