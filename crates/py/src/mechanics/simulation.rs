//! Simulation of one body.

use super::bodies::{Inertia, rotor};
use super::closed_form::check_times;
use super::forces_and_events::{Event, Force};
use super::law_value::{LawValue, failed};
use super::torque::Law;
use crate::support::arrays::{Array, Rows, bad, line, numbers, one, table};
use crate::support::facts::dict;
use polhode_ga::Bivector;
use polhode_rigid::SimulateError;
use polhode_rigid::laws::event::Direction;
use polhode_rigid::methods::Method;
use polhode_rigid::run::{self as rigid, Options, Problem, Progress, Setup, States};
use polhode_rigid::state::center::Center;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::time::{Duration, Instant};

/// Interval between checks for Ctrl-C and calls of `progress`.
const BETWEEN_SIGNALS: Duration = Duration::from_millis(50);

/// Names of the methods, in ascending order.
#[pyfunction]
pub(crate) fn methods() -> Vec<&'static str> {
    polhode_rigid::methods::methods().map(Method::name).collect()
}

/// Calls `progress(pass, fraction)` and checks for Ctrl-C, at most every 50 ms; stores the error raised.
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

/// States of a motion: times (n,), rotors (n, 4), angular velocities (n, 3) in the body, momenta (n, 3) in space, energies
/// (n,), positions (n, 3) and velocities (n, 3).
type Points<'py> = PyResult<[Array<'py>; 7]>;

fn points<'py>(py: Python<'py>, states: States) -> Points<'py> {
    Ok([
        line(py, states.times),
        table(py, states.rotors.iter().map(|r| r.components()))?,
        table(py, states.omegas.iter().map(|w| w.0))?,
        table(py, states.momenta_space.iter().map(|l| l.0))?,
        line(py, states.energies),
        table(py, states.centers.iter().map(|c| c.position.0))?,
        table(py, states.centers.iter().map(|c| c.velocity.0))?,
    ])
}

/// A simulated motion.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Motion {
    motion: rigid::Motion,
    setup: Setup,
    /// The laws and events, which store the exceptions of their functions.
    callbacks: Vec<Py<LawValue>>,
}

impl Motion {
    /// The motion that `simulate` computes, with progress and Ctrl-C.
    pub(crate) fn new(
        py: Python<'_>,
        setup: Setup,
        callbacks: Vec<Py<LawValue>>,
        progress: Option<Py<PyAny>>,
        simulate: impl FnOnce(&mut dyn FnMut(Progress) -> bool) -> Result<rigid::Motion, SimulateError> + Send,
    ) -> PyResult<Motion> {
        run(py, &callbacks, progress.as_ref(), simulate).map(|motion| Motion { motion, setup, callbacks })
    }
}

#[pymethods]
impl Motion {
    fn states<'py>(&self, py: Python<'py>) -> Points<'py> {
        points(py, self.motion.states())
    }

    /// The states at other times.
    fn at<'py>(&self, py: Python<'py>, times: Rows<'py>) -> Points<'py> {
        let times = numbers(&times)?;
        check_times(times)?;
        let states = run(py, &self.callbacks, None, |progress| self.motion.at(times, progress))?;
        points(py, states)
    }

    /// The events in the order of integration: index, whether rising, and states.
    fn events<'py>(&self, py: Python<'py>) -> PyResult<(Vec<usize>, Vec<bool>, [Array<'py>; 7])> {
        let which = self.motion.events.iter().map(|occurrence| occurrence.event).collect();
        let rising =
            self.motion.events.iter().map(|occurrence| occurrence.direction == Direction::Rising).collect();
        Ok((which, rising, points(py, self.motion.event_states())?))
    }

    /// Each conserved quantity's name and its relative change (n,) since the start.
    fn drifts<'py>(&self, py: Python<'py>) -> Vec<(&'static str, Array<'py>)> {
        let drifts = self.motion.drifts().into_iter();
        drifts.map(|(quantity, change)| (quantity.name(), line(py, change))).collect()
    }

    /// The name of its kind.
    #[getter]
    fn kind(&self) -> &'static str {
        self.setup.kind()
    }

    /// The description of the motion, by name.
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict(py, py.detach(|| self.setup.describe(&self.motion)))
    }

    /// Facts that follow from the start, by name.
    fn facts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict(py, self.setup.facts())
    }

    /// The axis of a satellite's least moment, rows (n, 3): along the orbit, on its normal and up. None for other bodies.
    fn long_axis<'py>(&self, py: Python<'py>) -> PyResult<Option<Array<'py>>> {
        let parts = self.setup.long_axis(&self.motion.states());
        parts.map(|parts| table(py, parts.into_iter())).transpose()
    }

    /// How the motion was computed and what it conserved.
    fn certificate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let proof = &self.motion.certificate;
        let certificate = PyDict::new(py);
        certificate.set_item("method", proof.method)?;
        certificate.set_item("step", proof.step)?;
        certificate.set_item("steps", proof.steps)?;
        certificate.set_item("evaluations", proof.evaluations)?;
        certificate.set_item("error_estimate", proof.error_estimate)?;
        let (conserved, drift) = (PyDict::new(py), PyDict::new(py));
        for (quantity, value, change) in &proof.drifts {
            conserved.set_item(quantity.name(), value)?;
            drift.set_item(quantity.name(), change)?;
        }
        certificate.set_item("conserved", conserved)?;
        certificate.set_item("drift", drift)?;
        certificate.set_item("norm_drift", proof.norm_drift)?;
        certificate.set_item("warnings", PyTuple::new(py, &proof.warnings)?)?;
        Ok(certificate)
    }
}

/// Runs without the GIL, with progress and Ctrl-C.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    callbacks: &[Py<LawValue>],
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&mut dyn FnMut(Progress) -> bool) -> Result<T, SimulateError> + Send,
) -> PyResult<T> {
    let mut watcher = Watcher { progress, last: Instant::now(), error: None };
    let (result, error) = py.detach(|| {
        let result = work(&mut |at| watcher.go_on(at));
        (result, watcher.error)
    });
    match (result, error) {
        (Ok(found), _) => Ok(found),
        (Err(SimulateError::Interrupted), Some(error)) => Err(error),
        (Err(error @ (SimulateError::Torque { .. } | SimulateError::Undefined { .. })), _) => {
            Err(failed(callbacks.iter().map(|one| one.bind(py)), error))
        }
        (Err(error), _) => Err(bad(error)),
    }
}

/// The method of a name, and whether the closed form is required.
pub(crate) fn method_of(name: &str) -> PyResult<(Option<Method>, bool)> {
    match name {
        "auto" | "exact" => Ok((None, name == "exact")),
        _ => Method::from_name(name)
            .map(|method| (Some(method), false))
            .ok_or_else(|| bad(format!("unknown method {name}"))),
    }
}

/// The longest step in s, the maximum number of steps of a pass, and times at which steps end.
pub(crate) type Limits = (Option<f64>, Option<f64>, Vec<f64>);

/// Simulates from a start time on. `center` is the position and velocity of the centre of mass; the mass is NaN if
/// unknown.
#[pyfunction]
#[pyo3(signature = (
    inertia, start, rotor_row, omega, laws, center, mass, forces, times, method, step, rtol, limits, events, progress
))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    inertia: &Inertia,
    start: f64,
    rotor_row: Rows<'py>,
    omega: Rows<'py>,
    laws: Vec<Bound<'py, Law>>,
    center: Rows<'py>,
    mass: f64,
    forces: Vec<Bound<'py, Force>>,
    times: Rows<'py>,
    method: &str,
    step: Option<f64>,
    rtol: Option<f64>,
    limits: Limits,
    events: Vec<Bound<'py, Event>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Motion> {
    let (method, exact) = method_of(method)?;
    let callbacks: Vec<Py<LawValue>> = laws
        .iter()
        .map(|law| law.as_super().clone().unbind())
        .chain(forces.iter().map(|force| force.as_super().clone().unbind()))
        .chain(events.iter().map(|event| event.as_super().clone().unbind()))
        .collect();
    let torques: Vec<_> = laws.iter().map(|law| law.get().0.single().cloned()).collect::<PyResult<_>>()?;
    let forces: Vec<_> =
        forces.iter().map(|force| force.get().0.single().cloned()).collect::<PyResult<_>>()?;
    let events = events.iter().map(|event| event.get().event.clone()).collect();
    let center = Center::from(one(&center)?);
    let setup = Setup {
        inertia: inertia.0,
        rotor: rotor(&rotor_row)?,
        omega: Bivector(one(&omega)?),
        time: start,
        torques,
        mass,
        has_forces: !forces.is_empty(),
    };
    let problem = Problem::of(&setup).with_center(center, mass, &forces);
    let times = numbers(&times)?;
    let (max_step, max_steps, breaks) = limits;
    let options = Options { method, step, rtol, exact, max_step, max_steps, breaks, events };
    Motion::new(py, setup, callbacks, progress, |progress| problem.simulate(times, options, progress))
}
