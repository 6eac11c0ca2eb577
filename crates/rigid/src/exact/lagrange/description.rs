//! The regime of a heavy symmetric top, and its periods.

use super::LagrangeTop;
use super::series::Zeros;
use crate::exact::regime::regimes;
use crate::facts;
use crate::facts::Facts;
use crate::numerics::precise::Precise;
use crate::numerics::wide::Wide;
use crate::state::phase::Gyrostat;
use std::f64::consts::PI;

/// Tolerance of equal tilts in rad, and of rates relative to their terms: rounding of the start.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A top is nearly upright up to this relative loss of height of its centre of mass, a tilt of 11.5 degrees.
const NEARLY: f64 = 0.02;

regimes! {
    /// How a heavy top moves.
    LagrangeRegime {
        /// No rotation, and no torque.
        Rest = "at rest",
        /// Upright, with a spin of the critical rate or more: stable.
        Sleeping = "sleeping, upright",
        /// Nearly upright at all times, with at least the critical spin: a sleeping top after a small push.
        NearlySleeping = "sleeping, nearly upright",
        /// Upright, with less than the critical spin: unstable.
        Upright = "upright, unstable",
        /// Upside down, with or without spin.
        Hanging = "hanging",
        /// The tilt is constant.
        Steady = "regular precession",
        /// The precession changes its sign between the bounds of the tilt.
        Loops = "nutating with loops",
        /// The precession has one sign.
        Waves = "nutating with waves",
        /// The precession is 0 at the upper bound.
        Cusps = "nutating with cusps",
        /// A pendulum that does not reach the upright.
        Swinging = "pendulum, swinging",
        /// A pendulum that passes the upright.
        Circulating = "pendulum, circulating",
        /// The axis tends to the upright.
        Separatrix = "separatrix",
    }
}

/// Description of a heavy top by its invariants. The axis is that of symmetry, towards the centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LagrangeDescription {
    /// The kind of motion.
    pub regime: LagrangeRegime,
    /// Smallest angle of the axis from up (e3), in rad.
    pub tilt_min: f64,
    /// Largest angle, in rad.
    pub tilt_max: f64,
    /// Period of the tilt, 2K/λ, in s; None if it is constant or not periodic.
    pub nutation_period: Option<f64>,
    /// Mean rate of precession about e3, in rad/s; None for the upright, hanging and separatrix.
    pub precession_rate: Option<f64>,
    /// Mean rate of rotation about the axis against the line of nodes, ψ', in rad/s; None with the precession's.
    pub spin_rate: Option<f64>,
    /// Modulus k of the elliptic functions.
    pub modulus: f64,
    /// Kinetic and potential energy, in J.
    pub energy: f64,
    /// L3, the angular momentum about the axis, in kg m²/s.
    pub axial_momentum: f64,
    /// Lz, the angular momentum about e3, in kg m²/s.
    pub vertical_momentum: f64,
    /// Least rate about the axis for which an upright top is stable, `2 √(|c| i1)/i3`, in rad/s.
    pub critical_spin: f64,
    /// Whether an upright top with this spin is stable.
    pub sleeps: bool,
}

impl LagrangeDescription {
    /// Period of the mean precession, in s.
    pub fn precession_period(&self) -> Option<f64> {
        self.precession_rate.map(|rate| 2.0 * PI / rate.abs()).filter(|period| period.is_finite())
    }

    /// The description by name.
    pub fn facts(&self) -> Facts {
        facts! {
            regime: self.regime.to_string(), tilt_min: self.tilt_min, tilt_max: self.tilt_max,
            nutation_period: self.nutation_period, precession_rate: self.precession_rate,
            precession_period: self.precession_period(), spin_rate: self.spin_rate, modulus: self.modulus,
            energy: self.energy, axial_momentum: self.axial_momentum, vertical_momentum: self.vertical_momentum,
            critical_spin: self.critical_spin, sleeps: self.sleeps,
        }
    }
}

impl LagrangeTop {
    /// The description by the invariants.
    pub fn describe(&self) -> LagrangeDescription {
        let (axes, start) = (&self.axes, &self.start);
        let momentum = self.momentum();
        let above = start.above.value();
        let potential = axes.c * (above - 1.0);
        let constant = tilt(start.below, start.above);
        let g = start.g.map(|g| g.value());
        let vertical = momentum.0[0] * g[0] + momentum.0[1] * g[1] + momentum.0[2] * (above - 1.0);
        let critical_spin = 2.0 * (axes.c * axes.i1).sqrt() / axes.i3;
        let sleeps = start.omega3.abs() >= critical_spin;
        let still = LagrangeDescription {
            regime: match () {
                () if start.omega3 == 0.0 && axes.c == 0.0 => LagrangeRegime::Rest,
                () if start.below.is_zero() && sleeps => LagrangeRegime::Sleeping,
                () if start.below.is_zero() => LagrangeRegime::Upright,
                () if start.above.is_zero() => LagrangeRegime::Hanging,
                () => LagrangeRegime::Steady,
            },
            tilt_min: constant,
            tilt_max: constant,
            nutation_period: None,
            precession_rate: None,
            spin_rate: None,
            modulus: 0.0,
            energy: Gyrostat::rigid([axes.i1, axes.i1, axes.i3]).kinetic(momentum) + potential,
            axial_momentum: momentum.0[2],
            vertical_momentum: vertical,
            critical_spin,
            sleeps,
        };
        let Some(orbit) = &self.orbit else { return still };
        let (delta, sigma, spin) = (orbit.delta, orbit.sigma, start.spin);
        let [(tilt_max, lower, _), (tilt_min, upper, term)] = [0, 1].map(|k| {
            let (below, above) = (orbit.below[k], orbit.above[k]);
            // b − ℓu at the bounds, and the size of its terms; at a pole the precession has the sign of ±ℓ.
            let (numerator, term) = match () {
                () if below.is_zero() => (spin, spin),
                () if above.is_zero() => (-spin, spin),
                () if below < Wide::ONE => (delta + spin * below, spin * below),
                () => (sigma - spin * above, spin * above),
            };
            (tilt(below, above), numerator, term)
        });
        let small = term.abs() * ROUNDING.into();
        let pendulum = delta.is_zero() && sigma.is_zero();
        let regime = match () {
            () if orbit.mean.is_none() => LagrangeRegime::Separatrix,
            () if tilt_max - tilt_min <= ROUNDING => LagrangeRegime::Steady,
            () if pendulum && orbit.surplus.is_positive() => LagrangeRegime::Circulating,
            () if pendulum => LagrangeRegime::Swinging,
            () if sleeps && axes.c > 0.0 && orbit.below[0].value() <= NEARLY => {
                LagrangeRegime::NearlySleeping
            }
            () if upper.abs() <= small => LagrangeRegime::Cusps,
            () if upper.is_negative() != lower.is_negative() => LagrangeRegime::Loops,
            () => LagrangeRegime::Waves,
        };
        let moving = LagrangeDescription { regime, tilt_min, tilt_max, modulus: orbit.k2.sqrt(), ..still };
        let Some(mean) = orbit.mean else { return moving };
        // The turns of the theta functions; one with real zeros changes sign instead.
        let turn = orbit.lambda * mean;
        let phase = |k: usize| {
            let Zeros { side: [side], eta: [eta], .. } = orbit.zeros[k];
            let turns = if eta == 0.0 { 0.0 } else { side };
            orbit.rates[k] + turn * turns.into()
        };
        let (sum, difference) = (phase(0) + phase(1), phase(0) - phase(1));
        let period = PI / turn.value() / start.scale;
        LagrangeDescription {
            nutation_period: Some(period).filter(|x| x.is_finite() && regime != LagrangeRegime::Steady),
            precession_rate: Some(sum.value() * start.scale),
            spin_rate: Some((difference + start.excess.narrow()).value() * start.scale),
            ..moving
        }
    }
}

/// The angle of an axis from e3, from 1 − u and 1 + u.
fn tilt(below: Wide, above: Wide) -> f64 {
    2.0 * below.sqrt().value().atan2(above.sqrt().value())
}
