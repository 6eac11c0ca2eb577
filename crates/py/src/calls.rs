//! Calls of a formula on single values. A call with the names and the kinds of values of an earlier one is
//! known by the addresses of its names, which Python keeps once; so it costs no more than the arithmetic.

use crate::arrays::bad;
use crate::program::Program;
use crate::value::{Held, Operand, operand, scalar, wrap};
use polhode_ga::Graded;
use polhode_ga::formula::{Given, Type};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Mutex;

/// So many calls of a formula are kept.
const KEPT: usize = 8;

/// The calls, the latest first.
#[derive(Default)]
pub(crate) struct Calls(Mutex<Vec<Call>>);

/// Names as the caller spells them, what they stood for, and the program for that.
struct Call {
    names: Vec<Py<PyAny>>,
    types: Vec<Type>,
    /// For each name its place among the inputs.
    places: Vec<usize>,
    program: Py<Program>,
    /// Memory for the inputs, and for the values of the steps.
    inputs: Vec<Given>,
    values: Vec<Graded>,
}

impl Calls {
    /// The value for single values; `None` if no such call is known.
    pub fn value<'py>(&self, named: &Bound<'py, PyDict>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let py = named.py();
        // Nothing that Python sees is made while the calls are locked.
        let found = {
            let mut calls = self.0.lock().map_err(bad)?;
            let place = calls.iter_mut().position(|call| call.takes(named).is_some());
            place.and_then(|i| {
                calls[..=i].rotate_right(1);
                let Call { program, inputs, values, .. } = &mut calls[0];
                Some(program.get().value(inputs, values)?.map_err(|error| (error, program.clone_ref(py))))
            })
        };
        match found {
            None => Ok(None),
            Some(Ok((value, unit))) => wrap(py, Held::One(value), unit).map(Some),
            Some(Err((error, program))) => Err(program.get().row_error(py, &error, &[])),
        }
    }

    /// Keeps a call for the next time.
    pub fn keep(&self, named: &Bound<'_, PyDict>, program: Py<Program>) -> PyResult<()> {
        let Some(types) = named.iter().map(|(_, value)| single(&value)).collect() else {
            return Ok(());
        };
        let order = &program.get().order;
        let places: Option<Vec<usize>> =
            (0..named.len()).map(|i| order.iter().position(|&given| given == i)).collect();
        let Some(places) = places else { return Ok(()) };
        let names = named.keys().iter().map(Bound::unbind).collect();
        let gone = {
            let mut calls = self.0.lock().map_err(bad)?;
            let inputs = vec![Given::Determinant(0.0); places.len()];
            calls.insert(0, Call { names, types, places, program, inputs, values: Vec::new() });
            (calls.len() > KEPT).then(|| calls.pop())
        };
        drop(gone);
        Ok(())
    }
}

impl Call {
    /// Takes the values for inputs, if their names and kinds are those of this call.
    fn takes(&mut self, named: &Bound<'_, PyDict>) -> Option<()> {
        if named.len() != self.names.len() {
            return None;
        }
        for (i, (name, value)) in named.iter().enumerate() {
            let ty = self.types[i];
            if !name.is(&self.names[i]) {
                return None;
            }
            self.inputs[self.places[i]] = match operand(&value) {
                Operand::Value(value, unit) if value.grades() == ty.grades && unit == ty.unit => {
                    Given::Value(*value)
                }
                Operand::Number(x) if ty == Type::SCALAR => Given::Value(scalar(x)),
                _ => return None,
            };
        }
        Some(())
    }
}

/// What a single value of 3-d space over float64, or a number, is.
pub(crate) fn single(value: &Bound<'_, PyAny>) -> Option<Type> {
    match operand(value) {
        Operand::Value(value, unit) => Some(Type { grades: value.grades(), unit }),
        Operand::Number(_) => Some(Type::SCALAR),
        Operand::Other => None,
    }
}
