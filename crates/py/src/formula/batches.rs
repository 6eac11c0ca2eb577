//! Native calls of formulas on batches of float64.
//!
//! The batches have one shape; single values are allowed too. They avoid a Python call that costs as much as a thousand rows.

use super::Formula;
use super::program::Program;
use crate::algebra::batch::{Kind, Rows, filled};
use crate::algebra::signature::Algebra;
use polhode_ga::formula::Type;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The value of a formula; `None` if Python must handle the values or an error.
pub(crate) fn value<'py>(
    formula: &Formula,
    named: &Bound<'py, PyDict>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let py = named.py();
    let pairs: Vec<_> = named.iter().collect();
    let mut kinds = Vec::with_capacity(pairs.len());
    let mut given = Vec::with_capacity(pairs.len());
    let mut owner: Option<&Py<Algebra>> = None;
    for (name, value) in &pairs {
        let Some(rows) = Rows::operand(value.as_borrowed()) else { return Ok(None) };
        if let Some(algebra) = rows.algebra
            && !owner.get_or_insert(algebra).is(algebra)
        {
            return Ok(None);
        }
        kinds.push((name.extract()?, rows.grades.0, rows.unit.into()));
        given.push(rows);
    }
    let Some(algebra) = owner.filter(|_| given.iter().any(|rows| !rows.shape.is_empty())) else {
        return Ok(None);
    };
    let Some(program) = formula.for_floats(py, algebra, kinds) else { return Ok(None) };
    let inputs: Vec<&Rows<'_>> = program.get().order.iter().map(|&place| &given[place]).collect();
    of_rows(py, program.get(), &inputs, algebra)
}

/// The value of a program for its inputs; `None` unless there are batches and all have one shape, and for rows without a
/// value in other algebras.
pub(super) fn of_rows<'py>(
    py: Python<'py>,
    program: &Program,
    inputs: &[&Rows<'_>],
    algebra: &Py<Algebra>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let mut batches = inputs.iter().map(|rows| &*rows.shape).filter(|shape| !shape.is_empty());
    let (Some(Type { grades, unit }), Some(shape)) = (program.ty(), batches.next()) else { return Ok(None) };
    if !batches.all(|other| other == shape) {
        return Ok(None);
    }
    let data: Vec<&[f64]> = inputs.iter().map(|rows| &*rows.numbers).collect();
    let kind = Kind { shape, size: grades.indices(&algebra.get().table).len(), grades, unit, algebra };
    let mut all = true;
    let value = filled(py, kind, |out| {
        if program.rows.is_some() {
            all = program.fill_rows_elsewhere(py, &data, out)?;
            return Ok(());
        }
        program.fill_rows(py, &data, shape, out)
    })?;
    Ok(all.then_some(value))
}
