//! A body with the torque `N = −g L` in closed form.
//!
//! The momentum decays as `e^{−gt}` with constant direction in space. With `dτ = e^{−gt} dt` and `Ω = e^{−gt} Ω̃` the
//! equations `L' = −g L` and `R' = −½ R Ω_B` become those of the free body:
//!
//! ```text
//! R(t) = R̃(τ),   Ω(t) = e^{−gt} Ω̃(τ),   τ = (1 − e^{−gt})/g.
//! ```
//!
//! τ tends to `1/g`. It is computed in double-double precision, in which the phases of the free body are reduced.

pub(super) mod flow;

use super::flow::{Flow, either};
use super::free::series::{Circular, Hyperbolic};
use super::free::{FreeBody, FreeMotions};
use super::lanes::{Coefficients, SetUp};
use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::state::phase::Gyrostat;
use flow::Flow as DampedFlow;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use std::array::from_fn;

/// Up to this many radians the rounding error of τ is negligible.
const MOST_RADIANS: f64 = 1e10;

/// Largest exponent whose exponential, times the rates, is finite.
const MOST_EXPONENT: f64 = 600.0;

/// A damped motion: rotor and angular velocity at any time within its [`DampedTop::horizons`].
#[derive(Clone, Copy, Debug)]
pub struct DampedTop {
    pub(super) flow: Flow,
    /// The g of the torque.
    damping: f64,
    /// How far in the time of the free body, in s, its phase is accurate.
    horizon: f64,
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
        DampedTop::of(&DampedTop::body(inertia, rotor, omega, damping)?, damping)
    }

    /// The motion of a body of [`DampedTop::body`] with the same g.
    pub(crate) fn of(body: &FreeBody, damping: f64) -> Result<DampedTop, SimulateError> {
        let free = body.motion();
        let horizon = own_horizon(body, free.horizon())?;
        let flow = free.flow.damped(damping).ok_or(SimulateError::Unresolved)?;
        Ok(DampedTop { flow, damping, horizon })
    }

    /// The free body of the motion. An error as of [`DampedTop::new`].
    pub fn body(
        inertia: &Inertia,
        rotor: Rotor,
        omega: Bivector,
        damping: f64,
    ) -> Result<FreeBody, SimulateError> {
        // Products in double-double precision overflow early.
        if damping.is_nan() || damping.abs() > 1e150 {
            return Err(SimulateError::BadValue { what: "the damping g", value: damping });
        }
        if let Some(&value) = omega.0.iter().find(|x| !x.is_finite()) {
            return Err(SimulateError::BadValue { what: "the angular velocity", value });
        }
        FreeBody::new(inertia, rotor, omega)
    }

    /// How far in time, in s, the phase is accurate, backwards and forwards; infinite where the motion decays.
    pub fn horizons(&self) -> [f64; 2] {
        horizons(self.horizon, self.damping)
    }

    /// Rotor and body angular velocity at time `t` in s, the same bits as [`DampedTop::at_many`].
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        self.flow.at(t)
    }

    /// The same at many times: rows of four rotor components and of three components of the angular velocity.
    ///
    /// # Panics
    /// If the numbers of rows and times differ.
    pub fn at_many(&self, threads: Threads, times: &[f64], rotors: &mut [f64], omegas: &mut [f64]) {
        self.flow.at_many(threads, times, rotors, omegas);
    }
}

/// The motions of damped bodies, one in each lane.
#[derive(Clone, Debug)]
pub(crate) struct DampedMotions {
    free: FreeMotions<TOGETHER>,
    /// Valid where the free motion is circular.
    pub(super) circular: DampedFlow<Circular<TOGETHER>, TOGETHER>,
    /// Valid elsewhere.
    pub(super) hyperbolic: DampedFlow<Hyperbolic<TOGETHER>, TOGETHER>,
    /// [`DampedTop::horizons`] of each, or why it is not resolved.
    pub horizons: [Result<[f64; 2], SimulateError>; TOGETHER],
}

impl Default for DampedMotions {
    fn default() -> DampedMotions {
        DampedMotions {
            free: FreeMotions::default(),
            circular: DampedFlow::empty(),
            hyperbolic: DampedFlow::empty(),
            horizons: from_fn(|_| Err(SimulateError::Unresolved)),
        }
    }
}

impl DampedMotions {
    /// [`SetUp::set_up`], from each [`DampedTop::body`] and its g. Each motion has the bits that it has alone.
    pub fn set_up(&mut self, bodies: &[(FreeBody, f64); TOGETHER], count: usize) {
        self.free.set_up(&bodies.map(|(body, _)| body), count);
        let dampings = bodies.map(|(_, g)| g);
        self.circular = DampedFlow::new(self.free.circular, dampings);
        if self.free.is_circular != [true; TOGETHER] {
            self.hyperbolic = DampedFlow::new(self.free.hyperbolic, dampings);
        }
        for (l, (body, g)) in bodies.iter().enumerate() {
            self.horizons[l] = own_horizon(body, self.free.horizons[l]).map(|own| horizons(own, *g));
        }
    }

    /// [`FreeMotions::lanes`].
    pub(super) fn lanes(&self, count: usize) -> [Vec<usize>; 2] {
        self.free.lanes(count)
    }

    /// [`FreeMotions::at`].
    pub fn at(
        &self,
        times: &[f64; TOGETHER],
        rotors: &mut [[f64; 4]; TOGETHER],
        omegas: &mut [[f64; 3]; TOGETHER],
    ) {
        either((&self.circular, &self.hyperbolic), &self.free.is_circular, times, rotors, omegas);
    }
}

/// How far in the time of the free body its phase and τ are accurate, from how far its phase is.
fn own_horizon(body: &FreeBody, horizon: f64) -> Result<f64, SimulateError> {
    let (moments, omega) = (body.moments, body.omega);
    // |ω| stays below |L|/i_min.
    let least = moments.iter().fold(f64::INFINITY, |m: f64, i| m.min(*i));
    let fastest = Gyrostat::rigid(moments).momentum(omega).norm() / least;
    if !fastest.is_finite() {
        return Err(SimulateError::BadValue { what: "the angular velocity", value: fastest });
    }
    Ok(horizon.min(MOST_RADIANS / fastest))
}

/// [`DampedTop::horizons`].
fn horizons(most: f64, damping: f64) -> [f64; 2] {
    let rate = damping.abs();
    if rate == 0.0 {
        return [most, most];
    }
    let growing = (rate * most).ln_1p().min(MOST_EXPONENT) / rate;
    let dying = if rate * most > 1.0 { f64::INFINITY } else { -(-rate * most).ln_1p() / rate };
    if damping > 0.0 { [growing, dying] } else { [dying, growing] }
}

#[cfg(test)]
mod tests;
