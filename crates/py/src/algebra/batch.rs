//! Operators of batches of float64 of one shape, also with a single value or a number. The Python half handles all other
//! batches, and takes some microseconds longer.
#![allow(unsafe_code)]

use super::rows::fill_numbers;
use super::signature::{Algebra, g3};
use super::value::{Any, Multivector, Object, Storage, This, is_aligned, number, one, wrap};
use crate::support::pool;
use numpy::npyffi::NPY_ARRAY_WRITEABLE;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use polhode_ga::g3::functions::Function;
use polhode_ga::product::{Grades, Product};
use polhode_ga::rows::compose::compose;
use polhode_ga::rows::product::turn;
use polhode_ga::rows::rotor_functions;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::G3;
use polhode_ga::{Graded, Multivector as FullMultivector};
use pyo3::prelude::*;
use pyo3::types::PyFloat;
use std::borrow::Cow;
use std::iter::zip;
use std::sync::atomic::{AtomicBool, Ordering};

/// Sums and signs of more numbers are left to the Python half: NumPy's loops are as fast.
const FEW: usize = 1 << 12;

/// The rows of a value.
pub(crate) struct Rows<'a> {
    pub numbers: Cow<'a, [f64]>,
    /// The shape of the batch, empty for a single value.
    pub shape: Cow<'a, [usize]>,
    pub grades: Grades,
    pub unit: bool,
    /// That of a number is any.
    pub algebra: Option<&'a Py<Algebra>>,
}

impl<'a> Rows<'a> {
    fn of<'py: 'a>(value: Borrowed<'a, 'py, Multivector>) -> Option<Rows<'a>> {
        let (py, Multivector { storage, unit }) = (value.py(), value.get());
        let (numbers, shape, grades, algebra) = match storage {
            Storage::One(one) => (one.components(), &[][..], one.grades(), g3(py).ok()?),
            Storage::Many { data, grades, algebra } => {
                let data =
                    data.bind(py).cast::<PyArrayDyn<f64>>().ok().filter(|data| data.is_c_contiguous())?;
                let (_, shape) = data.shape().split_last()?;
                // SAFETY: arrays of values are read-only.
                (unsafe { data.as_slice().ok()? }, shape, *grades, algebra)
            }
        };
        let (numbers, shape) = (numbers.into(), shape.into());
        Some(Rows { numbers, shape, grades, unit: *unit, algebra: Some(algebra) })
    }

    /// A value, a number, or an array of few numbers as a batch of scalars; `None` for anything else, and for values that
    /// are not of float64.
    pub fn operand<'py: 'a>(x: Borrowed<'a, 'py, PyAny>) -> Option<Rows<'a>> {
        match x.cast::<Multivector>() {
            Ok(value) => Rows::of(value),
            Err(_) => {
                let (numbers, shape) = match number(&x) {
                    Some(x) => (vec![x], Vec::new()),
                    None => numbers_of(&x)?,
                };
                let (numbers, shape) = (numbers.into(), shape.into());
                Some(Rows { numbers, shape, grades: Grades::SCALAR, unit: false, algebra: None })
            }
        }
    }

    /// A single value of 3-d space, or a small batch of them.
    fn of_space<'py: 'a>(value: This<'a, 'py>) -> Option<Rows<'a>> {
        let rows = Rows::of(value.as_borrowed())?;
        let is_g3 = rows.algebra.is_some_and(|algebra| algebra.get().is_g3());
        (is_g3 && !rows.numbers.is_empty() && rows.numbers.len() <= FEW).then_some(rows)
    }

    /// The numbers row by row.
    fn by_row(&self) -> impl Iterator<Item = &[f64]> {
        self.numbers.chunks_exact(self.grades.indices(&G3).len().max(1))
    }

    /// Whether it is a value of this algebra, or a number.
    pub fn is_of(&self, algebra: &Py<Algebra>) -> bool {
        self.algebra.is_none_or(|own| own.is(algebra))
    }

    /// The shape of the result of an operator and its algebra; `None` for two single values, and for values of several
    /// shapes or algebras.
    fn together<'s>(&'s self, other: &'s Rows<'a>) -> Option<(&'s [usize], &'a Py<Algebra>)> {
        let algebra = self.algebra.or(other.algebra)?;
        let same = self.is_of(algebra) && other.is_of(algebra);
        let shape = if self.shape.is_empty() { &*other.shape } else { &*self.shape };
        let fits = [self, other].iter().all(|rows| rows.shape.is_empty() || *rows.shape == *shape);
        (same && fits && !shape.is_empty()).then_some((shape, algebra))
    }
}

/// A copy of the numbers of an array, which Python may change, and its shape; `None` for many, and for other types, also
/// derived ones, such as masked arrays.
fn numbers_of(array: Any<'_, '_>) -> Option<(Vec<f64>, Vec<usize>)> {
    if !array.get_type().is(array.py().get_type::<PyUntypedArray>()) {
        return None;
    }
    let array =
        array.cast::<PyArrayDyn<f64>>().ok().filter(|array| array.len() <= FEW && is_aligned(array))?;
    let numbers = array.try_readonly().ok()?.as_array().iter().copied().collect();
    Some((numbers, array.shape().to_vec()))
}

/// What a result consists of, but its numbers.
pub(crate) struct Kind<'a> {
    pub shape: &'a [usize],
    pub size: usize,
    pub grades: Grades,
    pub unit: bool,
    pub algebra: &'a Py<Algebra>,
}

/// A new Python value, whose numbers a function fills.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    kind: Kind<'_>,
    fill: impl FnOnce(&mut [f64]) -> PyResult<()>,
) -> Object<'py> {
    let Kind { shape, size, grades, unit, algebra } = kind;
    let data = pool::array(py, &[shape, &[size]].concat())?;
    // SAFETY: nothing else refers to the array.
    unsafe {
        fill(data.as_slice_mut()?)?;
        (*data.as_array_ptr()).fields.flags &= !NPY_ARRAY_WRITEABLE;
    }
    let (data, algebra) = (data.into_any().unbind(), algebra.clone_ref(py));
    wrap(py, Storage::Many { data, grades, algebra }, unit)
}

/// A product.
pub(super) fn product<'py>(left: Any<'_, 'py>, kind: Product, right: Any<'_, 'py>) -> Option<Object<'py>> {
    let (a, b) = (Rows::operand(left.as_borrowed())?, Rows::operand(right.as_borrowed())?);
    let (shape, algebra) = a.together(&b)?;
    let py = left.py();
    if a.unit && b.unit && kind == Product::Geometric {
        let kind = Kind { shape, size: 4, grades: Grades::EVEN, unit: true, algebra };
        return Some(filled(py, kind, |out| {
            fill_numbers(py, (4, 4, 4), &a.numbers, &b.numbers, out, compose)
        }));
    }
    let plan = algebra.get().plan_of(kind, a.grades, b.grades).ok()?;
    let kind = Kind { shape, size: plan.sizes.2, grades: plan.grades, unit: false, algebra };
    let work = |threads, a: &[f64], b: &[f64], out: &mut [f64]| plan.run(threads, a, b, out);
    Some(filled(py, kind, |out| fill_numbers(py, plan.sizes, &a.numbers, &b.numbers, out, work)))
}

/// `R X ~R` for rotors R.
pub(super) fn turned<'py>(rotor: Any<'_, 'py>, x: Any<'_, 'py>) -> Option<Object<'py>> {
    let (r, x) = (Rows::of(rotor.as_borrowed().cast().ok()?)?, Rows::of(x.as_borrowed().cast().ok()?)?);
    let (shape, algebra) = r.together(&x)?;
    let (py, size) = (rotor.py(), x.grades.indices(&algebra.get().table).len());
    let kind = Kind { shape, size, grades: x.grades, unit: x.unit, algebra };
    let work = |threads: Threads, r: &[f64], v: &[f64], out: &mut [f64]| turn(threads, r, v, x.grades, out);
    Some(filled(py, kind, |out| fill_numbers(py, (4, size, size), &r.numbers, &x.numbers, out, work)))
}

/// A function in 3-d space; `None` for large batches but `exp` of bivectors and `log` of rotors, and if some row has none.
pub(super) fn function<'py>(value: This<'_, 'py>, f: Function) -> Option<Object<'py>> {
    let a = Rows::of(value.as_borrowed())?;
    let algebra = a.algebra.filter(|algebra| !a.shape.is_empty() && algebra.get().is_g3())?;
    let (work, na, size, grades): (Work, _, _, _) = match f {
        Function::Exp if a.grades == Grades::BIVECTOR => (rotor_functions::exp, 3, 4, Grades::EVEN),
        Function::Log if a.unit => (rotor_functions::log, 4, 3, Grades::BIVECTOR),
        _ => return by_row(value.py(), f, &a, algebra),
    };
    let py = value.py();
    let kind = Kind { shape: &a.shape, size, grades, unit: f == Function::Exp, algebra };
    let all = AtomicBool::new(true);
    let value = filled(py, kind, |out| {
        fill_numbers(py, (na, na, size), &a.numbers, &a.numbers, out, |threads, a, _: &[f64], out| {
            all.fetch_and(work(threads, a, out).is_ok(), Ordering::Relaxed);
        })
    });
    all.into_inner().then_some(value)
}

/// A function of the rows of a small batch one by one; `None` if some row has none, and if all results may be rotors.
fn by_row<'py>(py: Python<'py>, f: Function, a: &Rows<'_>, algebra: &Py<Algebra>) -> Option<Object<'py>> {
    let grades = f.grades(a.grades);
    if a.numbers.len() > FEW || f == Function::Exp && grades == Grades::EVEN {
        return None;
    }
    let value = |row: &[f64]| {
        let FullMultivector(full) = f.apply(FullMultivector(Graded::new(row, a.grades)?.full())).ok()?;
        full.iter().all(|x| x.is_finite()).then_some(full)
    };
    let places = grades.indices(&G3);
    let mut all = true;
    let kind = Kind { shape: &a.shape, size: places.len(), grades, unit: false, algebra };
    let result = filled(py, kind, |out| {
        for (out, row) in zip(out.chunks_exact_mut(places.len()), a.by_row()) {
            let Some(full) = value(row) else {
                all = false;
                break;
            };
            zip(out, &places).for_each(|(out, &place)| *out = full[place]);
        }
        Ok(())
    });
    all.then_some(result)
}

/// A function of rows, which fails with the first row without a value.
type Work = fn(Threads, &[f64], &mut [f64]) -> Result<(), usize>;

/// `f` of each component of two values of the same grades, such as their sum.
pub(super) fn zipped<'py>(
    left: This<'_, 'py>,
    right: Any<'_, 'py>,
    f: impl Fn(f64, f64) -> f64,
) -> Option<Object<'py>> {
    let (a, b) = (Rows::of(left.as_borrowed())?, Rows::operand(right.as_borrowed())?);
    let (shape, algebra) = a.together(&b)?;
    if a.grades != b.grades || a.shape != b.shape || a.numbers.len() > FEW {
        return None;
    }
    let size = a.grades.indices(&algebra.get().table).len();
    let kind = Kind { shape, size, grades: a.grades, unit: false, algebra };
    let pairs = zip(&*a.numbers, &*b.numbers);
    Some(filled(left.py(), kind, |out| {
        zip(out, pairs).for_each(|(out, (&x, &y))| *out = f(x, y));
        Ok(())
    }))
}

/// `f` of each component; never a rotor.
pub(super) fn mapped<'py>(value: This<'_, 'py>, f: impl Fn(f64) -> f64) -> Option<Object<'py>> {
    let Rows { numbers, shape, grades, algebra, .. } = Rows::of(value.as_borrowed())?;
    let algebra = algebra.filter(|_| !shape.is_empty() && numbers.len() <= FEW)?;
    let size = grades.indices(&algebra.get().table).len();
    let kind = Kind { shape: &shape, size, grades, unit: false, algebra };
    Some(filled(value.py(), kind, |out| {
        zip(out, &*numbers).for_each(|(out, &x)| *out = f(x));
        Ok(())
    }))
}

/// The value with the sign of the grades reversed for which `negative` holds.
pub(super) fn signed<'py>(value: This<'_, 'py>, negative: impl Fn(usize) -> bool) -> Option<Object<'py>> {
    let a = Rows::of(value.as_borrowed())?;
    if a.shape.is_empty() || a.numbers.len() > FEW {
        return None;
    }
    let (grades, algebra) = (a.grades, a.algebra?);
    let blades = algebra.get().table.blades().iter().map(|blade| blade.grade());
    let signs: Vec<bool> = blades.filter(|&k| grades.contains(k)).map(negative).collect();
    let kind = Kind { shape: &a.shape, size: signs.len(), grades, unit: a.unit, algebra };
    Some(filled(value.py(), kind, |out| {
        for (out, row) in zip(out.chunks_exact_mut(signs.len()), a.numbers.chunks_exact(signs.len())) {
            zip(out, zip(row, &signs))
                .for_each(|(out, (&x, &negative))| *out = if negative { -x } else { x });
        }
        Ok(())
    }))
}

/// `⟨A ~A⟩`, the sum of squares in NumPy's order, of a value of 3-d space: a number, or an array for a small batch; `None` for
/// other values.
#[pyfunction]
pub(crate) fn norm_squared<'py>(value: This<'_, 'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
    numbers_by_row(value, |_, row| match row {
        &[a, b, c, d, e, f, g, h] => {
            ((a * a + b * b) + (c * c + d * d)) + ((e * e + f * f) + (g * g + h * h))
        }
        few => few.iter().fold(0.0, |sum, x| sum + x * x),
    })
}

/// `√⟨A ~A⟩` of the same values, without overflow on the way.
#[pyfunction]
pub(crate) fn norm_of<'py>(value: This<'_, 'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
    numbers_by_row(value, |grades, row| {
        Graded::new(row, grades).map_or(f64::NAN, |value| FullMultivector(value.full()).norm())
    })
}

/// A number for a value of 3-d space, or for each row of a small batch.
fn numbers_by_row<'py>(
    value: This<'_, 'py>,
    number: impl Fn(Grades, &[f64]) -> f64,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let (py, Some(rows)) = (value.py(), Rows::of_space(value)) else { return Ok(None) };
    if rows.shape.is_empty() {
        return Ok(Some(PyFloat::new(py, number(rows.grades, &rows.numbers)).into_any()));
    }
    let array = pool::array(py, &rows.shape)?;
    let mut target = array.readwrite();
    for (out, row) in zip(target.as_slice_mut()?, rows.by_row()) {
        *out = number(rows.grades, row);
    }
    drop(target);
    Ok(Some(array.into_any()))
}

/// `A/|A|` of a value of 3-d space; `None` for large batches and other values, and if some row has no direction.
#[pyfunction]
pub(crate) fn normalized<'py>(value: This<'_, 'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let (py, Some(rows)) = (value.py(), Rows::of_space(value)) else { return Ok(None) };
    let signs = [1.0; 8];
    let direction = |row: &[f64], out: &mut [f64]| {
        let (unit, size) = Algebra::unit_and_size(row, &signs);
        zip(out, row).for_each(|(out, x)| *out = x / unit / size);
        size > 0.0 && row.iter().all(|x| x.is_finite())
    };
    if rows.shape.is_empty() {
        let mut numbers = [0.0; 8];
        let numbers = &mut numbers[..rows.numbers.len()];
        let found = direction(&rows.numbers, numbers).then(|| Graded::new(numbers, rows.grades));
        return found.flatten().map(|unit| one(py, unit)).transpose();
    }
    let (size, mut all) = (rows.grades.indices(&G3).len(), true);
    let kind = Kind { shape: &rows.shape, size, grades: rows.grades, unit: false, algebra: g3(py)? };
    let unit = filled(py, kind, |out| {
        all = zip(out.chunks_exact_mut(size), rows.by_row()).all(|(out, row)| direction(row, out));
        Ok(())
    })?;
    Ok(all.then_some(unit))
}
