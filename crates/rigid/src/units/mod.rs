//! Quantities as people write them: `5 rev/s`, `12 deg`, `7.85 g/cm^3`, `3 kg·m²`.
//!
//! A quantity is a number and unit factors, joined by a space, `*`, `·` or `/`; `/` divides by the one
//! factor after it; a factor may carry a power: `s^-2`, `s**2`, `s²`. The value comes out in SI units.
//!
//! Angle is no SI dimension, since a radian is 1. Here it is kept as a fourth dimension beside length,
//! mass and time, because a rate of `5 1/s` may mean 5 rad/s or 5 turns per second: we ask.
//!
//! Powers of ten (prefixes, grams, centimetres) never touch floating point: they move the decimal
//! exponent of the number's text, so that `7.85 g/cm^3` is exactly the `7850.0` of a source file.

mod factor;
mod table;
#[cfg(test)]
mod tests;
mod within;

pub use within::{Within, WithinError, quantities};

use factor::{Factor, Problem};
use polhode_ga::diagnostic::quote;
use std::fmt;
use table::{ANGLE, Dimension, FREQUENCY, LENGTH, MASS, TIME, find_unit, near_unit};

/// What a number measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Quantity {
    Length,
    Mass,
    Time,
    Angle,
    AngularRate,
    Density,
    Acceleration,
    MomentOfInertia,
}

impl Quantity {
    /// Every quantity, in the order of the enum.
    pub const ALL: [Quantity; 8] = [
        Quantity::Length,
        Quantity::Mass,
        Quantity::Time,
        Quantity::Angle,
        Quantity::AngularRate,
        Quantity::Density,
        Quantity::Acceleration,
        Quantity::MomentOfInertia,
    ];

    /// Its unit in SI, which a bare number has.
    pub fn si_unit(self) -> &'static str {
        match self {
            Quantity::Length => "m",
            Quantity::Mass => "kg",
            Quantity::Time => "s",
            Quantity::Angle => "rad",
            Quantity::AngularRate => "rad/s",
            Quantity::Density => "kg/m^3",
            Quantity::Acceleration => "m/s^2",
            Quantity::MomentOfInertia => "kg m^2",
        }
    }

    /// One such value as a person might write it.
    pub fn example(self) -> &'static str {
        match self {
            Quantity::Length => "5 cm",
            Quantity::Mass => "2 kg",
            Quantity::Time => "10 s",
            Quantity::Angle => "30 deg",
            Quantity::AngularRate => "5 rev/s",
            Quantity::Density => "7.85 g/cm^3",
            Quantity::Acceleration => "9.81 m/s^2",
            Quantity::MomentOfInertia => "3 kg m^2",
        }
    }

    fn dimension(self) -> Dimension {
        match self {
            Quantity::Length => LENGTH,
            Quantity::Mass => MASS,
            Quantity::Time => TIME,
            Quantity::Angle => ANGLE,
            Quantity::AngularRate => Dimension([0, 0, -1, 1]),
            Quantity::Density => Dimension([-3, 1, 0, 0]),
            Quantity::Acceleration => Dimension([1, 0, -2, 0]),
            Quantity::MomentOfInertia => Dimension([2, 1, 0, 0]),
        }
    }
}

impl fmt::Display for Quantity {
    /// With its article: `an angle`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.dimension().name())
    }
}

/// Why a text is no such quantity. The text is the whole of what was written.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum UnitError {
    /// It does not begin with a number.
    NoNumber { text: String, expected: Quantity },
    /// A number alone.
    NoUnit { text: String, expected: Quantity },
    /// A name that is no unit, and the unit it may stand for.
    UnknownUnit { text: String, unit: String, near: Option<&'static str>, expected: Quantity },
    /// It measures something else, `found` with its article.
    WrongQuantity { text: String, found: &'static str, expected: Quantity },
    /// The units are not written as units are.
    Syntax { text: String, problem: String },
    /// The value is beyond the range of floating point.
    Overflow { text: String },
    /// The value is not zero, but nearer to zero than any floating-point number.
    Underflow { text: String },
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            UnitError::NoNumber { text, expected } => {
                write!(f, "expected {expected} such as `{}`, found {}", expected.example(), quote(text))
            }
            UnitError::NoUnit { text, expected } => write!(
                f,
                "expected {expected} such as `{}`, found {} without a unit",
                expected.example(),
                quote(text)
            ),
            UnitError::UnknownUnit { text, unit, near, expected } => {
                write!(f, "unknown unit {} in {}, ", quote(unit), quote(text))?;
                match near {
                    Some(near) => write!(f, "did you mean `{near}`?"),
                    None => write!(f, "expected {expected} such as `{}`", expected.example()),
                }
            }
            UnitError::WrongQuantity { text, found, expected } => {
                let example = expected.example();
                write!(f, "expected {expected} such as `{example}`, found {found} ({})", quote(text))?;
                if *expected == Quantity::AngularRate && *found == FREQUENCY.name() {
                    write!(f, "; write rev/s or rad/s")?;
                }
                Ok(())
            }
            UnitError::Syntax { text, problem } => write!(f, "{problem} in {}", quote(text)),
            UnitError::Overflow { text } => {
                write!(f, "{} is beyond the range of floating point, about 1.8e308", quote(text))
            }
            UnitError::Underflow { text } => {
                write!(f, "{} is below the range of floating point, about 5e-324; write 0", quote(text))
            }
        }
    }
}

impl std::error::Error for UnitError {}

/// The value of `text` in SI units (rad for angles). A zero needs no unit.
pub fn parse(text: &str, expected: Quantity) -> Result<f64, UnitError> {
    let Some((number, unit)) = split_number(text.trim()) else {
        return Err(UnitError::NoNumber { text: text.to_owned(), expected });
    };
    if !unit.is_empty() {
        return value(text, &number, factor(text, unit, expected)?);
    }
    match value(text, &number, Factor::default())? {
        0.0 => Ok(0.0),
        _ => Err(UnitError::NoUnit { text: text.to_owned(), expected }),
    }
}

/// The SI value of one unit, `mm` or `kg m^2`.
pub fn parse_unit(unit: &str, expected: Quantity) -> Result<f64, UnitError> {
    value(unit, &Number { mantissa: "1".to_owned(), exponent: 0 }, factor(unit, unit.trim(), expected)?)
}

/// The unit that a word is, `deg`, or that it may stand for, as `degrees` does.
pub fn near(word: &str) -> Option<String> {
    find_unit(word).map_or_else(|| near_unit(word).map(str::to_owned), |_| Some(word.to_owned()))
}

/// The unit that stands in `text`, if it measures what is expected.
fn factor(text: &str, unit: &str, expected: Quantity) -> Result<Factor, UnitError> {
    let text = text.to_owned();
    match Factor::parse(unit) {
        Ok(factor) if factor.dimension == expected.dimension() => Ok(factor),
        Ok(factor) => Err(UnitError::WrongQuantity { text, found: factor.dimension.name(), expected }),
        Err(Problem::UnknownUnit(unit)) => {
            Err(UnitError::UnknownUnit { text, near: near_unit(&unit), unit, expected })
        }
        Err(Problem::Syntax(problem)) => Err(UnitError::Syntax { text, problem }),
    }
}

/// A decimal number, `mantissa · 10^exponent`.
struct Number {
    mantissa: String,
    exponent: i32,
}

/// The number at the beginning of the text, and the rest without the space between them.
fn split_number(text: &str) -> Option<(Number, &str)> {
    let (sign, unsigned) = match text.strip_prefix(['-', '\u{2212}']) {
        Some(unsigned) => ("-", unsigned),
        None => ("", text.strip_prefix('+').unwrap_or(text)),
    };
    let (whole, rest) = split_digits(unsigned);
    let (fraction, rest) = rest.strip_prefix('.').map_or(("", rest), split_digits);
    if whole.is_empty() && fraction.is_empty() {
        return None;
    }
    let (exponent, rest) = split_exponent(rest).unwrap_or((0, rest));
    Some((Number { mantissa: format!("{sign}{whole}.{fraction}"), exponent }, rest.trim_start()))
}

/// `e3`, `E-12` at the beginning of the text; one far beyond any range stays so.
fn split_exponent(text: &str) -> Option<(i32, &str)> {
    let text = text.strip_prefix(['e', 'E'])?;
    let (sign, text) = match text.strip_prefix(['-', '\u{2212}']) {
        Some(text) => (-1, text),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let (digits, rest) = split_digits(text);
    // Digits fail to parse only when there are none, or too many.
    let size: i32 = digits.parse().unwrap_or(FAR);
    (!digits.is_empty()).then_some((sign * size.min(FAR), rest))
}

/// An exponent of ten that no number of digits in a file brings back into range.
const FAR: i32 = 1_000_000_000;

fn split_digits(text: &str) -> (&str, &str) {
    text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()))
}

/// The number times the factor, in range.
fn value(text: &str, number: &Number, factor: Factor) -> Result<f64, UnitError> {
    let exponent = number.exponent.saturating_add(factor.ten);
    let decimal = format!("{}e{exponent}", number.mantissa).parse().unwrap_or(f64::NAN);
    let value = decimal * factor.numerator / factor.denominator;
    if !value.is_finite() {
        return Err(UnitError::Overflow { text: text.to_owned() });
    }
    if value == 0.0 && number.mantissa.contains(|c| ('1'..='9').contains(&c)) {
        return Err(UnitError::Underflow { text: text.to_owned() });
    }
    Ok(value)
}
