//! Scene files in TOML: a body, its initial state, the laws, and the run.
//!
//! ```toml
//! title = "optional text"
//! caption = "optional text: what the motion shows"
//!
//! [define]                   # optional: names and functions for formulas, in which numbers may have units
//! "θ" = "30 deg"
//! "unit(B)" = "B/norm(B)"
//!
//! [body]                     # exactly one of: mesh, solid, moments, inertia
//! solid = "box"              # box lengths; ellipsoid semi_axes; sphere radius; cylinder radius, height; …
//! lengths = ["10 cm", "5 cm", "2 cm"]
//! density = "7.85 g/cm^3"    # or mass
//! # mesh = "part.stl"        # a path relative to this file; length_unit = "mm"; density or mass
//! # moments = ["3 kg m^2", 2, 1]    # about the centre of mass; mass and center_of_mass optional
//! # inertia = [[3, 0, 0], [0, 2, 0], [0, 0, 1]]
//!
//! [initial]
//! attitude = { plane = "e1e2", angle = "30 deg" }  # or rotor = [4]; quaternion = [4], order = "wxyz";
//!                                                  # rotation_vector = [3]; the identity if left out
//!                                                  # or attitude = "exp(-θ/2 e1∧e2)", a formula
//! spin = { plane = "e2e3", rate = "5 rev/s" }      # or vector = [3]; bivector = [3]; formula = "…"; frame = "space"
//! time = "0 s"               # the initial time, for laws that depend on time; 0 by default
//!
//! [gravity]                  # optional: along −e3 of space, the body held at a fixed point
//! acceleration = "9.81 m/s^2"
//! pivot = ["0 m", 0, 0]      # in body coordinates; the origin if left out
//!
//! [torque]                   # optional: laws that add up, to gravity too
//! damping = "0.1 /s"
//! torque_body = "-k Ω_B"     # a formula; or torque_space
//!
//! [force]                    # optional: forces on the centre of mass
//! drag = "0.1 N s/m"
//!
//! [run]
//! duration = "10 s"
//! samples = 1001             # or interval = "10 ms"; first = "1 ms": from there on in equal ratios
//! drift_bound = 1e-8         # optional
//!
//! [method]                   # optional, as are all its fields; name (as method), step and rtol may stand in [run]
//! name = "auto"
//! step = "1 ms"
//! rtol = 1e-10
//! atol = 1e-10
//!
//! [ensemble]                 # optional: many bodies that differ at random from this one
//! number = 100_000
//! seed = 7                   # 0 if left out
//! attitude = "uniform"       # or { normal = "2 deg" }, one or three along the body axes: turned by a rotation vector
//! spin = { relative = 0.01 } # or normal, uniform, as below; direction = "uniform" alone or with one of them
//! moments = { relative = 0.02 }           # each integral of x_k² dm along the principal axes
//! position = { normal = "1 mm" }          # or { uniform = … }, half widths; one or three; velocity too
//! gravity.acceleration = { normal = "1e-3 m/s^2" }
//! torque.damping = { relative = 0.1 }     # times exp(0.1 n); or normal, uniform: any parameter of a law
//! torque.magnetic.dipole = { normal = ["1 mA m^2", 0, 0] }
//! keep = ["last", "extrema"] # optional, instead of the motions; also regime, periods, quantiles, events
//! covariance = { of = ["velocity"], matrix = [[…], …] }          # normal, correlated
//! grid.torque.damping = [0.1, 0.2]        # given values, each with each; or list, side by side; or table = "bodies.csv"
//! ```
//!
//! A bare number is in SI units, a string has a unit. All errors in a file are reported at once, each with its line and
//! column; [`Scene::diagnose`] gives later errors their place.

mod body;
mod build;
mod correlated;
mod covariance;
mod definitions;
mod draws;
mod ensemble;
#[cfg(test)]
mod file_tests;
mod formulas;
mod individual;
mod initial;
mod laws;
mod parameters;
mod parts;
mod points;
mod reader;
mod run;
mod solve;
mod spread;
mod syntax;
#[cfg(test)]
mod tests;

pub use crate::laws::force::Push;
pub use crate::laws::registry::Limit;
use crate::state::center::Center;
pub use body::BodySpec;
pub use build::MeshSource;
pub use draws::DrawError;
pub use ensemble::{Attitudes, Ensemble, KEPT, Varied};
pub use initial::SpinFrame;
pub use laws::Law;
pub use parameters::Parameter;
pub use points::{Given, Points, TableSource};
use polhode_ga::diagnostic::Diagnostic;
use polhode_ga::{Bivector, Rotor, Vector};
use reader::{Reader, Table};
pub use run::{Choice, Run};
pub use spread::{Form, Spread};
use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::de::DeTable;

/// Maximum size of a scene file in bytes.
const LARGEST_FILE: u64 = 10_000_000;
/// Names at the top of a file, but for those of formulas.
const NAMES: [&str; 11] = [
    "title", "caption", "define", "body", "initial", "gravity", "torque", "force", "run", "method",
    "ensemble",
];
/// Maximum number of reported errors.
const MOST_REPORTED: usize = 100;

/// A scene file in SI units.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The title.
    pub title: Option<String>,
    /// What the motion shows, in words.
    pub caption: Option<String>,
    /// The body.
    pub body: BodySpec,
    /// The initial rotor from body axes to space axes.
    pub attitude: Rotor,
    /// The initial angular velocity in rad/s, in the axes of `spin_frame`.
    pub spin: Bivector,
    /// The axes of `spin`.
    pub spin_frame: SpinFrame,
    /// The initial centre of mass, or fixed point if there is one.
    pub center: Center,
    /// The initial time in s.
    pub time: f64,
    /// Uniform gravity on a body held at a point.
    pub gravity: Option<Gravity>,
    /// The other torque laws, in the order of the file.
    pub torques: Vec<Law>,
    /// The forces, in the order of the file.
    pub forces: Vec<Push>,
    /// The duration, the output times and the method.
    pub run: Run,
    /// The number of bodies and their distributions, of an ensemble.
    pub ensemble: Option<Ensemble>,
    /// The file, from which paths in it are relative.
    pub path: PathBuf,
    /// The content of the file.
    pub text: String,
}

/// Uniform gravity along −e3 of space on a body held at a fixed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity {
    /// In m/s².
    pub acceleration: f64,
    /// The fixed point in body coordinates, in metres.
    pub pivot: Vector,
}

impl Scene {
    /// Reads a file, and the table of points that it names; the errors are all that the file has, in its order.
    pub fn read(path: &Path) -> Result<Scene, Vec<Diagnostic>> {
        Scene::read_with(path, &read_table)
    }

    /// The same with another source of tables, such as of other formats.
    pub fn read_with(path: &Path, tables: TableSource<'_>) -> Result<Scene, Vec<Diagnostic>> {
        let bytes = read_file(path).map_err(|problem| vec![Diagnostic::of_file(path, problem)])?;
        match std::str::from_utf8(&bytes) {
            Ok(text) => Scene::parse_with(text, path, tables),
            Err(error) => {
                // Up to the error the lossy text is the text.
                let (text, start) = (String::from_utf8_lossy(&bytes), error.valid_up_to());
                let message = "not UTF-8 text from here on, save the file as UTF-8";
                Err(vec![Diagnostic::at(path, &text, start..start, message)])
            }
        }
    }

    /// Reads the text of the file at `path`, which need not exist.
    pub fn parse(text: &str, path: &Path) -> Result<Scene, Vec<Diagnostic>> {
        Scene::parse_with(text, path, &read_table)
    }

    /// The same with another source of tables, as in a browser, which has no files.
    pub fn parse_with(text: &str, path: &Path, tables: TableSource<'_>) -> Result<Scene, Vec<Diagnostic>> {
        if let Some(at) = text.find('\0') {
            // As in UTF-16 without a mark.
            let message = format!("byte {at} is zero, not text; save the file as UTF-8");
            return Err(vec![Diagnostic::at(path, text, at..at, message)]);
        }
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let diagnose = |span: Range<usize>, message: &str| Diagnostic::at(path, text, span, message);
        if text.trim().is_empty() {
            let message = "the file is empty, a scene needs the tables [body], [initial] and [run]";
            return Err(vec![Diagnostic::of_file(path, message)]);
        }
        let root = DeTable::parse(text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            vec![diagnose(span.clone(), &syntax::explained(error.message(), text, span))]
        })?;
        // Missing tables are reported at the end of the file.
        let end = text.trim_end().len();
        let root = Table { title: "the file".into(), span: end..end, fields: root.get_ref() };
        let mut reader = Reader::default();
        let scene = read_scene(&mut reader, &root, path, text, tables);
        let mut problems = reader.problems;
        match scene {
            Some(scene) if problems.is_empty() => Ok(scene),
            _ => {
                problems.sort_by_key(|(span, _)| span.start);
                let reported = problems.iter().take(MOST_REPORTED);
                let mut all: Vec<_> = reported.map(|(span, text)| diagnose(span.clone(), text)).collect();
                if let Some(rest @ 1..) = problems.len().checked_sub(MOST_REPORTED) {
                    all.push(Diagnostic::of_file(path, format!("and {rest} more")));
                }
                Err(all)
            }
        }
    }

    /// An error at the field of this dotted name, `initial.spin.rate`, or at the innermost enclosing table of the file.
    pub fn diagnose(&self, field: &str, message: impl Into<String>) -> Diagnostic {
        let mut span = 0..0;
        if let Ok(root) = DeTable::parse(&self.text) {
            let mut table = Some(root.get_ref());
            for name in field.split('.') {
                let Some(value) = table.and_then(|table| table.get(name)) else { break };
                span = value.span();
                table = value.get_ref().as_table();
            }
        }
        Diagnostic::at(&self.path, &self.text, span, message)
    }

    /// The output times in s: the initial time plus [`Run::offsets`].
    pub fn times(&self) -> Vec<f64> {
        self.run.offsets().into_iter().map(|offset| self.time + offset).collect()
    }

    /// The initial angular velocity in body axes: `Ω_B = ~R Ω_S R`.
    pub fn omega_body(&self) -> Bivector {
        match self.spin_frame {
            SpinFrame::Body => self.spin,
            SpinFrame::Space => self.attitude.reverse().apply_bivector(self.spin),
        }
    }
}

fn read_scene(
    reader: &mut Reader,
    root: &Table,
    path: &Path,
    text: &str,
    tables: TableSource<'_>,
) -> Option<Scene> {
    reader.only(root, &[&NAMES[..], &laws::FORMULAS.map(|(name, _)| name)].concat());
    parts::define(reader, root);
    let title = reader.optional(root, "title", |reader, value| reader.string(value).map(str::to_owned));
    let caption = reader.optional(root, "caption", |reader, value| {
        reader.string(value).map(|text| text.split_whitespace().collect::<Vec<_>>().join(" "))
    });
    for (name, title) in [("body", "[body]"), ("initial", "[initial]")] {
        if root.get(name).is_none() {
            reader.missing(root, &[name], format!("missing table {title}"));
        }
    }
    let found = parts::read(reader, root);
    let method = reader.optional(root, "method", |reader, value| reader.table(value, "[method]"));
    let run = required(reader, root, "run", "[run]")
        .and_then(|table| run::read(reader, &table, method.as_ref().and_then(Option::as_ref)));
    let nominal = ensemble::Nominal {
        initial: found.initial.flatten(),
        gravity: found.gravity,
        laws: found.laws.as_deref(),
    };
    let table = |name: &str| tables(&path.parent().unwrap_or(Path::new("")).join(name));
    let ensemble = reader.optional(root, "ensemble", |reader, value| {
        individual::read(reader, value, &nominal, root, text, &table)
    });
    let initial = found.initial??;
    Some(Scene {
        title: title?,
        caption: caption?,
        body: found.body??,
        attitude: initial.attitude,
        spin: initial.spin,
        spin_frame: initial.spin_frame,
        center: initial.center,
        time: initial.time,
        gravity: found.gravity?,
        torques: found.laws?,
        forces: found.forces?.unwrap_or_default(),
        run: run?,
        ensemble: ensemble?,
        path: path.to_owned(),
        text: text.to_owned(),
    })
}

/// A required table.
fn required<'t>(reader: &mut Reader, root: &Table<'t>, name: &str, title: &'static str) -> Option<Table<'t>> {
    let Some(value) = root.get(name) else {
        reader.missing(root, &[name], format!("missing table {title}"));
        return None;
    };
    reader.table(value, title)
}

/// The text of a table of points.
fn read_table(path: &Path) -> Result<String, String> {
    let name = path.display();
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => std::fs::read_to_string(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => format!("{name}: no such file"),
            _ => format!("{name}: cannot be read: {error}"),
        }),
        _ => Err(format!("{name}: expected a table in a file .csv")),
    }
}

/// The bytes of a file, at most [`LARGEST_FILE`].
fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    let cannot = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_owned(),
        _ => format!("cannot be read: {error}"),
    };
    if path.is_dir() {
        return Err("is a directory, expected a scene file".to_owned());
    }
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(LARGEST_FILE + 1).read_to_end(&mut bytes)).map_err(cannot)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(format!("larger than {} MB, expected a scene file", LARGEST_FILE / 1_000_000));
    }
    Ok(bytes)
}
