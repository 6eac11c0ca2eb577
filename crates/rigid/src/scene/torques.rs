//! The table `[torque]`: what turns the body. Its fields are laws, which add up.
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
use crate::laws::torque::{self, Axes, Gains, Kind, Orbit, Torque};
use crate::units::Quantity;
use polhode_ga::{Bivector, Rotor, Vector};
use std::f64::consts::TAU;
use std::sync::Arc;
use toml::de::DeValue;

/// A law, and its formula as it stands in the file, if it is one.
#[derive(Clone, Debug)]
pub struct Law {
    /// The field of `[torque]` that says it, or `gravity`.
    pub name: &'static str,
    /// The law.
    pub torque: Torque,
    /// The formula, whose numbers may have units.
    pub formula: Option<String>,
}

impl Law {
    /// Its name and, as text, its formula or its numbers.
    pub fn facts(&self) -> Facts {
        law_facts(self.name, &self.torque, self.formula.as_deref())
    }
}

/// Reads one law.
type Read = fn(&mut Reader, &Value) -> Option<Torque>;

/// Every law but the formulas, in the order in which messages name them.
const LAWS: [(&str, Read); 13] = [
    ("damping", |reader, value| reader.quantity(value, Quantity::DecayRate).map(Torque::Damping)),
    ("quadratic_damping", |reader, value| {
        not_negative(reader, value, Quantity::QuadraticRotaryDamping).map(Torque::QuadraticDamping)
    }),
    ("viscous_damping", |reader, value| {
        gains(reader, value, Quantity::RotaryDamping).map(Torque::ViscousDamping)
    }),
    ("gravity_gradient", gravity_gradient),
    ("constant_body", |reader, value| {
        formulas::bivector(reader, value, Quantity::Torque).map(Torque::ConstantBody)
    }),
    ("constant_space", |reader, value| {
        formulas::bivector(reader, value, Quantity::Torque).map(Torque::ConstantSpace)
    }),
    ("magnetic", magnetic),
    ("torsion_spring", torsion_spring),
    ("gyrostat", |reader, value| {
        formulas::bivector(reader, value, Quantity::AngularMomentum).map(Torque::Wheel)
    }),
    ("pd_control", pd_control),
    ("larmor", |reader, value| formulas::vector(reader, value, Quantity::AngularRate).map(Torque::Larmor)),
    ("tabulated", tabulated),
    ("heavy", |reader, value| formulas::vector(reader, value, Quantity::Torque).map(Torque::Heavy)),
];

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
        let names = LAWS.iter().map(|(name, _)| *name).chain(FORMULAS.iter().map(|(name, _)| *name));
        reader.only(table, &names.collect::<Vec<_>>());
        for (name, read) in LAWS {
            if let Some(value) = table.get(name) {
                let torque = read(reader, value);
                laws.push((value.span().start, torque.map(|torque| Law { name, torque, formula: None })));
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

fn not_negative(reader: &mut Reader, value: &Value, quantity: Quantity) -> Option<f64> {
    let number = reader.quantity(value, quantity)?;
    if number < 0.0 {
        reader.report(value.span(), format!("must not be negative, found {number}"));
        return None;
    }
    Some(number)
}

/// One number, or three along the body axes; none negative.
fn gains(reader: &mut Reader, value: &Value, quantity: Quantity) -> Option<Gains> {
    let along = match value.get_ref() {
        DeValue::Array(_) => {
            reader.array(value, "numbers", |reader, item| not_negative(reader, item, quantity))?
        }
        _ => [not_negative(reader, value, quantity)?; 3],
    };
    Some(Gains::new(along))
}

fn gravity_gradient(reader: &mut Reader, value: &Value) -> Option<Torque> {
    let table = &reader.table(value, "`gravity_gradient`")?;
    reader.only(table, &["rate", "period", "eccentricity", "mean_anomaly"]);
    let rate = match reader.exactly_one(table, &["rate", "period"])? {
        "rate" => reader.field(table, "rate", |reader, value| reader.quantity(value, Quantity::AngularRate)),
        _ => reader
            .field(table, "period", |reader, value| reader.positive(value, Quantity::Time))
            .map(|period| TAU / period),
    };
    let eccentricity = reader.optional(table, "eccentricity", |reader, value| {
        let number = reader.number(value)?;
        if !(0.0..1.0).contains(&number) {
            let message = format!("must be at least 0 and below 1 for an orbit that returns, found {number}");
            reader.report(value.span(), message);
            return None;
        }
        Some(number)
    });
    let anomaly =
        reader.optional(table, "mean_anomaly", |reader, value| reader.quantity(value, Quantity::Angle));
    let orbit = Orbit::new(rate?, eccentricity?.unwrap_or(0.0), anomaly?.unwrap_or(0.0));
    placed(reader, value, orbit).map(Torque::GravityGradient)
}

fn magnetic(reader: &mut Reader, value: &Value) -> Option<Torque> {
    let table = &reader.table(value, "`magnetic`")?;
    reader.only(table, &["dipole", "field"]);
    let mut read =
        |name, quantity| reader.field(table, name, |reader, value| formulas::vector(reader, value, quantity));
    let (dipole, field): (Option<Vector>, Option<Vector>) =
        (read("dipole", Quantity::MagneticDipole), read("field", Quantity::MagneticField));
    Some(Torque::Magnetic { dipole: dipole?, field: field? })
}

fn torsion_spring(reader: &mut Reader, value: &Value) -> Option<Torque> {
    let table = &reader.table(value, "`torsion_spring`")?;
    reader.only(table, &["stiffness", "rest"]);
    let stiffness = reader
        .field(table, "stiffness", |reader, value| reader.quantity(value, Quantity::TorsionalStiffness));
    let rest = attitude(reader, table, "rest", "`rest`");
    Some(Torque::TorsionSpring { stiffness: stiffness?, rest: rest? })
}

fn pd_control(reader: &mut Reader, value: &Value) -> Option<Torque> {
    let table = &reader.table(value, "`pd_control`")?;
    reader.only(table, &["kp", "kd", "target"]);
    let mut read = |name, quantity| reader.field(table, name, |reader, value| gains(reader, value, quantity));
    let (stiffness, damping) =
        (read("kp", Quantity::TorsionalStiffness), read("kd", Quantity::RotaryDamping));
    let target = attitude(reader, table, "target", "`target`");
    Some(Torque::Control { stiffness: stiffness?, damping: damping?, target: target? })
}

/// The attitude in this field, the identity without it.
fn attitude(reader: &mut Reader, table: &Table, name: &str, title: &'static str) -> Option<Rotor> {
    let read = reader.optional(table, name, |reader, value| initial::attitude(reader, value, title));
    Some(read?.unwrap_or(Rotor::IDENTITY))
}

fn tabulated(reader: &mut Reader, value: &Value) -> Option<Torque> {
    let table = &reader.table(value, "`tabulated`")?;
    reader.only(table, &["times", "torques", "frame", "kind"]);
    let times = reader.field(table, "times", |reader, value| {
        reader.list(value, "times", |reader, item| reader.quantity(item, Quantity::Time))
    });
    let torques = reader.field(table, "torques", |reader, value| {
        reader.list(value, "torques", |reader, item| formulas::bivector(reader, item, Quantity::Torque))
    });
    let frame =
        reader.optional(table, "frame", |reader, value| reader.word(value, "frame", &["body", "space"]));
    let kind =
        reader.optional(table, "kind", |reader, value| reader.word(value, "kind", &["linear", "cubic"]));
    let axes = if frame? == Some("space") { Axes::Space } else { Axes::Body };
    let kind = if kind? == Some("cubic") { Kind::Cubic } else { Kind::Linear };
    let rows: Vec<Bivector> = torques?;
    let made = torque::Table::new(times?, rows, axes, kind);
    placed(reader, value, made).map(|table| Torque::Tabulated(Arc::new(table)))
}

/// What is made of a value, or why nothing is, at its place.
fn placed<T>(reader: &mut Reader, value: &Value, made: Result<T, TorqueError>) -> Option<T> {
    made.map_err(|error| reader.report(value.span(), error.to_string())).ok()
}
