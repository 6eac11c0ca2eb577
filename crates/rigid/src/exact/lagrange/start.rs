//! Start of a heavy top: its axes, and its state in double-double precision.

use crate::body::inertia::{Inertia, apart, equal};
use crate::error::SimulateError;
use crate::exact::free::power_of_two;
use crate::numerics::quaternion::{product, quaternion, turned_back};
use crate::numerics::wide::Wide;
use crate::state::checks::check_moments;
use polhode_ga::{Bivector, Rotor, Vector};

/// Largest part of `c` across the symmetry axis that counts as rounding, relative to its size.
const ASIDE: f64 = 64.0 * f64::EPSILON;

/// Torques below this, relative to the scale of the rates, are zero.
const NONE: f64 = 1e-250;

/// A complex number of twice the precision.
pub(super) type Complex = [Wide; 2];

/// `a b*`.
pub(super) fn times_conjugate(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]]
}

pub(super) fn square(a: Complex) -> Wide {
    a[0] * a[0] + a[1] * a[1]
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

/// The state at the start, rates in units of `scale`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// A power of two near the largest rate, in rad/s.
    pub scale: f64,
    /// 2c/i1.
    pub gravity: Wide,
    /// ℓ = L3/i1.
    pub spin: Wide,
    /// The rate about the axis less ℓ.
    pub excess: Wide,
    /// The rate about the axis, in rad/s.
    pub omega3: f64,
    /// The Cayley–Klein parameters, with their norm.
    pub alpha: Complex,
    pub beta: Complex,
    /// 1 − u and 1 + u.
    pub below: Wide,
    pub above: Wide,
    /// g = γ1 + iγ2 and w = ω1 + iω2.
    pub g: Complex,
    pub w: Complex,
}

impl Start {
    pub fn new(axes: &Axes, rotor: Rotor, omega: Bivector) -> Result<Start, SimulateError> {
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
        let scale = power_of_two([fastest, 0.0, 0.0]);
        let frame = quaternion(axes.frame);
        let [s, x, y, z] = product(quaternion(rotor), frame);
        let norm = s * s + x * x + y * y + z * z;
        let (alpha, beta) = ([s, z], [y, -x]);
        let double = |a: Wide| (a + a) / norm;
        let [g, g_im] = times_conjugate(beta, alpha).map(double);
        let [w1, w2, w3] = turned_back(frame, omega.0.map(|w| Wide::from(w) / scale.into()));
        let spin = w3 * axes.i3.into() / axes.i1.into();
        let square_rate = Wide::from(2.0) * axes.c.into() / axes.i1.into();
        let gravity = square_rate / scale.into() / scale.into();
        // A torque this small has no effect up to any horizon.
        let gravity = if gravity.value() < NONE { Wide::ZERO } else { gravity };
        Ok(Start {
            scale,
            gravity,
            spin,
            excess: w3 - spin,
            omega3: w3.value() * scale,
            alpha,
            beta,
            below: double(square(beta)),
            above: double(square(alpha)),
            g: [-g, -g_im],
            w: [w1, w2],
        })
    }

    /// Whether the top turns steadily about its axis without a torque.
    pub fn is_steady(&self) -> bool {
        let zero = |z: Complex| z[0].is_zero() && z[1].is_zero();
        zero(self.w) && (zero(self.g) || self.gravity.is_zero())
    }
}
