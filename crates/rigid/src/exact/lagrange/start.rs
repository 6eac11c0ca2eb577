//! Starts of heavy tops: their axes, and their states in double-double precision, one top in each lane.

use crate::body::inertia::{Inertia, apart, equal};
use crate::error::SimulateError;
use crate::exact::free::power_of_two;
use crate::numerics::precise::Precise;
use crate::numerics::quaternion::{product, quaternions, turned_back};
use crate::numerics::wide::Wide;
use crate::state::checks::check_moments;
use polhode_ga::{Bivector, Rotor, Vector};

/// Largest part of `c` across the symmetry axis that counts as rounding, relative to its size.
const ASIDE: f64 = 64.0 * f64::EPSILON;

/// Torques below this, relative to the scale of the rates, are zero.
const NONE: f64 = 1e-250;

/// The series cannot represent tilts and rates below this.
pub(super) const LEAST: f64 = 1e-303;

/// Complex numbers of twice the precision.
pub(super) type Complex<N> = [N; 2];

/// `a b*`.
#[inline(always)]
pub(super) fn times_conjugate<N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    a: Complex<N>,
    b: Complex<N>,
) -> Complex<N> {
    [a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]]
}

#[inline(always)]
pub(super) fn square<N: Precise<W, FMA>, const W: usize, const FMA: bool>(a: Complex<N>) -> N {
    a[0] * a[0] + a[1] * a[1]
}

/// A heavy top at time 0.
#[derive(Clone, Copy, Debug)]
pub struct HeavyTop {
    pub(super) axes: Axes,
    /// From body axes to space.
    pub(super) rotor: Rotor,
    /// In body axes.
    pub(super) omega: Bivector,
    /// A power of two near the largest rate, in rad/s.
    pub(super) scale: f64,
}

impl HeavyTop {
    /// Takes the arguments of [`super::LagrangeTop::new`].
    ///
    /// # Errors
    /// For a body that is not such a top, and for numbers that are not finite or out of range.
    pub fn new(
        inertia: &Inertia,
        rotor: Rotor,
        omega: Bivector,
        c: Vector,
    ) -> Result<HeavyTop, SimulateError> {
        let axes = Axes::new(inertia, c)?;
        if let Some(&value) = omega.0.iter().find(|x| !x.is_finite()) {
            return Err(SimulateError::BadValue { what: "a component of the angular velocity", value });
        }
        let rate = (2.0 * (axes.c / axes.i1)).sqrt();
        let fastest = omega.0.iter().fold(rate, |m: f64, x| m.max(x.abs()));
        // Squares of rates, and their ratios to the moments, must be numbers.
        if !(fastest < 1e140 && (fastest == 0.0 || fastest > 1e-140)) {
            let what = "the largest rate, which must lie between 1e-140 and 1e140 rad/s,";
            return Err(SimulateError::BadValue { what, value: fastest });
        }
        Ok(HeavyTop { axes, rotor, omega, scale: power_of_two([fastest, 0.0, 0.0]) })
    }

    /// Whether the motion neglects nothing: [`super::LagrangeTop::neglected`] is 0.
    pub(crate) fn is_exact(&self) -> bool {
        self.axes.apart == 0.0
    }
}

/// The top's own axes: the third is that of symmetry, in the direction of the centre of mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// From the top's axes to those of the body.
    pub frame: Rotor,
    pub i1: f64,
    pub i3: f64,
    /// |c|, in N m.
    pub c: f64,
    /// Relative difference of the two moments, plus the relative part of c across the axis.
    pub apart: f64,
}

impl Axes {
    pub fn new(inertia: &Inertia, c: Vector) -> Result<Axes, SimulateError> {
        let (moments, principal) = (inertia.principal_moments(), inertia.principal_frame());
        check_moments(moments)?;
        if let Some(&value) = c.0.iter().find(|x| !x.is_finite()) {
            return Err(SimulateError::BadValue { what: "a component of c", value });
        }
        let others = |k: usize| [moments[(k + 1) % 3], moments[(k + 2) % 3]];
        let along = principal.reverse().apply(c);
        let axis = (0..3)
            .filter(|&k| equal(others(k)[0], others(k)[1]))
            .max_by(|&j, &k| along.0[j].abs().total_cmp(&along.0[k].abs()))
            .ok_or(SimulateError::NotSymmetric { moments })?;
        let [x, y] = others(axis);
        let (size, beside) = (c.norm(), aside(along, axis));
        let (frame, beside) = if beside <= ASIDE * size {
            let beside = if beside > 0.0 { beside / size } else { 0.0 };
            (principal * axis_to(axis, along.0[axis] < 0.0), beside)
        } else if equal(x, moments[axis]) {
            // Any axis of a sphere is one of symmetry.
            let frame = Rotor::from_vectors(Vector([0.0, 0.0, 1.0]), c).unwrap_or(Rotor::IDENTITY);
            (frame, apart(x, moments[axis]))
        } else {
            let mut e = Vector::default();
            e.0[axis] = 1.0;
            return Err(SimulateError::OffAxis { c, axis: principal.apply(e) });
        };
        let apart = apart(x, y) + beside;
        Ok(Axes { frame, i1: 0.5 * x + 0.5 * y, i3: moments[axis], c: size, apart })
    }
}

fn aside(along: Vector, axis: usize) -> f64 {
    along.0[(axis + 1) % 3].hypot(along.0[(axis + 2) % 3])
}

/// The rotor that carries e3 to the axis or its opposite: a cyclic permutation of axes after an optional half turn about
/// e1. Its components are exact.
fn axis_to(axis: usize, opposite: bool) -> Rotor {
    let cyclic = match axis {
        0 => [0.5, -0.5, -0.5, -0.5],
        1 => [0.5; 4],
        _ => [1.0, 0.0, 0.0, 0.0],
    };
    let half_turn = if opposite { [0.0, 1.0, 0.0, 0.0] } else { [1.0, 0.0, 0.0, 0.0] };
    Rotor::from_unit_components(cyclic) * Rotor::from_unit_components(half_turn)
}

/// States at the start, rates in units of each `scale`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Starts<N, const W: usize, const FMA: bool> {
    pub scale: [f64; W],
    /// 2c/i1.
    pub gravity: N,
    /// ℓ = L3/i1.
    pub spin: N,
    /// The rate about the axis less ℓ.
    pub excess: N,
    /// The rate about the axis, in rad/s.
    pub omega3: [f64; W],
    /// The Cayley–Klein parameters, with their norm.
    pub alpha: Complex<N>,
    pub beta: Complex<N>,
    /// 1 − u and 1 + u.
    pub below: N,
    pub above: N,
    /// g = γ1 + iγ2 and w = ω1 + iω2.
    pub g: Complex<N>,
    pub w: Complex<N>,
    /// Whether the top turns steadily about its axis without a torque.
    pub steady: [bool; W],
}

/// What a description needs of a start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub scale: f64,
    pub gravity: Wide,
    pub spin: Wide,
    pub excess: Wide,
    pub omega3: f64,
    pub below: Wide,
    pub above: Wide,
    pub g: [Wide; 2],
    pub w: [Wide; 2],
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Starts<N, W, FMA> {
    /// From the tops, with the rotors of their axes and their own, and their angular velocities.
    #[inline(always)]
    pub fn new(
        tops: &[HeavyTop; W],
        frames: &[[f64; W]; 4],
        rotors: &[[f64; W]; 4],
        omegas: &[[f64; W]; 3],
    ) -> Self {
        let (mut scale, mut constants) = ([0.0; W], [[0.0; W]; 3]);
        for l in 0..W {
            let HeavyTop { axes, scale: one, .. } = &tops[l];
            scale[l] = *one;
            (constants[0][l], constants[1][l], constants[2][l]) = (axes.i1, axes.i3, axes.c);
        }
        let [i1, i3, c] = [N::from(constants[0]), N::from(constants[1]), N::from(constants[2])];
        let frame: [N; 4] = quaternions(frames);
        let [s, x, y, z] = product(quaternions(rotors), frame);
        let norm = s * s + x * x + y * y + z * z;
        let (alpha, beta) = ([s, z], [y, -x]);
        let [g, g_im] = times_conjugate(beta, alpha);
        let g = [-((g + g) / norm), -((g_im + g_im) / norm)];
        let mut rates = [N::all(0.0); 3];
        for k in 0..3 {
            rates[k] = N::from(omegas[k]).in_units(&scale);
        }
        let [w1, w2, w3] = turned_back(frame, rates);
        let spin = w3 * i3 / i1;
        let gravity = (c.twice() / i1).in_units(&scale).in_units(&scale);
        // A torque this small has no effect up to any horizon.
        let (gravity_values, mut acts) = (gravity.values(), [false; W]);
        for l in 0..W {
            acts[l] = gravity_values[l] >= NONE;
        }
        let gravity = gravity.or(&acts, N::all(0.0));
        let (below, above, w) = (square(beta), square(alpha), [w1, w2]);
        let (below, above) = ((below + below) / norm, (above + above) / norm);
        let (mut omega3, mut steady) = (w3.values(), [false; W]);
        let zeros = [w1.zeros(), w2.zeros(), g[0].zeros(), g[1].zeros()];
        for l in 0..W {
            omega3[l] *= scale[l];
            steady[l] = zeros[0][l] & zeros[1][l] & ((zeros[2][l] & zeros[3][l]) | !acts[l]);
        }
        let excess = w3 - spin;
        Starts { scale, gravity, spin, excess, omega3, alpha, beta, below, above, g, w, steady }
    }

    /// That of lane l.
    pub fn lane(&self, l: usize) -> Start {
        Start {
            scale: self.scale[l],
            gravity: self.gravity.lane(l),
            spin: self.spin.lane(l),
            excess: self.excess.lane(l),
            omega3: self.omega3[l],
            below: self.below.lane(l),
            above: self.above.lane(l),
            g: self.g.map(|x| x.lane(l)),
            w: self.w.map(|x| x.lane(l)),
        }
    }
}
