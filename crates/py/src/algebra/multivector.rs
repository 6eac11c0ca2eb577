//! Methods of the native half of Python's `Multivector` and `Rotor`.

use super::operators::{
    difference, equal, function, infix, infix_right, logarithm, named, negative, or_method, reversed, sum_of,
    turned,
};
use super::signature::{Algebra, g3};
use super::value::{
    Any, Multivector, Object, Rotor, Storage, This, number, one, operand, row, storage, wrap,
};
use super::{batch, single};
use numpy::PyArray1;
use polhode_ga::Graded;
use polhode_ga::g3::functions::Function;
use polhode_ga::product::{Grades, Product};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyInt, PyTuple, PyType};

#[pymethods]
impl Multivector {
    #[new]
    #[classmethod]
    #[pyo3(signature = (*_values, **_named))]
    fn new(
        cls: &Bound<'_, PyType>,
        _values: Any<'_, '_>,
        _named: Option<Any<'_, '_>>,
    ) -> PyResult<Multivector> {
        Err(no_constructor(cls))
    }

    /// Wraps an array (…, K) that must not be written to afterwards; K components of these grades, as bits.
    #[staticmethod]
    #[pyo3(signature = (data, grades, algebra=None))]
    fn _of<'py>(
        py: Python<'py>,
        data: Bound<'py, PyAny>,
        grades: u16,
        algebra: Option<Py<Algebra>>,
    ) -> Object<'py> {
        wrap(py, storage(py, data, Grades(grades), algebra)?, false)
    }

    /// The components of the grades present; for a single value a new array.
    #[getter]
    fn _data<'py>(&self, py: Python<'py>) -> Object<'py> {
        match &self.storage {
            Storage::One(graded) => Ok(PyArray1::from_slice(py, graded.components()).into_any()),
            Storage::Many { data, .. } => Ok(data.bind(py).clone()),
        }
    }

    /// The grades it may hold, as bits.
    #[getter]
    fn _mask(&self) -> u16 {
        match &self.storage {
            Storage::One(graded) => graded.grades().0,
            Storage::Many { grades, .. } => grades.0,
        }
    }

    /// A single value of 3-d space from an array, list or tuple of floats, or integers that floats represent, one for each
    /// component of the grades; None for anything else.
    #[staticmethod]
    fn _of_numbers<'py>(py: Python<'py>, numbers: Any<'_, 'py>, grades: u16) -> Object<'py> {
        match row(numbers).and_then(|(row, count)| Graded::new(&row[..count], Grades(grades))) {
            Some(value) => one(py, value),
            None => Ok(py.None().into_bound(py)),
        }
    }

    /// Whether it is a single value of 3-d space over float64, stored inline.
    #[getter]
    fn _is_one(&self) -> bool {
        self.single().is_some()
    }

    /// The algebra of the value.
    #[getter]
    fn algebra(&self, py: Python<'_>) -> PyResult<Py<Algebra>> {
        match &self.storage {
            Storage::One(_) => Ok(g3(py)?.clone_ref(py)),
            Storage::Many { algebra, .. } => Ok(algebra.clone_ref(py)),
        }
    }

    fn __mul__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        infix(slf, Product::Geometric, other)
    }

    fn __rmul__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        infix_right(slf, Product::Geometric, other)
    }

    /// ``A^B``, the wedge. Python binds ``^`` looser than ``+`` and ``*``; on paper it binds tighter.
    ///
    /// ``a + b ^ c`` is ``(a + b) ^ c``, and ``I * a ^ b`` is ``(I * a) ^ b``. Put brackets around it, or call
    /// the method: ``A.wedge(B)``.
    #[pyo3(signature = (other, /))]
    fn _xor<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        infix(slf, Product::Wedge, other)
    }

    fn __rxor__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        infix_right(slf, Product::Wedge, other)
    }

    /// ``A|B``, the dot. Python binds ``|`` looser than ``+``, ``*`` and ``^``; on paper it binds tighter.
    ///
    /// ``a + b | c`` is ``(a + b) | c``, and ``a | B * c`` is ``a | (B * c)``. Put brackets around it, or call
    /// the method: ``A.dot(B)``.
    #[pyo3(signature = (other, /))]
    fn _or<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        infix(slf, Product::Dot, other)
    }

    fn __ror__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        infix_right(slf, Product::Dot, other)
    }

    fn __add__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        let rows = || zipped(slf, other, |x, y| x + y);
        or_method(sum_of(operand(slf), operand(other)), rows, slf, "_add", (other,))
    }

    fn __radd__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        let rows = || zipped(slf, other, |x, y| x + y);
        or_method(sum_of(operand(other), operand(slf)), rows, slf, "_add", (other,))
    }

    fn __sub__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        let rows = || zipped(slf, other, |x, y| x - y);
        or_method(difference(operand(slf), operand(other)), rows, slf, "_subtract", (other,))
    }

    fn __rsub__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        let rows = || zipped(slf, other, |x, y| y - x);
        or_method(difference(operand(other), operand(slf)), rows, slf, "_subtract_from", (other,))
    }

    fn __truediv__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        let general = || slf.call_method1(intern!(slf.py(), "_divide"), (other,));
        match (slf.get().single(), number(other)) {
            (Some(a), Some(x)) if x != 0.0 => one(slf.py(), a.map(|y| y / x)),
            (None, Some(x)) if x != 0.0 => {
                let rows = single::mapped(slf, |y| y / x).or_else(|| batch::mapped(slf, |y| y / x));
                rows.unwrap_or_else(general)
            }
            _ => general(),
        }
    }

    fn __neg__<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        let rows = || single::mapped(slf, |x| -x).or_else(|| batch::signed(slf, |_| true));
        or_method(negative(operand(slf)), rows, slf, "_negated", ())
    }

    fn __invert__<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        Self::reverse(slf)
    }

    /// ``~A``: reverses the order of all products; grades 2 and 3 change sign (handout eq. 1.28).
    ///
    /// Examples
    /// --------
    /// >>> ~(1 + ph.e1 + (ph.e1 ^ ph.e2) + ph.I)
    /// 1 + e1 - e1∧e2 - I
    fn reverse<'py>(slf: &Bound<'py, Self>) -> Object<'py> {
        let rows = || single::reversed(slf).or_else(|| batch::signed(slf, |k| k % 4 > 1));
        or_method(reversed(operand(slf)), rows, slf, "_reversed", ())
    }

    /// Return the part of one grade or of several, ``grade(2)`` or ``grade(1, 3)``; zeros where absent.
    ///
    /// Examples
    /// --------
    /// >>> A = 1 + 2 * ph.e1 + ph.I
    /// >>> A.grade(1)
    /// 2 e1
    /// >>> A.grade(0, 3)
    /// 1 + I
    #[pyo3(signature = (*grades))]
    fn grade<'py>(slf: &Bound<'py, Self>, grades: &Bound<'py, PyTuple>) -> Object<'py> {
        let single = grades.get_item(0).ok().filter(|_| grades.len() == 1);
        let whole = single.and_then(|k| k.cast_exact::<PyInt>().ok()?.extract::<u16>().ok());
        let general = || slf.call_method1(intern!(slf.py(), "_grade"), grades);
        match (slf.get().single(), whole) {
            (Some(value), Some(k @ 0..=3)) => one(slf.py(), value.with_grades(Grades(1 << k))),
            (None, Some(k)) => single::grade(slf, k).unwrap_or_else(general),
            _ => general(),
        }
    }

    /// Exact equality of all components: a bool, or an array of the batch shape.
    fn __eq__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        match equal(slf, other) {
            Some(same) => Ok(PyBool::new(slf.py(), same).to_owned().into_any()),
            None => slf.call_method1(intern!(slf.py(), "_equals"), (other,)),
        }
    }

    fn __ne__<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>) -> Object<'py> {
        match equal(slf, other) {
            Some(same) => Ok(PyBool::new(slf.py(), !same).to_owned().into_any()),
            None => slf.call_method1(intern!(slf.py(), "_differs"), (other,)),
        }
    }

    /// ``A⁻¹``. Raises a ValueError, with the batch index, where A is singular to rounding (``1 + e1``).
    ///
    /// With ``errors="mask"``, here and in exp, log and sqrt, such rows are NaN: see ``is_finite``.
    ///
    /// Examples
    /// --------
    /// >>> A = 1 + 2 * ph.e1
    /// >>> A * A.inverse()
    /// 1
    /// >>> bool((1 + ph.e1).inverse(errors="mask").is_finite())
    /// False
    #[pyo3(signature = (*, errors="raise"))]
    fn inverse<'py>(slf: &Bound<'py, Self>, errors: &str) -> Object<'py> {
        function(slf, Function::Inverse, errors)
    }

    /// ``exp A``; of a bivector of 3-d space it is a `Rotor`, ``exp(−Bθ/2)`` turning by θ in the plane B.
    ///
    /// A value such as ``e1*e2``, whose scalar is exactly 0, counts as a bivector.
    ///
    /// Examples
    /// --------
    /// >>> R = (-np.pi / 6 * (ph.e1 ^ ph.e2)).exp()  # turns by 60° in the plane e1∧e2
    /// >>> R(ph.e1)
    /// 0.5 e1 + 0.8660254 e2
    #[pyo3(signature = (*, errors="raise"))]
    fn exp<'py>(slf: &Bound<'py, Self>, errors: &str) -> Object<'py> {
        function(slf, Function::Exp, errors)
    }

    /// Return a logarithm: ``exp(log A) = A``.
    ///
    /// The logarithm of an even element (scalar and bivector) is even, so ``log(−1) = π e1∧e2``; others have the
    /// principal one. Raises a ValueError, with the batch index, where A is singular. In other algebras it exists
    /// for positive multiples of rotors and motors.
    ///
    /// Examples
    /// --------
    /// >>> (2 * (ph.e1 ^ ph.e2)).log()
    /// 0.69314718 + 1.5707963 e1∧e2
    #[pyo3(signature = (*, errors="raise"))]
    fn log<'py>(slf: &Bound<'py, Self>, errors: &str) -> Object<'py> {
        function(slf, Function::Log, errors)
    }

    /// Return a square root; of an even element the half-way one, ``√(−1) = e1∧e2``.
    ///
    /// Examples
    /// --------
    /// >>> (3 + 4 * (ph.e1 ^ ph.e2)).sqrt()
    /// 2 + e1∧e2
    #[pyo3(signature = (*, errors="raise"))]
    fn sqrt<'py>(slf: &Bound<'py, Self>, errors: &str) -> Object<'py> {
        function(slf, Function::Sqrt, errors)
    }

    /// ``A B``, the geometric product by name.
    ///
    /// `out` receives the components of the result: a writable float array in C order of their shape (..., K).
    /// The result is a view of it. It must not overlap the factors.
    ///
    /// Examples
    /// --------
    /// >>> ph.e1.geometric_product(ph.e1 + ph.e2)
    /// 1 + e1∧e2
    #[pyo3(signature = (other, *, out=None))]
    fn geometric_product<'py>(
        slf: This<'_, 'py>,
        other: Any<'_, 'py>,
        out: Option<Any<'_, 'py>>,
    ) -> Object<'py> {
        named(slf, Product::Geometric, other, out)
    }

    /// ``A∧B``, the highest grade r + s of the product (handout eq. 1.10). `out` as in `geometric_product`.
    ///
    /// Examples
    /// --------
    /// >>> ph.e1.wedge(ph.e1 + ph.e2)
    /// e1∧e2
    #[pyo3(signature = (other, *, out=None))]
    fn wedge<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>, out: Option<Any<'_, 'py>>) -> Object<'py> {
        named(slf, Product::Wedge, other, out)
    }

    /// ``A·B``, the lowest grade abs(r − s) of the product, scalars included: ``3·a = 3a``.
    ///
    /// Examples
    /// --------
    /// >>> ph.e1.dot(ph.e1 + ph.e2)
    /// 1
    /// >>> ph.e1.dot(ph.e1 ^ ph.e2)
    /// e2
    #[pyo3(signature = (other, *, out=None))]
    fn dot<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>, out: Option<Any<'_, 'py>>) -> Object<'py> {
        named(slf, Product::Dot, other, out)
    }

    /// ``A×B = ½(AB − BA)``; not the vector cross product, which is `cross`.
    ///
    /// Examples
    /// --------
    /// >>> (ph.e1 ^ ph.e2).commutator(ph.e1)
    /// -e2
    #[pyo3(signature = (other, *, out=None))]
    fn commutator<'py>(slf: This<'_, 'py>, other: Any<'_, 'py>, out: Option<Any<'_, 'py>>) -> Object<'py> {
        named(slf, Product::Commutator, other, out)
    }

    /// ``A⌋B``, grade s − r; zero where r > s.
    ///
    /// Examples
    /// --------
    /// >>> ph.e1.left_contraction(ph.e1 ^ ph.e2)
    /// e2
    /// >>> (ph.e1 ^ ph.e2).left_contraction(ph.e1)
    /// 0
    #[pyo3(signature = (other, *, out=None))]
    fn left_contraction<'py>(
        slf: This<'_, 'py>,
        other: Any<'_, 'py>,
        out: Option<Any<'_, 'py>>,
    ) -> Object<'py> {
        named(slf, Product::LeftContraction, other, out)
    }

    /// ``A⌊B``, grade r − s; zero where r < s.
    ///
    /// Examples
    /// --------
    /// >>> (ph.e1 ^ ph.e2).right_contraction(ph.e2)
    /// e1
    #[pyo3(signature = (other, *, out=None))]
    fn right_contraction<'py>(
        slf: This<'_, 'py>,
        other: Any<'_, 'py>,
        out: Option<Any<'_, 'py>>,
    ) -> Object<'py> {
        named(slf, Product::RightContraction, other, out)
    }

    /// ``⟨AB⟩``, grade 0.
    ///
    /// Examples
    /// --------
    /// >>> (1 + ph.e1).scalar_product(2 + 3 * ph.e1)
    /// 5
    #[pyo3(signature = (other, *, out=None))]
    fn scalar_product<'py>(
        slf: This<'_, 'py>,
        other: Any<'_, 'py>,
        out: Option<Any<'_, 'py>>,
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
        _values: Any<'_, '_>,
        _named: Option<Any<'_, '_>>,
    ) -> PyResult<PyClassInitializer<Rotor>> {
        Err(no_constructor(cls))
    }

    /// Wraps rows (…, 4) of rotor components of norm 1 that must not be written to afterwards.
    #[staticmethod]
    fn _from_rows<'py>(py: Python<'py>, data: Bound<'py, PyAny>) -> Object<'py> {
        wrap(py, storage(py, data, Grades::EVEN, None)?, true)
    }

    /// Return the bivector −Bθ/2 with ``exp(log R) = R``, of size at most π; ``log(−1) = π e1∧e2``.
    ///
    /// Examples
    /// --------
    /// >>> ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, 0.5).log()
    /// -0.25 e1∧e2
    #[pyo3(signature = (*, errors="raise"))]
    fn log<'py>(slf: &Bound<'py, Self>, errors: &str) -> Object<'py> {
        if errors != "raise" {
            return function(slf.as_super(), Function::Log, errors);
        }
        let rows = || batch::function(slf.as_super(), Function::Log);
        or_method(logarithm(operand(slf)), rows, slf.as_super(), "_log", ())
    }

    fn __call__<'py>(slf: &Bound<'py, Self>, x: Any<'_, 'py>) -> Object<'py> {
        turned(slf, x).unwrap_or_else(|| slf.call_method1(intern!(slf.py(), "_turn"), (x,)))
    }

    /// ``R X ~R``: turns a value of any grade (handout eq. 2.4, 2.6); scalars and trivectors stay.
    ///
    /// `out` receives the components of the result: a writable float array in C order of their shape. The
    /// result is a view of it. It must not overlap the operands.
    ///
    /// Examples
    /// --------
    /// >>> R = ph.Rotor.from_plane_angle(ph.e1 ^ ph.e2, np.pi / 3)
    /// >>> R.apply(ph.e1)
    /// 0.5 e1 + 0.8660254 e2
    #[pyo3(signature = (x, *more, out=None, **named), text_signature = "($self, x, *, out=None)")]
    fn apply<'py>(
        slf: &Bound<'py, Self>,
        x: Any<'_, 'py>,
        more: &Bound<'py, PyTuple>,
        out: Option<Any<'_, 'py>>,
        named: Option<&Bound<'py, PyDict>>,
    ) -> Object<'py> {
        if named.is_some() || !more.is_empty() {
            return slf.call_method("_misapplied", more, named);
        }
        let here = if out.is_none() { turned(slf, x) } else { None };
        here.unwrap_or_else(|| slf.call_method1(intern!(slf.py(), "_turn"), (x, out)))
    }
}

/// `f` of each component of single values of any algebra, or of batches.
fn zipped<'py>(
    left: This<'_, 'py>,
    right: Any<'_, 'py>,
    f: impl Copy + Fn(f64, f64) -> f64,
) -> Option<Object<'py>> {
    single::zipped(left, right, f).or_else(|| batch::zipped(left, right, f))
}

fn no_constructor(cls: &Bound<'_, PyType>) -> PyErr {
    let name = cls.name().map_or_else(|_| "Multivector".into(), |name| name.to_string());
    let constructors = match &*name {
        "Rotor" => {
            "Rotor.from_quaternion, from_matrix, from_rotation_vector, from_plane_angle or another of its from_… constructors"
        }
        _ => "ph.scalar, ph.vector, ph.bivector, ph.trivector or ph.multivector",
    };
    PyTypeError::new_err(format!("{name} has no public constructor; use {constructors}"))
}
