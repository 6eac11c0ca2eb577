//! What kind of motion a free body is in, and its periods.

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
    /// Period of the angular velocity in the body, 4K/λ, in s. None where nothing repeats or changes.
    pub period: Option<f64>,
    /// Mean rate of precession about L, in rad/s; None with the period.
    pub precession_rate: Option<f64>,
    /// The solid angle that L sweeps in the body round the encircled axis in one period; None with the period.
    pub solid_angle: Option<f64>,
    /// Least and largest angle between L and the encircled axis, at most π/2; None at rest.
    pub wobble: Option<[f64; 2]>,
    /// Period of a small wobble about the axis of a steady rotation in s; None if that is not stable, and if the
    /// motion is not steady.
    pub wobble_period: Option<f64>,
}

impl FreeDescription {
    /// Period of the mean precession about L, in s.
    pub fn precession_period(&self) -> Option<f64> {
        self.precession_rate.map(|rate| 2.0 * PI / rate)
    }

    /// The angle by which the body has turned about L after one period, at the mean rate of precession. With it
    /// `R(T) = −exp(−½ L/|L| φ) R(0)`: the turns of a rotor are counted to 4π, and one of 2π is L's own way round
    /// the encircled axis in the body.
    pub fn phase_per_period(&self) -> Option<f64> {
        Some(self.precession_rate? * self.period?)
    }

    /// Time between reversals of the spin about the middle axis, half the period, in s.
    pub fn flip_time(&self) -> Option<f64> {
        match self.regime {
            Regime::ShortAxis | Regime::LongAxis => self.period.map(|t| 0.5 * t),
            _ => None,
        }
    }
}
