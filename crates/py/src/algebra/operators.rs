//! Operators of single values; the Python half of the type handles all other operands.

use super::value::{
    Any, Multivector, Object, Operand, Rotor, Storage, This, number, one, one_rotor, operand, scalar,
    unit_rotor, wrap,
};
use crate::support::arrays::bad;
use numpy::{PyArray1, PyArrayMethods};
use polhode_ga::g3::functions::Function;
use polhode_ga::product::{Grades, Product};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Graded, Multivector as FullMultivector, Rotor as UnitRotor};
use pyo3::intern;
use pyo3::prelude::*;

/// `A op B` here for single values; by the method of the Python half for all others.
pub(crate) fn product<'py>(
    left: This<'_, 'py>,
    product: Product,
    right: Any<'_, 'py>,
    fallback: impl FnOnce() -> Object<'py>,
) -> Object<'py> {
    let py = left.py();
    let Some(a) = left.get().single() else {
        return product_of_rows(left, product, right).unwrap_or_else(fallback);
    };
    match operand(right) {
        Operand::Value(b, unit) => {
            if unit && left.get().unit && product == Product::Geometric {
                return one_rotor(py, unit_rotor(a).compose(unit_rotor(b)));
            }
            one(py, a.product(product, b))
        }
        Operand::Number(x) => one(py, a.product(product, &scalar(x))),
        Operand::Other => fallback(),
    }
}

/// The product of two single values of another algebra, rows of float64.
pub(crate) fn product_of_rows<'py>(
    left: This<'_, 'py>,
    product: Product,
    right: Any<'_, 'py>,
) -> Option<Object<'py>> {
    let py = left.py();
    let (a, ga, algebra) = left.get().row(py)?;
    let (b, gb, other) = right.cast::<Multivector>().ok()?.get().row(py)?;
    if !algebra.is(other) {
        return None;
    }
    let plan = algebra.get().plan_of(product, ga, gb).ok()?;
    let out = PyArray1::zeros(py, plan.sizes.2, false);
    let mut target = out.readwrite();
    plan.run(Threads::ONE, a.as_slice().ok()?, b.as_slice().ok()?, target.as_slice_mut().ok()?);
    target.make_nonwriteable();
    let data = out.into_any().unbind();
    Some(wrap(py, Storage::Many { data, grades: plan.grades, algebra: algebra.clone_ref(py) }, false))
}

/// `A + B` and `A − B` here for single values.
pub(crate) fn sum<'py>(
    left: This<'_, 'py>,
    right: Any<'_, 'py>,
    name: &str,
    f: impl Fn(f64, f64) -> f64,
) -> Object<'py> {
    let fallback = || left.call_method1(name, (right,));
    let Some(a) = left.get().single() else { return fallback() };
    match operand(right) {
        Operand::Value(b, _) => one(left.py(), a.zip(b, f)),
        Operand::Number(x) => one(left.py(), a.zip(&scalar(x), f)),
        Operand::Other => fallback(),
    }
}

/// An infix product: the method `_product` of the Python half may return NotImplemented.
pub(crate) fn infix<'py>(left: This<'_, 'py>, kind: Product, right: Any<'_, 'py>) -> Object<'py> {
    product(left, kind, right, || left.call_method1(intern!(left.py(), "_product"), (kind.name(), right)))
}

/// `x op A` for a left factor x that is not a multivector.
pub(crate) fn infix_right<'py>(right: This<'_, 'py>, kind: Product, left: Any<'_, 'py>) -> Object<'py> {
    if let (Some(b), Some(x)) = (right.get().single(), number(left)) {
        return one(right.py(), scalar(x).product(kind, b));
    }
    right.call_method1(intern!(right.py(), "_product_from"), (kind.name(), left))
}

/// A named product, which may write to an array.
pub(crate) fn named<'py>(
    left: This<'_, 'py>,
    kind: Product,
    right: Any<'_, 'py>,
    out: Option<Any<'_, 'py>>,
) -> Object<'py> {
    let general = || left.call_method1(intern!(left.py(), "_named"), (kind.name(), right, out));
    if out.is_some() { general() } else { product(left, kind, right, general) }
}

/// A function here for single values; by the method `_function` of the Python half for all others. Of a
/// bivector, `exp` is a Rotor.
pub(crate) fn function<'py>(value: This<'_, 'py>, f: Function, errors: &str) -> Object<'py> {
    let py = value.py();
    if errors != "raise" {
        return value.call_method1(intern!(py, "_masked"), (f.name(), errors));
    }
    let Some(value) = value.get().single() else {
        return value.call_method1(intern!(py, "_function"), (f.name(),));
    };
    if let (Function::Exp, Grades::BIVECTOR, &[x, y, z]) = (f, value.grades(), value.components())
        && [x, y, z].iter().all(|x| x.is_finite())
    {
        return one_rotor(py, UnitRotor::exp(Bivector([x, y, z])));
    }
    let full = value.full();
    let grades = f.grades(value.grades());
    let result = Graded::new(&f.apply(FullMultivector(full)).map_err(bad)?.0, Grades::ALL);
    let result = result.unwrap_or_default().with_grades(grades);
    let others = [full[0], full[1], full[2], full[3], full[7]];
    let unit = f == Function::Exp && grades == Grades::EVEN && others == [0.0; 5];
    wrap(py, Storage::One(result), unit)
}

/// Whether two single values have the same components; None if one is not a single value.
pub(crate) fn equal(left: This<'_, '_>, right: Any<'_, '_>) -> Option<bool> {
    let a = left.get().single()?.full();
    match operand(right) {
        Operand::Value(b, _) => Some(a == b.full()),
        Operand::Number(x) => Some(a == scalar(x).full()),
        Operand::Other => None,
    }
}

/// `R X ~R` of single values.
pub(crate) fn turned<'py>(rotor: &Bound<'py, Rotor>, x: Any<'_, 'py>) -> Option<Object<'py>> {
    let rotor = rotor.as_super().get().single()?;
    match operand(x) {
        Operand::Value(value, unit) => {
            Some(wrap(x.py(), Storage::One(value.turned(unit_rotor(rotor))), unit))
        }
        _ => None,
    }
}
