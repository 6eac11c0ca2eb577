//! The free symmetric top in closed form.

use crate::body::inertia::{Inertia, equal};
use polhode_ga::{Bivector, Rotor};

/// The free symmetric top in closed form (handout eq. 4.35):
/// `R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t)` with `Ω_l = L/i1` and `Ω_r = ((i1 − i3)/i1) ω3 I e3`. The error grows as
/// ε|Ω|t, and for moments with a relative difference d as d|Ω|t; [`super::free::FreeMotion`] has neither error.
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

    /// Rotor and body angular velocity at time `t` in s. The angular velocity turns about the symmetry
    /// axis with `Ω_r`: `Ω_B(t) = exp(½Ω_r t) Ω_B(0) exp(−½Ω_r t)`.
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        let right = Rotor::exp(self.right * (-0.5 * t));
        let rotor = Rotor::exp(self.left * (-0.5 * t)) * self.rotor * right;
        (rotor.renormalized(), right.reverse().apply_bivector(self.omega))
    }
}
