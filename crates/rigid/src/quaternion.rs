//! Rotors of twice the precision, as quaternions.

use crate::double_double::DoubleDouble;
use polhode_ga::Rotor;

/// Quaternion units are the negatives of the planes.
pub(crate) fn quaternion(rotor: Rotor) -> [DoubleDouble; 4] {
    let [s, x, y, z] = rotor.components();
    [s, -x, -y, -z].map(DoubleDouble::from)
}

pub(crate) fn product(p: [DoubleDouble; 4], q: [DoubleDouble; 4]) -> [DoubleDouble; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// An axial vector as seen from axes turned by q: `~q v q`, less the norm.
pub(crate) fn turned_back(q: [DoubleDouble; 4], v: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let back = [q[0], -q[1], -q[2], -q[3]];
    let [_, x, y, z] = product(product(back, [DoubleDouble::ZERO, v[0], v[1], v[2]]), q);
    let [norm, ..] = product(back, q);
    [x / norm, y / norm, z / norm]
}
