//! The regime of a free motion, and its periods.

use crate::facts;
use crate::facts::Facts;
use std::f64::consts::PI;

/// An enum of regimes, each with the name that it displays.
macro_rules! regimes {
    ($(#[$doc:meta])* $name:ident { $($(#[$of:meta])* $regime:ident = $text:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($(#[$of])* $regime),*
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(match self {
                    $($name::$regime => $text),*
                })
            }
        }
    };
}

pub(crate) use regimes;

regimes! {
    /// How a free body moves.
    Regime {
        /// No rotation.
        Rest = "at rest",
        /// A fixed axis: a principal axis, or any axis of a sphere.
        Steady = "steady rotation about a fixed axis",
        /// Two equal moments: regular precession, handout eq. (4.35).
        Symmetric = "symmetric top, regular precession",
        /// The polhode encircles the axis of the largest moment.
        ShortAxis = "short-axis mode",
        /// The polhode encircles the axis of the smallest moment.
        LongAxis = "long-axis mode",
        /// Between the two: the spin tends to the middle axis.
        Separatrix = "separatrix",
    }
}

/// What follows from the invariants of a free motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeDescription {
    /// The kind of motion.
    pub regime: Regime,
    /// Kinetic energy in J.
    pub energy: f64,
    /// Norm of the angular momentum in kg m²/s.
    pub angular_momentum: f64,
    /// Modulus k of the elliptic functions.
    pub modulus: f64,
    /// Principal axis (0, 1, 2) that the polhode encircles.
    pub axis: usize,
    /// Period of the angular velocity in the body, 4K/λ, in s. None if ω is constant or does not repeat.
    pub period: Option<f64>,
    /// Mean rate of precession about L, in rad/s; None with the period.
    pub precession_rate: Option<f64>,
    /// The solid angle that L sweeps in the body round the encircled axis in one period; None with the period.
    pub solid_angle: Option<f64>,
    /// Least and largest angle between L and the encircled axis, at most π/2; None at rest.
    pub wobble: Option<[f64; 2]>,
    /// Period of a small wobble about the axis of a steady rotation in s; None if the rotation is unstable or not
    /// steady.
    pub wobble_period: Option<f64>,
}

impl FreeDescription {
    /// Period of the mean precession about L, in s.
    pub fn precession_period(&self) -> Option<f64> {
        self.precession_rate.map(|rate| 2.0 * PI / rate)
    }

    /// The angle φ by which the body turns about L in a period: `R(T) = −exp(−½ L/|L| φ) R(0)`. The sign is that of the
    /// full turn of L about the axis in the body.
    pub fn phase_per_period(&self) -> Option<f64> {
        Some(self.precession_rate? * self.period?)
    }

    /// Time between reversals of the spin about the middle axis in s: half the period.
    pub fn flip_time(&self) -> Option<f64> {
        match self.regime {
            Regime::ShortAxis | Regime::LongAxis => self.period.map(|t| 0.5 * t),
            _ => None,
        }
    }

    /// The description by name; `axis` is 1, 2 or 3.
    pub fn facts(&self) -> Facts {
        let [wobble_min, wobble_max] = [0, 1].map(|end| self.wobble.map(|wobble| wobble[end]));
        facts! {
            regime: self.regime.to_string(), axis: self.axis + 1, modulus: self.modulus, energy: self.energy,
            angular_momentum: self.angular_momentum, period: self.period, precession_rate: self.precession_rate,
            precession_period: self.precession_period(), phase_per_period: self.phase_per_period(),
            solid_angle: self.solid_angle, flip_time: self.flip_time(),
            wobble_min: wobble_min, wobble_max: wobble_max, wobble_period: self.wobble_period,
        }
    }
}
