//! A scene and its motion.

pub mod crowd;

use crate::rows::{ROW, rows};
use crowd::{Crowd, Slice};
use polhode_rigid::body::mesh::MeshError;
use polhode_rigid::run::{Motion, Problem, Progress, Setup};
use polhode_rigid::scene::Law;
use polhode_rigid::{Body, Diagnostic, Scene, SimulateError, Surface, TriangleMesh};
use std::cell::OnceCell;
use std::collections::HashMap;
use std::path::Path;

/// Contents of files, by their names in a scene.
pub type Files = HashMap<String, Vec<u8>>;

/// Called regularly during a run; returns whether to go on.
pub type GoOn<'a> = &'a mut dyn FnMut() -> bool;

/// A scene with its computed motion.
pub struct Opened {
    /// The scene.
    pub scene: Scene,
    /// The body; under gravity the fixed point is the origin of its axes.
    pub body: Body,
    /// The torque laws.
    pub laws: Vec<Law>,
    /// The rotation of the body: its start and all torques.
    pub setup: Setup,
    /// The problem that was solved.
    pub problem: Problem,
    /// The motion.
    pub motion: Motion,
    /// The surface of the body in body axes, if it is a mesh or a solid.
    pub surface: Option<Surface>,
    crowd: OnceCell<Result<Crowd, String>>,
}

/// The diagnostics as text.
fn texts(problems: &[Diagnostic]) -> String {
    let texts: Vec<String> = problems.iter().map(Diagnostic::to_string).collect();
    texts.join("\n")
}

impl Opened {
    /// Reads a scene and computes its motion at its output times, with the same bits as Python. Errors have places in
    /// the scene, or report that the time limit was exceeded.
    pub fn new(text: &str, name: &str, files: &Files, go_on: GoOn) -> Result<Opened, String> {
        let table = |path: &Path| table_among(files, path);
        let scene = Scene::parse_with(text, Path::new(name), &table).map_err(|problems| texts(&problems))?;
        // A scene has at most one mesh; the body and its surface both need it.
        let read = OnceCell::new();
        let source = |path: &Path| read.get_or_init(|| mesh_among(files, path)).clone();
        let (body, laws) = scene.build_with(&source).map_err(|problems| texts(&problems))?;
        let surface = scene.surface_with(&source).and_then(Result::ok);
        let problem = scene.problem(&body, &laws);
        let motion = problem.simulate(&scene.times(), scene.options(), &mut |_: Progress| go_on());
        let motion = motion.map_err(in_words)?;
        let setup = scene.setup(&body, &laws);
        Ok(Opened { scene, body, laws, setup, problem, motion, surface, crowd: OnceCell::new() })
    }

    /// Rows of states at any times: within the horizon of an exact motion, else within the run.
    pub fn states(&self, times: &[f64]) -> Result<Vec<[f64; ROW]>, String> {
        let states = match self.motion.exactly(times) {
            Some(states) => states,
            None => self.motion.at(times, &mut |_| true),
        };
        states.map(|states| rows(&states)).map_err(|error| error.to_string())
    }

    /// The first bodies of the ensemble, at most `count`; the first call computes them, unless [`Opened::join`] was called.
    pub fn bodies(&self, count: usize, go_on: GoOn) -> Result<&Crowd, String> {
        self.crowd.get_or_init(|| Crowd::new(self, count, go_on)).as_ref().map_err(String::clone)
    }

    /// Why the first of the computed bodies that are not known is not, with its number; empty if all are.
    pub fn bodies_problem(&self) -> &str {
        match self.crowd.get() {
            Some(Ok(crowd)) => crowd.problem(),
            _ => "",
        }
    }

    /// Takes the first bodies of the ensemble as other cores computed them.
    pub fn join(&mut self, slice: Slice) {
        self.crowd = Ok(Crowd::of_slice(self, slice)).into();
    }
}

/// The error of a motion in the words of the page.
fn in_words(error: SimulateError) -> String {
    match error {
        SimulateError::Interrupted => {
            "this motion takes too long to compute in the page; shorten [run] duration, \
                                       increase [run] rtol, or use `polhode run` or `polhode view`"
                .to_owned()
        }
        error => error.to_string(),
    }
}

/// The surface of the mesh or the solid of a scene, in body axes; None if it has neither or cannot be read.
pub fn surface(text: &str, name: &str, files: &Files) -> Option<Surface> {
    let scene = Scene::parse_with(text, Path::new(name), &|path: &Path| table_among(files, path)).ok()?;
    scene.surface_with(&|path: &Path| mesh_among(files, path))?.ok()
}

/// The text of a table of bodies in one of the files.
fn table_among(files: &Files, path: &Path) -> Result<String, String> {
    let name = path.display().to_string();
    let Some(bytes) =
        files.get(&name).filter(|_| path.extension().is_some_and(|extension| extension == "csv"))
    else {
        return Err(format!(
            "{name}: the page does not read this table; write its values in `list`, or use `polhode run`"
        ));
    };
    String::from_utf8(bytes.clone()).map_err(|_| format!("{name}: not UTF-8 text, save the file as UTF-8"))
}

/// The mesh in one of the files.
fn mesh_among(files: &Files, path: &Path) -> Result<TriangleMesh, MeshError> {
    let missing = "the page does not have this file; open it together with the scene";
    TriangleMesh::read_with(path, || files.get(&path.display().to_string()).ok_or(missing.to_owned()))
}
