//! The algebra over arrays of rows of components.

use super::signature::Algebra;
use crate::support::arrays::{
    Out, Rows, RowsToFill, bad, map_long_rows, map_rows, numbers, numbers_to_fill, place, threads,
};
use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use polhode_ga::g3::functions::Function;
use polhode_ga::g3::pauli;
use polhode_ga::general::Calculus;
use polhode_ga::product::Grades;
use polhode_ga::rows::compose::compose;
use polhode_ga::rows::product::{Element, turn_threads};
use polhode_ga::rows::rotor_functions;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::G3;
use polhode_ga::{MathError, Multivector, Rotor, Vector};
use pyo3::prelude::*;

/// One row, or a row for each.
fn check_rows(length: usize, size: usize, rows: usize) -> PyResult<()> {
    if length == size || length == rows * size {
        return Ok(());
    }
    Err(bad(format!("an operand has {length} numbers, expected {size} or {}", rows * size)))
}

/// Fills `out` with a product of rows of an algebra: `(n, K)` numbers of the grades given as bits. A factor
/// of one row meets every row of the other. All three hold float64, or float32.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn product<'py>(
    py: Python<'py>,
    algebra: &Algebra,
    name: &str,
    a: &Bound<'py, PyAny>,
    a_grades: u16,
    b: &Bound<'py, PyAny>,
    b_grades: u16,
    out: &Bound<'py, PyAny>,
) -> PyResult<()> {
    let plan = algebra.plan(name, a_grades, b_grades)?;
    if is_single(out) {
        return fill::<f32>(py, plan.sizes, [a, b, out], |t, a, b, out| plan.run_threads(t, a, b, out));
    }
    fill::<f64>(py, plan.sizes, [a, b, out], |t, a, b, out| plan.run_threads(t, a, b, out))
}

/// Whether an array is of float32.
fn is_single(array: &Bound<'_, PyAny>) -> bool {
    array.cast::<PyArrayDyn<f32>>().is_ok()
}

/// Fills an array from the rows of two others.
fn fill<T: Element + numpy::Element>(
    py: Python<'_>,
    (na, nb, nout): (usize, usize, usize),
    [a, b, out]: [&Bound<'_, PyAny>; 3],
    work: impl Fn(Threads, &[T], &[T], &mut [T]) + Sync,
) -> PyResult<()> {
    let (a, b): (Rows<'_, T>, Rows<'_, T>) = (a.extract()?, b.extract()?);
    let mut out: RowsToFill<'_, T> = out.extract()?;
    let (a, b, out) = (numbers(&a)?, numbers(&b)?, numbers_to_fill(&mut out)?);
    let rows = out.len() / nout;
    for (length, size) in [(a.len(), na), (b.len(), nb)] {
        check_rows(length, size, rows)?;
    }
    let threads = threads(out.len())?;
    py.detach(|| work(threads, a, b, out));
    Ok(())
}

/// The functions of an algebra, for components rounded to float32 or not.
fn calculus(algebra: &Algebra, single: bool) -> &Calculus {
    if single { algebra.single_calculus() } else { algebra.calculus() }
}

/// `inverse`, `exp`, `log` or `sqrt` of rows of all components of an algebra, `single` if they were float32.
#[pyfunction]
pub(crate) fn function<'py>(
    py: Python<'py>,
    algebra: &Algebra,
    name: &str,
    m: Rows<'py>,
    single: bool,
) -> Out<'py> {
    let f = Function::from_name(name).ok_or_else(|| bad(format!("unknown function {name}")))?;
    if algebra.is_g3() {
        return map_rows(py, &m, |c| f.apply(Multivector(c)).map(|m| m.0));
    }
    let calculus = calculus(algebra, single);
    map_long_rows(py, [&m], |rows| calculus.apply(f, rows[0]))
}

/// The join or the meet of blades, rows of all components of an algebra, `single` if they were float32.
#[pyfunction]
pub(crate) fn subspaces<'py>(
    py: Python<'py>,
    algebra: &Algebra,
    name: &str,
    a: Rows<'py>,
    b: Rows<'py>,
    single: bool,
) -> Out<'py> {
    let calculus = calculus(algebra, single);
    match name {
        "join" => map_long_rows(py, [&a, &b], |rows| calculus.join(rows[0], rows[1])),
        "meet" => map_long_rows(py, [&a, &b], |rows| calculus.meet(rows[0], rows[1])),
        _ => Err(bad(format!("unknown operation {name}"))),
    }
}

/// Euclidean norms of rows of up to eight numbers, without overflow on the way; the last axis has length 1.
#[pyfunction]
pub(crate) fn norm<'py>(py: Python<'py>, m: Rows<'py>) -> Out<'py> {
    match m.shape().last() {
        Some(1) => norms::<1>(py, &m),
        Some(2) => norms::<2>(py, &m),
        Some(3) => norms::<3>(py, &m),
        Some(4) => norms::<4>(py, &m),
        Some(5) => norms::<5>(py, &m),
        Some(6) => norms::<6>(py, &m),
        Some(7) => norms::<7>(py, &m),
        _ => norms::<8>(py, &m),
    }
}

fn norms<'py, const K: usize>(py: Python<'py>, m: &Rows<'py>) -> Out<'py> {
    map_rows(py, m, |c: [f64; K]| {
        let mut full = [0.0; 8];
        full[..K].copy_from_slice(&c);
        Ok::<_, MathError>([Multivector(full).norm()])
    })
}

/// Rotors from components, normalised.
#[pyfunction]
pub(crate) fn rotor_from_components<'py>(py: Python<'py>, c: Rows<'py>) -> Out<'py> {
    map_rows(py, &c, |c| Rotor::from_components(c).map(Rotor::components))
}

/// Rotors from rows of plane (3) and angle.
#[pyfunction]
pub(crate) fn rotor_from_plane_angle<'py>(py: Python<'py>, c: Rows<'py>) -> Out<'py> {
    map_rows(py, &c, |[x, y, z, angle]: [f64; 4]| {
        Rotor::from_plane_angle(Vector([x, y, z]).undual(), angle).map(Rotor::components)
    })
}

/// Rotors from rows of two vectors, turning the first to the second.
#[pyfunction]
pub(crate) fn rotor_from_vectors<'py>(py: Python<'py>, ab: Rows<'py>) -> Out<'py> {
    map_rows(py, &ab, |[x, y, z, u, v, w]: [f64; 6]| {
        Rotor::from_vectors(Vector([x, y, z]), Vector([u, v, w])).map(Rotor::components)
    })
}

/// Rotors from matrices, nine numbers a row.
#[pyfunction]
pub(crate) fn rotor_from_matrix<'py>(py: Python<'py>, m: Rows<'py>) -> Out<'py> {
    map_rows(py, &m, |m: [f64; 9]| {
        let row = |i: usize| [m[3 * i], m[3 * i + 1], m[3 * i + 2]];
        Rotor::from_matrix([row(0), row(1), row(2)]).map(Rotor::components)
    })
}

/// Rotors from rotation vectors.
#[pyfunction]
pub(crate) fn rotor_from_rotation_vector<'py>(py: Python<'py>, v: Rows<'py>) -> Out<'py> {
    map_rows(py, &v, |v| Rotor::from_rotation_vector(Vector(v)).map(Rotor::components))
}

/// Rotors from quaternions (w, x, y, z).
#[pyfunction]
pub(crate) fn rotor_from_quaternion<'py>(py: Python<'py>, q: Rows<'py>) -> Out<'py> {
    map_rows(py, &q, |q| Rotor::from_quaternion_wxyz(q).map(Rotor::components))
}

/// Quaternions (w, x, y, z) of rotors.
#[pyfunction]
pub(crate) fn rotor_to_quaternion<'py>(py: Python<'py>, r: Rows<'py>) -> Out<'py> {
    map_rows(py, &r, |c| Ok::<_, MathError>(Rotor::from_unit_components(c).to_quaternion_wxyz()))
}

/// Matrices of rotors, nine numbers a row.
#[pyfunction]
pub(crate) fn rotor_to_matrix<'py>(py: Python<'py>, r: Rows<'py>) -> Out<'py> {
    map_rows(py, &r, |c| {
        let m = Rotor::from_unit_components(c).to_matrix();
        Ok::<[f64; 9], MathError>(std::array::from_fn(|i| m[i / 3][i % 3]))
    })
}

/// Rotation vectors of rotors.
#[pyfunction]
pub(crate) fn rotor_to_rotation_vector<'py>(py: Python<'py>, r: Rows<'py>) -> Out<'py> {
    map_rows(py, &r, |c| Ok::<_, MathError>(Rotor::from_unit_components(c).to_rotation_vector().0))
}

/// Fills `out` with the rotors `exp B` of rows of bivectors; both hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_exp(b: &Bound<'_, PyAny>, out: &Bound<'_, PyAny>) -> PyResult<()> {
    if is_single(out) {
        return map_to::<f32>((3, 4), b, out, rotor_functions::exp);
    }
    map_to::<f64>((3, 4), b, out, rotor_functions::exp)
}

/// Fills `out` with the bivectors −Bθ/2 of rows of rotors; both hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_log(r: &Bound<'_, PyAny>, out: &Bound<'_, PyAny>) -> PyResult<()> {
    if is_single(out) {
        return map_to::<f32>((4, 3), r, out, rotor_functions::log);
    }
    map_to::<f64>((4, 3), r, out, rotor_functions::log)
}

/// Fills `out` with `exp(n log R)` of rows of rotors and of one number n each; all hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_power<'py>(
    r: &Bound<'py, PyAny>,
    n: &Bound<'py, PyAny>,
    out: &Bound<'py, PyAny>,
) -> PyResult<()> {
    if is_single(out) {
        let n: Rows<'_, f32> = n.extract()?;
        let n = numbers(&n)?;
        return map_to::<f32>((4, 4), r, out, |t, r, out| rotor_functions::power(t, r, n, out));
    }
    let n: Rows<'_> = n.extract()?;
    let n = numbers(&n)?;
    map_to::<f64>((4, 4), r, out, |t, r, out| rotor_functions::power(t, r, n, out))
}

/// Fills an array from the rows of another of the same batch shape; an error names the batch index of the first
/// row that is not finite.
fn map_to<T: Element + numpy::Element>(
    (size, filled): (usize, usize),
    input: &Bound<'_, PyAny>,
    out: &Bound<'_, PyAny>,
    work: impl Fn(Threads, &[T], &mut [T]) -> Result<(), usize> + Sync,
) -> PyResult<()> {
    let input: Rows<'_, T> = input.extract()?;
    let batch = input.shape().split_last().map_or(&[][..], |(_, batch)| batch);
    let mut to: RowsToFill<'_, T> = out.extract()?;
    let (from, to) = (numbers(&input)?, numbers_to_fill(&mut to)?);
    check_rows(from.len(), size, to.len() / filled)?;
    let threads = threads(to.len())?;
    let failed = |row| bad(format!("{}{}", place(row, batch), MathError::NotFinite));
    out.py().detach(|| work(threads, from, to)).map_err(failed)
}

/// Unit planes (3) and angles of rotors.
#[pyfunction]
pub(crate) fn rotor_plane_angle<'py>(py: Python<'py>, r: Rows<'py>) -> Out<'py> {
    map_rows(py, &r, |c| {
        let (plane, angle) = Rotor::from_unit_components(c).plane_angle();
        let [x, y, z] = plane.0;
        Ok::<_, MathError>([x, y, z, angle])
    })
}

/// Fills `out` with `R X ~R` for rows of rotors (n, 4) and of values of these grades; one row of either meets
/// every row of the other. All three hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_apply<'py>(
    py: Python<'py>,
    rotors: &Bound<'py, PyAny>,
    values: &Bound<'py, PyAny>,
    grades: u16,
    out: &Bound<'py, PyAny>,
) -> PyResult<()> {
    if grades == 0 || grades >= 16 {
        return Err(bad("a value of 3-d space must have some of the grades 0 to 3"));
    }
    let grades = Grades(grades);
    let size = grades.indices(&G3).len();
    let (sizes, arrays) = ((4, size, size), [rotors, values, out]);
    if is_single(out) {
        return fill::<f32>(py, sizes, arrays, |t, r, v, out| turn_threads(t, r, v, grades, out));
    }
    fill::<f64>(py, sizes, arrays, |t, r, v, out| turn_threads(t, r, v, grades, out))
}

/// Fills `out` with the products of rows of rotors (n, 4), of norm 1; one row of either meets every row of
/// the other. All three hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_compose<'py>(
    py: Python<'py>,
    left: &Bound<'py, PyAny>,
    right: &Bound<'py, PyAny>,
    out: &Bound<'py, PyAny>,
) -> PyResult<()> {
    let (sizes, arrays) = ((4, 4, 4), [left, right, out]);
    if is_single(out) {
        return fill::<f32>(py, sizes, arrays, compose);
    }
    fill::<f64>(py, sizes, arrays, compose)
}

/// 2×2 complex matrices, eight numbers a row, of multivectors.
#[pyfunction]
pub(crate) fn to_pauli<'py>(py: Python<'py>, m: Rows<'py>) -> Out<'py> {
    map_rows(py, &m, |c: [f64; 8]| {
        let p = pauli::to_pauli(Multivector(c));
        Ok::<[f64; 8], MathError>(std::array::from_fn(|i| p[i / 4][i / 2 % 2][i % 2]))
    })
}

/// Multivectors of 2×2 complex matrices, eight numbers a row.
#[pyfunction]
pub(crate) fn from_pauli<'py>(py: Python<'py>, p: Rows<'py>) -> Out<'py> {
    map_rows(py, &p, |p: [f64; 8]| {
        let matrix = [[[p[0], p[1]], [p[2], p[3]]], [[p[4], p[5]], [p[6], p[7]]]];
        Ok::<_, MathError>(pauli::from_pauli(matrix).0)
    })
}
