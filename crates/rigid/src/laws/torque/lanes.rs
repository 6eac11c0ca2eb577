//! Kernels of torques for bodies in lanes, in principal axes; a single body has one lane.
//!
//! Between the stages of a step the norm of a rotor differs from 1, and other formulas for the same rotation would give
//! other torques, so every stepper uses these.

use polhode_ga::simd::lanes::{Lanes, composed, cross, dot};

/// Three numbers for each body: a vector, a bivector, or a diagonal.
pub(crate) type Three<const W: usize, const F: bool> = [Lanes<W, F>; 3];

/// The numbers of each body, in lanes.
pub(crate) fn in_lanes<const N: usize, const W: usize, const F: bool>(
    each: impl Fn(usize) -> [f64; N],
) -> [Lanes<W, F>; N] {
    let mut lanes = [Lanes::ZERO; N];
    for l in 0..W {
        for (lane, x) in lanes.iter_mut().zip(each(l)) {
            lane.0[l] = x;
        }
    }
    lanes
}

/// The numbers of `P` of the bodies, from `first` on.
#[inline(always)]
pub(crate) fn part<const N: usize, const W: usize, const P: usize, const F: bool>(
    all: &[Lanes<W, F>; N],
    first: usize,
) -> [Lanes<P, F>; N] {
    let mut part = [Lanes::ZERO; N];
    for k in 0..N {
        part[k] = some(&all[k], first);
    }
    part
}

/// The same of one number.
#[inline(always)]
pub(crate) fn some<const W: usize, const P: usize, const F: bool>(
    all: &Lanes<W, F>,
    first: usize,
) -> Lanes<P, F> {
    let mut some = Lanes::ZERO;
    some.0.copy_from_slice(&all.0[first..first + P]);
    some
}

/// The inverse of [`part`].
#[inline(always)]
pub(crate) fn put<const N: usize, const W: usize, const P: usize, const F: bool>(
    all: &mut [Lanes<W, F>; N],
    first: usize,
    part: &[Lanes<P, F>; N],
) {
    for k in 0..N {
        all[k].0[first..first + P].copy_from_slice(&part[k].0);
    }
}

/// Adds the other three.
#[inline(always)]
pub(crate) fn add<const W: usize, const F: bool>(a: &mut Three<W, F>, b: &Three<W, F>) {
    for k in 0..3 {
        a[k] += b[k];
    }
}

/// `~R v R`: a vector or bivector of space in body axes. With the axial vector q of the rotor's plane
/// `v + 2s q x v + 2 q x (q x v)`.
#[inline(always)]
pub(crate) fn seen<const W: usize, const F: bool>(
    [s, x, y, z]: &[Lanes<W, F>; 4],
    v: &Three<W, F>,
) -> Three<W, F> {
    let q = [*x, *y, *z];
    let t = cross(&[*x + *x, *y + *y, *z + *z], v);
    let mut seen = *v;
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        seen[k] = q[i].times_plus(t[j], q[j].times_from(t[i], s.times_plus(t[k], v[k])));
    }
    seen
}

/// `R v ~R`: the inverse of [`seen`].
#[inline(always)]
pub(crate) fn turned<const W: usize, const F: bool>(r: &[Lanes<W, F>; 4], v: &Three<W, F>) -> Three<W, F> {
    seen(&reversed(r), v)
}

/// `~R`
#[inline(always)]
pub(crate) fn reversed<const W: usize, const F: bool>([s, x, y, z]: &[Lanes<W, F>; 4]) -> [Lanes<W, F>; 4] {
    [*s, -*x, -*y, -*z]
}

/// `f u x I(u)`: in principal axes `f (i3 − i2) u2 u3`, and cyclically.
#[inline(always)]
pub(crate) fn gradient<const W: usize, const F: bool>(
    moments: &Three<W, F>,
    u: &Three<W, F>,
    factor: Lanes<W, F>,
) -> Three<W, F> {
    let mut torque = *u;
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        torque[k] = (moments[j] - moments[i]) * factor * (u[i] * u[j]);
    }
    torque
}

/// `−k |Ω| Ω`
#[inline(always)]
pub(crate) fn quadratic<const W: usize, const F: bool>(
    factor: Lanes<W, F>,
    omega: &Three<W, F>,
) -> Three<W, F> {
    let scale = -(factor * dot(omega, omega).sqrt());
    [omega[0] * scale, omega[1] * scale, omega[2] * scale]
}

/// The bivector `Θ` of the shorter rotation from one attitude to another, see [`turn_from`](super::turn_from). With `q = ~rest R = cos ½θ − sin ½θ Θ/θ`, and of `±q` the one whose scalar part is
/// not negative, `Θ = −⟨q⟩₂ θ/sin ½θ`: 2 for the factor where there is no turn.
#[inline(always)]
pub(crate) fn turn_from<const W: usize, const F: bool>(
    rest: &[Lanes<W, F>; 4],
    rotor: &[Lanes<W, F>; 4],
) -> Three<W, F> {
    let [s, x, y, z] = composed(&reversed(rest), rotor);
    let plane = [x, y, z];
    let size = dot(&plane, &plane).sqrt();
    let half = size.angle(s);
    let mut factor = half;
    for l in 0..W {
        // A size that underflows has no digits.
        let twice = if size.0[l] == 0.0 { 2.0 } else { 2.0 * (half.0[l] / size.0[l]) };
        factor.0[l] = if s.0[l] < 0.0 { twice } else { -twice };
    }
    [x * factor, y * factor, z * factor]
}
