//! Scene files.

use crate::arrays::line;
use crate::bodies::Body;
use polhode_rigid::torque::Torque;
use polhode_rigid::{Diagnostic, scene};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

create_exception!(polhode, SceneError, PyValueError, "What is wrong with a scene file, with its places.");

fn report(diagnostics: &[Diagnostic]) -> PyErr {
    let texts: Vec<String> = diagnostics.iter().map(Diagnostic::to_string).collect();
    SceneError::new_err(texts.join("\n"))
}

/// Reads a scene file: a dict of what it says, in SI units, with the body made.
#[pyfunction]
pub(crate) fn read_scene<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyDict>> {
    let built = py.detach(|| {
        let scene = scene::Scene::read(&path)?;
        scene.build().map(|(body, torques)| (scene, body, torques))
    });
    let (scene, body, torques) = built.map_err(|diagnostics| report(&diagnostics))?;
    let heavy = torques.iter().find_map(|torque| match torque {
        Torque::Heavy(c) => Some(c.0),
        _ => None,
    });
    let result = PyDict::new(py);
    result.set_item("title", &scene.title)?;
    result.set_item("text", &scene.text)?;
    result.set_item("body", Py::new(py, Body(body))?)?;
    result.set_item("tells_mass", scene.tells_mass())?;
    result.set_item("rotor", line(py, scene.attitude.components().to_vec()))?;
    result.set_item("omega_body", line(py, scene.omega_body().0.to_vec()))?;
    result.set_item("heavy", heavy.map(|c| line(py, c.to_vec())))?;
    result.set_item("times", line(py, scene.run.times()))?;
    result.set_item("method", &scene.run.method)?;
    result.set_item("step", scene.run.step)?;
    result.set_item("rtol", scene.run.rtol)?;
    result.set_item("drift_bound", scene.run.drift_bound)?;
    Ok(result)
}
