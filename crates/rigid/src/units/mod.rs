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

use factor::Problem;
use polhode_ga::diagnostic::quote;
use polhode_ga::formula::session::Units;
use std::fmt;
use table::{Dimension, FREQUENCY, Factor, find_unit, near_unit};

/// How sessions of formulas read quantities.
pub const UNITS: Units = Units { quantities, near };

/// Quantities, each with its SI unit, an example of a value, its powers of metre, kilogram, second, radian and ampere,
/// and its name with the article.
macro_rules! quantities {
    ($($(#[$doc:meta])* $quantity:ident: $unit:literal, $example:literal, $powers:expr, $name:literal;)*) => {
        /// What a number measures.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[allow(missing_docs)]
        pub enum Quantity {
            $($(#[$doc])* $quantity),*
        }

        impl Quantity {
            /// Every quantity, in the order of the enum.
            pub const ALL: &[Quantity] = &[$(Quantity::$quantity),*];

            fn row(self) -> (&'static str, &'static str, [i32; 5], &'static str) {
                match self {
                    $(Quantity::$quantity => ($unit, $example, $powers, $name)),*
                }
            }
        }
    };
}

quantities! {
    Length: "m", "5 cm", [1, 0, 0, 0, 0], "a length";
    Mass: "kg", "2 kg", [0, 1, 0, 0, 0], "a mass";
    Time: "s", "10 s", [0, 0, 1, 0, 0], "a time";
    Angle: "rad", "30 deg", [0, 0, 0, 1, 0], "an angle";
    AngularRate: "rad/s", "5 rev/s", [0, 0, -1, 1, 0], "an angular rate";
    Density: "kg/m^3", "7.85 g/cm^3", [-3, 1, 0, 0, 0], "a density";
    Acceleration: "m/s^2", "9.81 m/s^2", [1, 0, -2, 0, 0], "an acceleration";
    MomentOfInertia: "kg m^2", "3 kg m^2", [2, 1, 0, 0, 0], "a moment of inertia";
    Speed: "m/s", "3 m/s", [1, 0, -1, 0, 0], "a speed";
    Force: "N", "2 N", [1, 1, -2, 0, 0], "a force";
    Torque: "N m", "2 N m", [2, 1, -2, 0, 0], "a torque";
    AngularMomentum: "kg m^2/s", "4 N m s", [2, 1, -1, 0, 0], "an angular momentum";
    /// Of damping: the fraction lost per second.
    DecayRate: "1/s", "0.1 /s", [0, 0, -1, 0, 0], "a rate of decay";
    TorsionalStiffness: "N m", "2 N m", [2, 1, -2, 0, 0], "a torque per angle";
    RotaryDamping: "N m s", "0.1 N m s", [2, 1, -1, 0, 0], "a torque per angular rate";
    QuadraticRotaryDamping: "N m s^2", "0.1 N m s^2", [2, 1, 0, 0, 0], "a torque per squared angular rate";
    Stiffness: "N/m", "20 N/m", [0, 1, -2, 0, 0], "a force per length";
    Drag: "N s/m", "0.1 N s/m", [0, 1, -1, 0, 0], "a force per speed";
    QuadraticDrag: "N s^2/m^2", "0.1 N s^2/m^2", [-1, 1, 0, 0, 0], "a force per squared speed";
    /// G M.
    GravitationalParameter: "m^3/s^2", "398600.4418 km^3/s^2", [3, 0, -2, 0, 0], "a gravitational parameter";
    MagneticDipole: "A m^2", "0.2 A m^2", [2, 0, 0, 0, 1], "a magnetic dipole";
    MagneticField: "T", "30 uT", [0, 1, -2, 0, -1], "a magnetic field";
    Area: "m^2", "2 m^2", [2, 0, 0, 0, 0], "an area";
    Pressure: "N/m^2", "4.56 uN/m^2", [-1, 1, -2, 0, 0], "a pressure";
}

impl Quantity {
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

/// The value of `text` in SI units (rad for angles). A zero needs no unit.
pub fn parse(text: &str, expected: Quantity) -> Result<f64, String> {
    let example = expected.example();
    let Some((number, unit)) = split_number(text.trim()) else {
        return Err(format!("expected {expected} such as `{example}`, found {}", quote(text)));
    };
    let unit = unit.trim_start();
    if !unit.is_empty() {
        return value(text, &number, factor(text, unit, expected)?);
    }
    match value(text, &number, Factor::default())? {
        0.0 => Ok(0.0),
        _ => Err(format!("expected {expected} such as `{example}`, found {} without a unit", quote(text))),
    }
}

/// The value of a quantity of any kind, in SI units, and its SI unit; None for other text.
pub fn si(text: &str) -> Option<(f64, &'static str)> {
    let (number, unit) = split_number(text.trim())?;
    let factor = match unit.trim_start() {
        "" => return Some((value(text, &number, Factor::default()).ok()?, "")),
        unit => Factor::parse(unit).ok()?,
    };
    let quantity = Quantity::ALL.iter().find(|quantity| quantity.measures(factor.dimension))?;
    Some((value(text, &number, factor).ok()?, quantity.si_unit()))
}

/// The SI value of one unit, `mm` or `kg m^2`.
pub fn parse_unit(unit: &str, expected: Quantity) -> Result<f64, String> {
    value(unit, &Number { mantissa: "1".to_owned(), exponent: 0 }, factor(unit, unit.trim(), expected)?)
}

/// The unit of a word, such as `deg`, or a similar unit, as for `degrees`.
pub fn near(word: &str) -> Option<String> {
    find_unit(word).map_or_else(|| near_unit(word).map(str::to_owned), |_| Some(word.to_owned()))
}

/// The factor of the unit in `text`, if it has the expected dimension.
fn factor(text: &str, unit: &str, expected: Quantity) -> Result<Factor, String> {
    let (text, example) = (quote(text), expected.example());
    match Factor::parse(unit) {
        Ok(factor) if expected.measures(factor.dimension) => Ok(factor),
        Ok(Factor { dimension, .. }) => {
            let frequency = expected == Quantity::AngularRate && dimension == FREQUENCY;
            let hint = if frequency { "; write rev/s or rad/s" } else { "" };
            let found = dimension.name();
            Err(format!("expected {expected} such as `{example}`, found {found} ({text}){hint}"))
        }
        Err(Problem::UnknownUnit(unit)) => {
            let hint = match near_unit(&unit) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("expected {expected} such as `{example}`"),
            };
            Err(format!("unknown unit {} in {text}, {hint}", quote(&unit)))
        }
        Err(Problem::Syntax(problem)) => Err(format!("{problem} in {text}")),
    }
}

/// A decimal number, `mantissa · 10^exponent`.
struct Number {
    mantissa: String,
    exponent: i32,
}

/// The number at the beginning of the text, and the rest.
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
    Some((Number { mantissa: format!("{sign}{whole}.{fraction}"), exponent }, rest))
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
fn value(text: &str, number: &Number, factor: Factor) -> Result<f64, String> {
    let exponent = number.exponent.saturating_add(factor.ten);
    let decimal = format!("{}e{exponent}", number.mantissa).parse().unwrap_or(f64::NAN);
    let value = decimal * factor.numerator / factor.denominator;
    if !value.is_finite() {
        return Err(format!("{} is beyond the range of floating point, about 1.8e308", quote(text)));
    }
    if value == 0.0 && number.mantissa.contains(|c| ('1'..='9').contains(&c)) {
        return Err(format!("{} is below the range of floating point, about 5e-324; write 0", quote(text)));
    }
    Ok(value)
}
