//! Quantities within a formula: `exp(-45 deg e1∧e2)`, `5 rev/s e1∧e2`.
//!
//! A quantity in a formula is a number directly followed by units, as in `5 kg m^2/s`, up to the first word that is not
//! a unit. A word that may be a unit or the name of a variable is an error.

use super::factor::{Factor, Problem, split_power};
use super::table::{Unit, find_unit};
use super::{split_number, value};
use polhode_ga::formula::{Error, Span};
use std::ops::Range;

/// A quantity's place in bytes, and its value in SI units, rad for angles.
type Found = (Range<usize>, f64);

/// The quantities in a formula, from left to right; `is_name` reports the names of variables.
pub fn quantities(text: &str, is_name: &dyn Fn(&str) -> bool) -> Result<Vec<Found>, Error> {
    let alone = text.trim().trim_start_matches(['-', '\u{2212}']);
    if begins_number(alone) && number_length(alone) == alone.len() {
        let start = text.find(alone).unwrap_or(0);
        check_exponent(alone, &(start..start + alone.len()))?;
    }
    let mut found = Vec::new();
    let mut at = 0;
    let mut before = ' ';
    while let Some(c) = text[at..].chars().next() {
        if begins_number(&text[at..]) && !continues_word(before) && before != '.' {
            let end = at + number_length(&text[at..]);
            match quantity(text, at, end, is_name)? {
                Some(quantity) => {
                    at = quantity.0.end;
                    found.push(quantity);
                }
                None => at = end,
            }
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
    is_name: &dyn Fn(&str) -> bool,
) -> Result<Option<Found>, Error> {
    let before = text[..start].trim_end().chars().next_back();
    let first = skip_spaces(text, number_end);
    // A number after `^` is a power.
    if unit_at(text, first).is_none() || before == Some('^') {
        return Ok(None);
    }
    let (factor, end) = factor(text, start, first, is_name)?;
    let (number, written, span) = (&text[start..number_end], &text[start..end], start..end);
    if before == Some('/') {
        let message = format!("`/` before a quantity has two readings; put brackets around `{written}`");
        return Err(error(span, message));
    }
    check_exponent(number, &span)?;
    let Some((number, _)) = split_number(number) else { return Ok(None) };
    match value(written, &number, factor) {
        Ok(value) => Ok(Some((span, value))),
        Err(problem) => Err(error(span, problem.to_string())),
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
            Some(Err(Problem::Syntax(problem) | Problem::UnknownUnit(problem))) => {
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
fn unit_at(text: &str, at: usize) -> Option<(usize, Unit)> {
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

fn begins_number(text: &str) -> bool {
    text.strip_prefix('.').unwrap_or(text).starts_with(|c: char| c.is_ascii_digit())
}

fn number_length(text: &str) -> usize {
    let digits =
        |from: usize| from + text[from..].find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len() - from);
    let mut end = digits(0);
    if text[end..].starts_with('.') {
        end = digits(end + 1);
    }
    if let Some(exponent) = text[end..].strip_prefix(['e', 'E']) {
        let unsigned = exponent.strip_prefix(['+', '-', '\u{2212}']).unwrap_or(exponent);
        if unsigned.starts_with(|c: char| c.is_ascii_digit()) {
            end = digits(text.len() - unsigned.len());
        }
    }
    end
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
