//! Torque laws: values made of a name and arguments, and their torques.

use crate::arrays::{Array, Rows, bad, line, numbers, one, table};
use crate::bodies::{Inertia, rotor};
use crate::calls::{Argument, of_map};
use crate::formula::{Said, names};
use crate::program::error;
use crate::value;
use polhode_ga::formula::{Given, Input, InputKind};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor, Vector};
use polhode_rigid::phase::{Gyrostat, Phase};
use polhode_rigid::torque::{
    Axes, FormulaTorque, FunctionTorque, Gains, Kind, Orbit, Table, Torque, TorqueError, total, wheel,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyTuple, PyType};
use std::collections::HashMap;
use std::fmt::Display;
use std::sync::{Arc, Mutex, PoisonError};

/// What a Python function raised, until it is told.
type Raised = Arc<Mutex<Option<PyErr>>>;

/// A torque law, and the call that made it.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Law {
    pub(crate) torque: Torque,
    name: String,
    arguments: Py<PyTuple>,
    raised: Raised,
}

impl Law {
    /// A law that is made, with the name and the arguments that would make it.
    pub(crate) fn named(torque: Torque, name: &str, arguments: Bound<'_, PyTuple>) -> Law {
        Law { torque, name: name.to_owned(), arguments: arguments.unbind(), raised: Raised::default() }
    }
}

#[pymethods]
impl Law {
    /// A law by its name in `polhode.torque`, its arguments as that module checked and spelled them.
    #[new]
    #[pyo3(signature = (name, *arguments))]
    fn new(name: String, arguments: Bound<'_, PyTuple>) -> PyResult<Law> {
        let raised = Raised::default();
        let torque = made(&name, &arguments, &raised)?;
        Ok(Law { torque, name, arguments: arguments.unbind(), raised })
    }

    /// Its name in `polhode.torque`.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The arguments that made it.
    #[getter]
    fn arguments(&self, py: Python<'_>) -> Py<PyTuple> {
        self.arguments.clone_ref(py)
    }

    fn __eq__(&self, py: Python<'_>, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        let Ok(other) = other.cast::<Law>() else { return Ok(false) };
        let other = other.get();
        Ok(self.name == other.name && self.arguments.bind(py).eq(&other.arguments)?)
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        (&self.name, &self.arguments).into_pyobject(py)?.hash()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let law = slf.get();
        let mut all = vec![law.name.clone().into_pyobject(slf.py())?.into_any()];
        all.extend(law.arguments.bind(slf.py()).iter());
        Ok((slf.get_type(), PyTuple::new(slf.py(), all)?))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("Law({:?}, {})", self.name, self.arguments.bind(py).repr()?))
    }
}

/// The torque of all laws in body axes, at a state and a time.
#[pyfunction]
pub(crate) fn torque_at<'py>(
    py: Python<'py>,
    laws: Vec<Bound<'py, Law>>,
    inertia: &Inertia,
    rotor_row: Rows<'py>,
    omega: Rows<'py>,
    time: f64,
) -> PyResult<Array<'py>> {
    let frame = inertia.0.principal_frame();
    let torques: Vec<Torque> = laws.iter().map(|law| law.get().torque.clone().in_axes(frame)).collect();
    let body = Gyrostat { moments: inertia.0.principal_moments(), wheel: wheel(&torques) };
    if body.moments.contains(&0.0) {
        let [a, b, c] = body.moments;
        return Err(bad(format!(
            "principal moments {a}, {b}, {c} kg m² include a zero; give the body some thickness"
        )));
    }
    let omega = frame.reverse().apply_bivector(Bivector(one(&omega)?));
    let state = Phase { rotor: rotor(&rotor_row)? * frame, momentum: body.momentum(omega), time };
    let torque =
        total(&body, &torques, &state).map_err(|error| failed(&laws, format!("at t = {time} s: {error}")))?;
    Ok(line(py, frame.apply_bivector(torque).0.to_vec()))
}

/// The direction from planet to body on an orbit, rows (n, 3) at times (n,).
#[pyfunction]
pub(crate) fn orbit_directions<'py>(
    py: Python<'py>,
    rate: f64,
    eccentricity: f64,
    anomaly: f64,
    times: Rows<'py>,
) -> PyResult<Array<'py>> {
    let orbit = Orbit::new(rate, eccentricity, anomaly).map_err(bad)?;
    table(py, numbers(&times)?.iter().map(|&time| orbit.place(time).0.0))
}

/// The exception where a law had no torque: what a Python function raised, or else what is told.
pub(crate) fn failed(laws: &[Bound<'_, Law>], told: impl Display) -> PyErr {
    let taken = |law: &Bound<'_, Law>| law.get().raised.lock().unwrap_or_else(PoisonError::into_inner).take();
    laws.iter().find_map(taken).unwrap_or_else(|| bad(told))
}

/// The law of a name and arguments.
fn made(name: &str, arguments: &Bound<'_, PyTuple>, raised: &Raised) -> PyResult<Torque> {
    Ok(match name {
        "heavy" => Torque::Heavy(Vector(sole(arguments)?)),
        "gravity_gradient" => {
            let (rate, eccentricity, anomaly) = arguments.extract()?;
            Torque::GravityGradient(Orbit::new(rate, eccentricity, anomaly).map_err(bad)?)
        }
        "constant_body" => Torque::ConstantBody(Bivector(sole(arguments)?)),
        "constant_space" => Torque::ConstantSpace(Bivector(sole(arguments)?)),
        "damping" => Torque::Damping(sole(arguments)?),
        "quadratic_damping" => Torque::QuadraticDamping(sole(arguments)?),
        "viscous_damping" => Torque::ViscousDamping(Gains::new(sole(arguments)?)),
        "magnetic" => {
            let (dipole, field) = arguments.extract()?;
            Torque::Magnetic { dipole: Vector(dipole), field: Vector(field) }
        }
        "torsion_spring" => {
            let (stiffness, rest) = arguments.extract()?;
            Torque::TorsionSpring { stiffness, rest: Rotor::from_components(rest).map_err(bad)? }
        }
        "gyrostat" => Torque::Wheel(Bivector(sole(arguments)?)),
        "pd_control" => {
            let (stiffness, damping, target) = arguments.extract()?;
            let target = Rotor::from_components(target).map_err(bad)?;
            Torque::Control { stiffness: Gains::new(stiffness), damping: Gains::new(damping), target }
        }
        "larmor" => Torque::Larmor(Vector(sole(arguments)?)),
        "tabulated" => {
            let (times, rows, frame, kind): (_, Vec<[f64; 3]>, String, String) = arguments.extract()?;
            let kind = if kind == "cubic" { Kind::Cubic } else { Kind::Linear };
            let rows = rows.into_iter().map(Bivector).collect();
            Torque::Tabulated(Arc::new(Table::new(times, rows, axes(&frame), kind).map_err(bad)?))
        }
        "formula" => Torque::Formula(formula(arguments)?),
        "function" => Torque::Function(function(sole(arguments)?, raised.clone())),
        _ => return Err(bad(format!("no torque law is called {name}"))),
    })
}

fn sole<'py, T: FromPyObjectOwned<'py>>(arguments: &Bound<'py, PyTuple>) -> PyResult<T> {
    arguments.get_item(0)?.extract().map_err(Into::into)
}

fn axes(frame: &str) -> Axes {
    if frame == "space" { Axes::Space } else { Axes::Body }
}

/// A formula from its text, its axes, and names with their values.
fn formula(arguments: &Bound<'_, PyTuple>) -> PyResult<FormulaTorque> {
    let py = arguments.py();
    let (text, frame, values): (String, String, Vec<(String, Bound<'_, PyAny>)>) = arguments.extract()?;
    let mut said: Vec<Said> = Vec::with_capacity(values.len());
    for (name, value) in &values {
        said.push(match Argument::of(value)? {
            Some(Argument::Value(ty, _)) => (name.clone(), ty.grades.0, ty.unit.into()),
            Some(Argument::Map(_, grade)) => (name.clone(), grade, 2),
            None => {
                let message = format!("{name} must be a single value over floats, a number or a linear map");
                return Err(PyTypeError::new_err(message));
            }
        });
    }
    let (names, spelled) = names(&said)?;
    let places: HashMap<&str, usize> = spelled.iter().map(String::as_str).zip(0..).collect();
    let mut wrong = None;
    let value = |input: &Input| {
        let (_, value) = values.get(*places.get(input.name.as_str())?)?;
        known(value, input.kind).map_err(|error| wrong = Some(error)).ok()
    };
    let made = FormulaTorque::new(&text, axes(&frame), names, value);
    match wrong {
        Some(error) => Err(error),
        None => made.map_err(|e| error(py, &text, &e)),
    }
}

/// What a value is for an input.
fn known(value: &Bound<'_, PyAny>, kind: InputKind) -> PyResult<Given> {
    match (kind, value::operand(value)) {
        (InputKind::Value(_), value::Operand::Value(value, _)) => Ok(Given::Value(*value)),
        (InputKind::Value(_), value::Operand::Number(x)) => Ok(Given::Value(value::scalar(x))),
        (kind, _) => of_map(value, kind),
    }
}

/// The law of a Python function of time, rotor and angular velocity in the body.
fn function(call: Py<PyAny>, raised: Raised) -> FunctionTorque {
    FunctionTorque::new(move |time, rotor, omega| {
        Python::attach(|py| {
            asked(call.bind(py), time, rotor, omega).map_err(|error| {
                let told = TorqueError(error.to_string());
                *raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                told
            })
        })
    })
}

/// What a Python function returns, if that is a torque.
fn asked(call: &Bound<'_, PyAny>, time: f64, rotor: Rotor, omega: Bivector) -> PyResult<Bivector> {
    let py = call.py();
    let omega = Graded::new(&omega.0, Grades::BIVECTOR).unwrap_or_default();
    let answer = call.call1((time, value::one_rotor(py, rotor)?, value::one(py, omega)?))?;
    if let value::Operand::Value(torque, _) = value::operand(&answer)
        && let (Grades::BIVECTOR, &[x, y, z]) = (torque.grades(), torque.components())
    {
        return Ok(Bivector([x, y, z]));
    }
    if let Some(([x, y, z, ..], 3)) = value::row(&answer) {
        return Ok(Bivector([x, y, z]));
    }
    if let Ok(three) = answer.extract::<Rows<'_>>().and_then(|rows| one(&rows)) {
        return Ok(Bivector(three));
    }
    // Any other value of three numbers, or the error that says why it is none.
    static CHECKED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let what = format!("the torque that the function returned at t = {time} s");
    let rows = CHECKED.import(py, "polhode._values", "as_bivectors")?.call1((answer, &what))?;
    let rows: Rows<'_> = rows.call_method0(intern!(py, "copy"))?.extract()?;
    one(&rows)
        .map(Bivector)
        .map_err(|error| PyValueError::new_err(format!("{what} must be a single bivector: {error}")))
}
