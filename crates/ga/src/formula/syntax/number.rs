//! Numbers as written in formulas: `2`, `0.25`, `1e-3`, `½`.

use std::fmt;
use std::hash::{Hash, Hasher};

/// A number, with its exact value where that is a ratio of two whole numbers of 64 bits.
///
/// Over floats `value` is used; over fractions and symbols `0.1` is exactly a tenth.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// The nearest float.
    pub value: f64,
    /// Numerator and denominator, in lowest terms, the denominator positive.
    pub ratio: Option<(i64, i64)>,
}

/// Numbers are equal if their bits are, so −0 is not 0.
impl PartialEq for Number {
    fn eq(&self, other: &Number) -> bool {
        self.bits() == other.bits()
    }
}

impl Eq for Number {}

impl Hash for Number {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().hash(state);
    }
}

impl Number {
    fn bits(self) -> (u64, Option<(i64, i64)>) {
        (self.value.to_bits(), self.ratio)
    }

    /// The ratio of two whole numbers; `None` if the second is 0 or the lowest terms need more than 64 bits.
    pub fn ratio(numerator: i128, denominator: i128) -> Option<Number> {
        if denominator == 0 {
            return None;
        }
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs()) as i128;
        let (n, d) = (numerator / divisor * denominator.signum(), (denominator / divisor).abs());
        let (n, d) = (i64::try_from(n).ok()?, i64::try_from(d).ok()?);
        // The quotient of two floats is the nearest to the ratio only where both are exact.
        let exact = n.unsigned_abs() <= 1 << 53 && d <= 1 << 53;
        exact.then(|| Number { value: n as f64 / d as f64, ratio: Some((n, d)) })
    }

    /// A whole number.
    pub fn whole(n: i32) -> Number {
        Number { value: f64::from(n), ratio: Some((i64::from(n), 1)) }
    }

    /// A float without an exact ratio, such as π.
    pub fn float(value: f64) -> Number {
        Number { value, ratio: None }
    }

    /// Parses a decimal number; `None` if it is not one, or beyond the range of floats.
    pub fn decimal(text: &str) -> Option<Number> {
        let value: f64 = text.parse().ok().filter(|x: &f64| x.is_finite())?;
        if value == 0.0 {
            let digits = text.split(['e', 'E']).next()?;
            return (!digits.contains(|c: char| ('1'..='9').contains(&c))).then_some(Number::whole(0));
        }
        let ratio = decimal_ratio(text).and_then(|n| n.ratio);
        Some(Number { value, ratio })
    }

    /// The number with the other sign.
    pub fn negated(self) -> Number {
        Number { value: -self.value, ratio: self.ratio.map(|(n, d)| (-n, d)) }
    }

    /// The product of two numbers.
    pub fn times(self, other: Number) -> Number {
        let exact = self.ratio.zip(other.ratio).and_then(|((a, b), (c, d))| {
            Number::ratio(i128::from(a) * i128::from(c), i128::from(b) * i128::from(d))
        });
        exact.unwrap_or(Number::float(self.value * other.value))
    }

    /// The quotient of two numbers; `None` if the second is 0.
    pub fn over(self, other: Number) -> Option<Number> {
        if other.value == 0.0 {
            return None;
        }
        let exact = self.ratio.zip(other.ratio).and_then(|((a, b), (c, d))| {
            Number::ratio(i128::from(a) * i128::from(d), i128::from(b) * i128::from(c))
        });
        Some(exact.unwrap_or(Number::float(self.value / other.value)))
    }
}

/// The fewest digits that parse as the same number, with the same exact value.
impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shortest = self.shortest();
        if Number::decimal(&shortest).is_some_and(|number| number.ratio == self.ratio) {
            return f.write_str(&shortest);
        }
        match self.ratio.map(exact_digits) {
            Some(digits) => f.write_str(&digits.unwrap_or(shortest)),
            None => f.write_str(&with_exponent(format!("{:.*e}", MOST_DIGITS, self.value))),
        }
    }
}

impl Number {
    /// The fewest digits that give the same float.
    fn shortest(&self) -> String {
        match self.ratio {
            Some((n, 1)) => n.to_string(),
            _ if self.value == 0.0 || (1e-5..1e16).contains(&self.value.abs()) => self.value.to_string(),
            _ => with_exponent(format!("{:e}", self.value)),
        }
    }
}

/// An exponent has its sign, for `2e1` is 2 times the basis vector.
fn with_exponent(text: String) -> String {
    if text.contains("e-") { text } else { text.replace('e', "e+") }
}

/// A ratio as a finite decimal fraction, if it is one.
fn exact_digits((n, d): (i64, i64)) -> Option<String> {
    let places = (0..=38).find(|&k| 10i128.pow(k) % i128::from(d) == 0)?;
    let digits = i128::from(n).checked_mul(10i128.pow(places) / i128::from(d))?;
    let (sign, places) = (if n < 0 { "-" } else { "" }, places as usize);
    let padded = format!("{:0>1$}", digits.unsigned_abs(), places + 1);
    let (whole, part) = padded.split_at(padded.len() - places);
    Some(format!("{sign}{whole}.{part}"))
}

/// Decimal numbers of more digits are floats only.
const MOST_DIGITS: usize = 17;

/// The exact value of decimal digits, where it has few enough.
fn decimal_ratio(text: &str) -> Option<Number> {
    let (digits, exponent) = match text.split_once(['e', 'E']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let digits = format!("{whole}{part}");
    if digits.trim_start_matches('0').len() > MOST_DIGITS {
        return None;
    }
    let numerator: i128 = digits.parse().ok()?;
    let power = exponent.checked_sub(i32::try_from(part.len()).ok()?)?;
    let ten = 10i128.checked_pow(power.unsigned_abs())?;
    if power >= 0 { Number::ratio(numerator.checked_mul(ten)?, 1) } else { Number::ratio(numerator, ten) }
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a.max(1)
}

/// The ratios written as one character; fifths and tenths are shorter as decimals.
pub(crate) const FRACTIONS: [(char, i64, i64); 11] = [
    ('½', 1, 2),
    ('⅓', 1, 3),
    ('⅔', 2, 3),
    ('¼', 1, 4),
    ('¾', 3, 4),
    ('⅙', 1, 6),
    ('⅚', 5, 6),
    ('⅛', 1, 8),
    ('⅜', 3, 8),
    ('⅝', 5, 8),
    ('⅞', 7, 8),
];

/// Fifths written as one character.
const FIFTHS: [(char, i64, i64); 4] = [('⅕', 1, 5), ('⅖', 2, 5), ('⅗', 3, 5), ('⅘', 4, 5)];

/// The number that a character is, such as `½`.
pub(crate) fn fraction(c: char) -> Option<Number> {
    let &(_, n, d) = FRACTIONS.iter().chain(&FIFTHS).find(|fraction| fraction.0 == c)?;
    Number::ratio(n.into(), d.into())
}

#[cfg(test)]
mod tests;
