//! Operators of single values of any algebra: rows of float64. The Python half handles all other values.
//!
//! The results have the bits of the same operations over batches, which are written for arrays and take 10 to 100 times as
//! long on a single value.
#![allow(unsafe_code)]

use super::signature::Algebra;
use super::value::{Any, Multivector, Object, Operand, Storage, This, number, operand, wrap};
use numpy::npyffi::NPY_ARRAY_WRITEABLE;
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use polhode_ga::g3::functions::Function;
use polhode_ga::product::{Grades, Product};
use polhode_ga::rows::motors::{self, Motors};
use pyo3::prelude::*;
use std::borrow::Cow;

/// The components of a single value.
#[derive(Clone)]
struct Row<'a> {
    numbers: Cow<'a, [f64]>,
    grades: Grades,
    algebra: &'a Py<Algebra>,
}

impl<'a> Row<'a> {
    fn of(value: This<'a, '_>) -> Option<Row<'a>> {
        let (py, value) = (value.py(), value.get());
        if value.unit {
            return None;
        }
        let Storage::Many { data, grades, algebra } = &value.storage else { return None };
        let data = data.bind(py).cast::<PyArray1<f64>>().ok()?;
        // SAFETY: arrays of values are read-only, and no Python code runs while an operator here reads them. The check of
        // borrows by `readonly` takes longer than most operators.
        let numbers = unsafe { data.as_slice().ok()? };
        Some(Row { numbers: Cow::Borrowed(numbers), grades: *grades, algebra })
    }

    /// A value, or a number as a scalar of this algebra.
    fn operand(x: Any<'a, '_>, algebra: &'a Py<Algebra>) -> Option<Row<'a>> {
        match x.cast::<Multivector>() {
            Ok(value) => Row::of(value).filter(|row| row.algebra.is(algebra)),
            Err(_) => Some(Row { numbers: Cow::Owned(vec![number(x)?]), grades: Grades::SCALAR, algebra }),
        }
    }

    /// The grade of each component.
    fn grade_of_each(&self) -> impl Iterator<Item = usize> {
        let blades = self.algebra.get().table.blades().iter();
        blades.map(|blade| blade.grade()).filter(|&k| self.grades.contains(k))
    }

    /// The same value with the components of these grades, 0 where it has none.
    fn with_grades(&self, grades: Grades) -> Row<'a> {
        if grades == self.grades {
            return self.clone();
        }
        let mut numbers = self.numbers.iter();
        let mut wanted = Vec::new();
        for blade in self.algebra.get().table.blades() {
            let k = blade.grade();
            let x = if self.grades.contains(k) { numbers.next() } else { None };
            if grades.contains(k) {
                wanted.push(x.copied().unwrap_or(0.0));
            }
        }
        Row { numbers: Cow::Owned(wanted), grades, ..*self }
    }

    /// The value with other numbers for the same components.
    fn with(&self, numbers: impl Iterator<Item = f64>) -> Row<'a> {
        Row { numbers: Cow::Owned(numbers.collect()), ..*self }
    }

    fn map(&self, f: impl Fn(f64) -> f64) -> Row<'a> {
        self.with(self.numbers.iter().map(|&x| f(x)))
    }

    /// The value with the sign of some grades reversed.
    fn signed(&self, negative: impl Fn(usize) -> bool) -> Row<'a> {
        let signed = self.numbers.iter().zip(self.grade_of_each());
        self.with(signed.map(|(&x, k)| if negative(k) { -x } else { x }))
    }

    fn reversed(&self) -> Row<'a> {
        self.signed(|k| k % 4 > 1)
    }

    fn times(&self, product: Product, other: &Row<'a>) -> Option<Row<'a>> {
        let plan = self.algebra.get().plan_of(product, self.grades, other.grades).ok()?;
        let mut numbers = vec![0.0; plan.sizes.2];
        plan.run_row(&self.numbers, &other.numbers, &mut numbers);
        Some(Row { numbers: Cow::Owned(numbers), grades: plan.grades, ..*self })
    }

    fn zip(&self, other: &Row<'a>, f: impl Fn(f64, f64) -> f64) -> Row<'a> {
        let grades = Grades(self.grades.0 | other.grades.0);
        let (a, b) = (self.with_grades(grades), other.with_grades(grades));
        a.with(a.numbers.iter().zip(&*b.numbers).map(|(&x, &y)| f(x, y)))
    }

    /// A new Python value.
    fn object<'py>(&self, py: Python<'py>) -> Object<'py> {
        let data = PyArray1::from_slice(py, &self.numbers);
        // SAFETY: nothing else refers to the array.
        unsafe { (*data.as_array_ptr()).fields.flags &= !NPY_ARRAY_WRITEABLE };
        let data = data.into_any().unbind();
        let (grades, algebra) = (self.grades, self.algebra.clone_ref(py));
        wrap(py, Storage::Many { data, grades, algebra }, false)
    }
}

/// A product; `None` unless the right factor is a value of the same algebra or a number.
pub(super) fn product<'py>(left: This<'_, 'py>, kind: Product, right: Any<'_, 'py>) -> Option<Object<'py>> {
    let a = Row::of(left)?;
    Some(a.times(kind, &Row::operand(right, a.algebra)?)?.object(left.py()))
}

/// The product of a number and a value.
pub(super) fn product_from<'py>(
    right: This<'_, 'py>,
    kind: Product,
    left: Any<'_, 'py>,
) -> Option<Object<'py>> {
    let b = Row::of(right)?;
    Some(Row::operand(left, b.algebra)?.times(kind, &b)?.object(right.py()))
}

/// `f` of each component of both, such as their sum; of components that one of them lacks, with 0.
pub(super) fn zipped<'py>(
    left: This<'_, 'py>,
    right: Any<'_, 'py>,
    f: impl Fn(f64, f64) -> f64,
) -> Option<Object<'py>> {
    let a = Row::of(left)?;
    Some(a.zip(&Row::operand(right, a.algebra)?, f).object(left.py()))
}

/// `f` of each component.
pub(super) fn mapped<'py>(value: This<'_, 'py>, f: impl Fn(f64) -> f64) -> Option<Object<'py>> {
    Some(Row::of(value)?.map(f).object(value.py()))
}

/// `~A`.
pub(super) fn reversed<'py>(value: This<'_, 'py>) -> Option<Object<'py>> {
    Some(Row::of(value)?.reversed().object(value.py()))
}

/// The part of grade `k`.
pub(super) fn grade<'py>(value: This<'_, 'py>, k: u16) -> Option<Object<'py>> {
    let row = Row::of(value)?;
    let wanted = row.algebra.get().check(1_u16.checked_shl(k.into())?).ok()?;
    Some(row.with_grades(wanted).object(value.py()))
}

/// Whether all components are the same.
pub(super) fn equal(left: This<'_, '_>, right: Any<'_, '_>) -> Option<bool> {
    let a = Row::of(left)?;
    let b = Row::operand(right, a.algebra)?;
    let grades = Grades(a.grades.0 | b.grades.0);
    Some(a.with_grades(grades).numbers == b.with_grades(grades).numbers)
}

impl<'a> Row<'a> {
    /// The functions of motors that apply to this value, and the value as a row for them.
    fn motor(&self, f: Function) -> Option<(&'a Motors, Row<'a>)> {
        let (wanted, fits) = match f {
            Function::Exp => (Grades::BIVECTOR, self.grades == Grades::BIVECTOR),
            _ => (motors::GRADES, self.grades.within(motors::GRADES)),
        };
        let found = if fits { self.algebra.get().motors() } else { None };
        Some((found?, self.with_grades(wanted)))
    }
}

/// A function, `None` where it has no finite value.
pub(super) fn function<'py>(value: This<'_, 'py>, f: Function) -> Option<Object<'py>> {
    let row = Row::of(value)?;
    let algebra = row.algebra.get();
    if algebra.is_g3() {
        return None;
    }
    if let Some((motors, held)) = row.motor(f) {
        let result =
            motors.run_row(f, &held.numbers).ok().filter(|motor| motor.iter().all(|x| x.is_finite()))?;
        let result = Row { numbers: Cow::Owned(result.to_vec()), grades: motors::GRADES, ..row };
        return Some(result.with_grades(algebra.calculus(false).grades(f, row.grades)).object(value.py()));
    }
    let all = Grades((2 << algebra.table.signature().generators()) - 1);
    let calculus = algebra.calculus(false);
    let result = calculus.apply(f, &row.with_grades(all).numbers).ok()?;
    let result = Row { numbers: Cow::Owned(result), grades: all, ..row };
    let is_finite = result.numbers.iter().all(|x| x.is_finite());
    is_finite.then(|| result.with_grades(calculus.grades(f, row.grades)).object(value.py()))
}

/// The unit and the norm in it of a single value, as [`Algebra::unit_and_size`]; `None` unless all components are finite.
#[pyfunction]
pub(crate) fn unit_and_size(value: This<'_, '_>) -> Option<(f64, f64)> {
    let row = Row::of(value)?;
    let is_finite = row.numbers.iter().all(|x| x.is_finite());
    is_finite.then(|| Algebra::unit_and_size(&row.numbers, &row.algebra.get().reverse_squares(row.grades)))
}

/// The number that a single scalar is, if all other components are 0.
#[pyfunction]
pub(crate) fn number_of(value: This<'_, '_>) -> Option<f64> {
    let one = value.get().single()?;
    let (&number, rest) = one.components().split_first()?;
    (one.grades().contains(0) && rest.iter().all(|x| *x == 0.0)).then_some(number)
}

/// Whether `|A − B| <= max(rtol · max(|A|, |B|), atol)` for single values of 3-d space, measured in units of the largest
/// component, so that nothing overflows; `None` for other values.
#[pyfunction]
pub(crate) fn are_close(a: This<'_, '_>, b: Any<'_, '_>, rtol: f64, atol: f64) -> Option<bool> {
    let (Operand::Value(a, _), Operand::Value(b, _)) = (operand(a), operand(b)) else { return None };
    let (a, b) = (a.full(), b.full());
    let unit = a.iter().chain(&b).fold(0.0, |most: f64, x| most.max(x.abs()));
    let unit = if unit > 0.0 && unit.is_finite() { unit } else { 1.0 };
    let length = |c: [f64; 8]| c.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (left, right) = (a.map(|x| x / unit), b.map(|x| x / unit));
    let (size, apart) =
        (length(left).max(length(right)), length(std::array::from_fn(|k| left[k] - right[k])));
    let is_finite = length(left).is_finite() && length(right).is_finite();
    Some(is_finite && apart <= (rtol * size).max(atol / unit) || a == b)
}

/// `M/√(M ~M)` of a single even element of an algebra with motors; `None` where it has no finite value.
#[pyfunction]
pub(crate) fn normalized_motor<'py>(value: This<'_, 'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let found = || {
        let row = Row::of(value)?;
        let (motors, held) = row.motor(Function::Log)?;
        let unit = motors.normalize_row(held.numbers.as_ref().try_into().ok()?)?;
        Some(Row { numbers: Cow::Owned(unit.to_vec()), ..held }.object(value.py()))
    };
    found().transpose()
}

/// `V X V⁻¹` of single values, for a versor V; `None` where V is not a versor to half of its digits.
#[pyfunction]
pub(crate) fn versor_action<'py>(
    versor: This<'_, 'py>,
    x: Any<'_, 'py>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let found = || {
        let v = Row::of(versor)?;
        let x = Row::of(x.cast().ok()?).filter(|x| x.algebra.is(v.algebra))?;
        Some(moved(&v, &x)?.object(versor.py()))
    };
    found().transpose()
}

/// `V X V⁻¹`, with the grade involution of X if V is odd.
fn moved<'a>(v: &Row<'a>, x: &Row<'a>) -> Option<Row<'a>> {
    let mut held = [false; 2];
    for (_, k) in v.numbers.iter().zip(v.grade_of_each()).filter(|(x, _)| **x != 0.0) {
        held[k % 2] = true;
    }
    let [even, odd] = held;
    if even == odd {
        return None;
    }
    let v = v.with_grades(v.grades.of_parity(odd));
    let action = v.algebra.get().action(v.grades, odd, x.grades)?;
    let mut numbers = vec![0.0; x.numbers.len()];
    let is_versor = action.run_row(&v.numbers, &x.numbers, &mut numbers);
    is_versor.then(|| Row { numbers: Cow::Owned(numbers), ..x.clone() })
}
