//! Reads the points of a scene one after the other.

use super::Points;
use crate::laws::force::Push;
use crate::scene::body::BodySpec;
use crate::scene::initial::Initial;
use crate::scene::laws::Law;
use crate::scene::reader::{Reader, Table};
use crate::scene::{Gravity, parts};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The tables of the scene that a point changes, read again.
#[derive(Debug)]
pub struct Point {
    pub body: Option<BodySpec>,
    pub initial: Option<Initial>,
    pub gravity: Option<Gravity>,
    /// Laws that the point changes.
    pub laws: Vec<Law>,
    /// Forces that the point changes.
    pub forces: Vec<Push>,
}

/// A parsed scene whose values are replaced.
pub struct Cursor<'s> {
    points: &'s Points,
    scene: &'s str,
    root: DeTable<'s>,
    reader: Reader,
    /// Whether the names of formulas differ between points.
    defines: bool,
    /// Indices of the values of all columns in `root`.
    at: Vec<Option<usize>>,
}

impl<'s> Cursor<'s> {
    /// For a scene with this text, from which the points have been read.
    pub fn new(points: &'s Points, scene: &'s str) -> Cursor<'s> {
        let mut root = DeTable::parse(scene).map_or_else(|_| DeTable::new(), |root| root.into_inner());
        let defines = points.vary(&["define"]);
        if !defines {
            // Only the tables, and the laws and forces, that points change.
            let kept = root
                .into_iter()
                .filter(|(key, _)| key.get_ref() == "define" || points.vary(&[key.get_ref()]));
            root = kept.collect();
            for table in ["torque", "force"] {
                if let Some(DeValue::Table(laws)) = root.get_mut(table).map(Spanned::get_mut) {
                    let varies = |law: &str| points.vary(&[&format!("{table}.{law}")]);
                    *laws =
                        std::mem::take(laws).into_iter().filter(|(law, _)| varies(law.get_ref())).collect();
                }
            }
        }
        let mut reader = Reader::default();
        parts::define(&mut reader, &whole(&root));
        reader.problems.clear();
        Cursor { points, scene, root, reader, defines, at: vec![None; points.columns.len()] }
    }

    /// The point, or the errors with their places in the scene; those in values of a table have its line and column.
    pub fn read(&mut self, point: usize) -> Result<Point, Vec<(Range<usize>, String)>> {
        let points = self.points;
        // Places beyond the text stand for the columns of a table.
        let beyond = self.scene.len() + 1;
        for (index, column) in points.columns.iter().enumerate() {
            let value = column.at(point);
            if self.at[index] == Some(value) {
                continue;
            }
            let span =
                if points.file.is_some() { beyond + index..beyond + index } else { column.span.clone() };
            let is_set = column
                .values
                .get(value, self.scene, &span)
                .is_some_and(|value| column.path.set(&mut self.root, value));
            if !is_set {
                return Err(vec![(
                    column.span.clone(),
                    format!("the scene has no place for `{}`", column.path),
                )]);
            }
            self.at[index] = Some(value);
        }
        let root = whole(&self.root);
        if self.defines {
            self.reader = Reader::default();
            parts::define(&mut self.reader, &root);
        }
        let found = parts::read(&mut self.reader, &root);
        let problems = std::mem::take(&mut self.reader.problems);
        if problems.is_empty()
            && let (Some(body), Some(initial), Some(gravity)) = (found.body, found.initial, found.gravity)
            && let (Some(laws), Some(forces)) = (found.laws, found.forces)
        {
            return Ok(Point { body, initial, gravity, laws, forces: forces.unwrap_or_default() });
        }
        let placed = |(span, message): (Range<usize>, String)| match span.start.checked_sub(beyond) {
            Some(column) => {
                let path = &points.columns[column].path;
                let place = points.describe(self.scene, point);
                (points.span.clone(), format!("{place}, column `{path}`: {message}"))
            }
            // A value in the list or grid is its own place.
            None if points.columns.iter().any(|column| column.values.hold(&span)) => (span, message),
            None => (span, format!("{message} ({})", points.describe(self.scene, point))),
        };
        Err(problems.into_iter().map(placed).collect())
    }
}

fn whole<'t>(root: &'t DeTable<'t>) -> Table<'t> {
    Table { title: "the file".into(), span: 0..0, fields: root }
}
