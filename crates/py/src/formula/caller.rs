//! The Python type of formulas, called by the vectorcall protocol (PEP 590).
//!
//! A formula of single values takes some 50 ns. Looking up `__call__` and storing the arguments in a tuple and a dictionary
//! would take twice as long; with vectorcall the arguments stay where Python has them.
#![allow(unsafe_code)]

use super::{Formula, called};
use pyo3::exceptions::PyTypeError;
use pyo3::ffi::{self, PyObject, ternaryfunc};
use pyo3::panic::PanicException;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::ffi::{c_ulong, c_void};
use std::mem::offset_of;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::null_mut;

/// What a formula in Python consists of. A base of the type in Python.
#[pyclass(frozen, subclass, weakref, module = "polhode._native")]
pub(crate) struct FormulaCaller {
    /// Where Python looks for the function to call.
    call: ffi::vectorcallfunc,
    formula: Py<Formula>,
}

impl FormulaCaller {
    fn of(formula: Py<Formula>) -> FormulaCaller {
        FormulaCaller { call: vectorcall, formula }
    }
}

#[pymethods]
impl FormulaCaller {
    #[new]
    fn new(formula: &Bound<'_, PyAny>) -> PyResult<FormulaCaller> {
        match formula.cast::<Formula>() {
            Ok(formula) => Ok(FormulaCaller::of(formula.clone().unbind())),
            Err(_) => Err(PyTypeError::new_err("create a Formula with ph.formula(text)")),
        }
    }

    /// The native formula.
    #[getter]
    fn _core(&self, py: Python<'_>) -> Py<Formula> {
        self.formula.clone_ref(py)
    }
}

/// The flag of types with the protocol, which headers before Python 3.12 do not have for the stable interface.
const HAVE_VECTORCALL: c_ulong = 1 << 11;

/// Creates the type.
pub(crate) fn create_type(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let sample = Bound::new(py, FormulaCaller::of(Py::new(py, Formula::default())?))?;
    let start = (&raw const *sample.get()).addr() - sample.as_ptr().addr();
    let mut members = [
        ffi::PyMemberDef {
            name: c"__vectorcalloffset__".as_ptr(),
            type_code: ffi::Py_T_PYSSIZET,
            offset: (start + offset_of!(FormulaCaller, call)) as ffi::Py_ssize_t,
            flags: ffi::Py_READONLY,
            ..ffi::PyMemberDef::default()
        },
        ffi::PyMemberDef::default(),
    ];
    let mut slots = [
        ffi::PyType_Slot { slot: ffi::Py_tp_call, pfunc: call as ternaryfunc as *mut c_void },
        ffi::PyType_Slot { slot: ffi::Py_tp_members, pfunc: members.as_mut_ptr().cast() },
        ffi::PyType_Slot::default(),
    ];
    let mut spec = ffi::PyType_Spec {
        name: c"polhode.Formula".as_ptr(),
        basicsize: 0, // that of the base
        itemsize: 0,
        flags: (ffi::Py_TPFLAGS_DEFAULT | ffi::Py_TPFLAGS_BASETYPE | HAVE_VECTORCALL) as _,
        slots: slots.as_mut_ptr(),
    };
    let bases = PyTuple::new(py, [py.get_type::<FormulaCaller>()])?;
    // SAFETY: the tables end with zeros, and have what their numbers say; they and the names live during the call, and
    // Python copies what it needs.
    unsafe { Bound::from_owned_ptr_or_err(py, ffi::PyType_FromSpecWithBases(&raw mut spec, bases.as_ptr())) }
}

/// `f(…)` for arguments in a row: those by position, then one for each of `names`, NULL or a tuple.
///
/// # Safety
///
/// As all calls: called by Python, with an object of the type and arguments that live longer than the call.
unsafe extern "C" fn vectorcall(
    this: *mut PyObject,
    arguments: *const *mut PyObject,
    count: usize,
    names: *mut PyObject,
) -> *mut PyObject {
    // SAFETY: the caller is Python.
    let py = unsafe { Python::assume_attached() };
    returned(py, || {
        // SAFETY: the caller says so; the objects are of these types.
        let (this, names) = unsafe {
            (
                Borrowed::from_ptr(py, this).cast_unchecked::<FormulaCaller>(),
                Borrowed::from_ptr_or_opt(py, names).map(|names| names.cast_unchecked::<PyTuple>()),
            )
        };
        let formula = this.get().formula.bind(py);
        // The highest bit only says that Python may write before the first.
        let count = count & (usize::MAX >> 1);
        let of_names = names.map_or(0, |names| names.len());
        // SAFETY: as above.
        let at = |i: usize| unsafe { Borrowed::from_ptr(py, *arguments.add(i)) };
        let value = match names {
            None => by_position(formula, || (0..count).map(at))?,
            Some(names) if count == 0 => {
                let pair = |i: usize| (names.get_borrowed_item(i).expect("there are so many"), at(i));
                formula.get().calls.value(py, || (0..of_names).map(pair))?
            }
            _ => None,
        };
        if let Some(value) = value {
            return Ok(value);
        }
        let named = names.map(|names| {
            let named = PyDict::new(py);
            let pairs = names.iter_borrowed().zip((count..count + of_names).map(at));
            pairs.into_iter().try_for_each(|(name, value)| named.set_item(name, value)).map(|()| named)
        });
        called(formula, &PyTuple::new(py, (0..count).map(at))?, named.transpose()?.as_ref())
    })
}

/// `f(…)` for a tuple of arguments and NULL or a dictionary.
///
/// # Safety
///
/// As [`vectorcall`].
unsafe extern "C" fn call(
    this: *mut PyObject,
    arguments: *mut PyObject,
    named: *mut PyObject,
) -> *mut PyObject {
    // SAFETY: the caller is Python.
    let py = unsafe { Python::assume_attached() };
    returned(py, || {
        // SAFETY: the caller says so; the objects are of these types.
        let (this, arguments, named) = unsafe {
            (
                Borrowed::from_ptr(py, this).cast_unchecked::<FormulaCaller>(),
                Borrowed::from_ptr(py, arguments).cast_unchecked::<PyTuple>(),
                Borrowed::from_ptr_or_opt(py, named).map(|named| named.cast_unchecked::<PyDict>()),
            )
        };
        let formula = this.get().formula.bind(py);
        let of_tuple = || arguments.iter_borrowed();
        match if named.is_none() { by_position(formula, of_tuple)? } else { None } {
            Some(value) => Ok(value),
            None => called(formula, &arguments, named.as_deref()),
        }
    })
}

/// The value for single values by position; `None` if no such call is cached.
#[inline]
fn by_position<'a, 'py: 'a, Values: ExactSizeIterator<Item = Borrowed<'a, 'py, PyAny>>>(
    formula: &'a Bound<'py, Formula>,
    values: impl Fn() -> Values,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let Formula { arguments, calls, .. } = formula.get();
    let py = formula.py();
    if arguments.is_empty() || values().len() != arguments.len() {
        return Ok(None);
    }
    calls.value(py, || arguments.iter().map(|name| name.bind(py).as_any().as_borrowed()).zip(values()))
}

/// A new reference to the value; NULL, with Python's error set, for an error or a panic.
fn returned<'py>(py: Python<'py>, value: impl FnOnce() -> PyResult<Bound<'py, PyAny>>) -> *mut PyObject {
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
