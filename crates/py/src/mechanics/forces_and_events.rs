//! Forces, events and the registry of laws for Python.

use super::columns::{Arguments, Laws};
use super::law_value::{
    Callback, Known, LawValue, Raised, Values, bivector_of, formula, number, rotor_of, sole, vector,
    vector_of,
};
use crate::support::arrays::bad;
use polhode_ga::{Bivector, Vector};
use polhode_rigid::laws::event::{self, Direction, Quantity};
use polhode_rigid::laws::force;
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::laws::registry::{self, Entry, Shape};
use polhode_rigid::state::point::{Function, Seen};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A force on the centre of mass.
#[pyclass(frozen, extends = LawValue, module = "polhode._native")]
pub(crate) struct Force(pub(crate) Laws<force::Force>);

#[pymethods]
impl Force {
    /// A force by its name in `polhode.force` and arguments checked and converted by that module.
    #[new]
    #[pyo3(signature = (name, *arguments))]
    fn new(name: String, arguments: Bound<'_, PyTuple>) -> PyResult<PyClassInitializer<Force>> {
        let raised = Raised::default();
        let force = Force(forces(&name, &arguments, &raised)?);
        Ok(PyClassInitializer::from(LawValue::new(name, arguments, raised)).add_subclass(force))
    }

    /// Shape of the batch of bodies; () for one.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.0.shape)
    }
}

/// The forces of this name and these arguments.
fn forces(name: &str, arguments: &Bound<'_, PyTuple>, raised: &Raised) -> PyResult<Laws<force::Force>> {
    use force::Force as Law;
    let values: Values<'_> = if name == "formula" { arguments.get_item(1)?.extract()? } else { Vec::new() };
    let given = Arguments::new(arguments, &values)?;
    let rows = match name {
        "formula" => {
            let text: String = arguments.get_item(0)?.extract()?;
            let formulas = given.formulas(&text, Purpose::Force, values)?;
            formulas.into_iter().map(Law::Formula).collect()
        }
        "function" => {
            let (call, with_omega) = arguments.extract()?;
            let callback = Callback { call, raised: raised.clone(), what: "force" };
            vec![Law::Function(Function::new(move |seen| {
                callback.at(seen.time, |py| arguments_of_force(py, seen, with_omega), vector)
            }))]
        }
        _ => {
            let entry = registry::force(name).ok_or_else(|| bad(format!("{name} is not a force")))?;
            given.registered(entry, |numbers| entry.build(numbers).map(|push| push.force))?
        }
    };
    Ok(Laws { rows, shape: given.shape })
}

/// The arguments of a function at a point, with the angular velocity or without.
fn arguments_of_force<'py>(py: Python<'py>, seen: &Seen, with_omega: bool) -> PyResult<Bound<'py, PyTuple>> {
    let (position, velocity) = (vector_of(py, seen.position)?, vector_of(py, seen.velocity)?);
    let rotor = rotor_of(py, seen.rotor)?;
    if !with_omega {
        return (seen.time, position, velocity, rotor).into_pyobject(py);
    }
    (seen.time, position, velocity, rotor, bivector_of(py, seen.omega)?).into_pyobject(py)
}

/// An event to detect along a motion.
#[pyclass(frozen, extends = LawValue, module = "polhode._native")]
pub(crate) struct Event {
    pub(crate) event: event::Event,
}

#[pymethods]
impl Event {
    /// An event by its name in `polhode.event`, its direction (1 for rising, -1 for falling, 0 for both), whether it ends
    /// the motion, and its arguments as that module has checked and converted them.
    #[new]
    #[pyo3(signature = (name, *arguments))]
    fn new(name: String, arguments: Bound<'_, PyTuple>) -> PyResult<PyClassInitializer<Event>> {
        let raised = Raised::default();
        let (direction, terminal): (i8, bool) = arguments.get_slice(0, 2).extract()?;
        let direction = match direction {
            1 => Some(Direction::Rising),
            -1 => Some(Direction::Falling),
            _ => None,
        };
        let own = arguments.get_slice(2, arguments.len());
        let event = event::Event { quantity: quantity(&name, &own, &raised)?, direction, terminal };
        Ok(PyClassInitializer::from(LawValue::new(name, arguments, raised)).add_subclass(Event { event }))
    }
}

fn quantity(name: &str, arguments: &Bound<'_, PyTuple>, raised: &Raised) -> PyResult<Quantity> {
    Ok(match name {
        "angle" => {
            let (body, space, angle): (_, _, f64) = arguments.extract()?;
            // The cosine of ½π is 0, not its rounding.
            let level = if angle == std::f64::consts::FRAC_PI_2 { 0.0 } else { angle.cos() };
            Quantity::Axis { body: Vector(body), space: Vector(space), level }
        }
        "plane" => {
            let (body, normal) = arguments.extract()?;
            Quantity::Axis { body: Vector(body), space: Vector(normal), level: 0.0 }
        }
        "spin" => {
            let (plane, level) = arguments.extract()?;
            Quantity::Spin { plane: Bivector(plane), level }
        }
        "position" => {
            let (normal, level) = arguments.extract()?;
            Quantity::Position { normal: Vector(normal), level }
        }
        "formula" => {
            let (text, values): (String, Values<'_>) = arguments.extract()?;
            let compile = |names, value: &mut Known<'_>| Formula::new(&text, Purpose::Event, names, value);
            Quantity::Formula(formula(arguments.py(), &text, &values, compile)?)
        }
        "function" => {
            let callback = Callback { call: sole(arguments)?, raised: raised.clone(), what: "value" };
            Quantity::Function(Function::new(move |seen| {
                callback.at(
                    seen.time,
                    |py| {
                        let (rotor, omega) = (rotor_of(py, seen.rotor)?, bivector_of(py, seen.omega)?);
                        let (x, v) = (vector_of(py, seen.position)?, vector_of(py, seen.velocity)?);
                        (seen.time, rotor, omega, x, v).into_pyobject(py)
                    },
                    number,
                )
            }))
        }
        _ => return Err(bad(format!("{name} is not an event"))),
    })
}

/// An argument of a law: name, field of a scene, unit, shape, default numbers, words.
type Argument = (&'static str, &'static str, &'static str, &'static str, Option<Vec<f64>>, Vec<&'static str>);

/// A law: name, label, formula, arguments.
type Row = (&'static str, &'static str, &'static str, Vec<Argument>);

fn rows<T>(entries: &'static [Entry<T>]) -> Vec<Row> {
    let argument = |argument: &'static registry::Argument| {
        let registry::Argument { name, field, quantity, shape, default, .. } = *argument;
        let words = if let Shape::Word(words) = shape { words.to_vec() } else { Vec::new() };
        let unit = quantity.map_or("1", |quantity| quantity.si_unit());
        (name, field, unit, shape.name(), default.map(<[f64]>::to_vec), words)
    };
    let row = |entry: &'static Entry<T>| {
        (entry.name, entry.label, entry.formula, entry.arguments.iter().map(argument).collect())
    };
    entries.iter().map(row).collect()
}

/// The registry of laws: torques and forces.
#[pyfunction]
pub(crate) fn law_registry() -> (Vec<Row>, Vec<Row>) {
    (rows(&registry::TORQUES), rows(&registry::FORCES))
}
