//! The table `[ensemble]`: the number of bodies, their random parameters and their points.
//!
//! ```toml
//! [ensemble]
//! number = 100_000
//! seed = 7
//! attitude = { normal = "2 deg" }
//! spin = { relative = 0.01 }
//! torque.damping = { relative = 0.1 }
//! ```

use super::covariance::Covariance;
use super::initial::Initial;
use super::parameters::{PARAMETERS, Parameter};
use super::points::{self, Points};
use super::reader::{Reader, Table, Value};
use super::spread::{self, FORMS, Shape, Spread};
use super::{Gravity, Law};
use crate::laws::registry::Limit;
use crate::units::Quantity;
use std::f64::consts::PI;
use std::sync::Arc;
use toml::Spanned;
use toml::de::DeValue;

const MOST_BODIES: i128 = 100_000_000;
const LARGEST_SEED: i128 = 1 << 53;

/// Bodies that differ from the body of the scene, by given values and at random.
#[derive(Clone, Debug, PartialEq)]
pub struct Ensemble {
    /// The number of bodies.
    pub number: usize,
    /// The random seed.
    pub seed: u64,
    /// The distribution of attitudes.
    pub attitude: Option<Attitudes>,
    /// Whether the direction of the spin is uniform.
    pub directions: bool,
    /// The distribution of the spin in the axes of the scene, after its direction is drawn.
    pub spin: Option<Spread>,
    /// The distribution of the integrals `∫ x_k² dm` along the principal axes.
    pub moments: Option<Spread>,
    /// The distribution of the position.
    pub position: Option<Spread>,
    /// The distribution of the velocity.
    pub velocity: Option<Spread>,
    /// The distributions of parameters of laws.
    pub parameters: Vec<(&'static Parameter, Spread)>,
    /// What is kept of each motion, some of [`KEPT`]; the motions themselves if this is empty.
    pub keep: Vec<&'static str>,
    /// The covariances of parameters that vary together.
    pub covariances: Vec<Covariance>,
    /// Values of the scene that are given for each body.
    pub points: Option<Arc<Points>>,
}

/// What may be kept of the motions: the last state, extrema over the output times, regime and periods of free bodies,
/// quantiles over the bodies at each time, and how often and when bodies turn over and leave the nominal attitude.
pub const KEPT: [&str; 6] = ["last", "extrema", "regime", "periods", "quantiles", "events"];

/// A random parameter of an ensemble.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// Its name in `[ensemble]`, dotted; `spin.direction` for directions.
    pub name: String,
    /// Its distribution; `None` if it is uniform over all values.
    pub spread: Option<Spread>,
    /// The unit of the widths, except for factors.
    pub unit: &'static str,
    /// Whether it is correlated with others.
    pub correlated: bool,
}

impl Ensemble {
    /// All random parameters.
    pub fn varied(&self) -> Vec<Varied> {
        let turned = match self.attitude {
            Some(Attitudes::Turned(spread)) => Some(spread),
            _ => None,
        };
        let own = [
            ("attitude", self.attitude.is_some(), turned, Quantity::Angle.si_unit()),
            ("spin.direction", self.directions, None, ""),
            ("spin", self.spin.is_some(), self.spin, Quantity::AngularRate.si_unit()),
            ("moments", self.moments.is_some(), self.moments, ""),
            ("position", self.position.is_some(), self.position, Quantity::Length.si_unit()),
            ("velocity", self.velocity.is_some(), self.velocity, Quantity::Speed.si_unit()),
        ];
        let own = own.into_iter().filter(|(_, differs, ..)| *differs);
        let correlated = |name: &str| self.covariances.iter().any(|all| all.find(name).is_some());
        let own = own.map(|(name, _, spread, unit)| Varied {
            name: name.to_owned(),
            spread,
            unit,
            correlated: correlated(name),
        });
        let parameters = self.parameters.iter().map(|(parameter, spread)| Varied {
            name: parameter.name(),
            spread: Some(*spread),
            unit: parameter.quantity.map_or("", Quantity::si_unit),
            correlated: correlated(&parameter.name()),
        });
        own.chain(parameters).collect()
    }
}

/// The distribution of attitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attitudes {
    /// Uniform.
    Uniform,
    /// Turned by a random rotation vector along the body axes.
    Turned(Spread),
}

impl Attitudes {
    /// Turned by rotation vectors of at most half a turn.
    pub fn turned(spread: Spread) -> Result<Attitudes, &'static str> {
        if spread.widths.iter().any(|width| *width > PI) {
            return Err(
                "turns by more than half a turn; for every attitude alike write `attitude = \"uniform\"`",
            );
        }
        Ok(Attitudes::Turned(spread))
    }
}

/// The nominal values of the scene, as far as they could be read.
pub struct Nominal<'s> {
    pub initial: Option<Initial>,
    pub gravity: Option<Option<Gravity>>,
    pub laws: Option<&'s [Law]>,
}

impl Nominal<'_> {
    /// The numbers of a parameter and whether they are equal; `None` if they could not be read.
    pub fn numbers(&self, parameter: &Parameter) -> Result<Option<([f64; 3], bool)>, Absent> {
        if parameter.law == "gravity" {
            let Some(gravity) = self.gravity else { return Ok(None) };
            return gravity.map(|gravity| Some(([gravity.acceleration, 0.0, 0.0], true))).ok_or(Absent);
        }
        let Some(laws) = self.laws else { return Ok(None) };
        let law = laws.iter().find(|law| law.name == parameter.law).ok_or(Absent)?;
        Ok(parameter.of(&law.torque))
    }
}

/// The scene has no such law.
pub struct Absent;

/// Reads the table but for its points, of which there is this number, and its covariances.
pub fn read(
    reader: &mut Reader,
    value: &Value,
    nominal: &Nominal,
    points: Option<usize>,
) -> Option<Ensemble> {
    let table = &reader.table(value, "[ensemble]")?;
    let varied = ["attitude", "spin", "moments", "position", "velocity", "gravity", "torque", "covariance"];
    reader.only(table, &[&["number", "seed", "keep"], &varied[..], &points::FIELDS].concat());
    let number = number(reader, table, points, varied.iter().any(|name| table.get(name).is_some()));
    let seed = reader.optional(table, "seed", |reader, value| whole(reader, value, 0, LARGEST_SEED));
    if table.fields.keys().all(|key| matches!(key.get_ref().as_ref(), "number" | "seed" | "keep")) {
        let message = "all bodies are the same; give at least one of `attitude`, `spin`, `moments`, `torque`, `grid`, …";
        reader.report(table.span.clone(), message);
    }
    let attitude = reader.optional(table, "attitude", attitude);
    let spin = reader.optional(table, "spin", |reader, value| spin(reader, value, nominal));
    let moments = reader.optional(table, "moments", moments);
    let position = reader.optional(table, "position", |reader, value| {
        let numbers = nominal.initial.map(|initial| initial.center.position.0);
        place(reader, value, Quantity::Length, numbers)
    });
    let velocity = reader.optional(table, "velocity", |reader, value| {
        let numbers = nominal.initial.map(|initial| initial.center.velocity.0);
        place(reader, value, Quantity::Speed, numbers)
    });
    let parameters = parameters(reader, table, nominal);
    let keep = reader.optional(table, "keep", |reader, value| keep(reader, value, nominal));
    let (directions, spin) = spin?.unwrap_or_default();
    Some(Ensemble {
        number: number?,
        seed: seed?.unwrap_or(0),
        attitude: attitude?,
        directions,
        spin,
        moments: moments?,
        position: position?,
        velocity: velocity?,
        parameters: parameters?,
        keep: keep?.unwrap_or_default(),
        covariances: Vec::new(),
        points: None,
    })
}

/// What is kept, in the order of [`KEPT`].
fn keep(reader: &mut Reader, value: &Value, nominal: &Nominal) -> Option<Vec<&'static str>> {
    let words = reader.list(value, "words such as `[\"last\", \"regime\"]`", |reader, value| {
        let word = reader.word(value, "output", &KEPT)?;
        let torques =
            matches!(nominal.gravity, Some(Some(_))) || nominal.laws.is_some_and(|laws| !laws.is_empty());
        if torques && matches!(word, "regime" | "periods") {
            let message = format!("`{word}` needs a body without torques; remove it from `keep`");
            reader.report(value.span(), message);
            return None;
        }
        Some(word)
    })?;
    if words.is_empty() {
        let message = format!("nothing is kept; give some of {}, or remove `keep`", KEPT.join(", "));
        reader.report(value.span(), message);
        return None;
    }
    Some(KEPT.into_iter().filter(|word| words.contains(word)).collect())
}

/// The number of bodies: that of the points if there are any, or a multiple of it for random parameters.
fn number(reader: &mut Reader, table: &Table, points: Option<usize>, random: bool) -> Option<usize> {
    let given = |reader: &mut Reader, value: &Value| whole(reader, value, 1, MOST_BODIES);
    let has_points = points::FIELDS.iter().any(|name| table.get(name).is_some());
    let number = match has_points {
        true => reader.optional(table, "number", given)?,
        false => reader.field(table, "number", given).map(Some)?,
    };
    let number = number.map(|number| number as usize);
    let Some(count) = points else { return number };
    let Some(number) = number else { return Some(count) };
    if number != count && !(random && number % count == 0) {
        let span = table.get("number").map_or(table.span.clone(), Spanned::span);
        let multiple = if random { ", or a multiple of it" } else { "" };
        reader.report(span, format!("must be the number of points, {count}{multiple}, found {number}"));
        return None;
    }
    Some(number)
}

/// An integer in a range.
fn whole(reader: &mut Reader, value: &Value, least: i128, most: i128) -> Option<u64> {
    let number = reader.integer(value)?;
    match u64::try_from(number) {
        Ok(whole) if (least..=most).contains(&number) => Some(whole),
        _ => {
            reader.report(value.span(), format!("must be from {least} to {most}, found {number}"));
            None
        }
    }
}

fn attitude(reader: &mut Reader, value: &Value) -> Option<Attitudes> {
    if let DeValue::String(_) = value.get_ref() {
        return reader.word(value, "attitude", &["uniform"]).map(|_| Attitudes::Uniform);
    }
    let shape = Shape { quantity: Some(Quantity::Angle), size: 3, alike: false };
    let turned = spread::read(reader, value, &["normal"], shape)?;
    Attitudes::turned(turned).map_err(|message| reader.report(value.span(), message)).ok()
}

/// Whether the direction is random, and the distribution of the spin.
fn spin(reader: &mut Reader, value: &Value, nominal: &Nominal) -> Option<(bool, Option<Spread>)> {
    let table = &spread::table(reader, value, "a table such as `{ relative = 0.01 }`")?;
    let fields = [&["direction"], &FORMS[..]].concat();
    let form = spread::form(reader, table, &FORMS, &fields);
    let direction =
        reader.optional(table, "direction", |reader, value| reader.word(value, "direction", &["uniform"]));
    let directions = direction?.is_some();
    let spin = nominal.initial.map(|initial| initial.spin);
    if directions && spin.is_some_and(|spin| spin.0 == [0.0; 3]) {
        reader.report(value.span(), "a spin of 0 has no direction; give a spin in [initial]");
    }
    let Some(form) = form else { return directions.then_some((true, None)) };
    let shape = Shape { quantity: Some(Quantity::AngularRate), size: 3, alike: false };
    let spread = spread::field(reader, table, form, shape)?;
    if let Some(spin) = spin {
        // With a random direction each component may be as large as the spin.
        let numbers = if directions { [spin.norm(); 3] } else { spin.0 };
        spread.check(reader, value.span(), &numbers, Limit::Finite);
    }
    Some((directions, Some(spread)))
}

/// A factor for each of the integrals `∫ x_k² dm`.
fn moments(reader: &mut Reader, value: &Value) -> Option<Spread> {
    let shape = Shape { quantity: None, size: 3, alike: false };
    let spread = spread::read(reader, value, &["relative"], shape)?;
    Some(Spread { alike: false, ..spread })
}

fn place(
    reader: &mut Reader,
    value: &Value,
    quantity: Quantity,
    numbers: Option<[f64; 3]>,
) -> Option<Spread> {
    let shape = Shape { quantity: Some(quantity), size: 3, alike: false };
    let spread = spread::read(reader, value, &FORMS[..2], shape)?;
    if let Some(numbers) = numbers {
        spread.check(reader, value.span(), &numbers, Limit::Finite);
    }
    Some(spread)
}

/// The parameters of gravity and of the laws, in the order of [`PARAMETERS`].
fn parameters(
    reader: &mut Reader,
    table: &Table,
    nominal: &Nominal,
) -> Option<Vec<(&'static Parameter, Spread)>> {
    let mut found = Vec::new();
    if let Some(value) = table.get("gravity") {
        found.extend(fields(reader, value, "`gravity`", "gravity", nominal));
    }
    if let Some(value) = table.get("torque") {
        let torque = &reader.table(value, "`torque`")?;
        let mut laws: Vec<&str> = PARAMETERS.iter().map(|parameter| parameter.law).collect();
        laws.dedup();
        reader.only(torque, &laws[1..]);
        for law in &laws[1..] {
            let Some(value) = torque.get(law) else { continue };
            match PARAMETERS.iter().find(|parameter| parameter.law == *law && parameter.field.is_empty()) {
                Some(parameter) => found.push(spread_of(reader, torque, value, parameter, nominal)),
                None => found.extend(fields(reader, value, "the law", law, nominal)),
            }
        }
    }
    found.into_iter().collect()
}

/// The parameters of a law that has fields.
fn fields(
    reader: &mut Reader,
    value: &Value,
    title: &'static str,
    law: &str,
    nominal: &Nominal,
) -> Vec<Option<(&'static Parameter, Spread)>> {
    let Some(table) = &reader.table(value, title) else { return vec![None] };
    let parameters: Vec<&'static Parameter> =
        PARAMETERS.iter().filter(|parameter| parameter.law == law).collect();
    let names: Vec<&'static str> = parameters.iter().map(|parameter| parameter.field).collect();
    reader.only(table, &names);
    // A rate and its period are the same number of the law.
    let same = parameters.chunk_by(|a, b| a.at == b.at);
    for names in same {
        reader.at_most_one(table, &names.iter().map(|parameter| parameter.field).collect::<Vec<_>>());
    }
    let given = parameters.into_iter().filter_map(|parameter| Some((parameter, table.get(parameter.field)?)));
    given.map(|(parameter, value)| spread_of(reader, table, value, parameter, nominal)).collect()
}

/// The distribution of one parameter.
fn spread_of(
    reader: &mut Reader,
    table: &Table,
    value: &Value,
    parameter: &'static Parameter,
    nominal: &Nominal,
) -> Option<(&'static Parameter, Spread)> {
    let Ok(known) = nominal.numbers(parameter) else {
        let name = if parameter.field.is_empty() { parameter.law } else { parameter.field };
        let message =
            format!("a random parameter needs a value in the scene, which has no {}", parameter.place());
        reader.report(table.name_span(name).unwrap_or(value.span()), message);
        return None;
    };
    let alike = known.is_some_and(|(_, one)| one);
    let shape = Shape { quantity: parameter.quantity, size: parameter.size, alike };
    let spread = spread::read(reader, value, &FORMS, shape)?;
    if let Some((numbers, _)) = known {
        spread.check(reader, value.span(), &numbers[..parameter.size], parameter.limit);
    }
    Some((parameter, spread))
}
