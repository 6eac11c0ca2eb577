//! Simulation of ensembles.

use super::bodies::Inertias;
use super::columns::spread;
use super::forces_and_events::Force;
use super::law_value::{LawValue, interrupted};
use super::simulation::{Limits, method_of, run};
use super::torque::Law;
use crate::support::arrays::{Array, Rows, all_threads, bad, line, numbers, place};
use crate::support::pool;
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::SimulateError;
use polhode_rigid::ensemble::{self, Drift, Ensemble, Outputs, Start, Summary};
use polhode_rigid::run::Options;
use polhode_rigid::state::center::Center;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Rotors, angular velocities, momenta, energies and, where forces move them, places and velocities of all bodies at all
/// times, body by body; and the summary of the bodies.
pub(crate) type Results<'py> = (Vec<Array<'py>>, Bound<'py, PyDict>);

/// Simulates bodies of a batch shape. Inertias with their shape, start times (…), rotors (…, 4), angular velocities (…, 3), laws, places and
/// velocities (…, 6) and masses (…), NaN where unknown, broadcast to it. Neither the batch nor the times may be empty.
#[pyfunction]
#[pyo3(signature = (
    shape, inertias, begins, rotors, omegas, laws, centers, masses, forces, times, method, step, rtol, limits, threads,
    progress
))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn simulate_many<'py>(
    py: Python<'py>,
    shape: Vec<usize>,
    inertias: (Inertias, Vec<usize>),
    begins: Rows<'py>,
    rotors: Rows<'py>,
    omegas: Rows<'py>,
    laws: Vec<Bound<'py, Law>>,
    centers: Rows<'py>,
    masses: Rows<'py>,
    forces: Vec<Bound<'py, Force>>,
    times: Rows<'py>,
    method: &str,
    step: Option<f64>,
    rtol: Option<f64>,
    limits: Limits,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Results<'py>> {
    let (method, exact) = method_of(method)?;
    if shape.contains(&0) || times.len() == 0 {
        return Err(bad("no bodies or no times to simulate"));
    }
    let callbacks = callbacks(&laws, &forces);
    let ensemble = ensemble_of(&shape, inertias, &[begins, rotors, omegas, centers, masses], &laws, &forces)?;
    let (max_step, max_steps, breaks) = limits;
    let events = Vec::new();
    let options = Options { method, step, rtol, exact, max_step, max_steps, breaks, events };
    run_many(py, &ensemble, &shape, numbers(&times)?, &options, threads, &callbacks, progress)
}

/// The laws and forces, which store the exceptions of their functions.
pub(crate) fn callbacks(laws: &[Bound<'_, Law>], forces: &[Bound<'_, Force>]) -> Vec<Py<LawValue>> {
    let laws = laws.iter().map(|law| law.as_super().clone().unbind());
    laws.chain(forces.iter().map(|force| force.as_super().clone().unbind())).collect()
}

/// The bodies of a batch shape; `numbers` are start times, rotors, angular velocities, places with velocities, and masses.
pub(crate) fn ensemble_of(
    shape: &[usize],
    (Inertias(inertias), own_shape): (Inertias, Vec<usize>),
    [begins, rotors, omegas, centers, masses]: &[Rows<'_>; 5],
    laws: &[Bound<'_, Law>],
    forces: &[Bound<'_, Force>],
) -> PyResult<Ensemble> {
    Ok(Ensemble {
        inertias: ensemble::Rows::new(spread(inertias, &own_shape, shape)?.into_owned()),
        starts: starts(shape, begins, rotors, omegas, centers)?,
        laws: laws.iter().map(|law| law.get().0.of_bodies(shape)).collect::<PyResult<_>>()?,
        masses: ensemble::Rows::new(spread(numbers(masses)?, masses.shape(), shape)?.into_owned()),
        forces: forces.iter().map(|force| force.get().0.of_bodies(shape)).collect::<PyResult<_>>()?,
    })
}

/// Runs the bodies of a batch shape.
#[allow(clippy::too_many_arguments)]
pub(crate) fn run_many<'py>(
    py: Python<'py>,
    ensemble: &Ensemble,
    shape: &[usize],
    times: &[f64],
    options: &Options,
    threads: Option<usize>,
    callbacks: &[Py<LawValue>],
    progress: Option<Py<PyAny>>,
) -> PyResult<Results<'py>> {
    if let Some((body, error)) = ensemble.first_unusable() {
        return Err(bad(format!("{}{error}", place(body, shape))));
    }
    let threads = threads.map_or_else(all_threads, |count| Ok(Threads::new(count)))?;
    let bodies = ensemble.starts.len();
    let sizes: &[usize] = if ensemble.forces.is_empty() { &[4, 3, 3, 1] } else { &[4, 3, 3, 1, 3, 3] };
    let arrays = sizes.iter().map(|&size| pool::array(py, &[bodies, times.len(), size]));
    let arrays: Vec<Array<'py>> = arrays.collect::<PyResult<_>>()?;
    let summary = {
        let mut rows: Vec<_> = arrays.iter().map(|array| array.readwrite()).collect();
        let slices: Vec<&mut [f64]> =
            rows.iter_mut().map(|row| row.as_slice_mut()).collect::<Result<_, _>>()?;
        let mut slices = slices.into_iter();
        let mut next = || slices.next().unwrap_or_default();
        let (rotors, omegas, momenta, energies) = (next(), next(), next(), next());
        let centers = (!ensemble.forces.is_empty()).then(|| [next(), next()]);
        let outputs = Outputs { rotors, omegas, momenta, energies, centers };
        run(py, callbacks, progress.as_ref(), |progress| {
            ensemble.run(times, options, threads, outputs, progress)
        })?
    };
    interrupted(callbacks.iter().map(|one| one.bind(py)))?;
    let unfit = summary.failures.iter().find(|failure| matches!(failure.error, SimulateError::Unfit { .. }));
    if let Some(failure) = unfit {
        return Err(bad(format!("{}{}", place(failure.body, shape), failure.error)));
    }
    Ok((arrays, dictionary(py, summary)?))
}

/// The starts of the bodies.
pub(crate) fn starts(
    shape: &[usize],
    begins: &Rows<'_>,
    rotors: &Rows<'_>,
    omegas: &Rows<'_>,
    centers: &Rows<'_>,
) -> PyResult<Vec<Start>> {
    let count = shape.iter().product();
    let begins = spread(numbers(begins)?, begins.shape(), shape)?;
    let whose = if batch(rotors).is_empty() { &[] } else { shape };
    let rotors = spread(numbers(rotors)?.as_chunks::<4>().0, batch(rotors), shape)?;
    let rotor = |body: usize| {
        let rotor = Rotor::from_components(*one_of(&rotors, body));
        rotor.map_err(|error| bad(format!("{}{error}", place(body, whose))))
    };
    let omegas = spread(numbers(omegas)?.as_chunks::<3>().0, batch(omegas), shape)?;
    let centers = spread(numbers(centers)?.as_chunks::<6>().0, batch(centers), shape)?;
    let common = if rotors.len() == 1 { Some(rotor(0)?) } else { None };
    let mut starts = Vec::with_capacity(count);
    for body in 0..count {
        starts.push(Start {
            time: *one_of(&begins, body),
            rotor: common.map_or_else(|| rotor(body), Ok)?,
            omega: Bivector(*one_of(&omegas, body)),
            center: Center::from(*one_of(&centers, body)),
        });
    }
    Ok(starts)
}

fn one_of<T>(rows: &[T], body: usize) -> &T {
    &rows[if rows.len() == 1 { 0 } else { body }]
}

fn batch<'a>(rows: &'a Rows<'_>) -> &'a [usize] {
    rows.shape().split_last().map_or(&[][..], |(_, batch)| batch)
}

/// The summary as a dict: arrays with one number per body, and lists of numbers, times and messages of failures.
fn dictionary<'py>(py: Python<'py>, summary: Summary) -> PyResult<Bound<'py, PyDict>> {
    // Collecting them reuses the memory.
    let counts = |words: Vec<u64>| PyArray1::from_vec(py, words.into_iter().map(|n| n as i64).collect());
    let (conserved, drift) = (PyDict::new(py), PyDict::new(py));
    for Drift { name, values, changes } in summary.drifts {
        conserved.set_item(name, line(py, values))?;
        drift.set_item(name, line(py, changes))?;
    }
    let failures = &summary.failures;
    let result = PyDict::new(py);
    result.set_item("methods", (&summary.method_names, counts(summary.methods)))?;
    result.set_item("steps", counts(summary.steps))?;
    result.set_item("evaluations", counts(summary.evaluations))?;
    result.set_item("step", line(py, summary.longest))?;
    result.set_item("error_estimate", line(py, summary.estimates))?;
    result.set_item("conserved", conserved)?;
    result.set_item("drift", drift)?;
    result.set_item("norm_drift", line(py, summary.norm_drifts))?;
    result.set_item("failed", failures.iter().map(|failure| failure.body).collect::<Vec<_>>())?;
    result.set_item("failure_times", failures.iter().map(|failure| failure.time).collect::<Vec<_>>())?;
    let messages: Vec<String> = failures.iter().map(|failure| failure.error.to_string()).collect();
    result.set_item("messages", messages)?;
    result.set_item("warnings", summary.warnings)?;
    Ok(result)
}
