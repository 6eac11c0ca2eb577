//! The torque-free top: what its invariants say of the motion, and the symmetric top in closed form.
//!
//! In principal axes `E = ½ Σ i_k ω_k²` and `G² = Σ i_k² ω_k²` are constant, so the angular velocity
//! runs along the intersection of two ellipsoids, the polhode. Name `c` the axis it encircles: that of
//! the largest moment when `G² > 2E i_mid` (short-axis mode), of the smallest otherwise (long-axis
//! mode); `b` the middle one, `a` the other. The combinations
//!
//! ```text
//! P = a(c−a) ω_a² + b(c−b) ω_b² = 2Ec − G²
//! Q = b(b−a) ω_b² + c(c−a) ω_c² = G² − 2Ea
//! D = c(c−b) ω_c² − a(b−a) ω_a² = G² − 2Eb
//! λ² = (c−b)Q / (abc),  k² = (b−a)P / ((c−b)Q),  k'² = (c−a)D / ((c−b)Q)
//! ```
//!
//! are formed without subtracting nearly equal numbers. Then ω is elliptic in time with period `4K/λ`,
//! and the precession about L advances at the mean rate `G/c + (G(c−a)/(ac)) Π(n|k²)/K`,
//! `n = −c(b−a)/(a(c−b))`.

use crate::elliptic::{complete_k, complete_pi};
use crate::inertia::Inertia;
use polhode_ga::{Bivector, Rotor, Vector};
use std::f64::consts::PI;
use std::fmt;

/// How a free body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regime {
    /// No rotation.
    Rest,
    /// A fixed axis: a principal axis, or any axis of a sphere.
    Steady,
    /// Two equal moments: regular precession, handout eq. (4.35).
    Symmetric,
    /// The polhode encircles the axis of the largest moment.
    ShortAxis,
    /// The polhode encircles the axis of the smallest moment.
    LongAxis,
    /// Exactly between the two: the spin tends to the middle axis.
    Separatrix,
}

impl fmt::Display for Regime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Regime::Rest => "at rest",
            Regime::Steady => "steady rotation about a fixed axis",
            Regime::Symmetric => "symmetric top, regular precession",
            Regime::ShortAxis => "short-axis mode",
            Regime::LongAxis => "long-axis mode",
            Regime::Separatrix => "separatrix",
        })
    }
}

/// What the invariants of a free motion tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeDescription {
    /// The kind of motion.
    pub regime: Regime,
    /// Kinetic energy in J.
    pub energy: f64,
    /// Size of the angular momentum in kg m²/s.
    pub angular_momentum: f64,
    /// Modulus k of the elliptic functions.
    pub modulus: f64,
    /// Principal axis (0, 1, 2) that the polhode encircles.
    pub axis: usize,
    /// Period of the angular velocity in the body, 4K/λ, in s. Infinite on the separatrix.
    pub period: Option<f64>,
    /// Mean rate of precession about L, in rad/s.
    pub precession_rate: Option<f64>,
}

impl FreeDescription {
    /// Period of the mean precession about L, in s.
    pub fn precession_period(&self) -> Option<f64> {
        self.precession_rate.map(|rate| 2.0 * PI / rate)
    }

    /// Time between reversals of the spin about the middle axis, half the period, in s.
    pub fn flip_time(&self) -> Option<f64> {
        match self.regime {
            Regime::ShortAxis | Regime::LongAxis => self.period.map(|t| 0.5 * t),
            _ => None,
        }
    }
}

/// Two numbers equal to this relative accuracy count as equal moments, or as a point on the separatrix:
/// a few roundings of the squares and products that lead to them.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

fn equal(x: f64, y: f64) -> bool {
    (x - y).abs() <= ROUNDING * x.abs().max(y.abs())
}

/// Describes the free motion of a body with angular velocity `omega` in body axes.
pub fn describe(inertia: &Inertia, omega: Bivector) -> FreeDescription {
    let i = inertia.principal_moments();
    let w = inertia.principal_frame().reverse().apply_bivector(omega).0;
    let energy = 0.5 * (i[0] * w[0] * w[0] + i[1] * w[1] * w[1] + i[2] * w[2] * w[2]);
    let angular_momentum = Vector([i[0] * w[0], i[1] * w[1], i[2] * w[2]]).norm();
    let mut order = [0, 1, 2];
    order.sort_by(|&x, &y| i[x].total_cmp(&i[y]));
    let [small, middle, large] = order;

    let square = |k: usize| w[k] * w[k];
    // G² − 2E i_mid: positive in short-axis mode.
    let high = i[large] * (i[large] - i[middle]) * square(large);
    let low = i[small] * (i[middle] - i[small]) * square(small);
    let (a, c) = if high >= low { (small, large) } else { (large, small) };
    let b = middle;
    let mut result = FreeDescription {
        regime: if a == small { Regime::ShortAxis } else { Regime::LongAxis },
        energy,
        angular_momentum,
        modulus: 0.0,
        axis: c,
        period: None,
        precession_rate: None,
    };
    if w == [0.0; 3] {
        return FreeDescription { regime: Regime::Rest, ..result };
    }
    let spinning = w.iter().filter(|x| **x != 0.0).count();
    let p = i[a] * (i[c] - i[a]) * square(a) + i[b] * (i[c] - i[b]) * square(b);
    let q = i[b] * (i[b] - i[a]) * square(b) + i[c] * (i[c] - i[a]) * square(c);
    if spinning == 1 || p == 0.0 || q == 0.0 {
        let axis = (0..3).max_by(|&x, &y| w[x].abs().total_cmp(&w[y].abs())).unwrap_or(c);
        return FreeDescription { regime: Regime::Steady, axis, ..result };
    }
    if (high - low).abs() <= ROUNDING * (high + low) {
        return FreeDescription { regime: Regime::Separatrix, modulus: 1.0, ..result };
    }
    let (ia, ib, ic) = (i[a], i[b], i[c]);
    if equal(ia, ib) {
        result.regime = Regime::Symmetric;
    }
    let d = if a == small { high - low } else { low - high };
    let d = d.abs();
    let (ab, ac, bc) = ((ib - ia).abs(), (ic - ia).abs(), (ic - ib).abs());
    let lambda = (bc * q.abs() / ia / ib / ic).sqrt();
    let k2 = ab * p.abs() / (bc * q.abs());
    let kc2 = (ac * d / (bc * q.abs())).min(1.0);
    let k = complete_k(kc2);
    let n = -ic * ab / (ia * bc);
    let one_minus_n = ib * ac / (ia * bc);
    let pi = complete_pi(n, one_minus_n, k2, kc2);
    result.modulus = k2.sqrt();
    result.period = Some(4.0 * k / lambda);
    result.precession_rate = Some(angular_momentum / ic + angular_momentum * (ic - ia) / (ia * ic) * pi / k);
    result
}

/// The free symmetric top in closed form (handout eq. 4.35):
/// `R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t)` with `Ω_l = L/i1` and `Ω_r = ((i1 − i3)/i1) ω3 I e3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetricTop {
    rotor: Rotor,
    omega: Bivector,
    left: Bivector,
    right: Bivector,
}

impl SymmetricTop {
    /// The motion that starts at `rotor` (body axes to space) with angular velocity `omega` in body axes.
    /// `None` unless two of the principal moments are equal to rounding.
    pub fn new(inertia: &Inertia, rotor: Rotor, omega: Bivector) -> Option<SymmetricTop> {
        let (moments, frame) = (inertia.principal_moments(), inertia.principal_frame());
        let axis = (0..3).find(|&k| equal(moments[(k + 1) % 3], moments[(k + 2) % 3]))?;
        let (i1, i3) = (moments[(axis + 1) % 3], moments[axis]);
        let mut spin = Bivector::default();
        spin.0[axis] = frame.reverse().apply_bivector(omega).0[axis];
        let momentum = rotor.apply_bivector(inertia.apply(omega));
        let right = frame.apply_bivector(spin) * ((i1 - i3) / i1);
        Some(SymmetricTop { rotor, omega, left: momentum / i1, right })
    }

    /// The constant bivectors `Ω_l` (in space) and `Ω_r` (in body axes), in rad/s.
    pub fn rates(&self) -> (Bivector, Bivector) {
        (self.left, self.right)
    }

    /// Rotor and body angular velocity at time `t` in s. The angular velocity turns about the symmetry
    /// axis with `Ω_r`: `Ω_B(t) = exp(½Ω_r t) Ω_B(0) exp(−½Ω_r t)`.
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        let right = Rotor::exp(self.right * (-0.5 * t));
        let rotor = Rotor::exp(self.left * (-0.5 * t)) * self.rotor * right;
        (rotor.renormalized(), right.reverse().apply_bivector(self.omega))
    }
}
