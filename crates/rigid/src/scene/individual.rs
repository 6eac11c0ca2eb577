//! Reads `[ensemble]` with the points of bodies, about which they vary at random.

use super::correlated;
use super::ensemble::{self, Ensemble, Nominal};
use super::initial::Initial;
use super::laws::Law;
use super::points::{self, Cursor, Point, Points};
use super::reader::{Reader, Table, Value};
use std::ops::Range;
use std::sync::Arc;

/// Number of errors after which no more points are checked.
const MOST_PROBLEMS: usize = 20;

/// Reads the table of a scene with this text.
pub fn read(
    reader: &mut Reader,
    value: &Value,
    nominal: &Nominal,
    root: &Table,
    text: &str,
    source: &dyn Fn(&str) -> Result<String, String>,
) -> Option<Ensemble> {
    let before = reader.problems.len();
    let table = &reader.table(value, "[ensemble]")?;
    let points = points::read(reader, table, root, source);
    let number = points.as_ref().and_then(|points| Some(points.as_ref()?.number));
    let mut ensemble = random(reader, value, nominal, number)?;
    let points = points?;
    // Each point is read again with the other values of the scene, which must be right.
    if let Some(points) = &points
        && reader.problems.len() == before
    {
        check(reader, value, nominal, points, text);
    }
    ensemble.points = points.map(Arc::new);
    Some(ensemble)
}

/// The number of bodies and the random parameters.
fn random(reader: &mut Reader, value: &Value, nominal: &Nominal, number: Option<usize>) -> Option<Ensemble> {
    let mut ensemble = ensemble::read(reader, value, nominal, number)?;
    if let Some(covariance) = value.get_ref().as_table().and_then(|table| table.get("covariance")) {
        correlated::read(reader, covariance, nominal, &mut ensemble)?;
    }
    Some(ensemble)
}

/// Reports the errors of all points, each once.
fn check(reader: &mut Reader, value: &Value, nominal: &Nominal, points: &Points, text: &str) {
    let before = reader.problems.len();
    let (Some(initial), Some(laws)) = (nominal.initial, nominal.laws) else { return };
    let is_given = |name: &str| matches!(name, "number" | "seed" | "keep") || points::FIELDS.contains(&name);
    let fields = value.get_ref().as_table();
    let random = fields.is_some_and(|table| table.keys().any(|key| !is_given(key.get_ref())));
    let mut cursor = Cursor::new(points, text);
    for point in 0..points.number {
        let found = match cursor.read(point) {
            Err(problems) => problems,
            Ok(_) if !random => continue,
            Ok(own) => problems(value, nominal, points.number, (&initial, laws), own, || {
                points.describe(text, point)
            }),
        };
        for problem in found {
            // A value of a grid has the same error at many points.
            if !reader.problems[before..].contains(&problem) {
                reader.problems.push(problem);
            }
        }
        if reader.problems.len() > before + MOST_PROBLEMS {
            return;
        }
    }
}

/// Errors of the random parameters about a point.
fn problems(
    value: &Value,
    nominal: &Nominal,
    number: usize,
    (initial, laws): (&Initial, &[Law]),
    point: Point,
    place: impl Fn() -> String,
) -> Vec<(Range<usize>, String)> {
    let own = |law: &Law| point.laws.iter().find(|own| own.name == law.name).unwrap_or(law).clone();
    let laws: Vec<Law> = laws.iter().map(own).collect();
    let around = Nominal {
        initial: Some(point.initial.unwrap_or(*initial)),
        gravity: point.gravity.map(Some).or(nominal.gravity),
        laws: Some(&laws),
    };
    let mut reader = Reader::default();
    random(&mut reader, value, &around, Some(number));
    reader.problems.into_iter().map(|(span, message)| (span, format!("{message} ({})", place()))).collect()
}
