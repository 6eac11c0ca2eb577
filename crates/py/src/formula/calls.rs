//! Cached calls of formulas on single values and on batches.
//!
//! A call with the names and kinds of an earlier one is recognized by the addresses of its names, which Python interns, at
//! little cost beside the arithmetic. Linear maps are recognized by their addresses, and their matrices are cached.

use super::program::Program;
use super::{Formula, NameKind, batches};
use crate::algebra::batch::Rows;
use crate::algebra::signature::g3;
use crate::algebra::value::{Operand, Storage, operand, scalar, wrap};
use crate::support::python_objects::LINEAR_MAP;
use polhode_ga::Graded;
use polhode_ga::formula::{Given, InputKind, Type};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Mutex;

/// Maximum number of cached calls of a formula.
const KEPT: usize = 8;

/// A value, after its name.
pub(crate) type Named<'a, 'py> = (Borrowed<'a, 'py, PyAny>, Borrowed<'a, 'py, PyAny>);

/// A name as the caller spells it, and its kind.
type Kind = (Py<PyAny>, Argument);

/// The calls, the latest first.
#[derive(Default)]
pub(crate) struct Calls(Mutex<Vec<Call>>);

/// Names as the caller spells them, their kinds, and the program for these.
struct Call {
    arguments: Vec<Kind>,
    program: Py<Program>,
    /// Memory for the inputs, and for the values of the steps.
    inputs: Vec<Given>,
    values: Vec<Graded>,
}

/// The kind of a name.
pub(crate) enum Argument {
    /// A value or number, and its place among the inputs, if the formula uses it.
    Value(Type, Option<usize>),
    /// A linear map of vectors or bivectors, whose inputs are cached.
    Map(Py<PyAny>, u16),
}

impl Calls {
    /// The value for values with their names; `None` if no such call is cached, and for batches of several shapes.
    pub fn value<'a, 'py: 'a, Values: ExactSizeIterator<Item = Named<'a, 'py>>>(
        &self,
        py: Python<'py>,
        values: impl Fn() -> Values,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        match self.value_of_ones(py, &values)? {
            None => self.value_of_rows(py, &values),
            value => Ok(value),
        }
    }

    /// The value for single values.
    fn value_of_ones<'a, 'py: 'a, Values: ExactSizeIterator<Item = Named<'a, 'py>>>(
        &self,
        py: Python<'py>,
        values: &impl Fn() -> Values,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        // Locked only if a finalizer, which Python may run anywhere, calls the formula within a call of it.
        let Ok(mut calls) = self.0.try_lock() else { return Ok(None) };
        let Some(place) = calls.iter_mut().position(|call| call.takes(values()).is_some()) else {
            return Ok(None);
        };
        if place > 0 {
            calls[..=place].rotate_right(1);
        }
        let Call { program, inputs, values, .. } = &mut calls[0];
        let error = match program.get().value(inputs, values) {
            None => return Ok(None),
            // A new value has no finalizer, and does not start the garbage collector.
            Some(Ok((&value, unit))) => return wrap(py, Storage::One(value), unit).map(Some),
            Some(Err(error)) => error,
        };
        let program = program.clone_ref(py);
        drop(calls);
        Err(program.get().row_error(py, &error, &[]))
    }

    /// The value for batches of one shape, also with single values.
    fn value_of_rows<'a, 'py: 'a, Values: ExactSizeIterator<Item = Named<'a, 'py>>>(
        &self,
        py: Python<'py>,
        values: &impl Fn() -> Values,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let found = {
            let Ok(calls) = self.0.try_lock() else { return Ok(None) };
            let rows = |call: &Call| Some((call.rows(py, values())?, call.program.clone_ref(py)));
            calls.iter().find_map(rows)
        };
        // Unlocked, since other threads may run meanwhile.
        let Some((rows, program)) = found else { return Ok(None) };
        batches::of_rows(py, program.get(), &rows.iter().collect::<Vec<_>>(), g3(py)?)
    }

    /// Caches a call; false if it is not one of values of 3-d space over float64, or if the formula is an equation.
    pub fn keep(&self, formula: &Formula, named: &Bound<'_, PyDict>) -> PyResult<bool> {
        let mut kinds = Vec::with_capacity(named.len());
        let mut arguments = Vec::with_capacity(named.len());
        for (name, value) in named.iter() {
            let Some(argument) = Argument::of(&value)? else { return Ok(false) };
            kinds.push(argument.named(name.extract()?));
            arguments.push((name.unbind(), argument));
        }
        let known = self.0.try_lock().is_ok_and(|calls| calls.iter().any(|call| call.is_of(&arguments)));
        if known {
            return Ok(true);
        }
        let Some(program) = formula.for_floats(named.py(), g3(named.py())?, kinds) else { return Ok(false) };
        let Program { order, program: steps, .. } = program.get();
        let mut inputs = vec![Given::Determinant(0.0); order.len()];
        for (place, (input, &i)) in steps.inputs.iter().zip(order).enumerate() {
            match &mut arguments[i].1 {
                Argument::Value(_, own) => *own = Some(place),
                Argument::Map(map, _) => inputs[place] = of_map(map.bind(named.py()), input.kind)?,
            }
        }
        let gone = {
            let Ok(mut calls) = self.0.try_lock() else { return Ok(true) };
            calls.insert(0, Call { arguments, program, inputs, values: Vec::new() });
            (calls.len() > KEPT).then(|| calls.pop())
        };
        drop(gone);
        Ok(true)
    }
}

impl Call {
    /// Takes the values for inputs, if their names and kinds are those of this call.
    fn takes<'a, 'py: 'a>(&mut self, values: impl ExactSizeIterator<Item = Named<'a, 'py>>) -> Option<()> {
        if values.len() != self.arguments.len() {
            return None;
        }
        for ((name, value), (known, argument)) in values.zip(&self.arguments) {
            match (argument, operand(&value)) {
                _ if !name.is(known) => return None,
                (Argument::Value(ty, place), Operand::Value(value, unit))
                    if value.grades() == ty.grades && unit == ty.unit =>
                {
                    place.iter().for_each(|&place| self.inputs[place] = Given::Value(*value));
                }
                (Argument::Value(Type::SCALAR, place), Operand::Number(x)) => {
                    place.iter().for_each(|&place| self.inputs[place] = Given::Value(scalar(x)));
                }
                (Argument::Map(map, _), Operand::Other) if value.is(map) => {}
                _ => return None,
            }
        }
        Some(())
    }

    /// Whether these are its names and kinds.
    fn is_of(&self, arguments: &[Kind]) -> bool {
        let same = |(own, other): (&Kind, &Kind)| own.0.is(&other.0) && own.1.is_as(&other.1);
        self.arguments.len() == arguments.len() && self.arguments.iter().zip(arguments).all(same)
    }

    /// The rows of the inputs, if the names and kinds of the values are those of this call and none is a linear map.
    fn rows<'a, 'py: 'a>(
        &self,
        py: Python<'py>,
        values: impl ExactSizeIterator<Item = Named<'a, 'py>>,
    ) -> Option<Vec<Rows<'a>>> {
        if values.len() != self.arguments.len() {
            return None;
        }
        let mut inputs: Vec<Option<Rows<'a>>> = self.inputs.iter().map(|_| None).collect();
        for ((name, value), (known, argument)) in values.zip(&self.arguments) {
            let Argument::Value(ty, place) = argument else { return None };
            let rows = if name.is(known) { Rows::operand(value)? } else { return None };
            if rows.grades != ty.grades || rows.unit != ty.unit || !rows.is_of(g3(py).ok()?) {
                return None;
            }
            if let Some(place) = *place {
                inputs[place] = Some(rows);
            }
        }
        inputs.into_iter().collect()
    }
}

impl Argument {
    /// Whether it is of the same kind.
    fn is_as(&self, other: &Argument) -> bool {
        match (self, other) {
            (Argument::Value(a, _), Argument::Value(b, _)) => a.grades == b.grades && a.unit == b.unit,
            (Argument::Map(a, _), Argument::Map(b, _)) => a.is(b),
            _ => false,
        }
    }

    /// A name of this kind.
    pub fn named(&self, name: String) -> NameKind {
        match self {
            Argument::Value(ty, _) => (name, ty.grades.0, ty.unit.into()),
            Argument::Map(_, grade) => (name, *grade, 2),
        }
    }

    /// A value of 3-d space over float64, a number, or a single linear map; `None` for anything else.
    pub fn of(value: &Bound<'_, PyAny>) -> PyResult<Option<Argument>> {
        let py = value.py();
        match operand(value) {
            Operand::Value(value, unit) => {
                Ok(Some(Argument::Value(Type { grades: value.grades(), unit }, None)))
            }
            Operand::Number(_) => Ok(Some(Argument::Value(Type::SCALAR, None))),
            Operand::Other => {
                if let Some(rows) = Rows::operand(value.as_borrowed()) {
                    let ty = Type { grades: rows.grades, unit: rows.unit };
                    return Ok(rows.is_of(g3(py)?).then_some(Argument::Value(ty, None)));
                }
                let one =
                    LINEAR_MAP.is_class_of(value)? && value.getattr(intern!(py, "shape"))?.is_empty()?;
                let grade = || value.getattr(intern!(py, "grade"))?.extract();
                Ok(if one { Some(Argument::Map(value.clone().unbind(), grade()?)) } else { None })
            }
        }
    }
}

/// The matrix or the determinant of a single linear map.
pub(crate) fn of_map(map: &Bound<'_, PyAny>, kind: InputKind) -> PyResult<Given> {
    let py = map.py();
    let name = match kind {
        InputKind::Determinant => {
            return Ok(Given::Determinant(map.getattr(intern!(py, "determinant"))?.extract()?));
        }
        InputKind::Matrix { grade: 1 } => intern!(py, "matrix"),
        _ => intern!(py, "bivector_matrix"),
    };
    let rows: [[f64; 3]; 3] = map.getattr(name)?.call_method0(intern!(py, "tolist"))?.extract()?;
    Ok(Given::Matrix(std::array::from_fn(|i| rows[i / 3][i % 3])))
}
