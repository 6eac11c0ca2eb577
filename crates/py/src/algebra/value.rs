//! Multivector and Rotor: storage of values in Python.
//!
//! A single value of 3-d space over float64 is stored inline, all others as arrays of any coefficients and algebra.

use super::signature::{Algebra, g3};
use super::types;
pub(crate) use super::types::{Multivector, Operand, Rotor, Storage};
use crate::support::arrays::bad;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArray1, PyUntypedArray, PyUntypedArrayMethods};
use polhode_ga::product::Grades;
use polhode_ga::{Graded, Rotor as UnitRotor};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt, PyList, PyTuple};

pub(crate) type Object<'py> = PyResult<Bound<'py, PyAny>>;
pub(crate) type Any<'a, 'py> = &'a Bound<'py, PyAny>;
pub(crate) type This<'a, 'py> = &'a Bound<'py, Multivector>;

/// A new Python value.
pub(crate) fn wrap(py: Python<'_>, storage: Storage, unit: bool) -> Object<'_> {
    types::object(py, Multivector { storage, unit })
}

/// A new single value.
pub(crate) fn one(py: Python<'_>, value: Graded) -> Object<'_> {
    wrap(py, Storage::One(value), false)
}

/// A new single rotor.
pub(crate) fn one_rotor(py: Python<'_>, rotor: UnitRotor) -> Object<'_> {
    wrap(py, Storage::One(Graded::even(rotor.components())), true)
}

/// A Python float or int (not a bool) as a number.
pub(crate) fn number(x: &Bound<'_, PyAny>) -> Option<f64> {
    match x.cast::<PyFloat>() {
        Ok(x) => Some(x.value()),
        Err(_) => x.cast_exact::<PyInt>().ok()?.extract().ok(),
    }
}

/// What an object is as an operand.
pub(crate) fn operand<'a>(x: &'a Bound<'_, PyAny>) -> Operand<'a> {
    // Nearly all are of these types, which are found without asking for the bases.
    match Operand::exactly(x) {
        Operand::Other => {}
        found => return found,
    }
    if let Ok(value) = x.cast::<Multivector>() {
        let value = value.get();
        return match &value.storage {
            Storage::One(graded) => Operand::Value(graded, value.unit),
            Storage::Many { .. } => Operand::Other,
        };
    }
    number(x).map_or(Operand::Other, Operand::Number)
}

/// Whether all numbers are at multiples of their size, unlike those of a field of packed records.
pub(crate) fn is_aligned(array: &Bound<'_, PyArrayDyn<f64>>) -> bool {
    array.data().is_aligned() && array.strides().iter().all(|stride| stride % 8 == 0)
}

/// An array of float64 in C order and aligned memory; of no derived type, such as a masked array.
pub(crate) fn plain_array<'a, 'py>(x: &'a Bound<'py, PyAny>) -> Option<&'a Bound<'py, PyArrayDyn<f64>>> {
    if !x.get_type().is(x.py().get_type::<PyUntypedArray>()) {
        return None;
    }
    x.cast::<PyArrayDyn<f64>>().ok().filter(|array| array.is_c_contiguous() && is_aligned(array))
}

/// The numbers of a short list, tuple or array of float64, and their count.
pub(crate) fn row(numbers: &Bound<'_, PyAny>) -> Option<([f64; 8], usize)> {
    let mut row = [0.0; 8];
    let mut count = 0;
    let mut take = |x: Bound<'_, PyAny>| {
        let x = x.cast_exact::<PyFloat>().map(|x| x.value()).ok().or_else(|| {
            let whole: i64 = x.cast_exact::<PyInt>().ok()?.extract().ok()?;
            (whole.unsigned_abs() <= 1 << 53).then_some(whole as f64)
        })?;
        *row.get_mut(count)? = x;
        count += 1;
        Some(())
    };
    if let Some(array) = plain_array(numbers) {
        if array.ndim() != 1 || array.len() > row.len() {
            return None;
        }
        let given = array.try_readonly().ok()?;
        row[..array.len()].copy_from_slice(given.as_slice().ok()?);
        return Some((row, array.len()));
    }
    match numbers.cast_exact::<PyList>() {
        Ok(list) => list.iter().try_for_each(&mut take)?,
        Err(_) => numbers.cast_exact::<PyTuple>().ok()?.iter().try_for_each(&mut take)?,
    }
    Some((row, count))
}

impl Multivector {
    pub(crate) fn single(&self) -> Option<&Graded> {
        match &self.storage {
            Storage::One(graded) => Some(graded),
            Storage::Many { .. } => None,
        }
    }
}

/// The rotor of the four components that a single Rotor has.
pub(crate) fn unit_rotor(value: &Graded) -> UnitRotor {
    let &[s, x, y, z] = value.components() else { return UnitRotor::IDENTITY };
    UnitRotor::from_unit_components([s, x, y, z])
}

/// A number as a scalar.
pub(crate) fn scalar(x: f64) -> Graded {
    Graded::default().map(|_| x)
}

/// Stores an array: inline if it is one value of 3-d space over float64; in C order and read-only if it is a
/// NumPy array; any other as it is.
pub(crate) fn storage<'py>(
    py: Python<'py>,
    mut data: Bound<'py, PyAny>,
    grades: Grades,
    algebra: Option<Py<Algebra>>,
) -> PyResult<Storage> {
    let g3 = g3(py)?;
    let algebra = algebra.unwrap_or_else(|| g3.clone_ref(py));
    if algebra.is(g3)
        && let Ok(components) = data.extract::<PyReadonlyArray1<'_, f64>>()
    {
        let numbers: Vec<f64> = components.as_array().iter().copied().collect();
        let misfit = || bad(format!("{} components do not fit the grades {:#b}", numbers.len(), grades.0));
        return Graded::new(&numbers, grades).map(Storage::One).ok_or_else(misfit);
    }
    if let Ok(array) = data.cast::<PyUntypedArray>() {
        if !array.is_c_contiguous() {
            data = data.call_method1(intern!(py, "copy"), ("C",))?;
        }
        data.call_method1(intern!(py, "setflags"), (false,))?;
    }
    Ok(Storage::Many { data: data.unbind(), grades, algebra })
}
