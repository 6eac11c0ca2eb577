//! The tables of a scene that describe the body, its start, the laws and the forces.

use super::body::{self, BodySpec};
use super::initial::{self, Initial};
use super::laws::{self, Law};
use super::reader::{Reader, Table, Value};
use super::{Gravity, formulas};
use crate::laws::force::Push;
use crate::units::Quantity;

/// What the tables give: None where a table is wrong, `Some(None)` where it is missing.
pub struct Parts {
    pub body: Option<Option<BodySpec>>,
    pub initial: Option<Option<Initial>>,
    pub gravity: Option<Option<Gravity>>,
    pub laws: Option<Vec<Law>>,
    pub forces: Option<Option<Vec<Push>>>,
}

/// Reads the names and functions of the table `[define]`.
pub fn define(reader: &mut Reader, root: &Table) {
    reader.optional(root, "define", |reader, value| {
        let table = reader.table(value, "[define]")?;
        formulas::read(reader, &table);
        Some(())
    });
}

/// Reads the tables.
pub fn read(reader: &mut Reader, root: &Table) -> Parts {
    let body = reader.optional(root, "body", |reader, value| {
        let table = reader.table(value, "[body]")?;
        body::read(reader, &table)
    });
    let initial = reader.optional(root, "initial", |reader, value| {
        let table = reader.table(value, "[initial]")?;
        initial::read(reader, &table)
    });
    let gravity = reader.optional(root, "gravity", gravity);
    let torque = reader.optional(root, "torque", |reader, value| reader.table(value, "[torque]"));
    let laws = laws::read(reader, root, torque.as_ref().and_then(Option::as_ref));
    let forces = reader.optional(root, "force", laws::forces);
    Parts { body, initial, gravity, laws: torque.and(laws), forces }
}

fn gravity(reader: &mut Reader, value: &Value) -> Option<Gravity> {
    let table = reader.table(value, "[gravity]")?;
    reader.only(&table, &["acceleration", "pivot"]);
    let acceleration =
        reader.field(&table, "acceleration", |reader, value| reader.quantity(value, Quantity::Acceleration));
    let pivot =
        reader.optional(&table, "pivot", |reader, value| formulas::vector(reader, value, Quantity::Length));
    Some(Gravity { acceleration: acceleration?, pivot: pivot?.unwrap_or_default() })
}
