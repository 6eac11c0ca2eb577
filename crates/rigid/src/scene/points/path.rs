//! Paths of scene values: `initial.spin.vector[0]`.

use crate::scene::reader::Value;
use std::fmt;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Into the field of a table.
    Field(String),
    /// Into the item of an array.
    Item(usize),
}

/// The place of a value below the tables of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Path(pub Vec<Step>);

impl Path {
    /// The path with the steps of a dotted text; None if it is not one.
    pub fn join(&self, text: &str) -> Option<Path> {
        let mut steps = self.0.clone();
        for part in text.split('.') {
            let (name, items) = part.split_at(part.find('[').unwrap_or(part.len()));
            if name.trim().is_empty() {
                return None;
            }
            steps.push(Step::Field(name.trim().to_owned()));
            let mut rest = items.trim_end();
            while !rest.is_empty() {
                let (index, after) = rest.strip_prefix('[')?.split_once(']')?;
                steps.push(Step::Item(index.trim().parse().ok()?));
                rest = after;
            }
        }
        Some(Path(steps))
    }

    /// The field at a depth, from 0; empty if there is none.
    pub fn field(&self, depth: usize) -> &str {
        match self.0.get(depth) {
            Some(Step::Field(name)) => name,
            _ => "",
        }
    }

    /// Whether the path is that of the other, or leads to a value in it.
    pub fn is_within(&self, other: &Path) -> bool {
        self.0.starts_with(&other.0)
    }

    /// The value in a table.
    pub fn find<'t, 'v>(&self, root: &'t DeTable<'v>) -> Option<&'t Value<'v>> {
        let (Step::Field(first), rest) = self.0.split_first()? else { return None };
        rest.iter().try_fold(root.get(first.as_str())?, |value, step| match step {
            Step::Field(name) => value.get_ref().as_table()?.get(name.as_str()),
            Step::Item(index) => value.get_ref().as_array()?.get(*index),
        })
    }

    /// Replaces the value in a table, or adds it as a new field. False if there is no place for it.
    pub fn set<'v>(&self, root: &mut DeTable<'v>, value: Value<'v>) -> bool {
        let Some((last, parents)) = self.0.split_last() else { return false };
        let Some((Step::Field(first), parents)) = parents.split_first() else { return false };
        let mut at = root.get_mut(first.as_str());
        for step in parents {
            at = at.and_then(|value| within(value, step));
        }
        let Some(parent) = at else { return false };
        if let Some(slot) = within(parent, last) {
            *slot = value;
            return true;
        }
        match (parent.get_mut(), last) {
            (DeValue::Table(fields), Step::Field(name)) => {
                fields.insert(Spanned::new(value.span(), name.clone().into()), value);
                true
            }
            _ => false,
        }
    }
}

fn within<'t, 'v>(value: &'t mut Value<'v>, step: &Step) -> Option<&'t mut Value<'v>> {
    match (value.get_mut(), step) {
        (DeValue::Table(fields), Step::Field(name)) => fields.get_mut(name.as_str()),
        (DeValue::Array(items), Step::Item(index)) => items.get_mut(*index),
        _ => None,
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (depth, step) in self.0.iter().enumerate() {
            match step {
                Step::Field(name) if depth == 0 => f.write_str(name)?,
                Step::Field(name) => write!(f, ".{name}")?,
                Step::Item(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}
