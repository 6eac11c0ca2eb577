//! Rotors in double-double precision, as quaternions, in lanes.

use super::precise::Precise;
use super::wide::Wide;
use polhode_ga::Rotor;

/// Quaternion units are the negatives of the planes.
pub(crate) fn quaternion(rotor: Rotor) -> [Wide; 4] {
    let [s, x, y, z] = rotor.components();
    [s, -x, -y, -z].map(Wide::from)
}

/// Those of many rotors, one in each lane.
#[inline(always)]
pub(crate) fn quaternions<N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    rotors: &[[f64; W]; 4],
) -> [N; 4] {
    let [s, x, y, z] = rotors;
    [N::from(*s), -N::from(*x), -N::from(*y), -N::from(*z)]
}

#[inline(always)]
pub(crate) fn product<N: Precise<W, FMA>, const W: usize, const FMA: bool>(p: [N; 4], q: [N; 4]) -> [N; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// The components of an axial vector in axes turned by q: `~q v q/|q|²`.
#[inline(always)]
pub(crate) fn turned_back<N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    q: [N; 4],
    v: [N; 3],
) -> [N; 3] {
    let back = [q[0], -q[1], -q[2], -q[3]];
    let [_, x, y, z] = product(product(back, [N::all(0.0), v[0], v[1], v[2]]), q);
    let [norm, ..] = product(back, q);
    [x / norm, y / norm, z / norm]
}
