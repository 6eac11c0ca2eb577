//! A body in principal axes, and its rotational state.

use polhode_ga::simd::lanes::{Lanes, One};
use polhode_ga::{Bivector, Rotor, Vector};

/// A body in its principal axes, with a wheel inside whose momentum relative to the body is constant (a gyrostat;
/// zero without a wheel). Its angular momentum is `m = I(Ω) + h`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gyrostat {
    /// Principal moments, wheel included, in kg m²; positive.
    pub moments: [f64; 3],
    /// The wheel's momentum `h` relative to the body, in kg m²/s.
    pub wheel: Bivector,
}

/// A point of the motion in principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// From principal axes to space.
    pub rotor: Rotor,
    /// Angular momentum in principal axes, that of the wheel included, kg m²/s.
    pub momentum: Bivector,
    /// Time in s.
    pub time: f64,
}

impl Phase {
    /// `γ = ~R e3 R`: the vertical of space in body axes.
    #[inline]
    pub fn vertical(&self) -> Vector {
        Vector(One::alone(vertical(&One::each(self.rotor.components()))))
    }
}

impl Gyrostat {
    /// A body without a wheel.
    pub fn rigid(moments: [f64; 3]) -> Gyrostat {
        Gyrostat { moments, wheel: Bivector::default() }
    }

    /// `m = I(Ω) + h`.
    pub fn momentum(&self, omega: Bivector) -> Bivector {
        self.carried(omega) + self.wheel
    }

    /// `I(Ω)`: the momentum without the wheel's.
    pub fn carried(&self, omega: Bivector) -> Bivector {
        Bivector([0, 1, 2].map(|k| self.moments[k] * omega.0[k]))
    }

    /// `Ω = I⁻¹(m − h)`.
    pub fn omega(&self, momentum: Bivector) -> Bivector {
        Bivector([0, 1, 2].map(|k| (momentum.0[k] - self.wheel.0[k]) / self.moments[k]))
    }

    /// `½ Ω·I(Ω)`, in J; without the wheel's relative rotation.
    pub fn kinetic(&self, momentum: Bivector) -> f64 {
        let term = |k: usize| {
            let carried = momentum.0[k] - self.wheel.0[k];
            if carried == 0.0 { 0.0 } else { carried * carried / self.moments[k] }
        };
        0.5 * (term(0) + term(1) + term(2))
    }

    /// The rate in rad/s at which rounding of the wheel's momentum is 1e-12 of `Ω`; 0 without a wheel.
    pub(crate) fn least_rate(&self) -> f64 {
        let smallest = self.moments.iter().fold(f64::INFINITY, |m: f64, x| m.min(*x));
        1e-4 * self.wheel.norm() / smallest
    }

    /// The inertia matrix on a vector.
    pub fn stretched(&self, u: Vector) -> Vector {
        Vector([0, 1, 2].map(|k| self.moments[k] * u.0[k]))
    }
}

/// `γ = ~R e3 R`: the vertical of space in body axes.
#[inline(always)]
pub(crate) fn vertical<const W: usize, const F: bool>([s, x, y, z]: &[Lanes<W, F>; 4]) -> [Lanes<W, F>; 3] {
    let (along, across) = (s.times_plus(*s, *z * *z), x.times_plus(*x, *y * *y));
    let [a, b] = [s.times_plus(*y, *x * *z), s.times_from(*x, *y * *z)];
    [a + a, b + b, along - across]
}
