//! The table `[define]`, and formulas in scenes.
//!
//! ```toml
//! [define]
//! "θ" = "30 deg"
//! n = "cos(θ) e1 + sin(θ) e3"
//! "plane(a)" = "dual(a)/norm(a)"
//!
//! [initial]
//! spin = "5 rev/s plane(n)"
//! ```

use super::reader::{Reader, Table, Value};
use crate::laws::formula::Formula;
use crate::laws::torque::Axes;
use crate::units::Quantity;
use polhode_ga::formula::{Error, heading};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Vector};
use toml::de::DeValue;

/// Reads `[define]`: values and functions, which may use earlier ones.
pub fn read(reader: &mut Reader, table: &Table) {
    let mut fields: Vec<_> = table.fields.iter().collect();
    fields.sort_by_key(|(key, _)| key.span().start);
    for (key, value) in fields {
        let head: &str = key.get_ref();
        let Ok((name, parameters)) = heading(head) else {
            let message = "expected a name, `θ`, or a function in quotes, `\"V(x)\"`";
            reader.report(key.span(), message);
            continue;
        };
        if reader.formulas.names.get(&name).is_some() {
            reader.report(key.span(), format!("`{name}` is defined twice"));
        } else if parameters.is_empty() {
            if let Some(defined) = value_of(reader, value) {
                reader.formulas.bind(name, defined);
            }
        } else if let Some(body) = reader.string(value) {
            let defined = reader.formulas.define(head, body);
            defined.unwrap_or_else(|error| report(reader, value, body, error));
        }
    }
}

/// A number, or the value of a formula whose numbers may have units.
pub fn value_of(reader: &mut Reader, value: &Value) -> Option<Graded> {
    match value.get_ref() {
        DeValue::Integer(_) | DeValue::Float(_) => {
            let number = reader.number(value)?;
            Some(Graded::default().map(|_| number))
        }
        _ => {
            let text = reader.string(value)?;
            let found = reader.formulas.value(text);
            found.map_err(|error| report(reader, value, text, error)).ok()
        }
    }
}

/// The components of a formula in these grades; all others must be zero.
pub fn components<const N: usize>(
    reader: &mut Reader,
    value: &Value,
    grades: Grades,
    what: &str,
) -> Option<[f64; N]> {
    let found = value_of(reader, value)?;
    let held = |k: usize| found.with_grades(Grades(1 << k)).components().iter().any(|&x| x != 0.0);
    let others: Vec<String> =
        (0..4).filter(|&k| !grades.contains(k) && held(k)).map(|k| k.to_string()).collect();
    if !others.is_empty() {
        let s = if others.len() == 1 { "" } else { "s" };
        reader
            .report(value.span(), format!("expected {what}, found a part of grade{s} {}", others.join(", ")));
        return None;
    }
    found.with_grades(grades).components().try_into().ok()
}

/// A vector: three quantities, or a formula.
pub fn vector(reader: &mut Reader, value: &Value, quantity: Quantity) -> Option<Vector> {
    match value.get_ref() {
        DeValue::String(_) => components(reader, value, Grades(0b0010), "a vector").map(Vector),
        _ => reader.quantities(value, quantity).map(Vector),
    }
}

/// A bivector: three quantities over e2e3, e3e1, e1e2, or a formula.
pub fn bivector(reader: &mut Reader, value: &Value, quantity: Quantity) -> Option<Bivector> {
    match value.get_ref() {
        DeValue::String(_) => components(reader, value, Grades::BIVECTOR, "a bivector").map(Bivector),
        _ => reader.quantities(value, quantity).map(Bivector),
    }
}

/// The torque law of a formula, with the names of `[define]` and of the motion.
pub fn torque(reader: &mut Reader, value: &Value, axes: Axes) -> Option<Formula> {
    let text = reader.string(value)?;
    let law = reader.formulas.torque(text, axes);
    law.map_err(|error| report(reader, value, text, error)).ok()
}

/// Reports an error in a formula at its place in the file, if the file has its text verbatim.
fn report(reader: &mut Reader, value: &Value, text: &str, error: Error) {
    let span = value.span();
    // Quotes are one byte long, or three.
    let quotes = span.len().saturating_sub(text.len());
    let span = match quotes {
        2 | 6 => span.start + quotes / 2 + error.span.start..span.start + quotes / 2 + error.span.end,
        _ => span,
    };
    reader.report(span, error.message);
}
