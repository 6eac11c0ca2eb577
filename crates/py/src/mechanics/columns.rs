//! Arguments of laws: numbers shared by all bodies, or a row for each body of a batch.

use super::law_value::{Known, Values, formula};
use crate::algebra::value::{self, Operand};
use crate::support::arrays::{Rows, bad, numbers, place};
use crate::support::python_objects::BATCH;
use numpy::PyUntypedArrayMethods;
use polhode_ga::formula::{Given, Input, canonical};
use polhode_ga::product::Grades;
use polhode_ga::{Graded, Vector};
use polhode_rigid::ensemble;
use polhode_rigid::error::TorqueError;
use polhode_rigid::laws::formula::{Formula, Purpose};
use polhode_rigid::laws::registry::Entry;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::borrow::Cow;
use std::convert::Infallible;
use std::fmt::Display;

/// Values of `polhode._mechanics.parameters.Batch`: a row for each body.
pub(crate) struct Batch<'py> {
    whole: Bound<'py, PyAny>,
    rows: Rows<'py>,
}

impl<'py> Batch<'py> {
    /// The value as a batch, if it is one.
    pub fn of(value: &Bound<'py, PyAny>) -> PyResult<Option<Batch<'py>>> {
        if !BATCH.is_class_of(value)? {
            return Ok(None);
        }
        Ok(Some(Batch { whole: value.clone(), rows: value.getattr("rows")?.extract()? }))
    }

    fn shape(&self) -> &[usize] {
        self.rows.shape().split_last().map_or(&[][..], |(_, batch)| batch)
    }

    /// A single value of its kind.
    pub fn like(&self) -> PyResult<Bound<'py, PyAny>> {
        self.whole.getattr("like")
    }

    /// The rows, as values of the kind of a single one.
    pub fn graded(&self, like: &Bound<'py, PyAny>) -> PyResult<Vec<Graded>> {
        let grades = match value::operand(like) {
            Operand::Value(value, _) => value.grades(),
            _ => Grades::SCALAR,
        };
        let size = self.rows.shape().last().copied().unwrap_or(0).max(1);
        let graded = |row| Graded::new(row, grades).ok_or_else(|| bad("rows of other grades"));
        numbers(&self.rows)?.chunks_exact(size).map(graded).collect()
    }
}

/// Rows of numbers: one for all bodies, or one for each.
pub(crate) struct Column {
    numbers: Vec<f64>,
    size: usize,
}

impl Column {
    /// The numbers of a body.
    pub fn of(&self, body: usize) -> &[f64] {
        let first = if self.numbers.len() == self.size { 0 } else { body * self.size };
        &self.numbers[first..first + self.size]
    }

    /// The three numbers of a body.
    pub fn vector(&self, body: usize) -> Vector {
        Vector(self.of(body).try_into().unwrap_or([f64::NAN; 3]))
    }
}

/// The arguments of a law. All batches have the same shape.
pub(crate) struct Arguments<'a, 'py> {
    pub all: &'a Bound<'py, PyTuple>,
    /// Shape of the batch of bodies.
    pub shape: Vec<usize>,
}

impl<'a, 'py> Arguments<'a, 'py> {
    /// The arguments, and the values of the names of a formula.
    pub fn new(all: &'a Bound<'py, PyTuple>, values: &Values<'py>) -> PyResult<Arguments<'a, 'py>> {
        for argument in all.iter().chain(values.iter().map(|(_, value)| value.clone())) {
            if let Some(batch) = Batch::of(&argument)? {
                return Ok(Arguments { all, shape: batch.shape().to_vec() });
            }
        }
        Ok(Arguments { all, shape: Vec::new() })
    }

    /// The numbers of an argument, `size` for each body.
    pub fn column(&self, which: usize, size: usize) -> PyResult<Column> {
        let argument = self.all.get_item(which)?;
        let numbers = match Batch::of(&argument)? {
            Some(batch) if batch.shape() == self.shape && batch.rows.shape().last() == Some(&size) => {
                numbers(&batch.rows)?.to_vec()
            }
            Some(batch) => {
                return Err(bad(format!("rows of shape {:?} do not fit the law", batch.rows.shape())));
            }
            None if size == 1 => vec![argument.extract()?],
            None => argument.extract()?,
        };
        if numbers.len() % size != 0 || numbers.is_empty() && !self.shape.contains(&0) {
            return Err(bad(format!("expected {size} numbers, got {}", numbers.len())));
        }
        Ok(Column { numbers, size })
    }

    /// A law for each body, or one; an error names the body.
    pub fn each<T, E: Display>(&self, law: impl Fn(usize) -> Result<T, E>) -> PyResult<Vec<T>> {
        let count = self.shape.iter().product();
        let failed = |body, error| bad(format!("{}{error}", place(body, &self.shape)));
        (0..count).map(|body| law(body).map_err(|error| failed(body, error))).collect()
    }

    /// The laws that `build` makes from the numbers of the first arguments of an entry of the registry.
    pub fn registered<E, T>(
        &self,
        entry: &Entry<E>,
        build: impl Fn(&[f64]) -> Result<T, TorqueError>,
    ) -> PyResult<Vec<T>> {
        let columns = entry.arguments.iter().take(self.all.len()).enumerate();
        let columns: Vec<Column> =
            columns.map(|(k, argument)| self.column(k, argument.shape.size())).collect::<PyResult<_>>()?;
        self.each(|body| {
            let numbers: Vec<f64> = columns.iter().flat_map(|column| column.of(body)).copied().collect();
            entry.check(&numbers)?;
            build(&numbers)
        })
    }

    /// A formula, compiled once, with the values of each body.
    pub fn formulas(&self, text: &str, purpose: Purpose, values: Values<'py>) -> PyResult<Vec<Formula>> {
        let (mut first, mut own) = (Values::with_capacity(values.len()), Vec::new());
        for (name, value) in values {
            let Some(batch) = Batch::of(&value)? else {
                first.push((name, value));
                continue;
            };
            let like = batch.like()?;
            own.push((canonical(&name).unwrap_or_else(|| name.clone()), batch.graded(&like)?));
            first.push((name, like));
        }
        let compile = |names, value: &mut Known<'_>| Formula::new(text, purpose, names, value);
        let law = formula(self.all.py(), text, &first, compile)?;
        self.each(|body| {
            let rows = |input: &Input| own.iter().find(|(name, _)| *name == input.name);
            let value = |input: &Input| rows(input).map(|(_, rows)| Given::Value(rows[body]));
            Ok::<_, Infallible>(law.with_values(value))
        })
    }
}

/// A law for all bodies, or one for each body of a batch.
pub(crate) struct Laws<T> {
    pub rows: Vec<T>,
    /// Shape of the batch.
    pub shape: Vec<usize>,
}

impl<T: Clone> Laws<T> {
    /// The law of a single body.
    pub fn single(&self) -> PyResult<&T> {
        match (&self.rows[..], &self.shape[..]) {
            ([law], []) => Ok(law),
            _ => {
                Err(bad(format!("expected the law of a single body, got a batch of shape {:?}", self.shape)))
            }
        }
    }

    /// The laws of the bodies of a batch.
    pub fn of_bodies(&self, shape: &[usize]) -> PyResult<ensemble::Rows<T>> {
        Ok(ensemble::Rows::new(spread(&self.rows, &self.shape, shape)?.into_owned()))
    }
}

/// Broadcasts values to the shape of a batch; a single value stays single.
pub(crate) fn spread<'a, T: Clone>(
    own: impl Into<Cow<'a, [T]>>,
    own_shape: &[usize],
    shape: &[usize],
) -> PyResult<Cow<'a, [T]>> {
    let own = own.into();
    if own.len() == 1 || own_shape == shape {
        return Ok(own);
    }
    let mut axes = own_shape.iter().rev().zip(shape.iter().rev());
    if own_shape.len() > shape.len() || !axes.all(|(&own, &all)| own == 1 || own == all) {
        return Err(bad(format!("the batch shape {own_shape:?} does not broadcast to {shape:?}")));
    }
    let count = shape.iter().product();
    let mut strides = vec![0; shape.len()];
    let mut step = 1;
    for (axis, &length) in (0..shape.len()).rev().zip(own_shape.iter().rev()) {
        strides[axis] = if length == 1 { 0 } else { step };
        step *= length;
    }
    let place = |body: usize| {
        let axes = shape.iter().zip(&strides).rev();
        axes.fold((body, 0), |(rest, at), (length, stride)| (rest / length, at + rest % length * stride)).1
    };
    Ok((0..count).map(|body| own[place(body)].clone()).collect())
}
