//! The type of all values in Python. A single value of 3-d space over float64 is held inline, and its
//! operators run here; everything else is held as an array, and the Python half of the type works on it.

use crate::arrays::bad;
use crate::signature::{Algebra, g3};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyUntypedArray, PyUntypedArrayMethods};
use polhode_ga::functions::Function;
use polhode_ga::product::{Grades, Product};
use polhode_ga::{Graded, Multivector as FullMultivector, Rotor as UnitRotor};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyTuple, PyType};

type Object<'py> = PyResult<Bound<'py, PyAny>>;

enum Held {
    /// A single value of 3-d space over float64.
    One(Graded),
    /// Any array `(…, K)` of the components of the grades present.
    Many { data: Py<PyAny>, grades: Grades, algebra: Py<Algebra> },
}

/// A multivector, or an array of them; immutable.
#[pyclass(frozen, subclass, module = "polhode")]
pub(crate) struct Multivector {
    held: Held,
    /// Whether it is a Rotor, of norm 1 by construction.
    unit: bool,
}

/// A rotor, or an array of them; immutable.
#[pyclass(frozen, subclass, extends = Multivector, module = "polhode")]
pub(crate) struct Rotor;

/// A new Python value.
fn wrap(py: Python<'_>, held: Held, unit: bool) -> Object<'_> {
    let value = PyClassInitializer::from(Multivector { held, unit });
    if unit {
        Ok(Bound::new(py, value.add_subclass(Rotor))?.into_any())
    } else {
        Ok(Bound::new(py, value)?.into_any())
    }
}

/// A new single value.
fn one(py: Python<'_>, value: Graded) -> Object<'_> {
    wrap(py, Held::One(value), false)
}

/// A new single rotor.
fn one_rotor(py: Python<'_>, rotor: UnitRotor) -> Object<'_> {
    let value = Graded::new(&rotor.components(), Grades::EVEN).ok_or_else(|| bad("a rotor is even"))?;
    wrap(py, Held::One(value), true)
}

/// A Python float or int (not a bool) as a number.
fn number(x: &Bound<'_, PyAny>) -> Option<f64> {
    if x.cast::<PyFloat>().is_ok() || x.cast_exact::<PyInt>().is_ok() { x.extract().ok() } else { None }
}

/// The single value that an operand is, if it is one.
enum Operand<'a> {
    Value(&'a Graded, bool),
    Number(f64),
    Other,
}

fn operand<'a>(x: &'a Bound<'_, PyAny>) -> Operand<'a> {
    if let Ok(value) = x.cast::<Multivector>() {
        let value = value.get();
        return match &value.held {
            Held::One(graded) => Operand::Value(graded, value.unit),
            Held::Many { .. } => Operand::Other,
        };
    }
    number(x).map_or(Operand::Other, Operand::Number)
}

/// The numbers of a short list or tuple, and how many they are.
fn row(numbers: &Bound<'_, PyAny>) -> Option<([f64; 8], usize)> {
    let mut row = [0.0; 8];
    let mut count = 0;
    let mut take = |x: &Bound<'_, PyAny>| {
        let x = x.cast_exact::<PyFloat>().map(|x| x.value()).ok().or_else(|| {
            let whole: i64 = x.cast_exact::<PyInt>().ok()?.extract().ok()?;
            (whole.unsigned_abs() <= 1 << 53).then_some(whole as f64)
        })?;
        *row.get_mut(count)? = x;
        count += 1;
        Some(())
    };
    if let Ok(list) = numbers.cast_exact::<PyList>() {
        for x in list.iter().take(9) {
            take(&x)?;
        }
    } else {
        for x in numbers.cast_exact::<PyTuple>().ok()?.iter().take(9) {
            take(&x)?;
        }
    }
    Some((row, count))
}

impl Multivector {
    /// A single value that is held as an array of float64: its row, grades and algebra.
    fn row<'py>(&self, py: Python<'py>) -> Option<(PyReadonlyArray1<'py, f64>, Grades, &Py<Algebra>)> {
        let Held::Many { data, grades, algebra } = &self.held else { return None };
        let row = data.bind(py).cast::<PyArray1<f64>>().ok()?.try_readonly().ok()?;
        Some((row, *grades, algebra))
    }

    fn single(&self) -> Option<&Graded> {
        match &self.held {
            Held::One(graded) => Some(graded),
            Held::Many { .. } => None,
        }
    }
}

/// The rotor of the four components that a single Rotor has.
fn unit_rotor(value: &Graded) -> UnitRotor {
    let &[s, x, y, z] = value.components() else { return UnitRotor::IDENTITY };
    UnitRotor::from_unit_components([s, x, y, z])
}

/// A number as a scalar.
fn scalar(x: f64) -> Graded {
    Graded::default().map(|_| x)
}

/// `A op B` here for single values; by the method of the Python half for all others.
fn product<'py>(
    left: &Bound<'py, Multivector>,
    product: Product,
    right: &Bound<'py, PyAny>,
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
fn product_of_rows<'py>(
    left: &Bound<'py, Multivector>,
    product: Product,
    right: &Bound<'py, PyAny>,
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
    plan.run(a.as_slice().ok()?, b.as_slice().ok()?, target.as_slice_mut().ok()?);
    target.make_nonwriteable();
    let data = out.into_any().unbind();
    Some(wrap(py, Held::Many { data, grades: plan.grades, algebra: algebra.clone_ref(py) }, false))
}

/// `A + B` and `A − B` here for single values.
fn sum<'py>(
    left: &Bound<'py, Multivector>,
    right: &Bound<'py, PyAny>,
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
fn infix<'py>(left: &Bound<'py, Multivector>, kind: Product, right: &Bound<'py, PyAny>) -> Object<'py> {
    product(left, kind, right, || left.call_method1(intern!(left.py(), "_product"), (kind.name(), right)))
}

/// `x op A` for a left factor x that is no multivector.
fn infix_right<'py>(right: &Bound<'py, Multivector>, kind: Product, left: &Bound<'py, PyAny>) -> Object<'py> {
    if let (Some(b), Some(x)) = (right.get().single(), number(left)) {
        return one(right.py(), scalar(x).product(kind, b));
    }
    right.call_method1(intern!(right.py(), "_product_from"), (kind.name(), left))
}

/// A named product, which may write to an array.
fn named<'py>(
    left: &Bound<'py, Multivector>,
    kind: Product,
    right: &Bound<'py, PyAny>,
    out: Option<&Bound<'py, PyAny>>,
) -> Object<'py> {
    let general = || left.call_method1(intern!(left.py(), "_named"), (kind.name(), right, out));
    if out.is_some() { general() } else { product(left, kind, right, general) }
}

/// A function here for single values; by the method `_function` of the Python half for all others. Of a
/// bivector, `exp` is a Rotor.
fn function<'py>(value: &Bound<'py, Multivector>, f: Function) -> Object<'py> {
    let py = value.py();
    let Some(value) = value.get().single() else {
        return value.call_method1(intern!(py, "_function"), (f.name(),));
    };
    let full = value.full();
    let grades = f.grades(value.grades());
    let result = Graded::new(&f.apply(FullMultivector(full)).map_err(bad)?.0, Grades::ALL);
    let result = result.unwrap_or_default().with_grades(grades);
    let others = [full[0], full[1], full[2], full[3], full[7]];
    let unit = f == Function::Exp && grades == Grades::EVEN && others == [0.0; 5];
    wrap(py, Held::One(result), unit)
}

/// Whether two single values have the same components; None if one is no single value.
fn equal(left: &Bound<'_, Multivector>, right: &Bound<'_, PyAny>) -> Option<bool> {
    let a = left.get().single()?.full();
    match operand(right) {
        Operand::Value(b, _) => Some(a == b.full()),
        Operand::Number(x) => Some(a == scalar(x).full()),
        Operand::Other => None,
    }
}

#[pymethods]
impl Multivector {
    #[new]
    #[classmethod]
    #[pyo3(signature = (*_values, **_named))]
    fn new(
        cls: &Bound<'_, PyType>,
        _values: &Bound<'_, PyAny>,
        _named: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Multivector> {
        Err(not_made_directly(cls))
    }

    /// Wraps an array (…, K) that nobody else writes to; K components of these grades, as bits.
    #[staticmethod]
    #[pyo3(signature = (data, grades, algebra=None))]
    fn _of<'py>(
        py: Python<'py>,
        data: Bound<'py, PyAny>,
        grades: u16,
        algebra: Option<Py<Algebra>>,
    ) -> Object<'py> {
        wrap(py, held(py, data, Grades(grades), algebra)?, false)
    }

    /// The components of the grades present.
    #[getter]
    fn _data<'py>(&self, py: Python<'py>) -> Object<'py> {
        match &self.held {
            Held::One(graded) => {
                let array = PyArray1::from_slice(py, graded.components()).into_any();
                array.call_method1(intern!(py, "setflags"), (false,))?;
                Ok(array)
            }
            Held::Many { data, .. } => Ok(data.bind(py).clone()),
        }
    }

    /// The grades it may hold, as bits.
    #[getter]
    fn _mask(&self) -> u16 {
        match &self.held {
            Held::One(graded) => graded.grades().0,
            Held::Many { grades, .. } => grades.0,
        }
    }

    /// A single value of 3-d space from a list or tuple of as many floats, or integers that floats hold, as the
    /// grades have components; None of anything else.
    #[staticmethod]
    fn _of_numbers<'py>(py: Python<'py>, numbers: &Bound<'py, PyAny>, grades: u16) -> Object<'py> {
        match row(numbers).and_then(|(row, count)| Graded::new(&row[..count], Grades(grades))) {
            Some(value) => one(py, value),
            None => Ok(py.None().into_bound(py)),
        }
    }

    /// The norm of a single value.
    fn _norm_of_one(&self) -> f64 {
        self.single().map_or(f64::NAN, |value| FullMultivector(value.full()).norm())
    }

    /// Whether it is a single value of 3-d space over float64, held inline.
    #[getter]
    fn _is_one(&self) -> bool {
        self.single().is_some()
    }

    /// The algebra it belongs to.
    #[getter]
    fn algebra(&self, py: Python<'_>) -> PyResult<Py<Algebra>> {
        match &self.held {
            Held::One(_) => Ok(g3(py)?.clone_ref(py)),
            Held::Many { algebra, .. } => Ok(algebra.clone_ref(py)),
        }
    }

    fn __mul__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        infix(slf, Product::Geometric, other)
    }

    fn __rmul__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        infix_right(slf, Product::Geometric, other)
    }

    /// ``A^B``, the wedge. Binds looser than ``+``: bracket it, or call `wedge`.
    fn __xor__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        infix(slf, Product::Wedge, other)
    }

    fn __rxor__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        infix_right(slf, Product::Wedge, other)
    }

    /// ``A|B``, the dot. Binds looser than ``+``: bracket it, or call `dot`.
    fn __or__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        infix(slf, Product::Dot, other)
    }

    fn __ror__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        infix_right(slf, Product::Dot, other)
    }

    fn __add__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        sum(slf, other, "_add", |x, y| x + y)
    }

    fn __radd__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        sum(slf, other, "_add", |x, y| y + x)
    }

    fn __sub__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        sum(slf, other, "_subtract", |x, y| x - y)
    }

    fn __rsub__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        sum(slf, other, "_subtract_from", |x, y| y - x)
    }

    fn __truediv__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        match (slf.get().single(), number(other)) {
            (Some(a), Some(x)) if x != 0.0 => one(slf.py(), a.map(|y| y / x)),
            _ => slf.call_method1(intern!(slf.py(), "_divide"), (other,)),
        }
    }

    fn __neg__<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        match slf.get().single() {
            Some(a) => wrap(slf.py(), Held::One(a.map(|x| -x)), slf.get().unit),
            None => slf.call_method0(intern!(slf.py(), "_negated")),
        }
    }

    fn __invert__<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        Self::reverse(slf)
    }

    /// ``~A``: reverses the order of all products; grades 2 and 3 change sign (handout eq. 1.28).
    fn reverse<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        match slf.get().single() {
            Some(a) => wrap(slf.py(), Held::One(a.reverse()), slf.get().unit),
            None => slf.call_method0(intern!(slf.py(), "_reversed")),
        }
    }

    /// Return the part of grade k; zero if it holds none.
    fn grade<'py>(slf: &Bound<'py, Self>, k: &Bound<'py, PyAny>) -> Object<'py> {
        let whole: Option<u16> = k.cast_exact::<PyInt>().ok().and_then(|k| k.extract().ok());
        match (slf.get().single(), whole) {
            (Some(value), Some(k @ 0..=3)) => one(slf.py(), value.with_grades(Grades(1 << k))),
            _ => slf.call_method1(intern!(slf.py(), "_grade"), (k,)),
        }
    }

    /// Exact equality of all components: a bool, or an array of the batch shape.
    fn __eq__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        match equal(slf, other) {
            Some(same) => Ok(PyBool::new(slf.py(), same).to_owned().into_any()),
            None => slf.call_method1(intern!(slf.py(), "_equals"), (other,)),
        }
    }

    fn __ne__<'py>(slf: &Bound<'py, Self>, other: &Bound<'py, PyAny>) -> Object<'py> {
        match equal(slf, other) {
            Some(same) => Ok(PyBool::new(slf.py(), !same).to_owned().into_any()),
            None => slf.call_method1(intern!(slf.py(), "_differs"), (other,)),
        }
    }

    /// ``A⁻¹``. A ValueError, with the batch index, where A is singular to rounding (``1 + e1``).
    fn inverse<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        function(slf, Function::Inverse)
    }

    /// ``exp A``; of a bivector of 3-d space it is a `Rotor`, ``exp(−Bθ/2)`` turning by θ in the plane B.
    ///
    /// A value such as ``e1*e2``, whose scalar is exactly 0, counts as a bivector.
    fn exp<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        function(slf, Function::Exp)
    }

    /// Return a logarithm: ``exp(log A) = A``.
    ///
    /// Even elements (scalar and bivector) have an even one, so that ``log(−1) = π e1∧e2``; others the
    /// principal one. A ValueError, with the batch index, where A is singular. In other algebras: of
    /// rotors and motors, times a positive number.
    fn log<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        function(slf, Function::Log)
    }

    /// Return a square root; of an even element the half-way one, ``√(−1) = e1∧e2``.
    fn sqrt<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        function(slf, Function::Sqrt)
    }

    /// ``A B``, the geometric product by name.
    ///
    /// `out` is a writable float array in C order of the shape of the result's components (..., K), which
    /// they are written to; the result is a view of it. It may not overlap the factors.
    #[pyo3(signature = (other, *, out=None))]
    fn geometric_product<'py>(
        slf: &Bound<'py, Self>,
        other: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        named(slf, Product::Geometric, other, out)
    }

    /// ``A∧B``, the highest grade r + s of the product (handout eq. 1.10). `out` as in `geometric_product`.
    #[pyo3(signature = (other, *, out=None))]
    fn wedge<'py>(
        slf: &Bound<'py, Self>,
        other: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        named(slf, Product::Wedge, other, out)
    }

    /// ``A·B``, the lowest grade abs(r − s) of the product, scalars included: ``3·a = 3a``.
    #[pyo3(signature = (other, *, out=None))]
    fn dot<'py>(
        slf: &Bound<'py, Self>,
        other: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        named(slf, Product::Dot, other, out)
    }

    /// ``A×B = ½(AB − BA)``; not the vector cross product, which is `cross`.
    #[pyo3(signature = (other, *, out=None))]
    fn commutator<'py>(
        slf: &Bound<'py, Self>,
        other: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        named(slf, Product::Commutator, other, out)
    }

    /// ``A⌋B``, grade s − r; zero where r > s.
    #[pyo3(signature = (other, *, out=None))]
    fn left_contraction<'py>(
        slf: &Bound<'py, Self>,
        other: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        named(slf, Product::LeftContraction, other, out)
    }

    /// ``A⌊B``, grade r − s; zero where r < s.
    #[pyo3(signature = (other, *, out=None))]
    fn right_contraction<'py>(
        slf: &Bound<'py, Self>,
        other: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        named(slf, Product::RightContraction, other, out)
    }

    /// ``⟨AB⟩``, grade 0.
    #[pyo3(signature = (other, *, out=None))]
    fn scalar_product<'py>(
        slf: &Bound<'py, Self>,
        other: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        named(slf, Product::Scalar, other, out)
    }
}

#[pymethods]
impl Rotor {
    #[new]
    #[classmethod]
    #[pyo3(signature = (*_values, **_named))]
    fn new(
        cls: &Bound<'_, PyType>,
        _values: &Bound<'_, PyAny>,
        _named: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Rotor>> {
        Err(not_made_directly(cls))
    }

    /// Wraps rows (…, 4) of rotor components, of norm 1, that nobody else writes to.
    #[staticmethod]
    fn _from_rows<'py>(py: Python<'py>, data: Bound<'py, PyAny>) -> Object<'py> {
        wrap(py, held(py, data, Grades::EVEN, None)?, true)
    }

    /// Return the bivector −Bθ/2 with ``exp(log R) = R``, of size at most π; ``log(−1) = π e1∧e2``.
    fn log<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        match slf.as_super().get().single() {
            Some(value) => {
                let log = Graded::new(&unit_rotor(value).log().0, Grades::BIVECTOR);
                one(slf.py(), log.unwrap_or_default())
            }
            None => slf.call_method0(intern!(slf.py(), "_log")),
        }
    }

    fn __call__<'py>(slf: &Bound<'py, Self>, x: &Bound<'py, PyAny>) -> Object<'py> {
        turned(slf, x).unwrap_or_else(|| slf.call_method1(intern!(slf.py(), "_turn"), (x,)))
    }

    /// ``R X ~R``: turns a value of any grade (handout eq. 2.4, 2.6); scalars and trivectors stay.
    ///
    /// `out` is a writable float array in C order of the shape of the result's components, which they are
    /// written to; the result is a view of it. It may not overlap the operands.
    #[pyo3(signature = (x, *, out=None))]
    fn apply<'py>(
        slf: &Bound<'py, Self>,
        x: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> Object<'py> {
        let here = if out.is_none() { turned(slf, x) } else { None };
        here.unwrap_or_else(|| slf.call_method1(intern!(slf.py(), "_turn"), (x, out)))
    }
}

/// `R X ~R` of single values.
fn turned<'py>(rotor: &Bound<'py, Rotor>, x: &Bound<'py, PyAny>) -> Option<Object<'py>> {
    let rotor = rotor.as_super().get().single()?;
    match operand(x) {
        Operand::Value(value, unit) => Some(wrap(x.py(), Held::One(value.turned(unit_rotor(rotor))), unit)),
        _ => None,
    }
}

fn not_made_directly(cls: &Bound<'_, PyType>) -> PyErr {
    let name = cls.name().map_or_else(|_| "Multivector".into(), |name| name.to_string());
    PyTypeError::new_err(format!(
        "{name} is not made directly; use ph.vector, ph.bivector, ph.multivector, or one of the \
         Rotor.from_… constructors"
    ))
}

/// Holds an array: inline if it is one value of 3-d space over float64; in C order and read-only if it is a
/// NumPy array; any other as it is.
fn held<'py>(
    py: Python<'py>,
    data: Bound<'py, PyAny>,
    grades: Grades,
    algebra: Option<Py<Algebra>>,
) -> PyResult<Held> {
    let g3 = g3(py)?;
    let algebra = algebra.unwrap_or_else(|| g3.clone_ref(py));
    if algebra.is(g3)
        && let Ok(components) = data.extract::<PyReadonlyArray1<'_, f64>>()
    {
        let numbers = components.as_array();
        let mut row = [0.0; 8];
        let count = numbers.len().min(8);
        for (slot, x) in row.iter_mut().zip(numbers) {
            *slot = *x;
        }
        let fits = numbers.len() <= 8;
        return match Graded::new(&row[..count], grades) {
            Some(value) if fits => Ok(Held::One(value)),
            _ => Err(bad(format!("{} components do not fit the grades {:#b}", numbers.len(), grades.0))),
        };
    }
    let mut data = data;
    if let Ok(array) = data.cast::<PyUntypedArray>() {
        if !array.is_c_contiguous() {
            data = data.call_method1(intern!(py, "copy"), ("C",))?;
        }
        data.call_method1(intern!(py, "setflags"), (false,))?;
    }
    Ok(Held::Many { data: data.unbind(), grades, algebra })
}
