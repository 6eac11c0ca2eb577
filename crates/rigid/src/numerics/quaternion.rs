//! Rotors of more than single precision, as quaternions.

use polhode_ga::Rotor;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Numbers with the four operations.
pub(crate) trait Number:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
}

impl Number for super::double_double::DoubleDouble {}
impl Number for super::wide::Wide {}

/// Quaternion units are the negatives of the planes.
pub(crate) fn quaternion<T: Number>(rotor: Rotor) -> [T; 4] {
    let [s, x, y, z] = rotor.components();
    [s, -x, -y, -z].map(T::from)
}

pub(crate) fn product<T: Number>(p: [T; 4], q: [T; 4]) -> [T; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// An axial vector as seen from axes turned by q: `~q v q`, less the norm.
pub(crate) fn turned_back<T: Number>(q: [T; 4], v: [T; 3]) -> [T; 3] {
    let back = [q[0], -q[1], -q[2], -q[3]];
    let [_, x, y, z] = product(product(back, [T::from(0.0), v[0], v[1], v[2]]), q);
    let [norm, ..] = product(back, q);
    [x / norm, y / norm, z / norm]
}
