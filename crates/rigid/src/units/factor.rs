//! Products of units as they are written: `kg m^2 / s`.

use super::split_digits;
use super::table::{Dimension, Factor, find_unit};
use polhode_ga::diagnostic::quote;

impl Default for Factor {
    fn default() -> Factor {
        Factor { dimension: Dimension::default(), ten: 0, numerator: 1.0, denominator: 1.0 }
    }
}

/// An error in a product of units.
pub enum Problem {
    UnknownUnit(String),
    Syntax(String),
}

impl Factor {
    /// Reads `kg m^2 / s`: units separated by operators or spaces.
    pub fn parse(text: &str) -> Result<Factor, Problem> {
        let mut product = Factor::default();
        let mut rest = text;
        let mut first = true;
        while first || !rest.is_empty() {
            let operator = rest.chars().next().filter(|c| matches!(c, '*' | '·' | '⋅' | '/'));
            if let Some(operator) = operator {
                rest = rest[operator.len_utf8()..].trim_start();
            }
            let (unit, after) = split_unit(rest)?;
            let (power, after) = split_power(after).map_err(Problem::Syntax)?;
            product.multiply(unit, if operator == Some('/') { -power } else { power });
            rest = after.trim_start();
            first = false;
        }
        Ok(product)
    }

    /// Times `unit^power`.
    pub fn multiply(&mut self, unit: Factor, power: i32) {
        for (total, d) in self.dimension.0.iter_mut().zip(unit.dimension.0) {
            *total += power * d;
        }
        self.ten += power * unit.ten;
        let (above, below) = match power < 0 {
            false => (unit.numerator, unit.denominator),
            true => (unit.denominator, unit.numerator),
        };
        self.numerator *= above.powi(power.abs());
        self.denominator *= below.powi(power.abs());
    }
}

/// The unit at the beginning of the text.
fn split_unit(text: &str) -> Result<(Factor, &str), Problem> {
    let one = text.starts_with('1').then_some(1);
    let letters = text.find(|c: char| !(c.is_alphabetic() || c == '°')).unwrap_or(text.len());
    let (name, rest) = text.split_at(one.unwrap_or(letters));
    if !name.is_empty() {
        let unit = find_unit(name).ok_or_else(|| Problem::UnknownUnit(name.to_owned()))?;
        return Ok((unit, rest));
    }
    Err(Problem::Syntax(match text.chars().next() {
        None => "a unit is missing at the end".to_owned(),
        Some(',') => "unexpected `,` (a decimal point is written `.`)".to_owned(),
        Some('(' | ')') => "parentheses are not supported (write `/` before each divisor)".to_owned(),
        Some(c @ '0'..='9') => format!("unexpected `{c}` (a power is written `^{c}`)"),
        Some(c) => format!("unexpected {}", quote(&c.to_string())),
    }))
}

/// The power at the beginning of the text, 1 if there is none.
pub fn split_power(text: &str) -> Result<(i32, &str), String> {
    if let Some(written) = text.strip_prefix("**").or_else(|| text.strip_prefix('^')) {
        let (sign, digits) = match written.strip_prefix(['-', '\u{2212}']) {
            Some(digits) => (-1, digits),
            None => (1, written),
        };
        let (digits, rest) = split_digits(digits);
        return Ok((sign * power_of(digits)?, rest));
    }
    let (sign, raised) = text.strip_prefix('⁻').map_or((1, text), |raised| (-1, raised));
    let end = raised.find(|c| superscript(c).is_none()).unwrap_or(raised.len());
    let (raised, rest) = raised.split_at(end);
    if raised.is_empty() && sign == 1 {
        return Ok((1, rest));
    }
    let digits: String = raised.chars().filter_map(superscript).collect();
    Ok((sign * power_of(&digits)?, rest))
}

/// A power of one digit: no quantity needs more.
fn power_of(digits: &str) -> Result<i32, String> {
    match digits.parse() {
        Ok(power @ 1..=9) => Ok(power),
        _ => Err("a power must be a whole number from -9 to 9 and not 0".to_owned()),
    }
}

fn superscript(c: char) -> Option<char> {
    let index = "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c)?;
    char::from_digit(u32::try_from(index).ok()?, 10)
}
