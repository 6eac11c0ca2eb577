//! Rotors in double-double precision, as quaternions.

use super::wide::Wide;
use polhode_ga::Rotor;

/// Quaternion units are the negatives of the planes.
pub(crate) fn quaternion(rotor: Rotor) -> [Wide; 4] {
    let [s, x, y, z] = rotor.components();
    [s, -x, -y, -z].map(Wide::from)
}

pub(crate) fn product(p: [Wide; 4], q: [Wide; 4]) -> [Wide; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// The components of an axial vector in axes turned by q: `~q v q/|q|²`.
pub(crate) fn turned_back(q: [Wide; 4], v: [Wide; 3]) -> [Wide; 3] {
    let back = [q[0], -q[1], -q[2], -q[3]];
    let [_, x, y, z] = product(product(back, [Wide::ZERO, v[0], v[1], v[2]]), q);
    let [norm, ..] = product(back, q);
    [x / norm, y / norm, z / norm]
}
