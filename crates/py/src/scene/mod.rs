//! Scene files.

mod draws;
mod reduced;

use crate::algebra::value;
use crate::mechanics::bodies::{Body, Inertia};
use crate::mechanics::ensemble::{Results, run_many};
use crate::mechanics::simulation::Motion;
use crate::mechanics::surfaces::{Triangles, triangles};
use crate::mechanics::torque::Law;
use crate::support::arrays::{Array, Rows, bad, line, numbers, table};
use crate::support::facts::dict;
use draws::{Bodies, PointValues, Points, Varied, bodies, given, inertias, varied};
use polhode_ga::Bivector;
use polhode_ga::formula::Given;
use polhode_ga::product::Grades;
use polhode_rigid::ensemble::Ensemble;
use polhode_rigid::laws::registry::{Entry, TABLE};
use polhode_rigid::laws::torque::{Axes, Torque};
use polhode_rigid::run::Setup;
use polhode_rigid::scene::Push;
use polhode_rigid::{Diagnostic, TriangleMesh, body, scene};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
pub(crate) use reduced::{BinCounts, kept_words, regimes};
use reduced::{Watched, reduced};
use std::path::{Path, PathBuf};

create_exception!(polhode, SceneError, PyValueError, "Errors in a scene file, with their places.");

fn report(diagnostics: &[Diagnostic]) -> PyErr {
    let texts: Vec<String> = diagnostics.iter().map(Diagnostic::to_string).collect();
    SceneError::new_err(texts.join("\n"))
}

/// A scene with its body and laws, ready to run.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Scene {
    scene: scene::Scene,
    body: body::Body,
    laws: Vec<scene::Law>,
}

#[pymethods]
impl Scene {
    /// Reads a scene file and the mesh that it names; `table` returns the text of a table of bodies from its path.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, table: Py<PyAny>) -> PyResult<Scene> {
        let text = |path: &Path| {
            let read = |py: Python<'_>| table.call1(py, (path,))?.extract(py);
            Python::attach(|py| read(py).map_err(|error: PyErr| error.value(py).to_string()))
        };
        let built = py.detach(|| {
            let scene = scene::Scene::read_with(&path, &text)?;
            scene.build().map(|(body, laws)| Scene { scene, body, laws })
        });
        built.map_err(|diagnostics| report(&diagnostics))
    }

    /// The attributes of Python's `Scene`, in SI units.
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Scene { scene, body, laws } = self;
        let formulas: Vec<_> = laws.iter().map(|law| law.formula.as_deref()).collect();
        let law_objects: Vec<Py<Law>> =
            laws.iter().map(|law| named(py, law.torque.clone())).collect::<PyResult<_>>()?;
        let forces: Vec<_> = scene.forces.iter().map(|push| pushed(py, push)).collect::<PyResult<_>>()?;
        let choice = &scene.run.choice;
        let result = PyDict::new(py);
        result.set_item("title", &scene.title)?;
        result.set_item("caption", &scene.caption)?;
        result.set_item("text", &scene.text)?;
        result.set_item("body", Py::new(py, Body(*body))?)?;
        result.set_item("has_mass", scene.has_mass())?;
        result.set_item("solid", scene.solid().map(|solid| dict(py, solid.facts())).transpose()?)?;
        result.set_item("shift", line(py, scene.shift().0.to_vec()))?;
        result.set_item("rotor", line(py, scene.attitude.components().to_vec()))?;
        result.set_item("omega_body", line(py, scene.omega_body().0.to_vec()))?;
        result.set_item("position", line(py, scene.center.position.0.to_vec()))?;
        result.set_item("velocity", line(py, scene.center.velocity.0.to_vec()))?;
        result.set_item("time", scene.time)?;
        result.set_item("laws", law_objects)?;
        result.set_item("formulas", formulas)?;
        result.set_item("forces", forces)?;
        result.set_item("times", line(py, scene.times()))?;
        result.set_item("method", &choice.method)?;
        result.set_item("step", choice.step)?;
        result.set_item("rtol", choice.rtol)?;
        result.set_item("atol", choice.atol)?;
        result.set_item("max_step", choice.max_step)?;
        result.set_item("max_steps", choice.max_steps)?;
        result.set_item("drift_bound", scene.run.drift_bound)?;
        Ok(result)
    }

    /// The inertia of the equations of motion: about the fixed point if there is one.
    fn inertia(&self) -> Inertia {
        Inertia(self.scene.ruling_inertia(&self.body))
    }

    /// The name of the kind of motion.
    #[getter]
    fn kind(&self) -> &'static str {
        self.setup().kind()
    }

    /// Facts that follow from the start, by name.
    fn facts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict(py, self.setup().facts())
    }

    /// For each law its name and, as text, its formula or its numbers.
    fn laws<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.laws.iter().map(|law| dict(py, law.facts())).collect()
    }

    /// The motion of the scene's own body at times.
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        times: Rows<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Motion> {
        let times = numbers(&times)?;
        let (problem, options) = (self.scene.problem(&self.body, &self.laws), self.scene.options());
        Motion::new(py, self.setup(), Vec::new(), progress, |progress| {
            problem.simulate(times, options, progress)
        })
    }

    /// Number of bodies, seed, varied quantities and points of the ensemble; None without one.
    fn ensemble(&self) -> Option<(usize, u64, Vec<Varied>, Option<Points>)> {
        let ensemble = self.scene.ensemble.as_ref()?;
        let varied = ensemble.varied().into_iter().map(varied).collect();
        let points = ensemble.points.as_ref();
        let points = points.map(|points| (points.form, points.number, points.paths().collect()));
        Some((ensemble.number, ensemble.seed, varied, points))
    }

    /// The values that the points give to `count` bodies from number `first` on: for each path an array (count,) or
    /// (count, m) and its unit, empty if unknown, or texts.
    fn given<'py>(&self, py: Python<'py>, first: usize, count: usize) -> PyResult<Vec<PointValues<'py>>> {
        let Some(points) = self.scene.ensemble.as_ref().and_then(|ensemble| ensemble.points.as_ref()) else {
            return Ok(Vec::new());
        };
        let bodies = (first..first.saturating_add(count)).map(|body| body % points.number);
        points
            .given(&self.scene.text, bodies)
            .into_iter()
            .map(|(path, values)| given(py, path, values))
            .collect()
    }

    /// The surface of the mesh or the solid in body axes, in metres, as of a scene file at this path: vertices (n, 3) and
    /// triangles (m, 3); None if the scene has neither.
    fn surface<'py>(&self, py: Python<'py>, path: PathBuf) -> PyResult<Option<Triangles<'py>>> {
        let scene = scene::Scene { path, ..self.scene.clone() };
        let read = py.detach(|| scene.surface_with(&TriangleMesh::read).transpose()).map_err(bad)?;
        read.map(|surface| triangles(py, &surface.vertices, surface.faces)).transpose()
    }

    /// What is kept of the motions of the ensemble, instead of the motions.
    fn ensemble_keep(&self) -> Vec<&'static str> {
        self.scene.ensemble.as_ref().map(|ensemble| ensemble.keep.clone()).unwrap_or_default()
    }

    /// `count` bodies of the ensemble from number `first` on.
    fn draw<'py>(&self, py: Python<'py>, first: usize, count: usize) -> PyResult<Bodies<'py>> {
        bodies(py, &self.bodies(py, first, count)?, self.laws.len())
    }

    /// The motions of bodies of the ensemble from the first on at times, as `simulate_many`, with their inertias (one or
    /// n), and places and velocities at the start (n, 6).
    fn simulate_many<'py>(
        &self,
        py: Python<'py>,
        first: usize,
        count: usize,
        times: Rows<'py>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Results<'py>, Vec<Inertia>, Array<'py>)> {
        let bodies = self.bodies(py, first, count)?;
        let centers = table(py, bodies.starts.iter().map(|start| start.center.components()))?;
        let options = self.scene.options();
        let results = run_many(py, &bodies, &[count], numbers(&times)?, &options, threads, &[], progress)?;
        Ok((results, inertias(&bodies), centers))
    }

    /// The motions of bodies of the ensemble from the first on at times, reduced: the last states, rows of
    /// `polhode_rigid::ensemble::reduce`, and the summary of the bodies. `watched` is what motions are compared with; `counts`
    /// gets the bins of the bodies.
    #[allow(clippy::too_many_arguments)]
    fn reduce_many<'py>(
        &self,
        py: Python<'py>,
        first: usize,
        count: usize,
        times: Rows<'py>,
        watched: Option<Watched<'py>>,
        free: bool,
        counts: Option<&Bound<'py, BinCounts>>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let bodies = self.bodies(py, first, count)?;
        let times = numbers(&times)?;
        let run =
            |threads| run_many(py, &bodies, &[count], times, &self.scene.options(), threads, &[], progress);
        reduced(py, &bodies, times, run, watched, free, counts, threads)
    }
}

impl Scene {
    fn setup(&self) -> Setup {
        self.scene.setup(&self.body, &self.laws)
    }

    /// `count` bodies of the ensemble from number `first` on.
    fn bodies(&self, py: Python<'_>, first: usize, count: usize) -> PyResult<Ensemble> {
        let Some(ensemble) = &self.scene.ensemble else {
            return Err(bad("this scene has no table [ensemble]"));
        };
        let (number, last) = (ensemble.number, first.saturating_add(count));
        if last <= first || last > number {
            return Err(bad(format!("range {first}..{last} is out of bounds for {number} bodies")));
        }
        let built = (&self.body, &self.laws[..]);
        py.detach(|| self.scene.bodies(ensemble, built, first..last)).map_err(bad)
    }
}

/// A law with its name in `polhode.torque` and its arguments.
pub(crate) fn named(py: Python<'_>, torque: Torque) -> PyResult<Py<Law>> {
    let (name, arguments) = match &torque {
        Torque::Tabulated(table) => {
            let times = PyTuple::new(py, table.times())?;
            let rows = PyTuple::new(py, table.torques().iter().map(|Bivector([x, y, z])| (*x, *y, *z)))?;
            let kind = table.kind.name();
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
