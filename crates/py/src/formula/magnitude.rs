//! Arithmetic of the sizes of terms over any arrays: Python's operators and an array namespace.

use polhode_ga::formula::{Arithmetic, Magnitude};
use pyo3::basic::CompareOp;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyFloat;

/// A number or an array of floats, and the namespace of its library.
#[derive(Clone)]
pub(crate) struct PyMagnitude<'a, 'py> {
    pub value: Bound<'py, PyAny>,
    pub namespace: &'a Bound<'py, PyAny>,
}

impl Magnitude for PyMagnitude<'_, '_> {
    type Error = PyErr;

    fn apply(&self, operation: Arithmetic, other: &Self) -> PyResult<Self> {
        let PyMagnitude { value, namespace } = self;
        let (py, other) = (value.py(), &other.value);
        let value = match operation {
            Arithmetic::Plus => value.add(other),
            Arithmetic::Times => value.mul(other),
            Arithmetic::Over => value.div(other),
            Arithmetic::Larger => namespace.call_method1(intern!(py, "maximum"), (value, other)),
            Arithmetic::Smaller => {
                let other = namespace.call_method1(intern!(py, "full_like"), (value, other))?;
                namespace.call_method1(intern!(py, "minimum"), (value, other))
            }
        };
        Ok(PyMagnitude { value: value?, namespace })
    }

    fn number(&self, x: f64) -> Self {
        PyMagnitude { value: PyFloat::new(self.value.py(), x).into_any(), namespace: self.namespace }
    }

    fn nonzero(&self) -> PyResult<Self> {
        let zero = self.value.rich_compare(0, CompareOp::Eq)?;
        Ok(PyMagnitude { value: self.value.add(zero)?, namespace: self.namespace })
    }
}
