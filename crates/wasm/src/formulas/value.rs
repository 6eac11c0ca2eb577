//! Values of formulas as JSON.

use polhode_ga::Graded;
use polhode_ga::formula::Type;
use polhode_ga::product::Grades;
use serde_json::{Value, json};

/// Largest distance from 1 of the norm of a rotor.
const UNIT: f64 = 1e-9;

/// Digits of numbers, as Python prints values.
const DIGITS: usize = 8;

const BLADES: [&str; 8] = ["", "e1", "e2", "e3", "e2∧e3", "e3∧e1", "e1∧e2", "I"];

/// Its components in the order of the basis, its grades, whether it is a rotor, and its text.
pub fn valued(value: &Graded, ty: Type) -> Value {
    let full = value.full();
    let grades: Vec<usize> = (0..4).filter(|&k| ty.grades.contains(k)).collect();
    json!({
        "components": full,
        "grades": grades,
        "rotor": ty.unit || is_rotor(&full, ty),
        "text": text(&full),
    })
}

/// Whether an even value whose formula does not make it a rotor, such as `a b`, has norm 1.
fn is_rotor(full: &[f64; 8], ty: Type) -> bool {
    let squared: f64 = full.iter().map(|x| x * x).sum();
    ty.grades == Grades::EVEN && (squared.sqrt() - 1.0).abs() <= UNIT
}

/// The sum of the terms that are not 0: `2 e1 - e2∧e3`.
fn text(full: &[f64; 8]) -> String {
    let mut text = String::new();
    for (&x, blade) in full.iter().zip(BLADES).filter(|(x, _)| **x != 0.0) {
        let size = number(x.abs());
        let term = match (blade, size.as_str()) {
            ("", _) => size,
            (_, "1") => blade.to_owned(),
            _ => format!("{size} {blade}"),
        };
        text += match (text.is_empty(), x < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text += &term;
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// A positive number in eight digits, as `%.8g` of C and Python.
fn number(x: f64) -> String {
    let rounded = format!("{x:.*e}", DIGITS - 1);
    let (digits, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let stripped = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    if (-4..DIGITS as i32).contains(&exponent) {
        let decimals = (DIGITS as i32 - 1 - exponent) as usize;
        return stripped(&format!("{x:.decimals$}"));
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{}e{sign}{:02}", stripped(digits), exponent.abs())
}

#[cfg(test)]
mod tests;
