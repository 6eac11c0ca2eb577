//! Conversions between NumPy arrays and fixed-size rows.

use super::interrupts::in_pieces;
use super::pool;
pub(crate) use super::pool::{Array, Out};
use numpy::{
    Element, PyArray1, PyArrayMethods, PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArrayMethods,
};
use polhode_ga::simd::threads::Threads;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

/// An array of float64 whose last axis holds the components, contiguous.
pub(crate) type Rows<'py, T = f64> = PyReadonlyArrayDyn<'py, T>;

/// An array to write to.
pub(crate) type RowsToFill<'py, T = f64> = PyReadwriteArrayDyn<'py, T>;

/// Any Rust error as a ValueError.
pub(crate) fn bad<E: std::fmt::Display>(message: E) -> PyErr {
    PyValueError::new_err(message.to_string())
}

/// The numbers of an array in C order. Other orders are errors: `as_slice` alone would accept Fortran
/// order and swap rows and columns.
pub(crate) fn numbers<'a, T: Element>(array: &'a Rows<'_, T>) -> PyResult<&'a [T]> {
    if !array.is_c_contiguous() {
        return Err(bad("the array is not C-contiguous"));
    }
    Ok(array.as_slice()?)
}

/// The numbers of an array in C order, to be written.
pub(crate) fn numbers_to_fill<'a, T: Element>(array: &'a mut RowsToFill<'_, T>) -> PyResult<&'a mut [T]> {
    if !array.is_c_contiguous() {
        return Err(bad("the array to fill is not C-contiguous"));
    }
    Ok(array.as_slice_mut()?)
}

/// Arrays of fewer numbers use one thread, without asking the system.
const SHARED: usize = 1 << 16;

/// Threads for an array of this many numbers: `POLHODE_NUM_THREADS`, or the available parallelism.
pub(crate) fn threads(numbers: usize) -> PyResult<Threads> {
    if numbers < SHARED { Ok(Threads::ONE) } else { all_threads() }
}

/// `POLHODE_NUM_THREADS`, or the available parallelism.
pub(crate) fn all_threads() -> PyResult<Threads> {
    match std::env::var("POLHODE_NUM_THREADS") {
        Err(std::env::VarError::NotPresent) => Ok(Threads::available()),
        Err(error) => Err(bad(error)),
        Ok(text) => match text.trim().parse() {
            Ok(count) if count > 0 => Ok(Threads::new(count)),
            _ => Err(bad(format!("POLHODE_NUM_THREADS must be a positive whole number, got {text:?}"))),
        },
    }
}

/// A single row of N numbers.
pub(crate) fn one<const N: usize>(row: &Rows<'_>) -> PyResult<[f64; N]> {
    let data = numbers(row)?;
    data.try_into().map_err(|_| bad(format!("expected {N} numbers, got shape {:?}", row.shape())))
}

/// Numbers as a one-dimensional array.
pub(crate) fn line<'py>(py: Python<'py>, numbers: Vec<f64>) -> Array<'py> {
    PyArray1::from_vec(py, numbers).to_dyn().clone()
}

/// A row takes up to a microsecond.
const ROWS_BETWEEN_CHECKS: usize = 1 << 14;

/// Rows of N numbers as an array of shape (rows, N).
pub(crate) fn table<'py, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [f64; N]>,
) -> Out<'py> {
    let array = pool::array(py, &[rows.len(), N])?;
    let mut target = array.readwrite();
    for (number, (row, out)) in rows.zip(target.as_slice_mut()?.as_chunks_mut().0).enumerate() {
        *out = row;
        if number % ROWS_BETWEEN_CHECKS == 0 {
            py.check_signals()?;
        }
    }
    drop(target);
    Ok(array)
}

/// `at index (2, 0): ` for row 4 of shape (…, 2); nothing for a single value.
pub(crate) fn place(row: usize, batch: &[usize]) -> String {
    if batch.is_empty() {
        return String::new();
    }
    let mut rest = row;
    let mut index: Vec<String> = Vec::new();
    for &length in batch.iter().rev() {
        index.push((rest % length).to_string());
        rest /= length;
    }
    index.reverse();
    let comma = if index.len() == 1 { "," } else { "" };
    format!("at index ({}{comma}): ", index.join(", "))
}

/// Applies a function of one row to every row; an error names the batch index.
pub(crate) fn map_rows<'py, const IN: usize, const OUT: usize, E: std::fmt::Display + Send>(
    py: Python<'py>,
    input: &Rows<'py>,
    f: impl Fn([f64; IN]) -> Result<[f64; OUT], E> + Sync,
) -> Out<'py> {
    let shape = input.shape();
    let batch = match shape.split_last() {
        Some((&last, batch)) if last == IN => batch,
        _ => return Err(bad(format!("expected {IN} components in the last axis, got shape {shape:?}"))),
    };
    let rows = numbers(input)?.as_chunks::<IN>().0;
    fill_rows(py, (batch, OUT), 1 << 13, |row, out: &mut [f64]| {
        out.copy_from_slice(&f(rows[row])?);
        Ok::<(), E>(())
    })
}

/// Applies a function of rows to all rows of arrays of one shape; results have the same length. An error names the
/// batch index.
pub(crate) fn map_long_rows<'py, const N: usize, E: std::fmt::Display + Send>(
    py: Python<'py>,
    inputs: [&Rows<'py>; N],
    f: impl Fn([&[f64]; N]) -> Result<Vec<f64>, E> + Sync,
) -> Out<'py> {
    let shape = inputs[0].shape();
    let Some((&size, batch)) = shape.split_last() else { return Err(bad("expected rows of components")) };
    if inputs.iter().any(|input| input.shape() != shape) || size == 0 {
        return Err(bad("expected arrays of one shape"));
    }
    let mut data = [&[][..]; N];
    for (slot, input) in data.iter_mut().zip(inputs) {
        *slot = numbers(input)?;
    }
    // In the largest algebras a row takes milliseconds.
    let least = ((1 << 14) / (size * size)).clamp(1, 1 << 6);
    fill_rows(py, (batch, size), least, |row, out: &mut [f64]| {
        out.copy_from_slice(&f(data.map(|numbers| &numbers[row * size..(row + 1) * size]))?);
        Ok::<(), E>(())
    })
}

/// A new array of a batch of rows of `size` numbers, each row filled by a function of its number. Threads take
/// at least `least` rows, and Python may interrupt. An error names the batch index of the first failing row.
pub(crate) fn fill_rows<'py, E: std::fmt::Display + Send>(
    py: Python<'py>,
    (batch, size): (&[usize], usize),
    least: usize,
    f: impl Fn(usize, &mut [f64]) -> Result<(), E> + Sync,
) -> Out<'py> {
    let shape: Vec<usize> = batch.iter().copied().chain([size]).collect();
    let array = pool::array(py, &shape)?;
    let mut target = array.readwrite();
    let out = target.as_slice_mut()?;
    let threads = threads(out.len())?;
    in_pieces(py, out.len() / size, 16 * least, |rows| {
        let first = rows.start;
        let piece = &mut out[size * rows.start..size * rows.end];
        let failure: Mutex<Option<(usize, E)>> = Mutex::new(None);
        py.detach(|| {
            threads.for_each_piece(least, size, piece, |rows, piece| {
                for (row, out) in rows.zip(piece.chunks_exact_mut(size)) {
                    if let Err(error) = f(first + row, out) {
                        let mut failure = failure.lock().unwrap_or_else(PoisonError::into_inner);
                        if failure.as_ref().is_none_or(|(earlier, _)| row < *earlier) {
                            *failure = Some((row, error));
                        }
                        return;
                    }
                }
            });
        });
        if let Some((row, error)) = failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(bad(format!("{}{error}", place(first + row, batch))));
        }
        Ok(())
    })?;
    drop(target);
    Ok(array)
}
