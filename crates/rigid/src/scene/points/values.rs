//! Lists of scene values as text of TOML: written one by one, as a range, or as the cells of a table.

use crate::scene::reader::{Reader, Value};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeValue};

/// Maximum number of points.
pub const MOST_POINTS: usize = 100_000_000;
/// Maximum number of bytes of values that the scene does not have.
pub const MOST_TEXT: usize = u32::MAX as usize;
/// Bytes of a number in a range, with quotes and a space.
const LONGEST_NUMBER: usize = 28;

/// The values of a column.
#[derive(Clone, Debug)]
pub struct Values {
    /// Text of values that the scene does not have; None for the text of the scene.
    own: Option<String>,
    /// Bytes of the values in the text.
    places: Vec<[u32; 2]>,
}

impl Values {
    /// Items of an array of the scene.
    pub fn items(items: &[Value]) -> Values {
        let places = items.iter().map(|item| [item.span().start as u32, item.span().end as u32]);
        Values { own: None, places: places.collect() }
    }

    /// No values, to be pushed.
    pub fn new() -> Values {
        Values { own: Some(String::new()), places: Vec::new() }
    }

    /// Adds a value. False if there is too much text.
    pub fn push(&mut self, value: &str) -> bool {
        let text = self.own.get_or_insert_default();
        let start = text.len();
        text.push_str(value);
        let (Ok(start), Ok(end)) = (u32::try_from(start), u32::try_from(text.len())) else { return false };
        self.places.push([start, end]);
        true
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Number of bytes of values that the scene does not have.
    pub fn size(&self) -> usize {
        self.own.as_ref().map_or(0, String::len)
    }

    /// Whether a place in the scene is in one of the values.
    pub fn hold(&self, span: &Range<usize>) -> bool {
        let holds = |[start, end]: &[u32; 2]| *start as usize <= span.start && span.end <= *end as usize;
        self.own.is_none() && self.places.iter().any(holds)
    }

    /// The text of a value in a scene with this text.
    pub fn text<'t>(&'t self, index: usize, scene: &'t str) -> &'t str {
        let [start, end] = self.places[index].map(|at| at as usize);
        &self.own.as_deref().unwrap_or(scene)[start..end]
    }

    /// The value. Its places are those in the scene if it has it, else `span`.
    pub fn get<'t>(&'t self, index: usize, scene: &'t str, span: &Range<usize>) -> Option<Value<'t>> {
        let value = DeValue::parse(self.text(index, scene)).ok()?;
        let start = self.places[index][0] as usize;
        Some(match self.own {
            Some(_) => placed(value, &|_| span.clone()),
            None => placed(value, &|at| start + at.start..start + at.end),
        })
    }
}

/// The value with other places of itself and of its parts.
fn placed<'t>(value: Value<'t>, place: &impl Fn(Range<usize>) -> Range<usize>) -> Value<'t> {
    let span = place(value.span());
    let value = match value.into_inner() {
        DeValue::Array(items) => {
            let mut moved = DeArray::new();
            items.into_iter().for_each(|item| moved.push(placed(item, place)));
            DeValue::Array(moved)
        }
        DeValue::Table(fields) => {
            let fields = fields.into_iter();
            let moved = fields
                .map(|(key, item)| (Spanned::new(place(key.span()), key.into_inner()), placed(item, place)));
            DeValue::Table(moved.collect())
        }
        other => other,
    };
    Spanned::new(span, value)
}

/// A number as text of TOML.
pub fn number(x: f64) -> String {
    match x {
        _ if x.is_nan() => "nan".to_owned(),
        _ if x.is_infinite() => format!("{x}"),
        _ => format!("{x:e}"),
    }
}

/// A string as text of TOML.
pub fn string(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", c as u32)),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// The values of `{ from = a, to = b, number = n }`, in equal steps, or with `spacing = "log"` in equal ratios; at most
/// `most` bytes of text.
pub fn range(reader: &mut Reader, value: &Value, most: usize) -> Option<Values> {
    let table = &reader.table(value, "of a range")?;
    reader.only(table, &["from", "to", "number", "spacing"]);
    let from = reader.field(table, "from", end);
    let to = reader.field(table, "to", end);
    let count = reader.field(table, "number", |reader, value| {
        let count = reader.integer(value)?;
        match usize::try_from(count) {
            Ok(count) if (2..=MOST_POINTS).contains(&count) => Some(count),
            _ => {
                reader.report(value.span(), format!("must be from 2 to {MOST_POINTS}, found {count}"));
                None
            }
        }
    });
    let spacing =
        reader.optional(table, "spacing", |reader, value| reader.word(value, "spacing", &["linear", "log"]));
    let ((a, unit), (b, last), count, log) = (from?, to?, count?, spacing? == Some("log"));
    if unit != last {
        let message = format!("`from` and `to` must have the same unit, found `{unit}` and `{last}`");
        reader.report(value.span(), message);
        return None;
    }
    if log && a * b <= 0.0 {
        let message = format!("equal ratios need two numbers of one sign and not 0, found {a} and {b}");
        reader.report(value.span(), message);
        return None;
    }
    if count.saturating_mul(LONGEST_NUMBER + unit.len()) > most {
        reader.report(value.span(), "the values have more than 4 GB of text, give fewer or a shorter unit");
        return None;
    }
    let mut values = Values::new();
    for k in 0..count {
        let part = k as f64 / (count - 1) as f64;
        let x = match k {
            0 => a,
            _ if k == count - 1 => b,
            _ if log => a * (b / a).powf(part),
            _ => a * (1.0 - part) + b * part,
        };
        values.push(&if unit.is_empty() { number(x) } else { string(&format!("{x:e} {unit}")) });
    }
    Some(values)
}

/// An end of a range: its number, and its unit as text.
fn end(reader: &mut Reader, value: &Value) -> Option<(f64, String)> {
    let DeValue::String(text) = value.get_ref() else { return Some((reader.number(value)?, String::new())) };
    let text = text.trim();
    let unit =
        text.find(|c: char| c.is_whitespace() || (c.is_alphabetic() && c != 'e' && c != 'E') || c == '°');
    let (number, unit) = text.split_at(unit.unwrap_or(text.len()));
    match number.parse::<f64>() {
        Ok(number) if number.is_finite() => Some((number, unit.trim().to_owned())),
        _ => {
            reader.report(value.span(), "expected a number, or a string of a number, a space and a unit");
            None
        }
    }
}
