//! Native calls of formulas on batches of float64 of 3-d space.
//!
//! The batches have one shape; single values are allowed too. They avoid a Python call that costs as much as a thousand rows.

use super::Formula;
use crate::algebra::signature::g3;
use crate::algebra::value::{Multivector, Storage, number, scalar, storage, wrap};
use crate::support::arrays::numbers;
use crate::support::pool;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use polhode_ga::Graded;
use polhode_ga::product::Grades;
use polhode_ga::table::G3;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The values of a name.
enum Rows<'py> {
    One(Graded),
    Many(PyReadonlyArrayDyn<'py, f64>),
}

impl<'py> Rows<'py> {
    /// The rows, their grades, and whether they are rotors; `None` for anything else.
    fn of(value: &Bound<'py, PyAny>) -> PyResult<Option<(Rows<'py>, Grades, bool)>> {
        let Ok(value) = value.cast::<Multivector>() else {
            return Ok(number(value).map(|x| (Rows::One(scalar(x)), Grades::SCALAR, false)));
        };
        let py = value.py();
        let Multivector { storage, unit } = value.get();
        match storage {
            Storage::One(graded) => Ok(Some((Rows::One(*graded), graded.grades(), *unit))),
            Storage::Many { data, grades, algebra } if algebra.is(g3(py)?) => {
                let rows = data.bind(py).cast::<PyArrayDyn<f64>>().ok().and_then(|x| x.try_readonly().ok());
                Ok(rows.map(|rows| (Rows::Many(rows), *grades, *unit)))
            }
            Storage::Many { .. } => Ok(None),
        }
    }
}

/// The value of a formula; `None` if Python must handle the values or an error.
pub(crate) fn value<'py>(
    formula: &Formula,
    named: &Bound<'py, PyDict>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let py = named.py();
    let mut kinds = Vec::with_capacity(named.len());
    let mut given = Vec::with_capacity(named.len());
    for (name, value) in named.iter() {
        let Some((rows, grades, unit)) = Rows::of(&value)? else { return Ok(None) };
        kinds.push((name.extract()?, grades.0, unit.into()));
        given.push(rows);
    }
    if !given.iter().any(|rows| matches!(rows, Rows::Many(_))) {
        return Ok(None);
    }
    let Some(program) = formula.for_floats(py, kinds) else { return Ok(None) };
    let program = program.get();
    let Some(ty) = program.ty() else { return Ok(None) };
    let mut data = Vec::with_capacity(program.order.len());
    let mut batch: Option<&[usize]> = None;
    for &place in &program.order {
        data.push(match &given[place] {
            Rows::One(graded) => graded.components(),
            Rows::Many(rows) => {
                let own = rows.shape().split_last().map_or(&[][..], |(_, own)| own);
                if **batch.get_or_insert(own) != *own {
                    return Ok(None);
                }
                numbers(rows)?
            }
        });
    }
    let Some(batch) = batch else { return Ok(None) };
    let shape: Vec<usize> = batch.iter().copied().chain([ty.grades.indices(&G3).len()]).collect();
    let out = pool::array(py, &shape)?;
    program.fill_rows(py, &data, batch, out.readwrite().as_slice_mut()?)?;
    wrap(py, storage(py, out.into_any(), ty.grades, None)?, ty.unit).map(Some)
}
