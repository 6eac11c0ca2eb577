//! Operators of single values of 3-d space, and of other algebras; the Python half of the type handles all other operands.
use super::value::{Any, Object, Operand, Rotor, Storage, This, number, operand, scalar, unit_rotor, wrap};
use super::{batch, single};
use crate::support::arrays::bad;
use polhode_ga::g3::functions::Function;
use polhode_ga::product::{Grades, Product};
use polhode_ga::{Bivector, Graded, Multivector as FullMultivector, Rotor as UnitRotor};
use pyo3::intern;
use pyo3::prelude::*;

/// A single value, and whether it is a rotor.
pub(super) struct One {
    pub value: Graded,
    pub unit: bool,
}

impl One {
    fn of(value: Graded) -> One {
        One { value, unit: false }
    }

    fn of_rotor(rotor: UnitRotor) -> One {
        One { value: Graded::even(rotor.components()), unit: true }
    }

    /// A new Python value.
    pub fn object(self, py: Python<'_>) -> Object<'_> {
        wrap(py, Storage::One(self.value), self.unit)
    }
}

/// A product of single values and numbers, at least one of them a value.
#[inline]
pub(super) fn product_of(product: Product, a: Operand<'_>, b: Operand<'_>) -> Option<One> {
    Some(match (a, b) {
        (Operand::Value(a, true), Operand::Value(b, true)) if product == Product::Geometric => {
            One::of_rotor(unit_rotor(a).compose(unit_rotor(b)))
        }
        (Operand::Value(a, _), Operand::Value(b, _)) => One::of(a.product(product, b)),
        (Operand::Value(a, _), Operand::Number(x)) => One::of(a.product(product, &scalar(x))),
        (Operand::Number(x), Operand::Value(b, _)) => One::of(scalar(x).product(product, b)),
        _ => return None,
    })
}

/// `A + B` of single values and numbers.
pub(super) fn sum_of(a: Operand<'_>, b: Operand<'_>) -> Option<One> {
    zipped(a, b, |x, y| x + y)
}

/// `A − B` of single values and numbers.
pub(super) fn difference(a: Operand<'_>, b: Operand<'_>) -> Option<One> {
    zipped(a, b, |x, y| x - y)
}

#[inline]
fn zipped(a: Operand<'_>, b: Operand<'_>, f: impl Fn(f64, f64) -> f64) -> Option<One> {
    Some(One::of(match (a, b) {
        (Operand::Value(a, _), Operand::Value(b, _)) => a.zip(b, f),
        (Operand::Value(a, _), Operand::Number(x)) => a.zip(&scalar(x), f),
        (Operand::Number(x), Operand::Value(b, _)) => scalar(x).zip(b, f),
        _ => return None,
    }))
}

/// `−A` of a single value; a rotor's is a rotor.
pub(super) fn negative(a: Operand<'_>) -> Option<One> {
    let Operand::Value(a, unit) = a else { return None };
    Some(One { value: a.map(|x| -x), unit })
}

/// `~A` of a single value; a rotor's is a rotor.
pub(super) fn reversed(a: Operand<'_>) -> Option<One> {
    let Operand::Value(a, unit) = a else { return None };
    Some(One { value: a.reverse(), unit })
}

/// `R X ~R` of single values; of a rotor a rotor.
pub(super) fn turned_by(rotor: Operand<'_>, x: Operand<'_>) -> Option<One> {
    let (Operand::Value(rotor, true), Operand::Value(x, unit)) = (rotor, x) else { return None };
    Some(One { value: x.turned(unit_rotor(rotor)), unit })
}

/// `exp B` of a finite single bivector, a rotor.
pub(super) fn exponential(b: Operand<'_>) -> Option<One> {
    let Operand::Value(b, _) = b else { return None };
    let &[x, y, z] = b.components() else { return None };
    let is_finite = x.is_finite() && y.is_finite() && z.is_finite();
    (b.grades() == Grades::BIVECTOR && is_finite).then(|| One::of_rotor(UnitRotor::exp(Bivector([x, y, z]))))
}

/// `log R` of a single rotor.
pub(super) fn logarithm(rotor: Operand<'_>) -> Option<One> {
    let Operand::Value(rotor, true) = rotor else { return None };
    Some(One::of(Graded::bivector(unit_rotor(rotor).log().0)))
}

/// `A op B` here for single values; by the method of the Python half for all others.
pub(crate) fn product<'py>(
    left: This<'_, 'py>,
    product: Product,
    right: Any<'_, 'py>,
    fallback: impl FnOnce() -> Object<'py>,
) -> Object<'py> {
    match product_of(product, operand(left), operand(right)) {
        Some(result) => result.object(left.py()),
        None => single::product(left, product, right)
            .or_else(|| batch::product(left, product, right))
            .unwrap_or_else(fallback),
    }
}

/// A result for single values of 3-d space, or one for those of other algebras and for batches, or that of a method of the
/// Python half.
pub(super) fn or_method<'py>(
    result: Option<One>,
    of_rows: impl FnOnce() -> Option<Object<'py>>,
    value: This<'_, 'py>,
    name: &str,
    arguments: impl pyo3::call::PyCallArgs<'py>,
) -> Object<'py> {
    match result {
        Some(result) => result.object(value.py()),
        None => of_rows().unwrap_or_else(|| value.call_method1(name, arguments)),
    }
}

/// An infix product: the method `_product` of the Python half may return NotImplemented.
pub(crate) fn infix<'py>(left: This<'_, 'py>, kind: Product, right: Any<'_, 'py>) -> Object<'py> {
    product(left, kind, right, || left.call_method1(intern!(left.py(), "_product"), (kind.name(), right)))
}

/// `x op A` for a left factor x that is not a multivector.
pub(crate) fn infix_right<'py>(right: This<'_, 'py>, kind: Product, left: Any<'_, 'py>) -> Object<'py> {
    let number = number(left).map_or(Operand::Other, Operand::Number);
    match product_of(kind, number, operand(right)) {
        Some(result) => result.object(right.py()),
        None => single::product_from(right, kind, left)
            .or_else(|| batch::product(left, kind, right))
            .unwrap_or_else(|| right.call_method1(intern!(right.py(), "_product_from"), (kind.name(), left))),
    }
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
        let general = || value.call_method1(intern!(py, "_function"), (f.name(),));
        let rows = single::function(value, f).or_else(|| batch::function(value, f));
        return rows.unwrap_or_else(general);
    };
    if f == Function::Exp
        && let Some(rotor) = exponential(Operand::Value(value, false))
    {
        return rotor.object(py);
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
    let Some(a) = left.get().single() else { return single::equal(left, right) };
    let a = a.full();
    match operand(right) {
        Operand::Value(b, _) => Some(a == b.full()),
        Operand::Number(x) => Some(a == scalar(x).full()),
        Operand::Other => None,
    }
}

/// `R X ~R` of single values, and of batches.
pub(crate) fn turned<'py>(rotor: &Bound<'py, Rotor>, x: Any<'_, 'py>) -> Option<Object<'py>> {
    match turned_by(operand(rotor), operand(x)) {
        Some(one) => Some(one.object(x.py())),
        None => batch::turned(rotor, x),
    }
}
