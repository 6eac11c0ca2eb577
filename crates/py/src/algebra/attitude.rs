//! Rotors from parameters and parameters of rotors: single values and small batches of float64.
//!
//! Each function returns `None` for anything else, and for values that are errors: the Python half, which takes ten times as
//! long, converts or reports them.

use super::batch::{Kind, Rows, filled};
use super::signature::g3;
use super::value::{Any, one_rotor, plain_array, row};
use crate::support::arrays::fill_rows;
use crate::support::pool;
use numpy::{PyArrayMethods, PyUntypedArrayMethods};
use polhode_ga::g3::attitude::EulerSequence;
use polhode_ga::product::Grades;
use polhode_ga::rows::rotor_functions::power;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, MathError, Rotor, Vector};
use pyo3::prelude::*;
use pyo3::types::PyInt;
use std::array::from_fn;

/// Larger batches are left to the Python half, which lets threads share them.
const FEW: usize = 1 << 12;

type Found<'py> = PyResult<Option<Bound<'py, PyAny>>>;

/// The numbers and the whole shape of an argument.
struct Given {
    numbers: Vec<f64>,
    shape: Vec<usize>,
}

impl Given {
    /// An array of float64, a list or tuple of numbers, a number, or a value of this grade; `None` for anything else.
    fn new(x: Any<'_, '_>, grade: Option<Grades>) -> Option<Given> {
        if let Some((row, count)) = row(x) {
            return Some(Given { numbers: row[..count].to_vec(), shape: vec![count] });
        }
        if let Some(array) = plain_array(x) {
            if array.len() > FEW {
                return None;
            }
            let numbers = array.try_readonly().ok()?.as_slice().ok()?.to_vec();
            return Some(Given { numbers, shape: array.shape().to_vec() });
        }
        // Larger integers are exact in the Python half.
        if let Ok(whole) = x.cast_exact::<PyInt>()
            && whole.extract().map_or(true, |n: i64| n.unsigned_abs() > 1 << 53)
        {
            return None;
        }
        let rows = Rows::operand(x.as_borrowed()).filter(|rows| rows.numbers.len() <= FEW)?;
        let (mut shape, numbers) = (rows.shape.to_vec(), rows.numbers.to_vec());
        if rows.algebra.is_some() {
            if Some(rows.grades) != grade || !rows.is_of(g3(x.py()).ok()?) {
                return None;
            }
            shape.push(3);
        }
        Some(Given { numbers, shape })
    }

    /// The shape of its batch, if its last axes are these.
    fn batch(&self, last: &[usize]) -> Option<&[usize]> {
        self.shape.strip_suffix(last)
    }
}

/// Rotors of one row of numbers each.
fn rotors<'py>(
    py: Python<'py>,
    batch: &[usize],
    rotor: impl Fn(usize) -> Result<Rotor, MathError>,
) -> Found<'py> {
    if batch.is_empty() {
        return rotor(0).ok().map(|rotor| one_rotor(py, rotor)).transpose();
    }
    let kind = Kind { shape: batch, size: 4, grades: Grades::EVEN, unit: true, algebra: g3(py)? };
    if batch.contains(&0) {
        return Ok(None); // the Python half checks the arguments
    }
    let mut all = true;
    let value = filled(py, kind, |out| {
        for (row, out) in out.as_chunks_mut().0.iter_mut().enumerate() {
            match rotor(row) {
                Ok(rotor) => *out = rotor.components(),
                Err(_) => all = false,
            }
        }
        Ok(())
    })?;
    Ok(all.then_some(value))
}

/// Rotors from rows of N numbers whose last axes are `last`.
fn from_rows<'py, const N: usize>(
    (x, grade): (Any<'_, 'py>, Option<Grades>),
    last: &[usize],
    rotor: impl Fn([f64; N]) -> Result<Rotor, MathError>,
) -> Found<'py> {
    let Some(given) = Given::new(x, grade) else { return Ok(None) };
    let Some(batch) = given.batch(last) else { return Ok(None) };
    let rows = given.numbers.as_chunks::<N>().0;
    rotors(x.py(), batch, |row| rotor(rows[row]))
}

/// Rotors from `components`, `wxyz` or `xyzw` (…, 4), a `rotation vector` (…, 3) or a `matrix` (…, 3, 3).
#[pyfunction]
pub(crate) fn rotor_from<'py>(form: &str, x: Any<'_, 'py>) -> Found<'py> {
    match form {
        "components" => from_rows((x, None), &[4], Rotor::from_components),
        "wxyz" => from_rows((x, None), &[4], Rotor::from_quaternion_wxyz),
        "xyzw" => from_rows((x, None), &[4], |[x, y, z, w]| Rotor::from_quaternion_wxyz([w, x, y, z])),
        "rotation vector" => {
            from_rows((x, Some(Grades::VECTOR)), &[3], |v| Rotor::from_rotation_vector(Vector(v)))
        }
        "matrix" => {
            from_rows::<9>((x, None), &[3, 3], |m| Rotor::from_matrix(from_fn(|i| from_fn(|j| m[3 * i + j]))))
        }
        _ => Ok(None),
    }
}

/// The shape of two batches of which one may be a single value.
fn together<'a>(a: Option<&'a [usize]>, b: Option<&'a [usize]>) -> Option<&'a [usize]> {
    let (a, b) = (a?, b?);
    match (a.is_empty(), b.is_empty()) {
        (false, false) => (a == b).then_some(a),
        (true, _) => Some(b),
        _ => Some(a),
    }
}

/// Rotors that turn by angles (…), times `unit`, in planes (…, 3); `grade` is that of values for the planes or their axes.
/// Either may be a single one for all of the other.
#[pyfunction]
pub(crate) fn rotor_from_turn<'py>(
    plane: Any<'_, 'py>,
    grade: u16,
    angle: Any<'_, 'py>,
    unit: f64,
) -> Found<'py> {
    let (Some(planes), Some(angles)) = (Given::new(plane, Some(Grades(1 << grade))), Given::new(angle, None))
    else {
        return Ok(None);
    };
    let Some(batch) = together(planes.batch(&[3]), angles.batch(&[])) else { return Ok(None) };
    let (planes, angles) = (planes.numbers.as_chunks().0, &angles.numbers);
    rotors(plane.py(), batch, |row| {
        Rotor::from_plane_angle(Bivector(planes[row % planes.len()]), unit * angles[row % angles.len()])
    })
}

/// Rotors that turn directions (…, 3) into others.
#[pyfunction]
pub(crate) fn rotor_between<'py>(a: Any<'_, 'py>, b: Any<'_, 'py>) -> Found<'py> {
    let of = |x| Given::new(x, Some(Grades::VECTOR));
    let (Some(from), Some(to)) = (of(a), of(b)) else { return Ok(None) };
    let Some(batch) = together(from.batch(&[3]), to.batch(&[3])) else { return Ok(None) };
    let (from, to) = (from.numbers.as_chunks().0, to.numbers.as_chunks().0);
    rotors(a.py(), batch, |row| {
        Rotor::from_vectors(Vector(from[row % from.len()]), Vector(to[row % to.len()]))
    })
}

/// The sequence of axes with these letters.
fn sequence_of(letters: Any<'_, '_>) -> Option<EulerSequence> {
    EulerSequence::new(&letters.extract::<String>().ok()?)
}

/// Rotors from Euler angles (…, n) times `unit`, or from a number for one axis.
#[pyfunction]
pub(crate) fn rotor_from_euler<'py>(sequence: Any<'_, 'py>, angles: Any<'_, 'py>, unit: f64) -> Found<'py> {
    let py = angles.py();
    let (Some(sequence), Some(mut angles)) = (sequence_of(sequence), Given::new(angles, None)) else {
        return Ok(None);
    };
    if angles.shape.is_empty() {
        angles.shape.push(1);
    }
    let count = sequence.count();
    let Some(batch) = angles.batch(&[count]) else { return Ok(None) };
    rotors(py, batch, |row| {
        let mut turns = [0.0; 3];
        for (turn, angle) in turns.iter_mut().zip(&angles.numbers[count * row..count * (row + 1)]) {
            *turn = unit * angle;
        }
        sequence.rotor(&turns[..count])
    })
}

/// The rows of rotors.
fn rows_of<'a, 'py: 'a>(x: Any<'a, 'py>) -> Option<Rows<'a>> {
    Rows::operand(x.as_borrowed()).filter(|rows| rows.unit && rows.numbers.len() <= FEW)
}

/// The same, of finite rotors.
fn finite_rows_of<'a, 'py: 'a>(x: Any<'a, 'py>) -> Option<Rows<'a>> {
    rows_of(x).filter(|rows| rows.numbers.iter().all(|x| x.is_finite()))
}

/// An array of parameters of rotors, N numbers each in axes of the lengths `last`.
fn to_rows<'py, const N: usize>(
    py: Python<'py>,
    rows: &Rows<'_>,
    last: &[usize],
    parameters: impl Fn(Rotor) -> [f64; N],
) -> Found<'py> {
    let array = pool::array(py, &[&*rows.shape, last].concat())?;
    let mut target = array.readwrite();
    for (out, row) in target.as_slice_mut()?.as_chunks_mut().0.iter_mut().zip(rows.numbers.as_chunks().0) {
        *out = parameters(Rotor::from_unit_components(*row));
    }
    drop(target);
    Ok(Some(array.into_any()))
}

/// Parameters of rotors: a `matrix` (…, 3, 3), `wxyz` or `xyzw` (…, 4), a `rotation vector` (…, 3), or the `angle` (…).
#[pyfunction]
pub(crate) fn rotor_to<'py>(form: &str, rotor: Any<'_, 'py>) -> Found<'py> {
    let (py, Some(rows)) = (rotor.py(), rows_of(rotor)) else { return Ok(None) };
    match form {
        "matrix" => to_rows(py, &rows, &[3, 3], |r| -> [f64; 9] {
            let m = r.to_matrix();
            from_fn(|i| m[i / 3][i % 3])
        }),
        "wxyz" => to_rows(py, &rows, &[4], Rotor::to_quaternion_wxyz),
        "xyzw" => to_rows(py, &rows, &[4], |r| {
            let [w, x, y, z] = r.to_quaternion_wxyz();
            [x, y, z, w]
        }),
        "rotation vector" => to_rows(py, &rows, &[3], |r| r.to_rotation_vector().0),
        "angle" => to_rows(py, &rows, &[], |r| [r.angle()]),
        _ => Ok(None),
    }
}

/// Euler angles (…, 3) of rotors.
#[pyfunction]
pub(crate) fn rotor_to_euler<'py>(sequence: Any<'_, 'py>, rotor: Any<'_, 'py>) -> Found<'py> {
    let rows = Rows::operand(rotor.as_borrowed()).filter(|rows| rows.unit);
    let (Some(sequence), Some(rows)) = (sequence_of(sequence), rows) else { return Ok(None) };
    if sequence.count() != 3 {
        return Ok(None);
    }
    let of: &[[f64; 4]] = rows.numbers.as_chunks().0;
    let found = fill_rows(rotor.py(), (&rows.shape, 3), 1 << 10, |row, out| {
        let angles = sequence.angles(Rotor::from_unit_components(of[row]));
        out.copy_from_slice(&angles.unwrap_or([f64::NAN; 3]));
        Ok::<(), MathError>(())
    })?;
    Ok(Some(found.into_any()))
}

/// R or −R, of a turn of at most π.
#[pyfunction]
pub(crate) fn rotor_canonical<'py>(rotor: Any<'_, 'py>) -> Found<'py> {
    let Some(rows) = rows_of(rotor) else { return Ok(None) };
    let of = rows.numbers.as_chunks().0;
    rotors(rotor.py(), &rows.shape, |row| Ok(Rotor::from_unit_components(of[row]).canonical()))
}

/// `exp(n log R)` of rotors, for one power or one for each.
#[pyfunction]
pub(crate) fn rotor_to_power<'py>(rotor: Any<'_, 'py>, n: Any<'_, 'py>) -> Found<'py> {
    let py = rotor.py();
    let (Some(rows), Some(powers)) = (finite_rows_of(rotor), Given::new(n, None)) else { return Ok(None) };
    if !powers.numbers.iter().all(|n| n.is_finite()) {
        return Ok(None);
    }
    let Some(batch) = together(Some(&*rows.shape), powers.batch(&[])) else { return Ok(None) };
    if batch.is_empty() {
        let of = rows.numbers.as_chunks().0;
        return one_rotor(py, Rotor::from_unit_components(of[0]).power(powers.numbers[0])).map(Some);
    }
    let kind = Kind { shape: batch, size: 4, grades: Grades::EVEN, unit: true, algebra: g3(py)? };
    let mut all = true;
    let value = filled(py, kind, |out| {
        all = out.is_empty() || power(Threads::ONE, &rows.numbers, &powers.numbers, out).is_ok();
        Ok(())
    })?;
    Ok(all.then_some(value))
}

/// The angles between the attitudes of rotors.
#[pyfunction]
pub(crate) fn distance_between<'py>(a: Any<'_, 'py>, b: Any<'_, 'py>) -> Found<'py> {
    let (Some(from), Some(to)) = (finite_rows_of(a), finite_rows_of(b)) else { return Ok(None) };
    let Some(batch) = together(Some(&*from.shape), Some(&*to.shape)) else { return Ok(None) };
    let array = pool::array(a.py(), batch)?;
    let mut target = array.readwrite();
    let (from, to) = (from.numbers.as_chunks().0, to.numbers.as_chunks().0);
    for (row, out) in target.as_slice_mut()?.iter_mut().enumerate() {
        let [from, to] = [from[row % from.len()], to[row % to.len()]].map(Rotor::from_unit_components);
        *out = from.distance(to);
    }
    drop(target);
    Ok(Some(array.into_any()))
}

/// The rotors a fraction t of the way from one to another.
#[pyfunction]
pub(crate) fn slerp_between<'py>(a: Any<'_, 'py>, b: Any<'_, 'py>, t: Any<'_, 'py>) -> Found<'py> {
    let (Some(from), Some(to), Some(t)) = (finite_rows_of(a), finite_rows_of(b), Given::new(t, None)) else {
        return Ok(None);
    };
    let both = together(Some(&*from.shape), Some(&*to.shape));
    let Some(batch) = together(both, t.batch(&[])) else { return Ok(None) };
    let (from, to) = (from.numbers.as_chunks().0, to.numbers.as_chunks().0);
    rotors(a.py(), batch, |row| {
        let [from, to] = [from[row % from.len()], to[row % to.len()]].map(Rotor::from_unit_components);
        from.slerp(to, t.numbers[row % t.numbers.len()])
    })
}
