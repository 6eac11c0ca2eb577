//! Slots of the types `Multivector` and `Rotor`: operators and methods of single values; all others go through pyo3.
#![allow(unsafe_code)]

use super::operators::{
    One, difference, exponential, logarithm, negative, product_of, reversed, sum_of, turned_by,
};
use super::types;
use super::value::{Multivector, Rotor, Storage};
use crate::support::arrays::bad;
use polhode_ga::product::Product;
use pyo3::exceptions::PyImportError;
use pyo3::ffi::{self, PyMethodDef, PyObject, binaryfunc, ternaryfunc, unaryfunc};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};
use std::ffi::{CStr, CString, c_int, c_void};
use std::mem::transmute;
use std::ptr::null_mut;
use std::sync::OnceLock;

type Class<'a, 'py> = &'a Bound<'py, PyType>;

/// Operators and methods of pyo3, for any operands.
struct General {
    multiply: binaryfunc,
    add: binaryfunc,
    subtract: binaryfunc,
    negative: unaryfunc,
    invert: unaryfunc,
    call: ternaryfunc,
    exp: Py<PyAny>,
    log: Py<PyAny>,
    rotor_log: Py<PyAny>,
}

impl General {
    /// Those of the two classes.
    fn of(base: Class<'_, '_>, rotor: Class<'_, '_>) -> PyResult<General> {
        Ok(General {
            multiply: binary_slot(base, ffi::Py_nb_multiply)?,
            add: binary_slot(base, ffi::Py_nb_add)?,
            subtract: binary_slot(base, ffi::Py_nb_subtract)?,
            negative: unary_slot(base, ffi::Py_nb_negative)?,
            invert: unary_slot(base, ffi::Py_nb_invert)?,
            // SAFETY: the function in this slot has this type.
            call: unsafe { transmute::<*mut c_void, ternaryfunc>(function(rotor, ffi::Py_tp_call)?) },
            exp: base.getattr("exp")?.unbind(),
            log: base.getattr("log")?.unbind(),
            rotor_log: rotor.getattr("log")?.unbind(),
        })
    }
}

fn binary_slot(class: Class<'_, '_>, number: c_int) -> PyResult<binaryfunc> {
    // SAFETY: the functions in the slots asked for have this type.
    Ok(unsafe { transmute::<*mut c_void, binaryfunc>(function(class, number)?) })
}

fn unary_slot(class: Class<'_, '_>, number: c_int) -> PyResult<unaryfunc> {
    // SAFETY: the functions in the slots asked for have this type.
    Ok(unsafe { transmute::<*mut c_void, unaryfunc>(function(class, number)?) })
}

/// The function in a slot of a type.
fn function(class: Class<'_, '_>, number: c_int) -> PyResult<*mut c_void> {
    // SAFETY: the type is alive, and the number is one of those of slots.
    let function = unsafe { ffi::PyType_GetSlot(class.as_type_ptr(), number) };
    if function.is_null() {
        return Err(PyImportError::new_err(format!("{class} has no function in slot {number}")));
    }
    Ok(function)
}

static GENERAL: OnceLock<General> = OnceLock::new();

/// Creates the types `Multivector` and `Rotor`.
pub(crate) fn create_types(py: Python<'_>) -> PyResult<[Bound<'_, PyAny>; 2]> {
    let bases = [py.get_type::<Multivector>(), py.get_type::<Rotor>()];
    let slots = [of_multivectors(&bases[0])?, of_rotors(&bases[1])?];
    let general = General::of(&bases[0], &bases[1])?;
    let types = types::create(&bases, slots)?;
    // Else the types exist, which is an error of the line before.
    GENERAL.get_or_init(|| general);
    Ok(types)
}

/// The slots of multivectors, from the class of pyo3 that has the documentation.
fn of_multivectors(base: Class<'_, '_>) -> PyResult<Vec<ffi::PyType_Slot>> {
    Ok([operators(), vec![methods(&[method(base, c"exp", exp)?, method(base, c"log", log)?])]].concat())
}

/// The slots of rotors, which can be called too.
fn of_rotors(base: Class<'_, '_>) -> PyResult<Vec<ffi::PyType_Slot>> {
    let own = vec![
        methods(&[method(base, c"log", rotor_log)?]),
        entry(ffi::Py_tp_call, turn as ternaryfunc as *mut c_void),
    ];
    Ok([operators(), own].concat())
}

fn operators() -> Vec<ffi::PyType_Slot> {
    vec![
        entry(ffi::Py_nb_multiply, multiply as binaryfunc as *mut c_void),
        entry(ffi::Py_nb_add, add as binaryfunc as *mut c_void),
        entry(ffi::Py_nb_subtract, subtract as binaryfunc as *mut c_void),
        entry(ffi::Py_nb_negative, negate as unaryfunc as *mut c_void),
        entry(ffi::Py_nb_invert, invert as unaryfunc as *mut c_void),
    ]
}

/// An entry of a table of slots.
fn entry(slot: c_int, pfunc: *mut c_void) -> ffi::PyType_Slot {
    ffi::PyType_Slot { slot, pfunc }
}

/// The slot of a table of methods, which lives as long as the process, as the type does.
fn methods(methods: &[PyMethodDef]) -> ffi::PyType_Slot {
    let table: Vec<_> = methods.iter().copied().chain([PyMethodDef::zeroed()]).collect();
    entry(ffi::Py_tp_methods, Box::leak(table.into_boxed_slice()).as_mut_ptr().cast())
}

/// A method with the signature and the documentation of that of a class.
fn method(
    class: Class<'_, '_>,
    name: &'static CStr,
    f: ffi::PyCFunctionFastWithKeywords,
) -> PyResult<PyMethodDef> {
    let name_of = name.to_str().map_err(bad)?;
    let general = class.getattr(name_of)?;
    let signature: String = general.getattr("__text_signature__")?.extract()?;
    let text: String = general.getattr("__doc__")?.extract()?;
    // As Python parses it: the signature, a line, and the text.
    let documented = CString::new(format!("{name_of}{signature}\n--\n\n{text}")).map_err(bad)?;
    Ok(PyMethodDef {
        ml_name: name.as_ptr(),
        ml_meth: ffi::PyMethodDefPointer { PyCFunctionFastWithKeywords: f },
        ml_flags: ffi::METH_FASTCALL | ffi::METH_KEYWORDS,
        ml_doc: documented.into_raw(),
    })
}

/// A new reference to the result, or `None` without one; NULL, with Python's error set, when memory runs out.
///
/// # Safety
///
/// The thread is attached to Python.
#[inline]
unsafe fn given(result: Option<One>) -> Option<*mut PyObject> {
    let One { value, unit } = result?;
    // SAFETY: the caller says so.
    let py = unsafe { Python::assume_attached() };
    Some(match types::object(py, Multivector { storage: Storage::One(value), unit }) {
        Ok(object) => object.into_ptr(),
        Err(error) => {
            error.restore(py);
            null_mut()
        }
    })
}

/// Defines an operator of two operands.
macro_rules! binary {
    ($name:ident, $base:ident, $f:expr) => {
        /// # Safety
        ///
        /// As all slots: called by Python, with objects that live longer than the call.
        unsafe extern "C" fn $name(a: *mut PyObject, b: *mut PyObject) -> *mut PyObject {
            let (Some(types), Some(general)) = (types::get(), GENERAL.get()) else { return null_mut() };
            // SAFETY: the caller is Python.
            unsafe {
                let result = given($f(types.operand(a), types.operand(b)));
                result.unwrap_or_else(|| (general.$base)(a, b))
            }
        }
    };
}

/// Defines an operator of one operand.
macro_rules! unary {
    ($name:ident, $base:ident, $f:expr) => {
        /// # Safety
        ///
        /// As all slots: called by Python, with an object that lives longer than the call.
        unsafe extern "C" fn $name(a: *mut PyObject) -> *mut PyObject {
            let (Some(types), Some(general)) = (types::get(), GENERAL.get()) else { return null_mut() };
            // SAFETY: the caller is Python.
            unsafe { given($f(types.operand(a))).unwrap_or_else(|| (general.$base)(a)) }
        }
    };
}

binary!(multiply, multiply, |a, b| product_of(Product::Geometric, a, b));
binary!(add, add, sum_of);
binary!(subtract, subtract, difference);
unary!(negate, negative, negative);
unary!(invert, invert, reversed);

/// `R(X)`.
///
/// # Safety
///
/// As all slots: called by Python, with objects that live longer than the call.
unsafe extern "C" fn turn(
    rotor: *mut PyObject,
    arguments: *mut PyObject,
    named: *mut PyObject,
) -> *mut PyObject {
    let (Some(types), Some(general)) = (types::get(), GENERAL.get()) else { return null_mut() };
    // SAFETY: the caller is Python; the arguments of a call are a tuple.
    unsafe {
        let single = named.is_null() && ffi::PyTuple_Size(arguments) == 1;
        let result = single
            .then(|| turned_by(types.operand(rotor), types.operand(ffi::PyTuple_GetItem(arguments, 0))))
            .flatten();
        given(result).unwrap_or_else(|| (general.call)(rotor, arguments, named))
    }
}

/// Defines a method without arguments of a single value; other values and calls with arguments are those of pyo3.
macro_rules! method {
    ($name:ident, $f:expr) => {
        /// # Safety
        ///
        /// As all methods: called by Python, with objects that live longer than the call.
        unsafe extern "C" fn $name(
            value: *mut PyObject,
            arguments: *const *mut PyObject,
            count: ffi::Py_ssize_t,
            names: *mut PyObject,
        ) -> *mut PyObject {
            let (Some(types), Some(general)) = (types::get(), GENERAL.get()) else { return null_mut() };
            // SAFETY: the caller is Python.
            unsafe {
                let result = if count == 0 && names.is_null() { $f(types.operand(value)) } else { None };
                given(result).unwrap_or_else(|| called(&general.$name, value, arguments, count, names))
            }
        }
    };
}

method!(exp, exponential);
method!(log, logarithm);
method!(rotor_log, logarithm);

/// Calls a method of pyo3 with any arguments: `count` of them, then one for each of `names`.
///
/// # Safety
///
/// The arguments are those of a call of a method by Python.
unsafe fn called(
    method: &Py<PyAny>,
    value: *mut PyObject,
    arguments: *const *mut PyObject,
    count: ffi::Py_ssize_t,
    names: *mut PyObject,
) -> *mut PyObject {
    Python::attach(|py| {
        // SAFETY: the caller says so.
        let at = |i: usize| unsafe { Bound::from_borrowed_ptr(py, *arguments.add(i)) };
        // SAFETY: as above; `names` is NULL or a tuple.
        let (value, names) =
            unsafe { (Bound::from_borrowed_ptr(py, value), Bound::from_borrowed_ptr_or_opt(py, names)) };
        let call = || {
            let count = usize::try_from(count)?;
            let named = PyDict::new(py);
            if let Some(names) = names {
                for (i, name) in names.cast::<PyTuple>()?.iter().enumerate() {
                    named.set_item(name, at(count + i))?;
                }
            }
            let all: Vec<_> = std::iter::once(value).chain((0..count).map(at)).collect();
            method.bind(py).call(PyTuple::new(py, all)?, Some(&named))
        };
        call().map_or_else(
            |error: PyErr| {
                error.restore(py);
                null_mut()
            },
            Bound::into_ptr,
        )
    })
}
