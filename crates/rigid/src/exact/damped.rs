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
use crate::numerics::lanes::{Pair, exp_of_pair};
use crate::state::phase::Gyrostat;
use polhode_ga::rows::curve::{Curve, sample, value};
use polhode_ga::simd::double::{quick_two_sum, two_product};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use std::array::from_fn;

/// Up to this many radians the cube of the rounding error of τ is negligible.
const MOST_RADIANS: f64 = 1e10;

/// Largest exponent whose exponential, times the rates, is finite.
const MOST_EXPONENT: f64 = 600.0;

/// Where `gt` is smaller, τ is t to rounding.
const STILL: f64 = 1e-200;

/// Exponents from which the exponential vanishes beside the rates.
const VANISHED: f64 = 720.0;

/// A damped motion: rotor and angular velocity at any time within its [`DampedTop::horizons`].
#[derive(Clone, Copy, Debug)]
pub struct DampedTop {
    free: FreeMotion,
    /// The principal axes of the body, in body axes, and `(i2 − i3)/i1` and so on.
    axes: [[f64; 3]; 3],
    ratios: [f64; 3],
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
        let [a, b, c] = moments;
        let axis = |unit| frame.apply_bivector(Bivector(unit)).0;
        Ok(DampedTop {
            free,
            axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(axis),
            ratios: [(b - c) / a, (c - a) / b, (a - b) / c],
            damping,
            fastest,
        })
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

    /// Rotor and body angular velocity at time `t` in s, the same bits as [`DampedTop::at_many`].
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        let (rotor, omega) = value(self, t);
        (Rotor::from_unit_components(rotor), Bivector(omega))
    }

    /// The same at many times: rows of four rotor components and of three components of the angular velocity.
    ///
    /// # Panics
    /// If the numbers of rows and times differ.
    pub fn at_many(&self, threads: Threads, times: &[f64], rotors: &mut [f64], omegas: &mut [f64]) {
        sample(self, threads, times, rotors, omegas);
    }

    /// The time τ of the free body in double-double precision, and `e^{−gt}`.
    #[inline(always)]
    fn time_and_factor<const FMA: bool>(&self, t: f64) -> (Pair, f64) {
        let g = self.damping;
        let (hi, lo) = two_product::<FMA>(-g, t);
        let vanished = hi < -VANISHED;
        let exponent = (if vanished { -VANISHED } else { hi }, if vanished { 0.0 } else { lo });
        let [factor, less] = exp_of_pair::<FMA>(exponent);
        // (1 − e^{−gt})/g: the quotient, and that of the remainder.
        let still = less.0.abs() < STILL;
        let divisor = if still { 1.0 } else { g };
        let quotient = -less.0 / divisor;
        let (product, error) = two_product::<FMA>(quotient, divisor);
        let rest = (((-less.0 - product) - error) - less.1) / divisor;
        let (hi, lo) = quick_two_sum(quotient, rest);
        ((if still { t } else { hi }, if still { 0.0 } else { lo }), factor.0 + factor.1)
    }

    /// The free state after a short time, by a midpoint step. Its rotor is `exp(−½ Ω dt)` to second order.
    #[inline(always)]
    fn ahead(&self, (rotor, omega): ([f64; 4], [f64; 3]), time: f64) -> ([f64; 4], [f64; 3]) {
        let rate = self.acceleration(omega);
        let middle: [f64; 3] = from_fn(|k| omega[k] + rate[k] * (0.5 * time));
        let rate = self.acceleration(middle);
        let [x, y, z] = middle.map(|w| w * (-0.5 * time));
        let step = Rotor::from_unit_components([1.0 - 0.5 * (x * x + y * y + z * z), x, y, z]);
        let turned = Rotor::from_unit_components(rotor) * step;
        (turned.components(), from_fn(|k| omega[k] + rate[k] * time))
    }

    /// Euler's equations without torque.
    #[inline(always)]
    fn acceleration(&self, omega: [f64; 3]) -> [f64; 3] {
        let dot = |a: [f64; 3]| a[0] * omega[0] + a[1] * omega[1] + a[2] * omega[2];
        let [x, y, z] = self.axes.map(dot);
        let [a, b, c] = self.ratios;
        let change = [a * (y * z), b * (z * x), c * (x * y)];
        from_fn(|k| self.axes[0][k] * change[0] + self.axes[1][k] * change[1] + self.axes[2][k] * change[2])
    }
}

impl Curve<4, 3> for DampedTop {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let (mut high, mut low, mut factor) = ([0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            ((high[l], low[l]), factor[l]) = self.time_and_factor::<FMA>(times[l]);
        }
        let (mut rotor, mut omega) = self.free.values::<W, FMA>(&high);
        for l in 0..W {
            let start = (rotor.map(|r| r[l]), omega.map(|w| w[l]));
            let (r, w) = self.ahead(start, low[l]);
            (0..4).for_each(|k| rotor[k][l] = r[k]);
            (0..3).for_each(|k| omega[k][l] = w[k] * factor[l]);
        }
        (rotor, omega)
    }
}

#[cfg(test)]
mod tests;
