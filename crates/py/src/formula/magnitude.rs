//! Arithmetic of the sizes of terms over any arrays: Python's operators and an array namespace.

use polhode_ga::formula::Magnitude;
use pyo3::basic::CompareOp;
use pyo3::intern;
use pyo3::prelude::*;

/// A number or an array of floats, and the namespace of its library.
pub(crate) struct PyMagnitude<'a, 'py> {
    pub value: Bound<'py, PyAny>,
    pub namespace: &'a Bound<'py, PyAny>,
}

impl<'py> PyMagnitude<'_, 'py> {
    fn with(&self, value: PyResult<Bound<'py, PyAny>>) -> PyResult<Self> {
        Ok(PyMagnitude { value: value?, namespace: self.namespace })
    }
}

impl Magnitude for PyMagnitude<'_, '_> {
    type Error = PyErr;

    fn plus(&self, other: &Self) -> PyResult<Self> {
        self.with(self.value.add(&other.value))
    }

    fn plus_one(&self) -> PyResult<Self> {
        self.with(self.value.add(1))
    }

    fn times(&self, other: &Self) -> PyResult<Self> {
        self.with(self.value.mul(&other.value))
    }

    fn over(&self, other: &Self) -> PyResult<Self> {
        self.with(self.value.div(&other.value))
    }

    fn larger(&self, other: &Self) -> PyResult<Self> {
        let name = intern!(self.namespace.py(), "maximum");
        self.with(self.namespace.call_method1(name, (&self.value, &other.value)))
    }

    fn multiple(&self, factor: f64, most: f64) -> PyResult<Self> {
        let multiple = self.value.mul(factor)?;
        let most = self.namespace.call_method1("full_like", (&multiple, most))?;
        self.with(self.namespace.call_method1("minimum", (multiple, most)))
    }

    fn nonzero(&self) -> PyResult<Self> {
        let zero = self.value.rich_compare(0, CompareOp::Eq)?;
        self.with(self.value.add(zero))
    }

    fn same(&self) -> Self {
        PyMagnitude { value: self.value.clone(), namespace: self.namespace }
    }
}
