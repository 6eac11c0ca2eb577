//! The types `Multivector` and `Rotor` of Python, with their own objects and operators.
//!
//! A product of two rotors takes some 60 instructions. Operators and objects of pyo3 take 900 more: a guard for each call,
//! checks of types, objects that the garbage collector tracks, a constructor and a destructor for each class. The time of
//! one operation is that of the call, so the classes of pyo3, which have all methods, are only bases here: values are of
//! types derived from them, whose frequent operators handle single values and leave all others to the operators of pyo3.
//!
//! An object has the layout of its base: the head of any object, then a [`Multivector`]. The collector does not track it,
//! and need not: a multivector is immutable, and no operation makes it refer to itself.
#![allow(unsafe_code)]

use super::signature::Algebra;
use polhode_ga::Graded;
use polhode_ga::product::Grades;
use pyo3::exceptions::{PyImportError, PyMemoryError};
use pyo3::ffi::{self, PyObject, PyTypeObject};
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};
use std::ffi::{CStr, c_int, c_void};
use std::mem::{size_of, transmute};
use std::sync::OnceLock;

pub(crate) enum Storage {
    /// A single value of 3-d space over float64.
    One(Graded),
    /// Any array `(…, K)` of the components of the grades present.
    Many { data: Py<PyAny>, grades: Grades, algebra: Py<Algebra> },
}

/// A multivector, or an array of them; immutable. A base of the type in Python.
#[pyclass(frozen, subclass, module = "polhode")]
pub(crate) struct Multivector {
    pub(crate) storage: Storage,
    /// Whether it is a Rotor, of norm 1 by construction.
    pub(crate) unit: bool,
}

/// A rotor, or an array of them; immutable. A base of the type in Python.
#[pyclass(frozen, subclass, extends = Multivector, module = "polhode")]
pub(crate) struct Rotor;

/// The types and what their operators need. The types are never freed.
pub(super) struct Types {
    pub multivector: *mut PyTypeObject,
    pub rotor: *mut PyTypeObject,
    /// Where a value lies in its object, in bytes.
    pub offset: usize,
}

// SAFETY: the pointers are to types that live as long as the process and are used only by threads attached to Python.
unsafe impl Send for Types {}
// SAFETY: as above; nothing writes to the fields.
unsafe impl Sync for Types {}

impl Types {
    /// An operand: a single value, a float, or anything else; objects of derived types are anything else.
    ///
    /// # Safety
    ///
    /// The object is alive for the lifetime of the result.
    #[inline]
    pub unsafe fn operand<'a>(&self, object: *mut PyObject) -> Operand<'a> {
        // SAFETY: objects of exactly these types have a value at this offset; the others are only asked for their type, or
        // are floats.
        unsafe {
            let class = ffi::Py_TYPE(object);
            if class == self.rotor || class == self.multivector {
                return match &*object.byte_add(self.offset).cast::<Multivector>() {
                    Multivector { storage: Storage::One(value), unit } => Operand::Value(value, *unit),
                    _ => Operand::Other,
                };
            }
            if class == &raw mut ffi::PyFloat_Type {
                return Operand::Number(ffi::PyFloat_AsDouble(object));
            }
        }
        Operand::Other
    }
}

/// An operand: a single value and whether it is a rotor, a number, or anything else.
pub(crate) enum Operand<'a> {
    Value(&'a Graded, bool),
    Number(f64),
    Other,
}

impl<'a> Operand<'a> {
    /// Of exactly the types here, or a float; other operands are [`Operand::Other`].
    #[inline]
    pub fn exactly(object: &'a Bound<'_, PyAny>) -> Operand<'a> {
        // SAFETY: the object is alive while it is borrowed.
        TYPES.get().map_or(Operand::Other, |types| unsafe { types.operand(object.as_ptr()) })
    }
}

static TYPES: OnceLock<Types> = OnceLock::new();

/// Creates the types `Multivector` and `Rotor` with some slots beside those of objects.
pub(super) fn create<'py>(
    bases: &[Bound<'py, PyType>; 2],
    slots: [Vec<ffi::PyType_Slot>; 2],
) -> PyResult<[Bound<'py, PyAny>; 2]> {
    let py = bases[0].py();
    let sample = Bound::new(py, Multivector { storage: Storage::One(Graded::default()), unit: false })?;
    let offset = (&raw const *sample.get()).addr() - sample.as_ptr().addr();
    for class in bases {
        let size: usize = class.getattr("__basicsize__")?.extract()?;
        if size != offset + size_of::<Multivector>() {
            return Err(PyImportError::new_err("this version of pyo3 lays out objects in another way"));
        }
    }
    let ([base, rotor_base], [slots, rotor_slots]) = (bases, slots);
    let multivector = derived(c"polhode.Multivector", [base.as_any()], slots)?;
    let rotor = derived(c"polhode.Rotor", [rotor_base.as_any(), &multivector], rotor_slots)?;
    let [first, second] = [&multivector, &rotor].map(|class| class.clone().into_ptr().cast());
    if TYPES.set(Types { multivector: first, rotor: second, offset }).is_err() {
        return Err(PyImportError::new_err("polhode is already loaded in this process"));
    }
    Ok([multivector, rotor])
}

/// A type with these bases, the first a class of pyo3, whose methods it has itself too, and slots beside those of objects.
fn derived<'py, const N: usize>(
    name: &'static CStr,
    bases: [&Bound<'py, PyAny>; N],
    mut slots: Vec<ffi::PyType_Slot>,
) -> PyResult<Bound<'py, PyAny>> {
    let entry = |slot, pfunc| ffi::PyType_Slot { slot, pfunc };
    slots.extend([
        entry(ffi::Py_tp_dealloc, dealloc as unsafe extern "C" fn(_) as *mut c_void),
        entry(ffi::Py_tp_free, ffi::PyObject_Free as unsafe extern "C" fn(_) as *mut c_void),
        // With a function of its own to traverse an object, the type does not inherit that of its base, and with it the
        // tracking of its objects.
        entry(ffi::Py_tp_traverse, traverse as ffi::traverseproc as *mut c_void),
        ffi::PyType_Slot::default(),
    ]);
    let tuple = PyTuple::new(bases[0].py(), bases)?;
    let mut spec = ffi::PyType_Spec {
        name: name.as_ptr(),
        basicsize: 0, // that of the base
        itemsize: 0,
        flags: (ffi::Py_TPFLAGS_DEFAULT | ffi::Py_TPFLAGS_BASETYPE) as _,
        slots: slots.as_mut_ptr(),
    };
    // SAFETY: the slots end with zeros, and each has what its number says; they and the name live during the call.
    let class = unsafe {
        Bound::from_owned_ptr_or_err(
            tuple.py(),
            ffi::PyType_FromSpecWithBases(&raw mut spec, tuple.as_ptr()),
        )?
    };
    let own = class.getattr("__dict__")?;
    for item in bases[0].getattr("__dict__")?.call_method0("items")?.try_iter()? {
        let (name, member): (String, Bound<'py, PyAny>) = item?.extract()?;
        if !name.starts_with("__") && !own.contains(&name)? {
            class.setattr(name, member)?;
        }
    }
    Ok(class)
}

/// The types, once they exist.
#[inline]
pub(super) fn get() -> Option<&'static Types> {
    TYPES.get()
}

/// A new object.
pub(super) fn object(py: Python<'_>, value: Multivector) -> PyResult<Bound<'_, PyAny>> {
    let types = TYPES.get().ok_or_else(|| PyImportError::new_err("import polhode"))?;
    let class = if value.unit { types.rotor } else { types.multivector };
    // SAFETY: the memory has the size of the type's objects; `PyObject_Init` writes the head, and the value is written
    // before anybody sees the object. It is aligned, as the one in `create` is.
    unsafe {
        let memory = ffi::PyObject_Malloc(types.offset + size_of::<Multivector>());
        if memory.is_null() {
            return Err(PyMemoryError::new_err(()));
        }
        memory.byte_add(types.offset).cast::<Multivector>().write(value);
        Ok(Bound::from_owned_ptr(py, ffi::PyObject_Init(memory.cast(), class)))
    }
}

/// Frees an object.
///
/// # Safety
///
/// The object is of one of the types here, or of a type derived from them, and nothing refers to it.
unsafe extern "C" fn dealloc(object: *mut PyObject) {
    // SAFETY: the object exists since the types do; its value is dropped once, its memory freed by the function of its
    // type, and the reference to its type, which an object holds, is given up at the end.
    unsafe {
        let Some(types) = TYPES.get() else { return };
        let class = ffi::Py_TYPE(object);
        let value = object.byte_add(types.offset).cast::<Multivector>();
        if let Storage::Many { data, algebra, .. } = value.read().storage {
            ffi::Py_DECREF(data.into_ptr());
            ffi::Py_DECREF(algebra.into_ptr());
        }
        if class == types.rotor || class == types.multivector {
            ffi::PyObject_Free(object.cast());
        } else {
            let free = ffi::PyType_GetSlot(class, ffi::Py_tp_free);
            transmute::<*mut c_void, ffi::freefunc>(free)(object.cast());
        }
        ffi::Py_DECREF(class.cast());
    }
}

/// Visits nothing.
unsafe extern "C" fn traverse(_: *mut PyObject, _: ffi::visitproc, _: *mut c_void) -> c_int {
    0
}
