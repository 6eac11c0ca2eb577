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

use crate::diagnostic::{nearest, quote};
use std::f64::consts::{PI, TAU};
use std::fmt;

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

/// Powers of metre, kilogram, second and radian.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Dimension([i32; 4]);

const LENGTH: Dimension = Dimension([1, 0, 0, 0]);
const MASS: Dimension = Dimension([0, 1, 0, 0]);
const TIME: Dimension = Dimension([0, 0, 1, 0]);
const ANGLE: Dimension = Dimension([0, 0, 0, 1]);
const FREQUENCY: Dimension = Dimension([0, 0, -1, 0]);

impl Dimension {
    fn name(self) -> &'static str {
        match self.0 {
            [0, 0, 0, 0] => "a pure number",
            [1, 0, 0, 0] => "a length",
            [2, 0, 0, 0] => "an area",
            [3, 0, 0, 0] => "a volume",
            [0, 1, 0, 0] => "a mass",
            [0, 0, 1, 0] => "a time",
            [0, 0, -1, 0] => "a frequency",
            [0, 0, 0, 1] => "an angle",
            [0, 0, -1, 1] => "an angular rate",
            [0, 0, -2, 1] => "an angular acceleration",
            [1, 0, -1, 0] => "a speed",
            [1, 0, -2, 0] => "an acceleration",
            [-3, 1, 0, 0] => "a density",
            [2, 1, 0, 0] => "a moment of inertia",
            [1, 1, -1, 0] => "a momentum",
            [2, 1, -1, 0] => "an angular momentum",
            [1, 1, -2, 0] => "a force",
            [2, 1, -2, 0] => "a torque or an energy",
            [-1, 1, -2, 0] => "a pressure",
            _ => "another quantity",
        }
    }
}

/// A unit is `10^ten · numerator / denominator` SI units.
#[derive(Clone, Copy)]
struct Unit {
    name: &'static str,
    dimension: Dimension,
    ten: i32,
    numerator: f64,
    denominator: f64,
    /// Whether `k`, `m`, … may stand before it.
    prefixes: bool,
}

/// A unit that is a power of ten of SI units and takes prefixes.
const fn metric(name: &'static str, dimension: Dimension, ten: i32) -> Unit {
    Unit { name, dimension, ten, numerator: 1.0, denominator: 1.0, prefixes: true }
}

/// Any other unit.
const fn other(name: &'static str, dimension: Dimension, numerator: f64, denominator: f64) -> Unit {
    Unit { name, dimension, ten: 0, numerator, denominator, prefixes: false }
}

const UNITS: [Unit; 26] = [
    metric("m", LENGTH, 0),
    metric("g", MASS, -3),
    metric("s", TIME, 0),
    metric("rad", ANGLE, 0),
    metric("N", Dimension([1, 1, -2, 0]), 0),
    metric("J", Dimension([2, 1, -2, 0]), 0),
    metric("Pa", Dimension([-1, 1, -2, 0]), 0),
    metric("Hz", FREQUENCY, 0),
    other("ft", LENGTH, 0.3048, 1.0),
    other("inch", LENGTH, 0.0254, 1.0),
    other("au", LENGTH, 149_597_870_700.0, 1.0),
    other("lb", MASS, 0.453_592_37, 1.0),
    other("t", MASS, 1000.0, 1.0),
    other("min", TIME, 60.0, 1.0),
    other("h", TIME, 3600.0, 1.0),
    other("d", TIME, 86_400.0, 1.0),
    other("day", TIME, 86_400.0, 1.0),
    // The Julian year of astronomy.
    other("yr", TIME, 365.25 * 86_400.0, 1.0),
    other("deg", ANGLE, PI, 180.0),
    other("°", ANGLE, PI, 180.0),
    other("arcmin", ANGLE, PI, 180.0 * 60.0),
    other("arcsec", ANGLE, PI, 180.0 * 3600.0),
    other("rev", ANGLE, TAU, 1.0),
    other("turn", ANGLE, TAU, 1.0),
    other("rpm", Dimension([0, 0, -1, 1]), TAU, 60.0),
    // The 1 of `1/s`.
    other("1", Dimension([0; 4]), 1.0, 1.0),
];

/// Both micro signs: U+00B5 of keyboards and U+03BC of the Greek alphabet.
const PREFIXES: [(&str, i32); 10] = [
    ("n", -9),
    ("u", -6),
    ("\u{b5}", -6),
    ("\u{3bc}", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("k", 3),
    ("M", 6),
    ("G", 9),
];

/// What people write instead of a unit's symbol.
const OTHER_NAMES: [(&str, &str); 22] = [
    ("meter", "m"),
    ("metre", "m"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("in", "inch"),
    ("gram", "g"),
    ("kilogram", "kg"),
    ("ton", "t"),
    ("tonne", "t"),
    ("pound", "lb"),
    ("lbs", "lb"),
    ("sec", "s"),
    ("second", "s"),
    ("minute", "min"),
    ("hr", "h"),
    ("hour", "h"),
    ("year", "yr"),
    ("radian", "rad"),
    ("degree", "deg"),
    ("revolution", "rev"),
    ("hertz", "Hz"),
    ("Nm", "N m"),
];

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
    let trimmed = text.trim();
    let (number, units) =
        split_number(trimmed).ok_or_else(|| UnitError::NoNumber { text: text.to_owned(), expected })?;
    if units.is_empty() {
        return match value(text, &number, Factor::default())? {
            0.0 => Ok(0.0),
            _ => Err(UnitError::NoUnit { text: text.to_owned(), expected }),
        };
    }
    let factor = Factor::parse(units).map_err(|problem| problem.in_text(text, expected))?;
    if factor.dimension != expected.dimension() {
        let found = factor.dimension.name();
        return Err(UnitError::WrongQuantity { text: text.to_owned(), found, expected });
    }
    value(text, &number, factor)
}

/// The SI value of one unit, `mm` or `kg m^2`.
pub fn parse_unit(unit: &str, expected: Quantity) -> Result<f64, UnitError> {
    let factor = Factor::parse(unit.trim()).map_err(|problem| problem.in_text(unit, expected))?;
    if factor.dimension != expected.dimension() {
        let found = factor.dimension.name();
        return Err(UnitError::WrongQuantity { text: unit.to_owned(), found, expected });
    }
    value(unit, &Number { mantissa: "1".to_owned(), exponent: 0 }, factor)
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
    let size = digits.trim_start_matches('0').parse().unwrap_or(if digits.is_empty() { 0 } else { FAR });
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

/// A product of powers of units: `10^ten · numerator / denominator` SI units.
#[derive(Clone, Copy)]
struct Factor {
    dimension: Dimension,
    ten: i32,
    numerator: f64,
    denominator: f64,
}

impl Default for Factor {
    fn default() -> Factor {
        Factor { dimension: Dimension::default(), ten: 0, numerator: 1.0, denominator: 1.0 }
    }
}

/// What is wrong with a product of units.
enum Problem {
    UnknownUnit(String),
    Syntax(String),
}

impl Problem {
    fn in_text(self, text: &str, expected: Quantity) -> UnitError {
        let text = text.to_owned();
        match self {
            Problem::UnknownUnit(unit) => {
                UnitError::UnknownUnit { text, near: near_unit(&unit), unit, expected }
            }
            Problem::Syntax(problem) => UnitError::Syntax { text, problem },
        }
    }
}

impl Factor {
    /// Reads `kg m^2 / s`: operator and unit by turns, a space standing for the times sign.
    fn parse(text: &str) -> Result<Factor, Problem> {
        let mut product = Factor::default();
        let mut rest = text;
        let mut first = true;
        while first || !rest.is_empty() {
            let operator = rest.chars().next().filter(|c| matches!(c, '*' | '·' | '⋅' | '/'));
            if let Some(operator) = operator {
                rest = rest[operator.len_utf8()..].trim_start();
            }
            let (unit, after) = split_unit(rest)?;
            let (power, after) = split_power(after)?;
            product.multiply(unit, if operator == Some('/') { -power } else { power });
            rest = after.trim_start();
            first = false;
        }
        Ok(product)
    }

    /// Times `unit^power`.
    fn multiply(&mut self, unit: Unit, power: i32) {
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
fn split_unit(text: &str) -> Result<(Unit, &str), Problem> {
    let one = text.starts_with('1').then_some(1);
    let letters = text.find(|c: char| !(c.is_alphabetic() || c == '°')).unwrap_or(text.len());
    let (name, rest) = text.split_at(one.unwrap_or(letters));
    match (name, text.chars().next()) {
        ("", None) => Err(Problem::Syntax("a unit is missing at the end".to_owned())),
        ("", Some(',')) => Err(Problem::Syntax("unexpected `,` (a decimal point is written `.`)".to_owned())),
        ("", Some('(' | ')')) => {
            Err(Problem::Syntax("parentheses are not read (write `/` before each divisor)".to_owned()))
        }
        ("", Some(c)) => Err(Problem::Syntax(format!("unexpected {}", quote(&c.to_string())))),
        _ => find_unit(name).map(|unit| (unit, rest)).ok_or_else(|| Problem::UnknownUnit(name.to_owned())),
    }
}

/// The power at the beginning of the text, 1 if there is none.
fn split_power(text: &str) -> Result<(i32, &str), Problem> {
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
fn power_of(digits: &str) -> Result<i32, Problem> {
    match digits.parse() {
        Ok(power @ 1..=9) => Ok(power),
        _ => Err(Problem::Syntax("a power is a whole number from -9 to 9, not 0,".to_owned())),
    }
}

fn superscript(c: char) -> Option<char> {
    let index = "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c)?;
    char::from_digit(u32::try_from(index).ok()?, 10)
}

/// The unit of this name, with a prefix if it takes one.
fn find_unit(name: &str) -> Option<Unit> {
    if let Some(unit) = UNITS.iter().find(|unit| unit.name == name) {
        return Some(*unit);
    }
    PREFIXES.iter().find_map(|(prefix, ten)| {
        let base = name.strip_prefix(prefix)?;
        let unit = UNITS.iter().find(|unit| unit.prefixes && unit.name == base)?;
        Some(Unit { ten: unit.ten + ten, ..*unit })
    })
}

/// The unit that a name may stand for.
fn near_unit(name: &str) -> Option<&'static str> {
    let singular = name.strip_suffix('s').unwrap_or(name);
    let word = |(word, unit): &(&str, &'static str)| (*word == name || *word == singular).then_some(*unit);
    OTHER_NAMES
        .iter()
        .find_map(word)
        .or_else(|| nearest(name, UNITS.iter().map(|unit| unit.name).chain(["kg"])))
}
