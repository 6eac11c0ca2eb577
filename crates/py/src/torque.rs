//! Torque laws: values made of a name and arguments, and their torques.

use crate::arrays::{Array, Rows, bad, line, numbers, one, table};
use crate::bodies::{Inertia, rotor};
use crate::made::{
    Asked, Known, Made, Raised, Values, bivector, bivector_of, failed, formula, rotor_of, sole,
};
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::phase::{Gyrostat, Phase};
use polhode_rigid::torque::{
    Axes, FormulaTorque, FunctionTorque, Gains, Kind, Orbit, Table, Torque, total, wheel,
};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::Arc;

/// A torque law.
#[pyclass(frozen, extends = Made, module = "polhode._native")]
pub(crate) struct Law {
    pub(crate) torque: Torque,
}

impl Law {
    /// A law that is made, with the name and the arguments that would make it.
    pub(crate) fn named(
        py: Python<'_>,
        torque: Torque,
        name: &str,
        arguments: Bound<'_, PyTuple>,
    ) -> PyResult<Py<Law>> {
        let made = Made::new(name.to_owned(), arguments, Raised::default());
        Py::new(py, PyClassInitializer::from(made).add_subclass(Law { torque }))
    }
}

#[pymethods]
impl Law {
    /// A law by its name in `polhode.torque`, its arguments as that module checked and spelled them.
    #[new]
    #[pyo3(signature = (name, *arguments))]
    fn new(name: String, arguments: Bound<'_, PyTuple>) -> PyResult<PyClassInitializer<Law>> {
        let raised = Raised::default();
        let torque = made(&name, &arguments, &raised)?;
        Ok(PyClassInitializer::from(Made::new(name, arguments, raised)).add_subclass(Law { torque }))
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
    let torque = total(&body, &torques, &state)
        .map_err(|error| failed(laws.iter().map(Bound::as_super), format!("at t = {time} s: {error}")))?;
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
        "formula" => {
            let (text, frame, values): (String, String, Values<'_>) = arguments.extract()?;
            let made = |names, value: &mut Known<'_>| FormulaTorque::new(&text, axes(&frame), names, value);
            Torque::Formula(formula(arguments.py(), &text, &values, made)?)
        }
        "function" => {
            let asked = Asked { call: sole(arguments)?, raised: raised.clone(), what: "torque" };
            Torque::Function(FunctionTorque::new(move |time, rotor, omega| {
                asked.of(
                    time,
                    |py| (time, rotor_of(py, rotor)?, bivector_of(py, omega)?).into_pyobject(py),
                    bivector,
                )
            }))
        }
        _ => return Err(bad(format!("no torque law is called {name}"))),
    })
}

fn axes(frame: &str) -> Axes {
    if frame == "space" { Axes::Space } else { Axes::Body }
}
