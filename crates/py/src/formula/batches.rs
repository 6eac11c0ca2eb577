//! Native calls of formulas on batches of float64.
//!
//! The batches have one shape; single values are allowed too. They avoid a Python call that costs as much as a thousand rows.

use super::Formula;
use crate::algebra::signature::{Algebra, g3};
use crate::algebra::value::{Multivector, Storage, number, scalar, storage, wrap};
use crate::support::arrays::numbers;
use crate::support::pool;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use polhode_ga::Graded;
use polhode_ga::product::Grades;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The values of a name.
enum Rows<'py> {
    One(Graded),
    Many(PyReadonlyArrayDyn<'py, f64>),
}

impl<'py> Rows<'py> {
    /// The rows, their grades, whether they are rotors, and their algebra, which a number does not have; `None` for
    /// anything else.
    #[allow(clippy::type_complexity)]
    fn of(value: &Bound<'py, PyAny>) -> PyResult<Option<(Rows<'py>, Grades, bool, Option<Py<Algebra>>)>> {
        let Ok(value) = value.cast::<Multivector>() else {
            return Ok(number(value).map(|x| (Rows::One(scalar(x)), Grades::SCALAR, false, None)));
        };
        let py = value.py();
        let Multivector { storage, unit } = value.get();
        Ok(match storage {
            Storage::One(graded) => {
                Some((Rows::One(*graded), graded.grades(), *unit, Some(g3(py)?.clone_ref(py))))
            }
            Storage::Many { data, grades, algebra } => {
                let rows = data.bind(py).cast::<PyArrayDyn<f64>>().ok().and_then(|x| x.try_readonly().ok());
                rows.map(|rows| (Rows::Many(rows), *grades, *unit, Some(algebra.clone_ref(py))))
            }
        })
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
    let mut owner: Option<Py<Algebra>> = None;
    for (name, value) in named.iter() {
        let Some((rows, grades, unit, algebra)) = Rows::of(&value)? else { return Ok(None) };
        if let Some(algebra) = algebra
            && !owner.get_or_insert_with(|| algebra.clone_ref(py)).is(&algebra)
        {
            return Ok(None);
        }
        kinds.push((name.extract()?, grades.0, unit.into()));
        given.push(rows);
    }
    if !given.iter().any(|rows| matches!(rows, Rows::Many(_))) {
        return Ok(None);
    }
    let Some(algebra) = owner else { return Ok(None) };
    let Some(program) = formula.for_floats(py, &algebra, kinds) else { return Ok(None) };
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
    let table = &algebra.get().table;
    let shape: Vec<usize> = batch.iter().copied().chain([ty.grades.indices(table).len()]).collect();
    let out = pool::array(py, &shape)?;
    if program.rows.is_some() {
        if !program.fill_rows_elsewhere(py, &data, out.readwrite().as_slice_mut()?)? {
            return Ok(None);
        }
    } else {
        program.fill_rows(py, &data, batch, out.readwrite().as_slice_mut()?)?;
    }
    wrap(py, storage(py, out.into_any(), ty.grades, Some(algebra))?, ty.unit).map(Some)
}
