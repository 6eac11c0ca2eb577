//! Torque laws: values made of a name and arguments, and their torques.

use super::bodies::{Inertia, rotor};
use super::columns::{Arguments, Batch};
use super::made::{
    Asked, Known, Made, Raised, Values, bivector, bivector_of, failed, formula, rotor_of, sole,
};
use crate::support::arrays::{Array, Rows, bad, line, numbers, one, table};
use crate::support::facts::dict;
use polhode_ga::formula::{Given, Input, canonical};
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::body::weight_moment;
use polhode_rigid::describe::law_facts;
use polhode_rigid::laws::torque::{
    Axes, FormulaTorque, FunctionTorque, Gains, Kind, Orbit, Table, Torque, total, wheel,
};
use polhode_rigid::state::phase::{Gyrostat, Phase};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

/// A torque law, or one for each body of a batch.
#[pyclass(frozen, extends = Made, module = "polhode._native")]
pub(crate) struct Law {
    pub(crate) torques: Vec<Torque>,
    /// Shape of the batch.
    pub(crate) shape: Vec<usize>,
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
        let law = Law { torques: vec![torque], shape: Vec::new() };
        Py::new(py, PyClassInitializer::from(made).add_subclass(law))
    }

    /// The law of a single body.
    pub(crate) fn single(&self) -> PyResult<Torque> {
        match (&self.torques[..], &self.shape[..]) {
            ([torque], []) => Ok(torque.clone()),
            _ => {
                Err(bad(format!("expected the law of a single body, got a batch of shape {:?}", self.shape)))
            }
        }
    }
}

#[pymethods]
impl Law {
    /// A law by its name in `polhode.torque`, its arguments as that module checked and spelled them.
    #[new]
    #[pyo3(signature = (name, *arguments))]
    fn new(name: String, arguments: Bound<'_, PyTuple>) -> PyResult<PyClassInitializer<Law>> {
        let raised = Raised::default();
        let given = Arguments::of(&name, &arguments)?;
        let law = Law { torques: made(&name, &given, &raised)?, shape: given.shape };
        Ok(PyClassInitializer::from(Made::new(name, arguments, raised)).add_subclass(law))
    }

    /// The moments of the weight, rows (n, 3) in body axes, of a law that holds the body; none of others.
    fn weight_moments<'py>(&self, py: Python<'py>) -> PyResult<Option<Array<'py>>> {
        let moments: Option<Vec<[f64; 3]>> = self
            .torques
            .iter()
            .map(|torque| if let Torque::Heavy(c) = torque { Some(c.0) } else { None })
            .collect();
        moments.map(|rows| table(py, rows.into_iter())).transpose()
    }

    /// Its name in scenes and, as text, its formula or its numbers; of a single body.
    fn facts<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let torque = slf.get().single()?;
        let name = match &torque {
            Torque::Formula(law) if law.axes() == Axes::Space => "torque_space",
            Torque::Formula(_) => "torque_body",
            _ => slf.as_super().get().name(),
        };
        dict(slf.py(), law_facts(name, &torque, None))
    }

    /// Shape of the batch of bodies; () for one.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.shape)
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
    let torques: Vec<Torque> =
        laws.iter().map(|law| Ok(law.get().single()?.in_axes(frame))).collect::<PyResult<_>>()?;
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

/// The laws of a name and arguments: one, or one for each body.
fn made(name: &str, given: &Arguments<'_, '_>, raised: &Raised) -> PyResult<Vec<Torque>> {
    let arguments = given.all;
    match name {
        "heavy" => given.each_vector(Torque::Heavy),
        "gravity" => {
            let (acceleration, mass) = (given.column(0)?, given.column(1)?);
            let (center, pivot) = (given.column(2)?, given.column(3)?);
            given.each_sound(|k| {
                let ([acceleration], [mass]) = (acceleration.of(k), mass.of(k));
                let arm = Vector(center.of(k)) - Vector(pivot.of(k));
                Torque::Heavy(weight_moment(mass, acceleration, arm))
            })
        }
        "gravity_gradient" => {
            let (rate, eccentricity, anomaly) = (given.column(0)?, given.column(1)?, given.column(2)?);
            given.each(|k| {
                let ([n], [e], [m]) = (rate.of(k), eccentricity.of(k), anomaly.of(k));
                Orbit::new(n, e, m).map(Torque::GravityGradient)
            })
        }
        "constant_body" => given.each_bivector(Torque::ConstantBody),
        "constant_space" => given.each_bivector(Torque::ConstantSpace),
        "damping" => given.each_number(Torque::Damping),
        "quadratic_damping" => given.each_number(Torque::QuadraticDamping),
        "viscous_damping" => {
            let along = given.column(0)?;
            given.each_sound(|k| Torque::ViscousDamping(Gains::new(along.of(k))))
        }
        "magnetic" => {
            let (dipole, field) = (given.column(0)?, given.column(1)?);
            given
                .each_sound(|k| Torque::Magnetic { dipole: Vector(dipole.of(k)), field: Vector(field.of(k)) })
        }
        "torsion_spring" => {
            let (stiffness, rest) = (given.column(0)?, given.column(1)?);
            given.each(|k| {
                let [stiffness] = stiffness.of(k);
                Rotor::from_components(rest.of(k)).map(|rest| Torque::TorsionSpring { stiffness, rest })
            })
        }
        "gyrostat" => given.each_bivector(Torque::Wheel),
        "pd_control" => {
            let (stiffness, damping, target) = (given.column(0)?, given.column(1)?, given.column(2)?);
            given.each(|k| {
                let (stiffness, damping) = (Gains::new(stiffness.of(k)), Gains::new(damping.of(k)));
                let target = Rotor::from_components(target.of(k));
                target.map(|target| Torque::Control { stiffness, damping, target })
            })
        }
        "larmor" => given.each_vector(Torque::Larmor),
        "tabulated" => {
            let (times, rows, frame, kind): (_, Vec<[f64; 3]>, String, String) = arguments.extract()?;
            let kind = if kind == "cubic" { Kind::Cubic } else { Kind::Linear };
            let rows = rows.into_iter().map(Bivector).collect();
            Ok(vec![Torque::Tabulated(Arc::new(Table::new(times, rows, axes(&frame), kind).map_err(bad)?))])
        }
        "formula" => formulas(given),
        "function" => {
            let asked = Asked { call: sole(arguments)?, raised: raised.clone(), what: "torque" };
            Ok(vec![Torque::Function(FunctionTorque::new(move |time, rotor, omega| {
                asked.of(
                    time,
                    |py| (time, rotor_of(py, rotor)?, bivector_of(py, omega)?).into_pyobject(py),
                    bivector,
                )
            }))])
        }
        _ => Err(bad(format!("no torque law is called {name}"))),
    }
}

/// A formula, compiled once, with the values of each body.
fn formulas(given: &Arguments<'_, '_>) -> PyResult<Vec<Torque>> {
    let (text, frame, values): (String, String, Values<'_>) = given.all.extract()?;
    let (mut first, mut own) = (Values::with_capacity(values.len()), Vec::new());
    for (name, value) in values {
        let Some(batch) = Batch::of(&value)? else {
            first.push((name, value));
            continue;
        };
        let like = batch.like()?;
        own.push((canonical(&name).unwrap_or_else(|| name.clone()), batch.graded(&like)?));
        first.push((name, like));
    }
    let made = |names, value: &mut Known<'_>| FormulaTorque::new(&text, axes(&frame), names, value);
    let law = formula(given.all.py(), &text, &first, made)?;
    given.each_sound(|k| {
        let value = |input: &Input| own.iter().find(|(name, _)| *name == input.name).map(|(_, rows)| rows[k]);
        Torque::Formula(law.with_values(|input| value(input).map(Given::Value)))
    })
}

fn axes(frame: &str) -> Axes {
    if frame == "space" { Axes::Space } else { Axes::Body }
}
