//! Registry of Python objects that the binding calls.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

/// A registered Python object.
pub(crate) struct Slot {
    name: &'static str,
    object: PyOnceLock<Py<PyAny>>,
}

/// The exception for errors in formulas.
pub(crate) static FORMULA_ERROR: Slot = Slot::new("FormulaError");
/// Evaluates a formula over values of any kind.
pub(crate) static CALL_FORMULA: Slot = Slot::new("call_formula");
/// The class of linear maps.
pub(crate) static LINEAR_MAP: Slot = Slot::new("LinearMap");
/// The class of values with a row for each body.
pub(crate) static BATCH: Slot = Slot::new("Batch");
/// Converts any value that `vector` takes to three components.
pub(crate) static AS_VECTORS: Slot = Slot::new("as_vectors");
/// Converts any value that `bivector` takes to three components.
pub(crate) static AS_BIVECTORS: Slot = Slot::new("as_bivectors");
/// Raises a MemoryError unless a number of bytes is free.
pub(crate) static REQUIRE_MEMORY: Slot = Slot::new("require_memory");

impl Slot {
    const fn new(name: &'static str) -> Slot {
        Slot { name, object: PyOnceLock::new() }
    }

    /// The object.
    pub fn get<'a, 'py>(&'a self, py: Python<'py>) -> PyResult<&'a Bound<'py, PyAny>> {
        let missing =
            || PyRuntimeError::new_err(format!("`{}` is not registered; import polhode", self.name));
        Ok(self.object.get(py).ok_or_else(missing)?.bind(py))
    }

    /// Whether a value is an instance of this class. A class that is not registered has no instances.
    pub fn is_class_of(&self, value: &Bound<'_, PyAny>) -> PyResult<bool> {
        let class = self.object.get(value.py());
        class.map_or(Ok(false), |class| value.is_instance(class.bind(value.py())))
    }
}

/// Registers an object under its name; later registrations are ignored.
#[pyfunction]
pub(crate) fn register(py: Python<'_>, name: &str, object: Py<PyAny>) -> PyResult<()> {
    let slots =
        [&FORMULA_ERROR, &CALL_FORMULA, &LINEAR_MAP, &BATCH, &AS_VECTORS, &AS_BIVECTORS, &REQUIRE_MEMORY];
    let unknown = || PyValueError::new_err(format!("the binding does not use {name:?}"));
    let slot = slots.into_iter().find(|slot| slot.name == name).ok_or_else(unknown)?;
    slot.object.get_or_init(py, || object);
    Ok(())
}
