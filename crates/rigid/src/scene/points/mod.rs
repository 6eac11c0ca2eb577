//! The points of an ensemble: values of the scene that a grid, lists or a table replace.
//!
//! ```toml
//! [ensemble]
//! grid.torque.damping = ["0.1 /s", 0.2]                  # each with each; the last varies fastest
//! grid.initial.spin.rate = { from = "1 rev/s", to = "5 rev/s", number = 9 }
//! # list.body.moments = [[3, 2, 1], [4, 3, 2]]           # lists of equal length, side by side
//! # table = "bodies.csv"                                 # a header line of paths, then a line for each point
//! ```
//!
//! Body i has point i modulo the number of points. Its values replace those of the scene, whose tables are then read
//! again by the same reader.

mod bodies;
mod csv;
mod cursor;
mod path;
mod place;
mod values;

#[cfg(test)]
mod tests;

use super::reader::{Reader, Table, Value};
use crate::units;
pub use cursor::{Cursor, Point};
use path::Path;
use polhode_ga::diagnostic::quote;
use std::ops::Range;
use std::sync::OnceLock;
use toml::de::DeValue;
use values::{MOST_POINTS, MOST_TEXT, Values};

/// Reads the text of a table of points by its path; relative paths start at the folder of the scene.
pub type TableSource<'a> = &'a dyn Fn(&std::path::Path) -> Result<String, String>;

/// The fields of `[ensemble]` that give points.
pub const FIELDS: [&str; 3] = ["grid", "list", "table"];

/// Values of a scene, for each of its points.
#[derive(Clone, Debug)]
pub struct Points {
    /// `grid`, `list` or `table`.
    pub form: &'static str,
    /// Number of points.
    pub number: usize,
    /// The path of the table, as in the scene.
    pub file: Option<String>,
    columns: Vec<Column>,
    /// Lines of the table, by rows.
    lines: Vec<u32>,
    /// The place of the field in the scene.
    span: Range<usize>,
}

/// A value of the scene that the points replace.
#[derive(Clone, Debug)]
struct Column {
    path: Path,
    values: Values,
    /// The place of its name in the scene.
    span: Range<usize>,
    /// Number of successive points that share a value.
    stride: usize,
    /// Number of numbers of a value and their unit, if all values are numbers.
    kind: OnceLock<Option<(usize, &'static str)>>,
}

impl Column {
    fn new(path: Path, values: Values, span: Range<usize>) -> Column {
        Column { path, values, span, stride: 1, kind: OnceLock::new() }
    }

    /// Number of numbers of a value and their unit, if all values are numbers; in a scene with this text.
    fn kind(&self, scene: &str) -> Option<(usize, &'static str)> {
        let texts = (0..self.values.len()).map(|index| self.values.text(index, scene));
        *self.kind.get_or_init(|| numbers(texts).map(|(_, size, unit)| (size, unit)))
    }

    /// The index of the value at a point.
    fn at(&self, point: usize) -> usize {
        point / self.stride % self.values.len()
    }
}

/// The values of a column at some points, in SI units where they are quantities.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// Rows of numbers of this size, and their unit if the scene has it.
    Numbers(Vec<f64>, usize, &'static str),
    /// Other values: the content of strings, such as formulas, and others as text of TOML.
    Texts(Vec<String>),
}

/// Bodies of equal ensembles need not be the same: their laws have no equality.
impl PartialEq for Points {
    fn eq(&self, other: &Points) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Points {
    /// The paths of the replaced values, each with its number of values.
    pub fn paths(&self) -> impl Iterator<Item = (String, usize)> {
        self.columns.iter().map(|column| (column.path.to_string(), column.values.len()))
    }

    /// Whether a value at one of these dotted places is replaced, or one in it.
    pub fn vary(&self, places: &[&str]) -> bool {
        let is_within = |column: &Column, place: &&str| {
            Path::default()
                .join(place)
                .is_some_and(|place| column.path.is_within(&place) || place.is_within(&column.path))
        };
        self.columns.iter().any(|column| places.iter().any(|place| is_within(column, place)))
    }

    /// The values of each column at some points of the scene with this text.
    pub fn given(&self, scene: &str, points: impl Iterator<Item = usize> + Clone) -> Vec<(String, Given)> {
        let given = |column: &Column| {
            let texts = points.clone().map(|point| column.values.text(column.at(point), scene));
            let all = column.kind(scene).and_then(|kind| Some((numbers(texts.clone())?.0, kind)));
            let values = match all {
                Some((numbers, (size, unit))) => Given::Numbers(numbers, size, unit),
                None => Given::Texts(texts.map(plain).collect()),
            };
            (column.path.to_string(), values)
        };
        self.columns.iter().map(given).collect()
    }

    /// A point in words, for errors.
    pub fn describe(&self, scene: &str, point: usize) -> String {
        if let Some(line) = self.lines.get(point) {
            return place::row(self.file.as_deref().unwrap_or_default(), *line);
        }
        let value = |column: &Column| {
            let text: String = column.values.text(column.at(point), scene).chars().take(40).collect();
            format!("{} = {text}", column.path)
        };
        let values: Vec<String> = self.columns.iter().take(4).map(value).collect();
        format!("point {point}, {}", values.join(", "))
    }
}

/// The content of a string of TOML; other values as they are.
fn plain(text: &str) -> String {
    match DeValue::parse(text).map(|value| value.into_inner()) {
        Ok(DeValue::String(content)) => content.into_owned(),
        _ => text.to_owned(),
    }
}

/// Numbers with one unit, or arrays of them, in SI units.
fn numbers<'t>(texts: impl Iterator<Item = &'t str>) -> Option<(Vec<f64>, usize, &'static str)> {
    let (mut all, mut size, mut unit) = (Vec::new(), 0, "");
    for text in texts {
        let before = all.len();
        let value = DeValue::parse(text).ok()?;
        let mut add = |value: &Value| {
            let (number, own) = match value.get_ref() {
                DeValue::Integer(x) if x.radix() == 10 => (x.as_str().parse().ok()?, ""),
                DeValue::Float(x) => (x.as_str().parse().ok()?, ""),
                DeValue::String(text) => units::si(text)?,
                _ => return None,
            };
            if !own.is_empty() && !unit.is_empty() && own != unit {
                return None;
            }
            unit = if own.is_empty() { unit } else { own };
            all.push(number);
            Some(())
        };
        match value.get_ref() {
            DeValue::Array(items) => items.iter().try_for_each(add)?,
            _ => add(&value)?,
        }
        let own = all.len() - before;
        if own == 0 || (before > 0 && own != size) {
            return None;
        }
        size = own;
    }
    Some((all, size, unit))
}

/// Reads the points of the table `[ensemble]` of a scene, if it has any.
pub fn read(
    reader: &mut Reader,
    table: &Table,
    root: &Table,
    source: &dyn Fn(&str) -> Result<String, String>,
) -> Option<Option<Points>> {
    let Some(form) = reader.at_most_one(table, &FIELDS) else { return Some(None) };
    let value = table.get(form)?;
    let mut lines = Vec::new();
    // The place of the names of a table; in a grid or list each name has its own.
    let (mut file, mut header) = (None, String::new());
    let mut columns = match form {
        "table" => {
            let name = reader.string(value)?;
            let read = source(name).and_then(|text| csv::read(name, &text));
            let found = read.map_err(|why| reader.report(value.span(), why)).ok()?;
            header = place::header(name, found.header);
            (file, lines) = (Some(name.to_owned()), found.lines);
            named(reader, value, &header, found.columns)?
        }
        _ => {
            let mut columns = Vec::new();
            let fields = reader.table(value, format!("`{form}`"))?;
            walk(reader, &fields, &Path::default(), &mut columns)?;
            columns.sort_by_key(|column| column.span.start);
            columns
        }
    };
    let before = reader.problems.len();
    for (index, column) in columns.iter().enumerate() {
        if let Err(why) = place::replaceable(root.fields, &column.path) {
            let remedy = if file.is_some() { place::remedy(column.path.field(0)) } else { "" };
            reader.report(column.span.clone(), format!("{header}{why}{remedy}"));
            continue;
        }
        let same = |other: &&Column| column.path.is_within(&other.path) || other.path.is_within(&column.path);
        if let Some(other) = columns[..index].iter().find(same) {
            let message = format!("{header}`{}` is given twice, as `{}` too", column.path, other.path);
            reader.report(column.span.clone(), message);
        }
    }
    let number = if form == "grid" { product(&mut columns) } else { length(reader, &columns) };
    if number.is_none_or(|number| number > MOST_POINTS) && reader.problems.len() == before {
        reader.report(value.span(), format!("has more than {MOST_POINTS} points"));
    }
    let points = Points { form, number: number?, file, columns, lines, span: value.span() };
    (reader.problems.len() == before).then_some(Some(points))
}

/// Sets the strides of a grid, whose last column varies fastest, and returns its number of points.
fn product(columns: &mut [Column]) -> Option<usize> {
    columns.iter_mut().rev().try_fold(1_usize, |stride, column| {
        column.stride = stride;
        stride.checked_mul(column.values.len())
    })
}

/// The common length of the columns.
fn length(reader: &mut Reader, columns: &[Column]) -> Option<usize> {
    let first = columns.first()?;
    let number = first.values.len();
    for other in columns.iter().filter(|column| column.values.len() != number) {
        let (a, b) = (&first.path, other.values.len());
        let message = format!("has {b} values, but `{a}` has {number}; lists must have equal lengths");
        reader.report(other.span.clone(), message);
    }
    Some(number)
}

/// The columns of a table by the paths in its header, whose place is given.
fn named(
    reader: &mut Reader,
    value: &Value,
    header: &str,
    columns: Vec<(String, Values)>,
) -> Option<Vec<Column>> {
    let column = |(index, (name, values)): (usize, (String, Values))| match Path::default().join(&name) {
        Some(path) => Some(Column::new(path, values, value.span())),
        None => {
            let why =
                if name.is_empty() { format!("column {} has no name", index + 1) } else { unreadable(&name) };
            reader.report(value.span(), format!("{header}{why}{}", place::remedy(&name)));
            None
        }
    };
    let columns: Vec<Option<Column>> = columns.into_iter().enumerate().map(column).collect();
    columns.into_iter().collect()
}

fn unreadable(name: &str) -> String {
    format!("expected the path of a scene value such as `initial.spin.vector[0]`, found {}", quote(name))
}

/// The columns of a table of the scene: arrays and ranges, at the paths of its fields.
fn walk(reader: &mut Reader, table: &Table, above: &Path, columns: &mut Vec<Column>) -> Option<()> {
    if table.fields.is_empty() {
        reader.report(
            table.span.clone(),
            "no values; write lists at the paths of scene values, such as `initial.spin.rate = [1, 2]`",
        );
        return None;
    }
    let mut complete = Some(());
    for (key, value) in table.fields.iter() {
        let Some(path) = above.join(key.get_ref()) else {
            reader.report(key.span(), unreadable(key.get_ref()));
            complete = None;
            continue;
        };
        let values = match value.get_ref() {
            DeValue::Array(items) if items.is_empty() => {
                reader.report(value.span(), "no values; write at least one");
                None
            }
            DeValue::Array(items) => Some(Values::items(items)),
            DeValue::Table(fields) if fields.contains_key("from") || fields.contains_key("to") => {
                let held: usize = columns.iter().map(|column| column.values.size()).sum();
                values::range(reader, value, MOST_TEXT.saturating_sub(held))
            }
            DeValue::Table(fields) => {
                let inner = Table { title: "the table".into(), span: value.span(), fields };
                complete = complete.and(walk(reader, &inner, &path, columns));
                continue;
            }
            _ => {
                reader.wrong_type(value, "an array of values, or a range `{ from = a, to = b, number = n }`");
                None
            }
        };
        match values {
            Some(values) => columns.push(Column::new(path, values, key.span())),
            None => complete = None,
        }
    }
    complete
}
