//! Pool of memory for large results.
//!
//! Memory is reused after a result is freed: the system provides new memory page by page and fills it with zeros, which
//! costs several times the arithmetic of a product.
//!
//! This module contains all unsafe code of the crate: a buffer exposes its memory.
#![allow(unsafe_code)]

use super::python_objects::REQUIRE_MEMORY;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyBufferError, PyMemoryError};
use pyo3::ffi;
use pyo3::prelude::*;
use std::ffi::{c_int, c_void};
use std::sync::Mutex;

/// A new array of float64.
pub(crate) type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A new array, or a Python exception.
pub(crate) type Out<'py> = PyResult<Array<'py>>;

type Memory = Py<PyArray1<u8>>;

/// Free memory, the latest last, at most [`KEPT`] bytes.
static FREE: Mutex<Vec<(usize, Memory)>> = Mutex::new(Vec::new());

/// Maximum number of free bytes to keep: two results of a million multivectors.
const KEPT: usize = 128 << 20;

/// Sizes are rounded up to this, so that results of similar sizes share memory.
const STEP: usize = 2 << 20;

/// Alignment: a cache line.
const LINE: usize = 64;

/// Memory of at least some number of bytes, returned to the pool when freed.
#[pyclass(frozen)]
pub(crate) struct Buffer {
    memory: Option<Memory>,
    bytes: usize,
    size: usize,
}

/// Smaller arrays use the allocator, which reuses memory itself.
const LARGE: usize = 1 << 20;

/// For smaller results, asking for the free memory would take as long as computing them.
const CHECKED: usize = 1 << 26;

/// A new array of unspecified numbers; a large one in memory of the pool.
pub(crate) fn array<'py>(py: Python<'py>, shape: &[usize]) -> Out<'py> {
    let bytes = shape.iter().fold(8_usize, |bytes, length| bytes.saturating_mul(*length));
    if bytes < LARGE {
        return Ok(PyArrayDyn::zeros(py, shape, false));
    }
    let memory = Bound::new(py, buffer(py, bytes)?)?;
    let line: Array<'py> = py.import("numpy")?.getattr("frombuffer")?.call1((memory,))?.extract()?;
    line.reshape(shape)
}

/// Uninitialized memory of `bytes` bytes.
#[pyfunction]
pub(crate) fn buffer(py: Python<'_>, bytes: usize) -> PyResult<Buffer> {
    let size = bytes.checked_add(LINE).and_then(|size| size.checked_next_multiple_of(STEP));
    let size = size.filter(|&size| isize::try_from(size).is_ok());
    let size =
        size.ok_or_else(|| PyMemoryError::new_err(format!("{bytes} bytes exceed the address space")))?;
    let kept = FREE.lock().ok().and_then(|mut free| {
        let place = free.iter().rposition(|(s, _)| *s == size)?;
        Some(free.remove(place).1)
    });
    let memory = match kept {
        Some(memory) => memory,
        None => {
            // The system may promise more memory than there is.
            if size >= CHECKED {
                REQUIRE_MEMORY.get(py)?.call1((size, "results"))?;
            }
            // NumPy requests huge pages.
            py.import("numpy")?.getattr("empty")?.call1((size, "u1"))?.extract()?
        }
    };
    Ok(Buffer { memory: Some(memory), bytes, size })
}

#[pymethods]
impl Buffer {
    /// Exposes the memory from the first cache line on.
    unsafe fn __getbuffer__(slf: Bound<'_, Self>, view: *mut ffi::Py_buffer, flags: c_int) -> PyResult<()> {
        let buffer = slf.get();
        let memory = buffer.memory.as_ref().ok_or_else(|| PyBufferError::new_err("no memory"))?;
        let array = memory.bind(slf.py());
        assert!(array.len() >= buffer.bytes + LINE, "the memory is too small");
        let offset = (array.data().addr()).wrapping_neg() % LINE;
        // SAFETY: the memory has `LINE` bytes more than `bytes`, so `bytes` of them lie after the offset, which is smaller
        // than `LINE`; they live as long as `slf`, to which the view refers. Python passes a valid `view`.
        let status = unsafe {
            let start: *mut c_void = array.data().add(offset).cast();
            let length = buffer.bytes as ffi::Py_ssize_t;
            ffi::PyBuffer_FillInfo(view, slf.as_ptr(), start, length, 0, flags)
        };
        if status == 0 { Ok(()) } else { Err(PyErr::fetch(slf.py())) }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let (Some(memory), Ok(mut free)) = (self.memory.take(), FREE.lock()) else { return };
        free.push((self.size, memory));
        let mut total: usize = free.iter().map(|(size, _)| size).sum();
        let mut gone = Vec::new();
        while total > KEPT {
            let oldest = free.remove(0);
            total -= oldest.0;
            gone.push(oldest);
        }
        // Freeing memory may run Python code, so the pool must be unlocked first.
        drop(free);
    }
}
