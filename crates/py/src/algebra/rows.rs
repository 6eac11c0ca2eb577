//! The algebra over arrays of rows of components.

use super::signature::Algebra;
use super::value::Any;
use crate::support::arrays::{
    Out, Rows, RowsToFill, bad, fill_rows, map_long_rows, map_rows, numbers, numbers_to_fill, place, threads,
};
use crate::support::interrupts::in_pieces;
use numpy::{PyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use polhode_ga::g3::functions::Function;
use polhode_ga::g3::pauli;
use polhode_ga::product::Grades;
use polhode_ga::rows::compose::compose;
use polhode_ga::rows::motors::{self, Motors};
use polhode_ga::rows::product::{Element, turn};
use polhode_ga::rows::rotor_functions;
use polhode_ga::rows::signs;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::G3;
use polhode_ga::{Bivector, MathError, Multivector, Rotor, Vector};
use pyo3::prelude::*;
use std::array::from_fn;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// The value of an expression with `T` the type of the numbers of an array: `f32`, or else `f64`.
macro_rules! by_type {
    ($array:expr, $T:ident => $value:expr) => {
        if $array.cast::<PyArrayDyn<f32>>().is_ok() {
            type $T = f32;
            $value
        } else {
            type $T = f64;
            $value
        }
    };
}

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
    a: Any<'_, 'py>,
    a_grades: u16,
    b: Any<'_, 'py>,
    b_grades: u16,
    out: Any<'_, 'py>,
) -> PyResult<()> {
    let plan = algebra.plan(name, a_grades, b_grades)?;
    by_type!(out, T => fill::<T>(py, plan.sizes, [a, b, out], |t, a, b, out| plan.run(t, a, b, out)))
}

/// Fills `out` with rows of components times their `signs`, 1 or −1. All three hold float64, or float32.
#[pyfunction]
pub(crate) fn with_signs<'py>(
    py: Python<'py>,
    rows: Any<'_, 'py>,
    signs: Any<'_, 'py>,
    out: Any<'_, 'py>,
) -> PyResult<()> {
    let size = signs.len()?;
    by_type!(out, T => fill::<T>(py, (size, size, size), [rows, signs, out], signs::with_signs))
}

/// Fills an array from the rows of two others.
fn fill<T: Element + numpy::Element>(
    py: Python<'_>,
    (na, nb, nout): (usize, usize, usize),
    [a, b, out]: [Any<'_, '_>; 3],
    work: impl Fn(Threads, &[T], &[T], &mut [T]) + Sync,
) -> PyResult<()> {
    let (a, b): (Rows<'_, T>, Rows<'_, T>) = (a.extract()?, b.extract()?);
    let mut out: RowsToFill<'_, T> = out.extract()?;
    let (a, b, out) = (numbers(&a)?, numbers(&b)?, numbers_to_fill(&mut out)?);
    fill_numbers(py, (na, nb, nout), a, b, out, work)
}

/// Results of fewer numbers are computed at once, without a check for signals.
const FEW: usize = 1 << 12;

/// Fills rows from those of two others, of numbers in C order. Python may interrupt.
pub(super) fn fill_numbers<T: Element>(
    py: Python<'_>,
    (na, nb, nout): (usize, usize, usize),
    a: &[T],
    b: &[T],
    out: &mut [T],
    work: impl Fn(Threads, &[T], &[T], &mut [T]) + Sync,
) -> PyResult<()> {
    let rows = out.len() / nout;
    for (length, size) in [(a.len(), na), (b.len(), nb)] {
        check_rows(length, size, rows)?;
    }
    if rows == 0 {
        return Ok(());
    }
    // A number of a result takes as many operations as the smaller factor has numbers, or fewer.
    let each = (nout * na.min(nb)).max(1);
    if rows.saturating_mul(each) < FEW {
        work(Threads::ONE, a, b, out);
        return Ok(());
    }
    let threads = threads(out.len())?;
    in_pieces(py, rows, (WORK / each).max(1), |piece| {
        let (a, b) = (part(a, na, rows, &piece), part(b, nb, rows, &piece));
        py.detach(|| work(threads, a, b, &mut out[nout * piece.start..nout * piece.end]));
        Ok(())
    })
}

/// Operations of some milliseconds.
const WORK: usize = 1 << 23;

/// Some rows of an operand of `rows` rows; all of one that has a single row.
fn part<'a, T>(data: &'a [T], size: usize, rows: usize, piece: &Range<usize>) -> &'a [T] {
    if data.len() == rows * size { &data[size * piece.start..size * piece.end] } else { data }
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
    let calculus = algebra.calculus(single);
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
    let calculus = algebra.calculus(single);
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
    let full = |c: [f64; K]| Multivector(from_fn(|i| c.get(i).copied().unwrap_or(0.0)));
    map_rows(py, m, |c| Ok::<_, MathError>([full(c).norm()]))
}

/// The units and the norms in them of rows of components of these grades, as [`Algebra::unit_and_size`].
#[pyfunction]
pub(crate) fn units_and_sizes<'py>(
    py: Python<'py>,
    algebra: &Algebra,
    grades: u16,
    m: Rows<'py>,
) -> Out<'py> {
    let signs = algebra.reverse_squares(algebra.check(grades)?);
    let size = signs.len();
    let (shape, data) = (m.shape(), numbers(&m)?);
    if shape.last() != Some(&size) || size == 0 {
        return Err(bad(format!("expected rows of {size} components, got the shape {shape:?}")));
    }
    fill_rows(py, (&shape[..shape.len() - 1], 2), 1 << 10, |row, out: &mut [f64]| {
        let (unit, norm) = Algebra::unit_and_size(&data[row * size..(row + 1) * size], &signs);
        out.copy_from_slice(&[unit, norm]);
        Ok::<(), MathError>(())
    })
}

/// Functions of Python that apply a function of one row to every row.
macro_rules! row_functions {
    ($($(#[$doc:meta])* $name:ident($row:ident: $width:literal) $value:expr;)*) => { $(
        $(#[$doc])*
        #[pyfunction]
        pub(crate) fn $name<'py>(py: Python<'py>, $row: Rows<'py>) -> Out<'py> {
            map_rows(py, &$row, |$row: [f64; $width]| -> Result<_, MathError> { $value })
        }
    )* };
}

row_functions! {
    /// Rotors from components, normalised.
    rotor_from_components(c: 4) Rotor::from_components(c).map(Rotor::components);

    /// Rotors from rows of plane (3) and angle.
    rotor_from_plane_angle(c: 4) {
        let [x, y, z, angle] = c;
        Rotor::from_plane_angle(Bivector([x, y, z]), angle).map(Rotor::components)
    };

    /// Rotors from rows of two vectors, turning the first to the second.
    rotor_from_vectors(ab: 6) {
        let [x, y, z, u, v, w] = ab;
        Rotor::from_vectors(Vector([x, y, z]), Vector([u, v, w])).map(Rotor::components)
    };

    /// Rotors from matrices, nine numbers a row.
    rotor_from_matrix(m: 9) {
        let rows = from_fn(|i| from_fn(|j| m[3 * i + j]));
        Rotor::from_matrix(rows).map(Rotor::components)
    };

    /// Rotors from rotation vectors.
    rotor_from_rotation_vector(v: 3) Rotor::from_rotation_vector(Vector(v)).map(Rotor::components);

    /// Rotors from quaternions (w, x, y, z).
    rotor_from_quaternion(q: 4) Rotor::from_quaternion_wxyz(q).map(Rotor::components);

    /// Quaternions (w, x, y, z) of rotors.
    rotor_to_quaternion(r: 4) Ok(Rotor::from_unit_components(r).to_quaternion_wxyz());

    /// Matrices of rotors, nine numbers a row.
    rotor_to_matrix(r: 4) {
        let m = Rotor::from_unit_components(r).to_matrix();
        Ok::<[f64; 9], _>(from_fn(|i| m[i / 3][i % 3]))
    };

    /// Rotation vectors of rotors.
    rotor_to_rotation_vector(r: 4) Ok(Rotor::from_unit_components(r).to_rotation_vector().0);

    /// Angles between the attitudes of two rotors; the last axis has length 1.
    rotor_distance(rs: 8) {
        let [from, to] = [0, 4].map(|first| Rotor::from_unit_components(from_fn(|k| rs[first + k])));
        Ok([from.distance(to)])
    };

    /// Unit planes (3) and angles of rotors.
    rotor_plane_angle(r: 4) {
        let (Bivector([x, y, z]), angle) = Rotor::from_unit_components(r).plane_angle();
        Ok([x, y, z, angle])
    };

    /// 2×2 complex matrices, eight numbers a row, of multivectors.
    to_pauli(m: 8) {
        let p = pauli::to_pauli(Multivector(m));
        Ok::<[f64; 8], _>(from_fn(|i| p[i / 4][i / 2 % 2][i % 2]))
    };

    /// Multivectors of 2×2 complex matrices, eight numbers a row.
    from_pauli(p: 8) {
        let matrix = [[[p[0], p[1]], [p[2], p[3]]], [[p[4], p[5]], [p[6], p[7]]]];
        Ok(pauli::from_pauli(matrix).0)
    };
}

/// Fills `out` with `inverse`, `exp`, `log` or `sqrt` of rows of motors, or with `exp` of rows of their bivectors; both hold
/// float64, or float32.
#[pyfunction]
pub(crate) fn motor_function(
    algebra: &Algebra,
    name: &str,
    m: Any<'_, '_>,
    out: Any<'_, '_>,
) -> PyResult<()> {
    let f = Function::from_name(name).ok_or_else(|| bad(format!("unknown function {name}")))?;
    let motors = motors(algebra)?;
    let size = if f == Function::Exp { motors::BIVECTOR } else { motors::SIZE };
    by_type!(out, T => map_to::<T>(
        (size, motors::SIZE), m, out,
        |row| motors.error(f, row),
        |t, m, out, _| motors.run(f, t, m, out),
    ))
}

/// Fills `out` with `M/√(M ~M)` of rows of even elements; both hold float64, or float32. An error if the norm of one is 0,
/// or a row is not finite.
#[pyfunction]
pub(crate) fn motor_normalize(algebra: &Algebra, m: Any<'_, '_>, out: Any<'_, '_>) -> PyResult<()> {
    let motors = motors(algebra)?;
    by_type!(out, T => map_to::<T>(
        (motors::SIZE, motors::SIZE), m, out,
        |_| MathError::NoDirection,
        |t, m, out, _| motors.normalize(t, m, out),
    ))
}

fn motors(algebra: &Algebra) -> PyResult<&Motors> {
    algebra.motors().ok_or_else(|| bad("the algebra has no motors of 3-d space"))
}

/// Fills `out` with the rotors `exp B` of rows of bivectors; both hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_exp(b: Any<'_, '_>, out: Any<'_, '_>) -> PyResult<()> {
    by_type!(out, T => map_to::<T>((3, 4), b, out, |_| MathError::NotFinite, |t, b, out, _| rotor_functions::exp(t, b, out)))
}

/// Fills `out` with the bivectors −Bθ/2 of rows of rotors; both hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_log(r: Any<'_, '_>, out: Any<'_, '_>) -> PyResult<()> {
    by_type!(out, T => map_to::<T>((4, 3), r, out, |_| MathError::NotFinite, |t, r, out, _| rotor_functions::log(t, r, out)))
}

/// Fills `out` with `exp(n log R)` of rows of rotors and of one number n each; all hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_power<'py>(r: Any<'_, 'py>, n: Any<'_, 'py>, out: Any<'_, 'py>) -> PyResult<()> {
    by_type!(out, T => {
        let n: Rows<'_, T> = n.extract()?;
        let n = numbers(&n)?;
        let rows = out.cast::<PyUntypedArray>()?.len() / 4;
        check_rows(n.len(), 1, rows)?;
        map_to::<T>((4, 4), r, out, |_| MathError::NotFinite, |t, r, out, piece| {
            rotor_functions::power(t, r, part(n, 1, rows, &piece), out)
        })
    })
}

/// Fills an array from the rows of another of the same batch shape; an error says why the first row without a value has
/// none, and names its batch index.
fn map_to<T: Element + numpy::Element>(
    (size, filled): (usize, usize),
    input: Any<'_, '_>,
    out: Any<'_, '_>,
    why: impl Fn(&[T]) -> MathError,
    work: impl Fn(Threads, &[T], &mut [T], Range<usize>) -> Result<(), usize> + Sync,
) -> PyResult<()> {
    let input: Rows<'_, T> = input.extract()?;
    let batch = input.shape().split_last().map_or(&[][..], |(_, batch)| batch);
    let mut to: RowsToFill<'_, T> = out.extract()?;
    let (from, to) = (numbers(&input)?, numbers_to_fill(&mut to)?);
    let rows = to.len() / filled;
    check_rows(from.len(), size, rows)?;
    let threads = threads(to.len())?;
    let py = out.py();
    in_pieces(py, rows, 1 << 17, |piece| {
        let first = piece.start;
        let (from, to) = (part(from, size, rows, &piece), &mut to[filled * first..filled * piece.end]);
        py.detach(|| work(threads, from, to, piece)).map_err(|row| {
            let of = if from.len() == size { from } else { &from[size * row..size * (row + 1)] };
            bad(format!("{}{}", place(first + row, batch), why(of)))
        })
    })
}

/// Fills `out` with `R X ~R` for rows of rotors (n, 4) and of values of these grades; one row of either meets
/// every row of the other. All three hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_apply<'py>(
    py: Python<'py>,
    rotors: Any<'_, 'py>,
    values: Any<'_, 'py>,
    grades: u16,
    out: Any<'_, 'py>,
) -> PyResult<()> {
    if grades == 0 || grades >= 16 {
        return Err(bad("a value of 3-d space must have some of the grades 0 to 3"));
    }
    let grades = Grades(grades);
    let size = grades.indices(&G3).len();
    let (sizes, arrays) = ((4, size, size), [rotors, values, out]);
    by_type!(out, T => fill::<T>(py, sizes, arrays, |t, r, v, out| turn(t, r, v, grades, out)))
}

/// Fills `out` with `V X V⁻¹` for rows of versors and of values of these grades, with the grade involution of X if the
/// versors are odd; one row of either meets every row of the other. All three hold float64, or float32. False if some row
/// is not a versor to half of its digits, or the core cannot recognise versors of this algebra.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn versor_apply<'py>(
    py: Python<'py>,
    algebra: &Algebra,
    versors: Any<'_, 'py>,
    versor_grades: u16,
    odd: bool,
    values: Any<'_, 'py>,
    value_grades: u16,
    out: Any<'_, 'py>,
) -> PyResult<bool> {
    let (v, x) = (algebra.check(versor_grades)?, algebra.check(value_grades)?);
    let Some(action) = algebra.action(v, odd, x) else { return Ok(false) };
    let [nv, nx] = [v, x].map(|grades| grades.indices(&algebra.table).len());
    let (sizes, arrays, done) = ((nv, nx, nx), [versors, values, out], AtomicBool::new(true));
    by_type!(out, T => fill::<T>(py, sizes, arrays, |threads, v, x, out| {
        done.fetch_and(action.run(threads, v, x, out), Ordering::Relaxed);
    }))?;
    Ok(done.into_inner())
}

/// Fills `out` with the products of rows of rotors (n, 4), of norm 1; one row of either meets every row of
/// the other. All three hold float64, or float32.
#[pyfunction]
pub(crate) fn rotor_compose<'py>(
    py: Python<'py>,
    left: Any<'_, 'py>,
    right: Any<'_, 'py>,
    out: Any<'_, 'py>,
) -> PyResult<()> {
    by_type!(out, T => fill::<T>(py, (4, 4, 4), [left, right, out], compose))
}
