//! Scene files.

pub(crate) mod draws;

use crate::algebra::value;
use crate::mechanics::bodies::Body;
use crate::mechanics::torque::Law;
use crate::support::arrays::{Array, bad, line, table};
use draws::Draws;
use polhode_ga::Bivector;
use polhode_ga::formula::Given;
use polhode_ga::product::Grades;
use polhode_rigid::laws::registry::{Entry, TABLE};
use polhode_rigid::laws::torque::{Axes, Kind, Torque};
use polhode_rigid::scene::Push;
use polhode_rigid::{Diagnostic, Size, Solid, TriangleMesh, scene};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::PathBuf;

create_exception!(polhode, SceneError, PyValueError, "What is wrong with a scene file, with its places.");

fn report(diagnostics: &[Diagnostic]) -> PyErr {
    let texts: Vec<String> = diagnostics.iter().map(Diagnostic::to_string).collect();
    SceneError::new_err(texts.join("\n"))
}

/// Reads a scene file: a dict of what it says, in SI units, with the body and the laws made.
#[pyfunction]
pub(crate) fn read_scene<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyDict>> {
    let built = py.detach(|| {
        let scene = scene::Scene::read(&path)?;
        scene.build().map(|(body, laws)| (scene, body, laws))
    });
    let (scene, body, laws) = built.map_err(|diagnostics| report(&diagnostics))?;
    let (position, velocity) = (scene.center.position, scene.center.velocity);
    let formulas: Vec<Option<String>> = laws.iter().map(|law| law.formula.clone()).collect();
    let made: Vec<Py<Law>> = laws.iter().map(|law| named(py, law.torque.clone())).collect::<PyResult<_>>()?;
    let forces: Vec<_> = scene.forces.iter().map(|push| pushed(py, push)).collect::<PyResult<_>>()?;
    let result = PyDict::new(py);
    result.set_item("title", &scene.title)?;
    result.set_item("text", &scene.text)?;
    result.set_item("body", Py::new(py, Body(body))?)?;
    result.set_item("tells_mass", scene.tells_mass())?;
    result.set_item("solid", scene.solid().map(|solid| sizes(py, solid)).transpose()?)?;
    result.set_item("shift", line(py, scene.shift().0.to_vec()))?;
    result.set_item("rotor", line(py, scene.attitude.components().to_vec()))?;
    result.set_item("omega_body", line(py, scene.omega_body().0.to_vec()))?;
    result.set_item("position", line(py, position.0.to_vec()))?;
    result.set_item("velocity", line(py, velocity.0.to_vec()))?;
    result.set_item("time", scene.time)?;
    result.set_item("laws", made)?;
    result.set_item("formulas", formulas)?;
    result.set_item("forces", forces)?;
    result.set_item("times", line(py, scene.times()))?;
    result.set_item("method", &scene.run.choice.method)?;
    result.set_item("step", scene.run.choice.step)?;
    result.set_item("rtol", scene.run.choice.rtol)?;
    result.set_item("atol", scene.run.choice.atol)?;
    result.set_item("max_step", scene.run.choice.max_step)?;
    result.set_item("max_steps", scene.run.choice.max_steps)?;
    result.set_item("drift_bound", scene.run.drift_bound)?;
    result.set_item("ensemble", Draws::of(py, scene, body, laws)?)?;
    Ok(result)
}

/// The kind of a solid and its sizes, by the names that scenes give them.
fn sizes(py: Python<'_>, solid: Solid) -> PyResult<Bound<'_, PyDict>> {
    let (kind, sizes) = solid.sizes();
    let told = PyDict::new(py);
    told.set_item("kind", kind)?;
    for (name, size) in sizes {
        match size {
            Size::One(length) => told.set_item(name, length)?,
            Size::Three(lengths) => told.set_item(name, lengths.to_vec())?,
        }
    }
    Ok(told)
}

/// The mesh that a scene names, in the axes of its body and in metres: vertices (n, 3) and triangles (m, 3); none where
/// it names none.
#[pyfunction]
pub(crate) fn scene_mesh(py: Python<'_>, path: PathBuf) -> PyResult<Option<(Array<'_>, Vec<[u32; 3]>)>> {
    let read = py.detach(|| {
        let scene = scene::Scene::read(&path).map_err(|problems| report(&problems))?;
        let mesh = scene.mesh_with(&TriangleMesh::read).transpose().map_err(bad)?;
        Ok::<_, PyErr>(mesh.map(|mesh| mesh.moved(scene.shift())))
    })?;
    read.map(|mesh| Ok((table(py, mesh.vertices().iter().map(|v| v.0))?, mesh.faces().to_vec()))).transpose()
}

/// A law with its name in `polhode.torque` and its arguments.
pub(crate) fn named(py: Python<'_>, torque: Torque) -> PyResult<Py<Law>> {
    let (name, arguments) = match &torque {
        Torque::Tabulated(table) => {
            let times = PyTuple::new(py, table.times())?;
            let rows = PyTuple::new(py, table.torques().iter().map(|Bivector([x, y, z])| (*x, *y, *z)))?;
            let kind = if table.kind == Kind::Cubic { "cubic" } else { "linear" };
            (TABLE, (times, rows, axes(table.axes), kind).into_pyobject(py)?)
        }
        Torque::Formula(law) => {
            let known = law.known().map(|(name, given)| Ok((name, known(py, given)?)));
            let known = PyTuple::new(py, known.collect::<PyResult<Vec<_>>>()?)?;
            ("formula", (law.text(), axes(law.axes()), known).into_pyobject(py)?)
        }
        _ => {
            let Some((entry, numbers)) = torque.registered() else {
                return Err(PyValueError::new_err("a scene has no Python functions"));
            };
            (entry.name, split(py, entry, &numbers)?)
        }
    };
    Law::named(py, torque, name, arguments)
}

fn axes(axes: Axes) -> &'static str {
    if axes == Axes::Space { "space" } else { "body" }
}

/// The value of a name in a formula.
fn known(py: Python<'_>, given: Given) -> PyResult<Bound<'_, PyAny>> {
    match given {
        Given::Value(value) if value.grades() == Grades::SCALAR => {
            Ok(value.components()[0].into_pyobject(py)?.into_any())
        }
        Given::Value(value) => value::one(py, value),
        _ => Err(PyValueError::new_err("a scene defines no linear maps")),
    }
}

/// The arguments of a law from their numbers.
fn split<'py, T>(py: Python<'py>, entry: &Entry<T>, numbers: &[f64]) -> PyResult<Bound<'py, PyTuple>> {
    let argument = |(_, own): (_, &[f64])| match own {
        [x] => Ok(x.into_pyobject(py)?.into_any()),
        own => Ok(PyTuple::new(py, own)?.into_any()),
    };
    PyTuple::new(py, entry.split(numbers).map(argument).collect::<PyResult<Vec<_>>>()?)
}

/// The name of a force in `polhode.force` and its arguments.
fn pushed<'py>(py: Python<'py>, push: &Push) -> PyResult<(&'static str, Bound<'py, PyTuple>)> {
    let Some((entry, numbers)) = push.registered() else {
        return Err(PyValueError::new_err("a scene has no such force"));
    };
    Ok((entry.name, split(py, entry, &numbers)?))
}
