//! Table of units: names, dimensions and SI factors.

use polhode_ga::diagnostic::nearest;
use std::f64::consts::{PI, TAU};

/// Powers of metre, kilogram, second, radian and ampere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension(pub [i32; 5]);

pub const LENGTH: Dimension = Dimension([1, 0, 0, 0, 0]);
pub const MASS: Dimension = Dimension([0, 1, 0, 0, 0]);
pub const TIME: Dimension = Dimension([0, 0, 1, 0, 0]);
pub const ANGLE: Dimension = Dimension([0, 0, 0, 1, 0]);
pub const FREQUENCY: Dimension = Dimension([0, 0, -1, 0, 0]);

impl Dimension {
    /// What a quantity of this dimension is called, with its article.
    pub fn name(self) -> &'static str {
        match self.0 {
            [0, 0, 0, 0, 0] => "a pure number",
            [1, 0, 0, 0, 0] => "a length",
            [2, 0, 0, 0, 0] => "an area",
            [3, 0, 0, 0, 0] => "a volume",
            [0, 1, 0, 0, 0] => "a mass",
            [0, 0, 1, 0, 0] => "a time",
            [0, 0, -1, 0, 0] => "a frequency",
            [0, 0, 0, 1, 0] => "an angle",
            [0, 0, -1, 1, 0] => "an angular rate",
            [0, 0, -2, 1, 0] => "an angular acceleration",
            [1, 0, -1, 0, 0] => "a speed",
            [1, 0, -2, 0, 0] => "an acceleration",
            [-3, 1, 0, 0, 0] => "a density",
            [2, 1, 0, 0, 0] => "a moment of inertia",
            [1, 1, -1, 0, 0] => "a momentum",
            [2, 1, -1, 0, 0] => "an angular momentum",
            [1, 1, -2, 0, 0] => "a force",
            [2, 1, -2, 0, 0] => "a torque or an energy",
            [-1, 1, -2, 0, 0] => "a pressure",
            [0, 0, 0, 0, 1] => "an electric current",
            [2, 0, 0, 0, 1] => "a magnetic dipole",
            [0, 1, -2, 0, -1] => "a magnetic field",
            _ => "another quantity",
        }
    }
}

/// `10^ten · numerator / denominator` SI units.
#[derive(Clone, Copy)]
pub struct Factor {
    pub dimension: Dimension,
    pub ten: i32,
    pub numerator: f64,
    pub denominator: f64,
}

struct Unit {
    name: &'static str,
    factor: Factor,
    /// Whether it takes prefixes.
    prefixes: bool,
}

/// A unit that is a power of ten of SI units and takes prefixes.
const fn metric(name: &'static str, dimension: Dimension, ten: i32) -> Unit {
    Unit { name, factor: Factor { dimension, ten, numerator: 1.0, denominator: 1.0 }, prefixes: true }
}

/// Any other unit.
const fn other(name: &'static str, dimension: Dimension, numerator: f64, denominator: f64) -> Unit {
    Unit { name, factor: Factor { dimension, ten: 0, numerator, denominator }, prefixes: false }
}

const UNITS: [Unit; 28] = [
    metric("m", LENGTH, 0),
    metric("g", MASS, -3),
    metric("s", TIME, 0),
    metric("rad", ANGLE, 0),
    metric("N", Dimension([1, 1, -2, 0, 0]), 0),
    metric("J", Dimension([2, 1, -2, 0, 0]), 0),
    metric("Pa", Dimension([-1, 1, -2, 0, 0]), 0),
    metric("Hz", FREQUENCY, 0),
    metric("A", Dimension([0, 0, 0, 0, 1]), 0),
    metric("T", Dimension([0, 1, -2, 0, -1]), 0),
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
    other("rpm", Dimension([0, 0, -1, 1, 0]), TAU, 60.0),
    // The 1 of `1/s`.
    other("1", Dimension([0; 5]), 1.0, 1.0),
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

/// Words written instead of a unit's symbol.
const OTHER_NAMES: [(&str, &str); 24] = [
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
    ("ampere", "A"),
    ("tesla", "T"),
    ("Nm", "N m"),
];

/// The unit of this name, with a prefix if it takes one.
pub fn find_unit(name: &str) -> Option<Factor> {
    if let Some(unit) = UNITS.iter().find(|unit| unit.name == name) {
        return Some(unit.factor);
    }
    PREFIXES.iter().find_map(|(prefix, ten)| {
        let base = name.strip_prefix(prefix)?;
        let unit = UNITS.iter().find(|unit| unit.prefixes && unit.name == base)?;
        Some(Factor { ten: unit.factor.ten + ten, ..unit.factor })
    })
}

/// The unit that a name may stand for.
pub fn near_unit(name: &str) -> Option<&'static str> {
    let singular = name.strip_suffix('s').unwrap_or(name);
    let word = |(word, unit): &(&str, &'static str)| (*word == name || *word == singular).then_some(*unit);
    OTHER_NAMES
        .iter()
        .find_map(word)
        .or_else(|| nearest(name, UNITS.iter().map(|unit| unit.name).chain(["kg"])))
}
