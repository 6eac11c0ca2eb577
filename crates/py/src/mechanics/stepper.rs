//! Bodies stepped by a caller, who holds a torque over each step.

use super::bodies::Inertias;
use super::ensemble::{callbacks, ensemble_of, starts};
use super::forces_and_events::Force;
use super::free::components;
use super::law_value::{LawValue, failed, interrupted};
use super::simulation::method_of;
use super::torque::Law;
use crate::algebra::value::{one, one_rotor};
use crate::support::arrays::{Array, Rows, bad, numbers, place};
use crate::support::pool;
use numpy::{PyArrayMethods, PyReadonlyArray1};
use polhode_ga::product::Grades;
use polhode_ga::{Graded, Rotor};
use polhode_rigid::SimulateError;
use polhode_rigid::laws::torque::Axes;
use polhode_rigid::stepper::{self, Failed, Held};
use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// Bodies of a batch shape with their states at a common time.
#[pyclass(module = "polhode._native")]
pub(crate) struct Stepper {
    stepper: stepper::Stepper,
    shape: Vec<usize>,
    callbacks: Vec<Py<LawValue>>,
}

#[pymethods]
impl Stepper {
    /// Bodies of a batch shape, which is not empty; arguments as of `simulate_many`. Steps are at most `longest` seconds.
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        shape: Vec<usize>,
        inertias: (Inertias, Vec<usize>),
        begins: Rows<'_>,
        rotors: Rows<'_>,
        omegas: Rows<'_>,
        laws: Vec<Bound<'_, Law>>,
        centers: Rows<'_>,
        masses: Rows<'_>,
        forces: Vec<Bound<'_, Force>>,
        method: &str,
        longest: f64,
    ) -> PyResult<Stepper> {
        let (Some(method), _) = method_of(method)? else {
            return Err(bad(format!("a stepper needs a stepping method, got {method}")));
        };
        let ensemble =
            ensemble_of(&shape, inertias, &[begins, rotors, omegas, centers, masses], &laws, &forces)?;
        let callbacks = callbacks(&laws, &forces);
        let stepper = stepper::Stepper::new(&ensemble, method, longest)
            .map_err(|(body, error)| bad(format!("{}{error}", place(body, &shape))))?;
        Ok(Stepper { stepper, shape, callbacks })
    }

    /// Sets the states, rows of the batch shape.
    fn reset(
        &mut self,
        begins: Rows<'_>,
        rotors: Rows<'_>,
        omegas: Rows<'_>,
        centers: Rows<'_>,
    ) -> PyResult<()> {
        self.stepper.reset(&starts(&self.shape, &begins, &rotors, &omegas, &centers)?);
        Ok(())
    }

    /// A step of a single body under a single torque; rotor and angular velocity. None, and no step, for anything else.
    fn step_once<'py>(
        &mut self,
        dt: f64,
        torque: &Bound<'py, PyAny>,
        in_space: bool,
    ) -> PyResult<Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>> {
        if !self.shape.is_empty() {
            return Ok(None);
        }
        let py = torque.py();
        let held = match torque.extract::<PyReadonlyArray1<'_, f64>>() {
            Ok(array) => array.as_array().iter().copied().collect::<Vec<_>>().try_into().ok(),
            Err(_) => components(torque, Grades::BIVECTOR),
        };
        let rows: &[[f64; 3]] = match &held {
            Some(row) => std::slice::from_ref(row),
            None if torque.is_none() => &[],
            None => return Ok(None),
        };
        self.advance(py, dt, rows, in_space)?;
        let (mut rotor, mut omega) = ([[0.0; 4]], [[0.0; 3]]);
        self.stepper.write(&mut rotor, &mut omega);
        let Some(omega) = Graded::new(&omega[0], Grades::BIVECTOR) else { return Ok(None) };
        Ok(Some((one_rotor(py, Rotor::from_unit_components(rotor[0]))?, one(py, omega)?)))
    }

    /// A step of length `dt`, with the torques (n, 3) of one body or of each; no rows for none.
    fn step(&mut self, py: Python<'_>, dt: f64, torques: Rows<'_>, in_space: bool) -> PyResult<()> {
        self.advance(py, dt, numbers(&torques)?.as_chunks().0, in_space)
    }

    /// The number of wheels with motors of each body.
    #[getter]
    fn wheels(&self) -> usize {
        self.stepper.wheels()
    }

    /// Commands the motors of all wheels from now on, (k,) for all bodies or (n, k).
    fn command(&mut self, torques: Rows<'_>) -> PyResult<()> {
        self.stepper.command(numbers(&torques)?);
        Ok(())
    }

    /// The speeds of all wheels relative to their bodies now, (…, k).
    fn wheel_speeds<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let speeds = self.rows(py, self.stepper.wheels())?;
        speeds.readwrite().as_slice_mut()?.copy_from_slice(&self.stepper.wheel_speeds());
        Ok(speeds)
    }

    #[getter]
    fn time(&self) -> f64 {
        self.stepper.time()
    }

    /// Whether the centres of mass move.
    #[getter]
    fn moves(&self) -> bool {
        self.stepper.moves()
    }

    /// Rotors (…, 4) and angular velocities (…, 3) now.
    fn spins<'py>(&self, py: Python<'py>) -> PyResult<(Array<'py>, Array<'py>)> {
        let (rotors, omegas) = (self.rows(py, 4)?, self.rows(py, 3)?);
        let (mut r, mut w) = (rotors.readwrite(), omegas.readwrite());
        self.stepper.write(r.as_slice_mut()?.as_chunks_mut().0, w.as_slice_mut()?.as_chunks_mut().0);
        drop((r, w));
        Ok((rotors, omegas))
    }

    /// Positions and velocities (…, 3) of the centres of mass now.
    fn centers<'py>(&self, py: Python<'py>) -> PyResult<(Array<'py>, Array<'py>)> {
        let (positions, velocities) = (self.rows(py, 3)?, self.rows(py, 3)?);
        let (mut x, mut v) = (positions.readwrite(), velocities.readwrite());
        let rows = x.as_slice_mut()?.as_chunks_mut().0.iter_mut().zip(v.as_slice_mut()?.as_chunks_mut().0);
        for (center, (x, v)) in self.stepper.centers().zip(rows) {
            (*x, *v) = (center.position.0, center.velocity.0);
        }
        drop((x, v));
        Ok((positions, velocities))
    }
}

impl Stepper {
    fn advance(&mut self, py: Python<'_>, dt: f64, torques: &[[f64; 3]], in_space: bool) -> PyResult<()> {
        if let Some(body) = torques.iter().position(|torque| !torque.iter().all(|x| x.is_finite())) {
            let shape = if torques.len() == 1 { &[] } else { &self.shape[..] };
            return Err(bad(format!(
                "{}the torque is {:?}; it must be finite",
                place(body, shape),
                torques[body]
            )));
        }
        let held = Held { torques, axes: if in_space { Axes::Space } else { Axes::Body } };
        let stepper = &mut self.stepper;
        let (mut last, mut raised) = (Instant::now(), None);
        let mut go_on = || {
            if last.elapsed() >= BETWEEN_SIGNALS {
                raised = Python::attach(|py| py.check_signals()).err();
                last = Instant::now();
            }
            raised.is_none()
        };
        let done = if self.callbacks.is_empty() && stepper.count() < LARGE {
            stepper.step_while(dt, held, &mut go_on)
        } else {
            py.detach(|| stepper.step_while(dt, held, &mut go_on))
        };
        if let Some(error) = raised {
            return Err(error);
        }
        let bound = || self.callbacks.iter().map(|one| one.bind(py));
        done.map_err(|(body, error): Failed| match error {
            SimulateError::Torque { .. } | SimulateError::Undefined { .. } => {
                failed(bound(), format!("{}{error}", place(body, &self.shape)))
            }
            _ => bad(format!("{}{error}", place(body, &self.shape))),
        })?;
        if self.callbacks.is_empty() { Ok(()) } else { interrupted(bound()) }
    }

    fn rows<'py>(&self, py: Python<'py>, size: usize) -> PyResult<Array<'py>> {
        let shape: Vec<usize> = self.shape.iter().copied().chain([size]).collect();
        pool::array(py, &shape)
    }
}

/// Interval between checks for Ctrl-C within a step.
const BETWEEN_SIGNALS: Duration = Duration::from_millis(50);

/// Number of bodies from which other Python threads may run during a step.
const LARGE: usize = 256;
