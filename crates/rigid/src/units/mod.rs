//! Quantities with units: `5 rev/s`, `12 deg`, `7.85 g/cm^3`, `3 kg·m²`.
//!
//! A quantity is a number and unit factors, joined by a space, `*`, `·` or `/`; `/` divides by the next factor only; a
//! factor may have a power: `s^-2`, `s**2`, `s²`. Values are in SI units.
//!
//! Angle is a dimension like length, mass, time and current: a rate of `5 1/s`, which may mean 5 rad/s or 5 turns per
//! second, is an error.
//!
//! Powers of ten (prefixes, grams, centimetres) change the decimal exponent of the number's text, so that
//! `7.85 g/cm^3` is exactly `7850.0`.

mod factor;
mod table;
#[cfg(test)]
mod tests;
mod within;

pub use within::quantities;

use factor::{Factor, Problem};
use polhode_ga::diagnostic::quote;
use polhode_ga::formula::session::Units;
use std::fmt;
use table::{Dimension, FREQUENCY, find_unit, near_unit};

/// How sessions of formulas read quantities.
pub const UNITS: Units = Units { quantities, near };

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
    Speed,
    Force,
    Torque,
    AngularMomentum,
    /// Of damping: the fraction lost per second.
    DecayRate,
    /// Torque per angle.
    TorsionalStiffness,
    /// Torque per angular rate.
    RotaryDamping,
    /// Torque per square of an angular rate.
    QuadraticRotaryDamping,
    /// Force per length.
    Stiffness,
    /// Force per speed.
    Drag,
    /// Force per square of a speed.
    QuadraticDrag,
    /// G M.
    GravitationalParameter,
    MagneticDipole,
    MagneticField,
    Area,
    Pressure,
}

impl Quantity {
    /// Every quantity, in the order of the enum.
    pub const ALL: [Quantity; 24] = [
        Quantity::Length,
        Quantity::Mass,
        Quantity::Time,
        Quantity::Angle,
        Quantity::AngularRate,
        Quantity::Density,
        Quantity::Acceleration,
        Quantity::MomentOfInertia,
        Quantity::Speed,
        Quantity::Force,
        Quantity::Torque,
        Quantity::AngularMomentum,
        Quantity::DecayRate,
        Quantity::TorsionalStiffness,
        Quantity::RotaryDamping,
        Quantity::QuadraticRotaryDamping,
        Quantity::Stiffness,
        Quantity::Drag,
        Quantity::QuadraticDrag,
        Quantity::GravitationalParameter,
        Quantity::MagneticDipole,
        Quantity::MagneticField,
        Quantity::Area,
        Quantity::Pressure,
    ];

    /// Its SI unit, an example of a value, its powers of metre, kilogram, second, radian and ampere, and its name with
    /// the article.
    fn row(self) -> (&'static str, &'static str, [i32; 5], &'static str) {
        match self {
            Quantity::Length => ("m", "5 cm", [1, 0, 0, 0, 0], "a length"),
            Quantity::Mass => ("kg", "2 kg", [0, 1, 0, 0, 0], "a mass"),
            Quantity::Time => ("s", "10 s", [0, 0, 1, 0, 0], "a time"),
            Quantity::Angle => ("rad", "30 deg", [0, 0, 0, 1, 0], "an angle"),
            Quantity::AngularRate => ("rad/s", "5 rev/s", [0, 0, -1, 1, 0], "an angular rate"),
            Quantity::Density => ("kg/m^3", "7.85 g/cm^3", [-3, 1, 0, 0, 0], "a density"),
            Quantity::Acceleration => ("m/s^2", "9.81 m/s^2", [1, 0, -2, 0, 0], "an acceleration"),
            Quantity::MomentOfInertia => ("kg m^2", "3 kg m^2", [2, 1, 0, 0, 0], "a moment of inertia"),
            Quantity::Speed => ("m/s", "3 m/s", [1, 0, -1, 0, 0], "a speed"),
            Quantity::Force => ("N", "2 N", [1, 1, -2, 0, 0], "a force"),
            Quantity::Torque => ("N m", "2 N m", [2, 1, -2, 0, 0], "a torque"),
            Quantity::AngularMomentum => ("kg m^2/s", "4 N m s", [2, 1, -1, 0, 0], "an angular momentum"),
            Quantity::DecayRate => ("1/s", "0.1 /s", [0, 0, -1, 0, 0], "a rate of decay"),
            Quantity::TorsionalStiffness => ("N m", "2 N m", [2, 1, -2, 0, 0], "a torque per angle"),
            Quantity::RotaryDamping => ("N m s", "0.1 N m s", [2, 1, -1, 0, 0], "a torque per angular rate"),
            Quantity::QuadraticRotaryDamping => {
                ("N m s^2", "0.1 N m s^2", [2, 1, 0, 0, 0], "a torque per squared angular rate")
            }
            Quantity::Stiffness => ("N/m", "20 N/m", [0, 1, -2, 0, 0], "a force per length"),
            Quantity::Drag => ("N s/m", "0.1 N s/m", [0, 1, -1, 0, 0], "a force per speed"),
            Quantity::QuadraticDrag => {
                ("N s^2/m^2", "0.1 N s^2/m^2", [-1, 1, 0, 0, 0], "a force per squared speed")
            }
            Quantity::GravitationalParameter => {
                ("m^3/s^2", "398600.4418 km^3/s^2", [3, 0, -2, 0, 0], "a gravitational parameter")
            }
            Quantity::MagneticDipole => ("A m^2", "0.2 A m^2", [2, 0, 0, 0, 1], "a magnetic dipole"),
            Quantity::MagneticField => ("T", "30 uT", [0, 1, -2, 0, -1], "a magnetic field"),
            Quantity::Area => ("m^2", "2 m^2", [2, 0, 0, 0, 0], "an area"),
            Quantity::Pressure => ("N/m^2", "4.56 uN/m^2", [-1, 1, -2, 0, 0], "a pressure"),
        }
    }

    /// Its SI unit.
    pub fn si_unit(self) -> &'static str {
        self.row().0
    }

    /// An example of a value.
    pub fn example(self) -> &'static str {
        self.row().1
    }

    /// Whether a dimension is that of the quantity; `/rad` is optional where the quantity is per angle.
    fn measures(self, dimension: Dimension) -> bool {
        let own = self.row().2;
        let [.., angle, _] = dimension.0;
        let least = match self {
            Quantity::TorsionalStiffness | Quantity::RotaryDamping => -1,
            Quantity::QuadraticRotaryDamping => -2,
            _ => own[3],
        };
        let [m, kg, s, _, a] = own;
        (least == angle || own[3] == angle) && dimension.0 == [m, kg, s, angle, a]
    }
}

impl fmt::Display for Quantity {
    /// With its article: `an angle`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.row().3)
    }
}

/// Why a text is not a quantity. `text` is the complete text.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum UnitError {
    /// It does not begin with a number.
    NoNumber { text: String, expected: Quantity },
    /// A number alone.
    NoUnit { text: String, expected: Quantity },
    /// An unknown unit, and a similar one.
    UnknownUnit { text: String, unit: String, near: Option<&'static str>, expected: Quantity },
    /// Another quantity; `found` has an article.
    WrongQuantity { text: String, found: &'static str, expected: Quantity },
    /// A syntax error in the units.
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

/// The unit of a word, such as `deg`, or a similar unit, as for `degrees`.
pub fn near(word: &str) -> Option<String> {
    find_unit(word).map_or_else(|| near_unit(word).map(str::to_owned), |_| Some(word.to_owned()))
}

/// The factor of the unit in `text`, if it has the expected dimension.
fn factor(text: &str, unit: &str, expected: Quantity) -> Result<Factor, UnitError> {
    let text = text.to_owned();
    match Factor::parse(unit) {
        Ok(factor) if expected.measures(factor.dimension) => Ok(factor),
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

/// `e3`, `E-12` at the beginning of the text, clamped to ±[`FAR`].
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

/// An exponent of ten that is out of range for any number of digits.
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
