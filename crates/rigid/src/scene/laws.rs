//! The tables `[torque]` and `[force]`: laws and forces, which add up.
//!
//! ```toml
//! [torque]
//! damping = "0.01 /s"
//! gravity_gradient = { period = "94.6 min" }
//! torque_body = "-k Ω_B"
//! ```

use super::reader::{Reader, Table, Value};
use super::{formulas, initial};
use crate::describe::law_facts;
use crate::error::TorqueError;
use crate::facts::Facts;
use crate::laws::force::Push;
use crate::laws::registry::{Argument, Entry, FORCES, Kernel, Shape, TORQUES};
use crate::laws::torque::{self, Axes, Kind, Torque};
use crate::units::Quantity;
use polhode_ga::Bivector;
use polhode_ga::product::Grades;
use std::f64::consts::TAU;
use std::sync::Arc;
use toml::de::DeValue;

/// A torque law, and its text in the file if it is a formula.
#[derive(Clone, Debug)]
pub struct Law {
    /// Its field in `[torque]`, or `gravity`.
    pub name: &'static str,
    /// The law.
    pub torque: Torque,
    /// The formula, whose numbers may have units.
    pub formula: Option<String>,
}

impl Law {
    /// Its name and its formula or numbers as text.
    pub fn facts(&self) -> Facts {
        law_facts(self.name, &self.torque, self.formula.as_deref())
    }
}

/// The fields that are formulas, which may stand before the first table too.
pub const FORMULAS: [(&str, Axes); 2] = [("torque_body", Axes::Body), ("torque_space", Axes::Space)];

/// The laws of the table, if there is one, and the formulas of the file itself, in the order of the file.
pub fn read(reader: &mut Reader, root: &Table, table: Option<&Table>) -> Option<Vec<Law>> {
    let mut laws = Vec::new();
    for (name, axes) in FORMULAS {
        if let (Some(value), Some(table)) = (root.get(name), table)
            && table.get(name).is_some()
        {
            reader.report(value.span(), format!("`{name}` is also in [torque], give only one of them"));
        }
        for value in [Some(root), table].into_iter().flatten().filter_map(|table| table.get(name)) {
            laws.push((value.span().start, formula(reader, value, name, axes)));
        }
    }
    if let Some(table) = table {
        let names = TORQUES.iter().map(|entry| entry.name).chain(FORMULAS.iter().map(|(name, _)| *name));
        reader.only(table, &names.collect::<Vec<_>>());
        for entry in &TORQUES {
            if let Some(value) = table.get(entry.name) {
                let law = law(reader, value, entry);
                laws.push((value.span().start, law));
            }
        }
    }
    laws.sort_by_key(|(start, _)| *start);
    laws.into_iter().map(|(_, law)| law).collect()
}

fn formula(reader: &mut Reader, value: &Value, name: &'static str, axes: Axes) -> Option<Law> {
    let law = formulas::torque(reader, value, axes)?;
    let written = reader.string(value)?.to_owned();
    Some(Law { name, torque: Torque::Formula(law), formula: Some(written) })
}

fn law(reader: &mut Reader, value: &Value, entry: &'static Entry<Torque>) -> Option<Law> {
    let torque = if let Kernel::Table = entry.kernel {
        tabulated(reader, value, entry)?
    } else {
        let numbers = arguments(reader, value, entry)?;
        placed(reader, value, entry.check(&numbers).and_then(|()| entry.build(&numbers)))?
    };
    Some(Law { name: entry.name, torque, formula: None })
}

/// The forces on the centre of mass, in the order of the file.
pub fn forces(reader: &mut Reader, value: &Value) -> Option<Vec<Push>> {
    let table = &reader.table(value, "[force]")?;
    reader.only(table, &FORCES.each_ref().map(|entry| entry.name));
    let mut pushes = Vec::new();
    for entry in &FORCES {
        if let Some(value) = table.get(entry.name) {
            let numbers = arguments(reader, value, entry);
            let push = numbers.and_then(|numbers| placed(reader, value, entry.build(&numbers)));
            pushes.push((value.span().start, push));
        }
    }
    pushes.sort_by_key(|(start, _)| *start);
    pushes.into_iter().map(|(_, push)| push).collect()
}

/// The numbers of all arguments of a law: its value, or the fields of its table.
fn arguments<T>(reader: &mut Reader, value: &Value, entry: &Entry<T>) -> Option<Vec<f64>> {
    if let [argument] = entry.arguments
        && argument.field.is_empty()
    {
        return one(reader, value, argument);
    }
    let table = &reader.table(value, format!("`{}`", entry.name))?;
    let periods = entry.arguments.iter().map(|argument| argument.period).filter(|name| !name.is_empty());
    let fields: Vec<_> = entry.arguments.iter().map(|argument| argument.field).chain(periods).collect();
    reader.only(table, &fields);
    // Read all arguments, so that all errors are reported.
    let numbers: Vec<Option<Vec<f64>>> =
        entry.arguments.iter().map(|argument| of_field(reader, table, argument)).collect();
    Some(numbers.into_iter().collect::<Option<Vec<_>>>()?.concat())
}

/// The numbers of an argument in a field of a table; its default values without the field.
fn of_field(reader: &mut Reader, table: &Table, argument: &Argument) -> Option<Vec<f64>> {
    let Argument { field, period, .. } = *argument;
    if !period.is_empty() && reader.exactly_one(table, &[field, period])? == period {
        let seconds = |reader: &mut Reader, value: &_| reader.positive(value, Quantity::Time);
        return reader.field(table, period, seconds).map(|seconds| vec![TAU / seconds]);
    }
    match (table.get(field), argument.default) {
        (None, Some(default)) => Some(default.to_vec()),
        _ => reader.field(table, field, |reader, value| one(reader, value, argument)),
    }
}

/// The numbers of one argument.
fn one(reader: &mut Reader, value: &Value, argument: &Argument) -> Option<Vec<f64>> {
    let scalar = |reader: &mut Reader, value: &Value| {
        let number = match argument.quantity {
            Some(quantity) => reader.quantity(value, quantity),
            None => reader.number(value),
        }?;
        if let Some(why) = argument.limit.refuses(number) {
            reader.report(value.span(), format!("{why}, found {number}"));
            return None;
        }
        Some(number)
    };
    match (argument.shape, argument.quantity) {
        (Shape::Vector, None) => {
            let components: Option<[f64; 3]> = match value.get_ref() {
                DeValue::String(_) => formulas::components(reader, value, Grades(0b0010), "a vector"),
                _ => reader.numbers(value),
            };
            components.map(Vec::from)
        }
        (Shape::Vector, Some(quantity)) => formulas::vector(reader, value, quantity).map(|v| v.0.to_vec()),
        (Shape::Bivector, Some(quantity)) => {
            formulas::bivector(reader, value, quantity).map(|b| b.0.to_vec())
        }
        (Shape::Gains, _) => match value.get_ref() {
            DeValue::Array(_) => reader.array(value, "numbers", scalar).map(|along: [f64; 3]| along.to_vec()),
            _ => Some(vec![scalar(reader, value)?; 3]),
        },
        (Shape::Rotor, _) => {
            let rotor = initial::attitude(reader, value, format!("`{}`", argument.field))?;
            Some(rotor.components().to_vec())
        }
        _ => Some(vec![scalar(reader, value)?]),
    }
}

fn tabulated(reader: &mut Reader, value: &Value, entry: &Entry<Torque>) -> Option<Torque> {
    let table = &reader.table(value, format!("`{}`", entry.name))?;
    reader.only(table, &["times", "torques", "frame", "kind"]);
    let times = reader.field(table, "times", |reader, value| {
        reader.list(value, "times", |reader, item| reader.quantity(item, Quantity::Time))
    });
    let torques = reader.field(table, "torques", |reader, value| {
        reader.list(value, "torques", |reader, item| formulas::bivector(reader, item, Quantity::Torque))
    });
    let mut word = |name, words: &[&'static str]| {
        reader.optional(table, name, |reader, value| reader.word(value, name, words))
    };
    let (frame, kind) = (word("frame", &["body", "space"]), word("kind", Kind::NAMES));
    let axes = if frame? == Some("space") { Axes::Space } else { Axes::Body };
    let kind = kind?.and_then(Kind::from_name).unwrap_or(Kind::Linear);
    let rows: Vec<Bivector> = torques?;
    placed(reader, value, torque::Table::new(times?, rows, axes, kind))
        .map(|table| Torque::Tabulated(Arc::new(table)))
}

/// Reports an error at the place of a value.
fn placed<T>(reader: &mut Reader, value: &Value, result: Result<T, TorqueError>) -> Option<T> {
    result.map_err(|error| reader.report(value.span(), error.to_string())).ok()
}
