//! Quantities within a formula: `exp(-45 deg e1∧e2)`, `5 rev/s e1∧e2`.
//!
//! A quantity in a formula is a number directly followed by units, as in `5 kg m^2/s`, up to the first word that is not
//! a unit. A word that may be a unit or the name of a variable is an error.

use super::factor::split_power;
use super::table::{Factor, find_unit};
use super::{Number, split_number, value};
use polhode_ga::formula::{Error, Span};
use std::ops::Range;

/// A quantity's place in bytes, and its value in SI units, rad for angles.
type Found = (Range<usize>, f64);

/// The quantities in a formula, from left to right; `is_name` reports the names of variables.
pub fn quantities(text: &str, is_name: &dyn Fn(&str) -> bool) -> Result<Vec<Found>, Error> {
    let alone = text.trim().trim_start_matches(['-', '\u{2212}']);
    if number_at(alone).is_some_and(|(_, length)| length == alone.len()) {
        let start = text.find(alone).unwrap_or(0);
        check_exponent(alone, &(start..start + alone.len()))?;
    }
    let mut found = Vec::new();
    let mut at = 0;
    let mut before = ' ';
    while let Some(c) = text[at..].chars().next() {
        let number = if continues_word(before) || before == '.' { None } else { number_at(&text[at..]) };
        if let Some((number, length)) = number {
            let quantity = quantity(text, at, at + length, &number, is_name)?;
            at = quantity.as_ref().map_or(at + length, |(place, _)| place.end);
            found.extend(quantity);
            before = ' ';
        } else {
            at += c.len_utf8();
            before = c;
        }
    }
    Ok(found)
}

fn error(place: Range<usize>, message: String) -> Error {
    Error { message, span: Span { start: place.start, end: place.end } }
}

/// The quantity whose number is `text[start..number_end]`.
fn quantity(
    text: &str,
    start: usize,
    number_end: usize,
    number: &Number,
    is_name: &dyn Fn(&str) -> bool,
) -> Result<Option<Found>, Error> {
    let before = text[..start].trim_end().chars().next_back();
    let first = skip_spaces(text, number_end);
    // A number after `^` is a power.
    if unit_at(text, first).is_none() || before == Some('^') {
        return Ok(None);
    }
    let (factor, end) = factor(text, start, first, is_name)?;
    let (written, span) = (&text[start..end], start..end);
    if before == Some('/') {
        let message = format!("`/` before a quantity has two readings; put brackets around `{written}`");
        return Err(error(span, message));
    }
    check_exponent(&text[start..number_end], &span)?;
    match value(written, number, factor) {
        Ok(value) => Ok(Some((span, value))),
        Err(problem) => Err(error(span, problem)),
    }
}

/// The units from `first` on, the number before them beginning at `start`, and where they end.
fn factor(
    text: &str,
    start: usize,
    first: usize,
    is_name: &dyn Fn(&str) -> bool,
) -> Result<(Factor, usize), Error> {
    let (mut factor, mut end) = (Factor::default(), first);
    let mut divided = false;
    let mut next = Some((first, None));
    while let Some((at, operator)) = next {
        let Some((length, unit)) = unit_at(text, at) else { break };
        let (word, after) = (&text[at..at + length], &text[at + length..]);
        let divides = operator == Some('/');
        if divided && operator.is_none() {
            let message = format!(
                "`{word}` may be a unit or a name; for the name write `({}) {word}`, for the unit `{}*{word}`",
                &text[start..end],
                &text[start..end]
            );
            return Err(error(at..at + length, message));
        }
        divided |= divides;
        if is_name(word) || word.chars().all(|c| is_name(c.encode_utf8(&mut [0; 4]))) {
            let name = match at == first {
                true => format!("{}*{word}", text[start..first].trim_end()),
                false => format!("({}) {word}", &text[start..end]),
            };
            let message = format!("`{word}` is a unit and a name here; for the name write `{name}`");
            return Err(error(at..at + length, message));
        }
        let (power, rest) = match begins_power(after).then(|| split_power(after)) {
            None => (1, after),
            Some(Ok(power)) => power,
            Some(Err(problem)) => {
                let message = format!("{problem} after the unit `{word}`");
                return Err(error(at..at + length, message));
            }
        };
        factor.multiply(unit, if divides { -power } else { power });
        end = text.len() - rest.len();
        next = following(text, end);
    }
    Ok((factor, end))
}

/// The place of a next unit, and the operator before it, if any.
fn following(text: &str, end: usize) -> Option<(usize, Option<char>)> {
    let at = skip_spaces(text, end);
    match text[at..].chars().next()? {
        c @ ('*' | '·' | '⋅' | '/') => Some((skip_spaces(text, at + c.len_utf8()), Some(c))),
        // Adjacent letters, as in `90°e1`, are not another unit.
        _ => (at > end).then_some((at, None)),
    }
}

/// The unit at a place, and its length, if the word ends with it: `m`, not `m2` or `m(x)`.
fn unit_at(text: &str, at: usize) -> Option<(usize, Factor)> {
    let rest = &text[at..];
    let length = match rest.starts_with('°') {
        true => '°'.len_utf8(),
        false => rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len()),
    };
    let (word, after) = rest.split_at(length);
    let next = after.chars().next().unwrap_or(' ');
    let ends = word == "°" || begins_power(after) || !(continues_word(next) || next == '(');
    find_unit(word).filter(|_| ends).map(|unit| (length, unit))
}

/// Whether the text begins with a power, not a wedge: `^2`, `**-1`, `²`.
fn begins_power(text: &str) -> bool {
    let written = text.strip_prefix("**").or_else(|| text.strip_prefix('^'));
    match written {
        Some(written) => {
            written.trim_start_matches(['-', '\u{2212}']).starts_with(|c: char| c.is_ascii_digit())
        }
        None => text.starts_with(['⁻', '⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹']),
    }
}

/// The unsigned number at the beginning of the text, and its length.
fn number_at(text: &str) -> Option<(Number, usize)> {
    let (number, rest) =
        split_number(text).filter(|_| text.starts_with(|c: char| c == '.' || c.is_ascii_digit()))?;
    Some((number, text.len() - rest.len()))
}

/// `2e1` is twice a basis vector in a formula, and 20 everywhere else.
fn check_exponent(number: &str, span: &Range<usize>) -> Result<(), Error> {
    let Some((digits, exponent)) = number.split_once('e') else { return Ok(()) };
    if !exponent.chars().all(|c| ('1'..='9').contains(&c)) {
        return Ok(());
    }
    let message = format!(
        "`{number}` has two readings; write `{digits}e+{exponent}` for the number, `{digits} e{exponent}` for the product"
    );
    Err(error(span.clone(), message))
}

/// Whether a character within a word belongs to it: letters, digits, subscripts, primes, combining marks.
fn continues_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '\'' | '′' | '’' | '∥' | '⊥' | '\u{300}'..='\u{36f}')
}

fn skip_spaces(text: &str, at: usize) -> usize {
    text.len() - text[at..].trim_start().len()
}
