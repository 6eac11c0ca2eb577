//! Forces, and events to look for, as values.

use crate::arrays::{Rows, one};
use polhode_ga::{Bivector, Vector};
use polhode_rigid::event::{self, Direction, Quantity};
use polhode_rigid::force;
use pyo3::prelude::*;

fn vector(row: &Rows<'_>) -> PyResult<Vector> {
    one(row).map(Vector)
}

/// A force on the centre of mass.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Force(pub(crate) force::Force);

#[pymethods]
impl Force {
    #[staticmethod]
    fn constant(force: Rows<'_>) -> PyResult<Force> {
        vector(&force).map(force::Force::Constant).map(Force)
    }

    #[staticmethod]
    fn body(force: Rows<'_>) -> PyResult<Force> {
        vector(&force).map(force::Force::Body).map(Force)
    }

    #[staticmethod]
    fn drag(k: f64) -> Force {
        Force(force::Force::Drag(k))
    }

    #[staticmethod]
    fn quadratic_drag(k: f64) -> Force {
        Force(force::Force::QuadraticDrag(k))
    }

    #[staticmethod]
    fn spring(k: f64, anchor: Rows<'_>) -> PyResult<Force> {
        Ok(Force(force::Force::Spring(k, vector(&anchor)?)))
    }

    #[staticmethod]
    fn central(mu: f64) -> Force {
        Force(force::Force::Central(mu))
    }
}

/// Something to look for along a motion; `direction` is 1 for rising, -1 for falling, 0 for both.
#[pyclass(frozen, module = "polhode._native")]
pub(crate) struct Event(pub(crate) event::Event);

fn made(quantity: Quantity, direction: i8, terminal: bool) -> Event {
    let direction = match direction {
        1 => Some(Direction::Rising),
        -1 => Some(Direction::Falling),
        _ => None,
    };
    Event(event::Event { quantity, direction, terminal })
}

#[pymethods]
impl Event {
    #[staticmethod]
    fn axis(body: Rows<'_>, space: Rows<'_>, level: f64, direction: i8, terminal: bool) -> PyResult<Event> {
        let quantity = Quantity::Axis { body: vector(&body)?, space: vector(&space)?, level };
        Ok(made(quantity, direction, terminal))
    }

    #[staticmethod]
    fn spin(plane: Rows<'_>, level: f64, direction: i8, terminal: bool) -> PyResult<Event> {
        Ok(made(Quantity::Spin { plane: Bivector(one(&plane)?), level }, direction, terminal))
    }

    #[staticmethod]
    fn position(normal: Rows<'_>, level: f64, direction: i8, terminal: bool) -> PyResult<Event> {
        Ok(made(Quantity::Position { normal: vector(&normal)?, level }, direction, terminal))
    }
}
