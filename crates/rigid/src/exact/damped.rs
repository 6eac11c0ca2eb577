//! A body with the torque `N = −g L` in closed form.
//!
//! The momentum decays as `e^{−gt}` with constant direction in space. With `dτ = e^{−gt} dt` and `Ω = e^{−gt} Ω̃` the
//! equations `L' = −g L` and `R' = −½ R Ω_B` become those of the free body:
//!
//! ```text
//! R(t) = R̃(τ),   Ω(t) = e^{−gt} Ω̃(τ),   τ = (1 − e^{−gt})/g.
//! ```
//!
//! τ tends to `1/g`. It is computed in double-double precision: a midpoint step over its low part corrects the state at
//! its high part.

use super::free::FreeMotion;
use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::numerics::double_double::DoubleDouble;
use crate::state::phase::Gyrostat;
use polhode_ga::{Bivector, Rotor};

/// Up to this many radians the cube of the rounding error of τ is negligible.
const MOST_RADIANS: f64 = 1e10;

/// Largest exponent whose exponential, times the rates, is finite.
const MOST_EXPONENT: f64 = 600.0;

/// A damped motion: rotor and angular velocity at any time within its [`DampedTop::horizons`].
#[derive(Clone, Copy, Debug)]
pub struct DampedTop {
    free: FreeMotion,
    /// Principal moments and frame of the body.
    moments: [f64; 3],
    frame: Rotor,
    /// The g of the torque.
    damping: f64,
    /// The largest rate, in rad/s.
    fastest: f64,
}

impl DampedTop {
    /// The motion that starts at `rotor` (body axes to space) with angular velocity `omega` in body axes, and
    /// torque `−g L`, g in 1/s, of either sign. An error if a principal moment is zero or a number is not finite.
    pub fn new(
        inertia: &Inertia,
        rotor: Rotor,
        omega: Bivector,
        damping: f64,
    ) -> Result<DampedTop, SimulateError> {
        // Products in double-double precision overflow early.
        if damping.is_nan() || damping.abs() > 1e150 {
            return Err(SimulateError::BadValue { what: "the damping g", value: damping });
        }
        let free = FreeMotion::new(inertia, rotor, omega)?;
        let (moments, frame) = (inertia.principal_moments(), inertia.principal_frame());
        // |ω| stays below |L|/i_min.
        let principal = frame.reverse().apply_bivector(omega);
        let least = moments.iter().fold(f64::INFINITY, |m: f64, i| m.min(*i));
        let fastest = Gyrostat::rigid(moments).momentum(principal).norm() / least;
        for value in omega.0.into_iter().chain([fastest]) {
            if !value.is_finite() {
                return Err(SimulateError::BadValue { what: "the angular velocity", value });
            }
        }
        Ok(DampedTop { free, moments, frame, damping, fastest })
    }

    /// How far in time, in s, the phase is accurate, backwards and forwards; infinite where the motion decays.
    pub fn horizons(&self) -> [f64; 2] {
        let most = self.free.horizon().min(MOST_RADIANS / self.fastest);
        let rate = self.damping.abs();
        if rate == 0.0 {
            return [most, most];
        }
        let growing = (rate * most).ln_1p().min(MOST_EXPONENT) / rate;
        let dying = if rate * most > 1.0 { f64::INFINITY } else { -(-rate * most).ln_1p() / rate };
        if self.damping > 0.0 { [growing, dying] } else { [dying, growing] }
    }

    /// Rotor and body angular velocity at time `t` in s.
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        let [factor, less] = self.exponent(t).exp();
        let time = if less.hi == 0.0 { t.into() } else { -less / self.damping.into() };
        let (rotor, omega) = self.free.at(time.hi);
        let (rotor, omega) = self.ahead(rotor, omega, time.lo);
        (rotor, omega * factor.value())
    }

    /// −gt, bounded where the exponential vanishes.
    fn exponent(&self, t: f64) -> DoubleDouble {
        let rough = -self.damping * t;
        if rough < -MOST_EXPONENT * 1.2 {
            return (-MOST_EXPONENT * 1.2).into();
        }
        DoubleDouble::two_product(-self.damping, t)
    }

    /// The free state after a short time, by a midpoint step.
    fn ahead(&self, rotor: Rotor, omega: Bivector, time: f64) -> (Rotor, Bivector) {
        if time == 0.0 {
            return (rotor, omega);
        }
        let middle = omega + self.acceleration(omega) * (0.5 * time);
        let step = Rotor::exp(middle * (-0.5 * time));
        ((rotor * step).renormalized(), omega + self.acceleration(middle) * time)
    }

    /// Euler's equations without torque.
    fn acceleration(&self, omega: Bivector) -> Bivector {
        let [x, y, z] = self.frame.reverse().apply_bivector(omega).0;
        let [a, b, c] = self.moments;
        self.frame.apply_bivector(Bivector([
            (b - c) / a * (y * z),
            (c - a) / b * (z * x),
            (a - b) / c * (x * y),
        ]))
    }
}

#[cfg(test)]
mod tests;
