//! The call of a formula, in a slot of the type from which the class in Python derives.
//!
//! A formula of single values takes some 50 ns. A method `__call__` that Python finds, and pyo3's conversion of the
//! arguments, would take twice as long; a class without such a method inherits the function in the slot of its base.
#![allow(unsafe_code)]

use super::calls::Named;
use super::{Formula, called};
use pyo3::exceptions::PyTypeError;
use pyo3::ffi::{self, PyObject, ternaryfunc};
use pyo3::panic::PanicException;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::null_mut;

/// What a formula in Python consists of. A base of the type with the call.
#[pyclass(frozen, subclass, module = "polhode._native")]
pub(crate) struct FormulaCaller {
    formula: Py<Formula>,
}

#[pymethods]
impl FormulaCaller {
    #[new]
    fn new(formula: &Bound<'_, PyAny>) -> PyResult<FormulaCaller> {
        match formula.cast::<Formula>() {
            Ok(formula) => Ok(FormulaCaller { formula: formula.clone().unbind() }),
            Err(_) => Err(PyTypeError::new_err("create a Formula with ph.formula(text)")),
        }
    }

    /// The native formula.
    #[getter]
    fn _core(&self, py: Python<'_>) -> Py<Formula> {
        self.formula.clone_ref(py)
    }
}

/// Creates the type with the call.
pub(crate) fn create_type(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let mut slots = [
        ffi::PyType_Slot { slot: ffi::Py_tp_call, pfunc: call as ternaryfunc as *mut c_void },
        ffi::PyType_Slot::default(),
    ];
    let mut spec = ffi::PyType_Spec {
        name: c"polhode._native.FormulaCaller".as_ptr(),
        basicsize: 0, // that of the base
        itemsize: 0,
        flags: (ffi::Py_TPFLAGS_DEFAULT | ffi::Py_TPFLAGS_BASETYPE) as _,
        slots: slots.as_mut_ptr(),
    };
    let bases = PyTuple::new(py, [py.get_type::<FormulaCaller>()])?;
    // SAFETY: the slots end with zeros, and have what their numbers say; they and the name live during the call.
    unsafe {
        Bound::from_owned_ptr_or_err(py, ffi::PyType_FromSpecWithBases(&raw mut spec, bases.as_ptr()))
    }
}

/// `f(…)`
///
/// # Safety
///
/// As all slots: called by Python, with an object of the type, a tuple, and NULL or a dictionary, which live longer than
/// the call.
unsafe extern "C" fn call(
    this: *mut PyObject,
    arguments: *mut PyObject,
    named: *mut PyObject,
) -> *mut PyObject {
    // SAFETY: the caller is Python.
    let py = unsafe { Python::assume_attached() };
    let value = || {
        // SAFETY: the caller says so; the objects are of these types.
        let (this, arguments, named) = unsafe {
            (
                Bound::from_borrowed_ptr(py, this).cast_into_unchecked::<FormulaCaller>(),
                Bound::from_borrowed_ptr(py, arguments).cast_into_unchecked::<PyTuple>(),
                Bound::from_borrowed_ptr_or_opt(py, named),
            )
        };
        // SAFETY: as above.
        let named = named.map(|named| unsafe { named.cast_into_unchecked::<PyDict>() });
        called(this.get().formula.bind(py), &arguments, named.as_ref())
    };
    let value = catch_unwind(AssertUnwindSafe(value)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(PanicException::new_err(text.unwrap_or("panic").to_owned()))
    });
    value.map_or_else(
        |error| {
            error.restore(py);
            null_mut()
        },
        Bound::into_ptr,
    )
}

/// The names and values of the keywords of a call, without references of their own. Nobody changes them meanwhile: the
/// dictionary belongs to the call, and nothing that reads single values runs Python code.
pub(super) fn pairs<'a, 'py>(
    named: &'a Bound<'py, PyDict>,
) -> impl ExactSizeIterator<Item = Named<'a, 'py>> + use<'a, 'py> {
    let mut place = 0;
    (0..named.len()).map(move |_| {
        let (mut name, mut value) = (null_mut(), null_mut());
        // SAFETY: there are as many entries as asked for, so that both are set; the dictionary keeps them alive.
        unsafe {
            ffi::PyDict_Next(named.as_ptr(), &raw mut place, &raw mut name, &raw mut value);
            (Borrowed::from_ptr(named.py(), name), Borrowed::from_ptr(named.py(), value))
        }
    })
}
