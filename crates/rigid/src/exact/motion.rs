//! Motions in closed form under the laws that have one.

use super::damped::DampedTop;
use super::flow::Flow;
use super::free::FreeMotion;
use super::lagrange::LagrangeTop;
use super::larmor::LarmorSphere;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use std::fmt::Debug;

/// A motion in closed form: its states at any time within its horizons.
pub trait ExactMotion: Debug + Send + Sync {
    /// Its states.
    fn flow(&self) -> &Flow;

    /// How far in time, in s, the phases are accurate, backwards and forwards.
    fn horizons(&self) -> [f64; 2];

    /// Estimated angle in rad at time `t` between the body's motion and this one, which takes moments that differ by
    /// rounding as equal.
    fn neglected(&self, _t: f64) -> f64 {
        0.0
    }

    /// Rotor and body angular velocity at time `t` in s, the same bits as [`ExactMotion::at_many`].
    fn at(&self, t: f64) -> (Rotor, Bivector) {
        self.flow().at(t)
    }

    /// The same at many times: rows of four rotor components and of three components of the angular velocity.
    ///
    /// # Panics
    /// If the numbers of rows and times differ.
    fn at_many(&self, threads: Threads, times: &[f64], rotors: &mut [f64], omegas: &mut [f64]) {
        self.flow().at_many(threads, times, rotors, omegas);
    }
}

impl ExactMotion for FreeMotion {
    fn flow(&self) -> &Flow {
        &self.flow
    }

    fn horizons(&self) -> [f64; 2] {
        [self.horizon(); 2]
    }
}

impl ExactMotion for LagrangeTop {
    fn flow(&self) -> &Flow {
        &self.flow
    }

    fn horizons(&self) -> [f64; 2] {
        [self.horizon(); 2]
    }

    fn neglected(&self, t: f64) -> f64 {
        LagrangeTop::neglected(self, t)
    }
}

impl ExactMotion for DampedTop {
    fn flow(&self) -> &Flow {
        &self.flow
    }

    fn horizons(&self) -> [f64; 2] {
        DampedTop::horizons(self)
    }
}

impl ExactMotion for LarmorSphere {
    fn flow(&self) -> &Flow {
        &self.flow
    }

    fn horizons(&self) -> [f64; 2] {
        [self.horizon(); 2]
    }

    fn neglected(&self, t: f64) -> f64 {
        LarmorSphere::neglected(self, t)
    }
}
