//! Facts of the core as Python objects.

use super::arrays::line;
use polhode_rigid::facts::{Fact, Facts};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A fact as a Python object.
pub(crate) fn object(py: Python<'_>, fact: Fact) -> PyResult<Bound<'_, PyAny>> {
    match fact {
        Fact::None => Ok(py.None().into_bound(py)),
        Fact::Flag(flag) => flag.into_bound_py_any(py),
        Fact::Count(count) => count.into_bound_py_any(py),
        Fact::Number(x) => x.into_bound_py_any(py),
        Fact::Text(text) => text.into_bound_py_any(py),
        Fact::List(facts) => {
            let facts = facts.into_iter().map(|fact| object(py, fact)).collect::<PyResult<Vec<_>>>()?;
            Ok(PyList::new(py, facts)?.into_any())
        }
        Fact::Table(facts) => Ok(dict(py, facts)?.into_any()),
    }
}

/// Facts by name.
pub(crate) fn dict(py: Python<'_>, facts: Facts) -> PyResult<Bound<'_, PyDict>> {
    let result = PyDict::new(py);
    for (name, fact) in facts {
        result.set_item(name, object(py, fact)?)?;
    }
    Ok(result)
}

/// Facts of many bodies by the names of a template: numbers as arrays with NaN for unknown values, all else as lists.
pub(crate) fn columns(
    py: Python<'_>,
    template: Facts,
    rows: impl Iterator<Item = Facts>,
) -> PyResult<Bound<'_, PyDict>> {
    let mut columns: Vec<(Vec<f64>, Vec<Fact>)> = vec![Default::default(); template.len()];
    for facts in rows {
        for ((numbers, others), (_, fact)) in columns.iter_mut().zip(facts) {
            match fact {
                Fact::Number(x) => numbers.push(x),
                Fact::None => numbers.push(f64::NAN),
                fact => others.push(fact),
            }
        }
    }
    let result = PyDict::new(py);
    for ((name, kind), (numbers, others)) in template.into_iter().zip(columns) {
        match kind {
            Fact::Number(_) | Fact::None => result.set_item(name, line(py, numbers))?,
            _ => result.set_item(name, object(py, Fact::List(others))?)?,
        }
    }
    Ok(result)
}
