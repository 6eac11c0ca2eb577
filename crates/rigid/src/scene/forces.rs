//! The table `[force]`: what moves the centre of mass. Its fields are forces, which add up.

use super::formulas;
use super::reader::{Reader, Value};
use crate::laws::force::Force;
use crate::units::Quantity;
use polhode_ga::Vector;

/// A force, and the point of the body at which it acts, in body axes, in metres; the centre of mass if none is
/// said.
#[derive(Clone, Debug)]
pub struct Push {
    /// The force.
    pub force: Force,
    /// The point, of a thrust alone.
    pub at: Option<Vector>,
}

type Read = fn(&mut Reader, &Value) -> Option<Force>;

/// Every force but the thrust.
const FORCES: [(&str, Read); 5] = [
    ("constant", |reader, value| formulas::vector(reader, value, Quantity::Force).map(Force::Constant)),
    ("drag", |reader, value| reader.quantity(value, Quantity::Drag).map(Force::Drag)),
    ("quadratic_drag", |reader, value| {
        reader.quantity(value, Quantity::QuadraticDrag).map(Force::QuadraticDrag)
    }),
    ("spring", spring),
    ("central", |reader, value| reader.quantity(value, Quantity::GravitationalParameter).map(Force::Central)),
];

pub fn read(reader: &mut Reader, value: &Value) -> Option<Vec<Push>> {
    let table = &reader.table(value, "[force]")?;
    let names = FORCES.iter().map(|(name, _)| *name).chain(["thrust"]);
    reader.only(table, &names.collect::<Vec<_>>());
    let mut pushes = Vec::new();
    for (name, read) in FORCES {
        if let Some(value) = table.get(name) {
            let force = read(reader, value);
            pushes.push((value.span().start, force.map(|force| Push { force, at: None })));
        }
    }
    if let Some(value) = table.get("thrust") {
        pushes.push((value.span().start, thrust(reader, value)));
    }
    pushes.sort_by_key(|(start, _)| *start);
    pushes.into_iter().map(|(_, push)| push).collect()
}

fn thrust(reader: &mut Reader, value: &Value) -> Option<Push> {
    let table = &reader.table(value, "`thrust`")?;
    reader.only(table, &["force", "at"]);
    let force =
        reader.field(table, "force", |reader, value| formulas::vector(reader, value, Quantity::Force));
    let at = reader.optional(table, "at", |reader, value| formulas::vector(reader, value, Quantity::Length));
    Some(Push { force: Force::Body(force?), at: at? })
}

fn spring(reader: &mut Reader, value: &Value) -> Option<Force> {
    let table = &reader.table(value, "`spring`")?;
    reader.only(table, &["stiffness", "anchor"]);
    let stiffness =
        reader.field(table, "stiffness", |reader, value| reader.quantity(value, Quantity::Stiffness));
    let anchor =
        reader.optional(table, "anchor", |reader, value| formulas::vector(reader, value, Quantity::Length));
    Some(Force::Spring(stiffness?, anchor?.unwrap_or_default()))
}
