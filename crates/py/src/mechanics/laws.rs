//! Forces, and events to look for, as values.

use super::made::{
    Asked, Known, Made, Raised, Values, bivector_of, formula, number, rotor_of, sole, vector, vector_of,
};
use crate::support::arrays::bad;
use polhode_ga::{Bivector, Vector};
use polhode_rigid::laws::event::{self, Direction, Quantity};
use polhode_rigid::laws::force;
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::state::point::Function;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A force on the centre of mass.
#[pyclass(frozen, extends = Made, module = "polhode._native")]
pub(crate) struct Force {
    pub(crate) force: force::Force,
}

#[pymethods]
impl Force {
    /// A force by its name in `polhode.force`, its arguments as that module checked and spelled them.
    #[new]
    #[pyo3(signature = (name, *arguments))]
    fn new(name: String, arguments: Bound<'_, PyTuple>) -> PyResult<PyClassInitializer<Force>> {
        let raised = Raised::default();
        let force = force(&name, &arguments, &raised)?;
        Ok(PyClassInitializer::from(Made::new(name, arguments, raised)).add_subclass(Force { force }))
    }
}

fn force(name: &str, arguments: &Bound<'_, PyTuple>, raised: &Raised) -> PyResult<force::Force> {
    use force::Force as Law;
    Ok(match name {
        "constant" => Law::Constant(Vector(sole(arguments)?)),
        "thrust" => Law::Body(Vector(sole(arguments)?)),
        "drag" => Law::Drag(sole(arguments)?),
        "quadratic_drag" => Law::QuadraticDrag(sole(arguments)?),
        "spring" => {
            let (k, anchor) = arguments.extract()?;
            Law::Spring(k, Vector(anchor))
        }
        "central" => Law::Central(sole(arguments)?),
        "formula" => {
            let (text, values): (String, Values<'_>) = arguments.extract()?;
            let made = |names, value: &mut Known<'_>| Formula::new(&text, Purpose::Force, names, value);
            Law::Formula(formula(arguments.py(), &text, &values, made)?)
        }
        "function" => {
            let asked = Asked { call: sole(arguments)?, raised: raised.clone(), what: "force" };
            Law::Function(Function::new(move |seen| {
                asked.of(
                    seen.time,
                    |py| {
                        let (x, v) = (vector_of(py, seen.position)?, vector_of(py, seen.velocity)?);
                        (seen.time, x, v, rotor_of(py, seen.rotor)?).into_pyobject(py)
                    },
                    vector,
                )
            }))
        }
        _ => return Err(bad(format!("no force is called {name}"))),
    })
}

/// Something to look for along a motion.
#[pyclass(frozen, extends = Made, module = "polhode._native")]
pub(crate) struct Event {
    pub(crate) event: event::Event,
}

#[pymethods]
impl Event {
    /// An event by its name in `polhode.event`, its direction (1 for rising, -1 for falling, 0 for both), whether it ends
    /// the motion, and its arguments as that module checked and spelled them.
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
        Ok(PyClassInitializer::from(Made::new(name, arguments, raised)).add_subclass(Event { event }))
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
            let made = |names, value: &mut Known<'_>| Formula::new(&text, Purpose::Event, names, value);
            Quantity::Formula(formula(arguments.py(), &text, &values, made)?)
        }
        "function" => {
            let asked = Asked { call: sole(arguments)?, raised: raised.clone(), what: "value" };
            Quantity::Function(Function::new(move |seen| {
                asked.of(
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
        _ => return Err(bad(format!("no event is called {name}"))),
    })
}
