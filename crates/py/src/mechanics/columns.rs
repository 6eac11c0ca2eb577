//! Arguments of laws: numbers for all bodies, or for each body of a batch its own.

use super::made::Values;
use crate::algebra::value::{self, Operand};
use crate::support::arrays::{Rows, bad, numbers, place};
use crate::support::face::BATCH;
use numpy::PyUntypedArrayMethods;
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Vector};
use polhode_rigid::laws::torque::Torque;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::convert::Infallible;
use std::fmt::Display;

/// Values of `polhode._mechanics.parameters.Batch`: a row for each body.
pub(crate) struct Batch<'py> {
    whole: Bound<'py, PyAny>,
    rows: Rows<'py>,
}

impl<'py> Batch<'py> {
    /// A batch, if it is one.
    pub fn of(value: &Bound<'py, PyAny>) -> PyResult<Option<Batch<'py>>> {
        if !BATCH.is_class_of(value)? {
            return Ok(None);
        }
        Ok(Some(Batch { whole: value.clone(), rows: value.getattr("rows")?.extract()? }))
    }

    fn shape(&self) -> &[usize] {
        self.rows.shape().split_last().map_or(&[][..], |(_, batch)| batch)
    }

    /// A single value of the kind that it holds.
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

/// N numbers for all bodies, or N for each.
pub(crate) struct Column<const N: usize>(Vec<[f64; N]>);

impl<const N: usize> Column<N> {
    /// Those of a body.
    pub fn of(&self, body: usize) -> [f64; N] {
        self.0[if self.0.len() == 1 { 0 } else { body }]
    }
}

/// The arguments of a law. Those of a batch have all the same shape.
pub(crate) struct Arguments<'a, 'py> {
    pub all: &'a Bound<'py, PyTuple>,
    /// Shape of the batch of bodies.
    pub shape: Vec<usize>,
}

impl<'a, 'py> Arguments<'a, 'py> {
    /// Those of a law of this name.
    pub fn of(name: &str, all: &'a Bound<'py, PyTuple>) -> PyResult<Arguments<'a, 'py>> {
        let own: Vec<Bound<'py, PyAny>> = match name {
            "formula" => {
                let values: Values<'py> = all.get_item(2)?.extract()?;
                values.into_iter().map(|(_, value)| value).collect()
            }
            _ => all.iter().collect(),
        };
        for argument in own {
            if let Some(batch) = Batch::of(&argument)? {
                return Ok(Arguments { all, shape: batch.shape().to_vec() });
            }
        }
        Ok(Arguments { all, shape: Vec::new() })
    }

    /// The numbers of an argument.
    pub fn column<const N: usize>(&self, which: usize) -> PyResult<Column<N>> {
        let argument = self.all.get_item(which)?;
        if let Some(batch) = Batch::of(&argument)? {
            if batch.shape() != self.shape || batch.rows.shape().last() != Some(&N) {
                return Err(bad(format!("rows of shape {:?} do not fit the law", batch.rows.shape())));
            }
            return Ok(Column(numbers(&batch.rows)?.as_chunks::<N>().0.to_vec()));
        }
        let row = argument.extract().or_else(|error| match (N, argument.extract()) {
            (1, Ok(number)) => Ok([number; N]),
            _ => Err(error),
        });
        Ok(Column(vec![row?]))
    }

    /// A law for each body, or one; an error names the body.
    pub fn each<E: Display>(&self, make: impl Fn(usize) -> Result<Torque, E>) -> PyResult<Vec<Torque>> {
        let count = self.shape.iter().product();
        let told = |body, error| bad(format!("{}{error}", place(body, &self.shape)));
        (0..count).map(|body| make(body).map_err(|error| told(body, error))).collect()
    }

    /// The same where nothing can be wrong.
    pub fn each_sound(&self, make: impl Fn(usize) -> Torque) -> PyResult<Vec<Torque>> {
        self.each(|body| Ok::<_, Infallible>(make(body)))
    }

    /// The laws of a number.
    pub fn each_number(&self, make: impl Fn(f64) -> Torque) -> PyResult<Vec<Torque>> {
        let column: Column<1> = self.column(0)?;
        self.each_sound(|body| make(column.of(body)[0]))
    }

    /// The laws of a vector.
    pub fn each_vector(&self, make: impl Fn(Vector) -> Torque) -> PyResult<Vec<Torque>> {
        let column = self.column(0)?;
        self.each_sound(|body| make(Vector(column.of(body))))
    }

    /// The laws of a bivector.
    pub fn each_bivector(&self, make: impl Fn(Bivector) -> Torque) -> PyResult<Vec<Torque>> {
        let column = self.column(0)?;
        self.each_sound(|body| make(Bivector(column.of(body))))
    }
}

/// For each body of a batch its value, from values whose shape broadcasts to that of the batch; one for all stays one.
pub(crate) fn spread<T: Clone>(own: Vec<T>, own_shape: &[usize], shape: &[usize]) -> Vec<T> {
    if own.len() == 1 || own_shape == shape {
        return own;
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
    (0..count).map(|body| own[place(body)].clone()).collect()
}
