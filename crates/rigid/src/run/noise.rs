//! Measures the amplification of rounding by a sweep with noise far above rounding.
//!
//! Every step rounds, and the motion amplifies the rounding of earlier steps: slightly where it is regular, exponentially
//! where it is chaotic. Sweeps with other steps do not measure this reliably, because they round alike. So a sweep is
//! repeated with the same steps, and the components of each point are multiplied by `1 ± s` with random signs. While the response is linear, with the tangent flow Φ and units ξ_k of random sign,
//!
//! ```text
//! difference = s |Σ_k Φ(t, t_k) ξ_k|,      rounding error = ρ |Σ_k Φ(t, t_k) ξ'_k|,
//! ```
//!
//! where ρ is the relative rounding of one step ([`super::engine::Engine::rounding`]). The two sums are of one
//! distribution, so that `difference ρ/s` estimates the rounding error; over n' steps instead of n it is √(n'/n) times
//! as large. A component that is zero stays zero, as in rounding: values that are exact by symmetry stay exact.

use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::Phase;
use polhode_ga::{Bivector, Rotor, Vector};

/// The first size of the noise: far above rounding, and small enough for a linear response where the amplification is
/// below 1e10.
pub(crate) const FIRST_SIZE: f64 = 1e-12;

/// A larger difference is not linear in the noise.
pub(crate) const LINEAR: f64 = 0.03;

/// Safety factor of the estimate: the response to rounding may exceed that to the noise.
const SAFETY: f64 = 3.0;

/// Random relative changes of size s of all components of a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// s.
    pub size: f64,
    /// Whether steps carry the momentum in space, and not in the body.
    pub in_space: bool,
    /// Of the generator SplitMix64 (Steele, Lea & Flood 2014).
    state: u64,
}

impl Noise {
    /// Noise of a size; another seed gives other signs.
    pub fn new(size: f64, in_space: bool, seed: u64) -> Noise {
        Noise { size, in_space, state: seed }
    }

    /// The point with noise added.
    pub fn perturb(&mut self, at: &Carried) -> Carried {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.state;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        let mut factor = || {
            let sign = if bits & 1 == 0 { 1.0 } else { -1.0 };
            bits >>= 1;
            1.0 + sign * self.size
        };
        let mut each = |v: [f64; 3]| v.map(|x| x * factor());
        let momentum = each(if self.in_space { at.momentum_space.0 } else { at.phase.momentum.0 });
        let center = Center {
            position: Vector(each(at.center.position.0)),
            velocity: Vector(each(at.center.velocity.0)),
        };
        let rotor = at.phase.rotor.components().map(|x| x * factor());
        let norm = rotor.iter().map(|x| x * x).sum::<f64>().sqrt();
        let rotor = Rotor::from_unit_components(rotor.map(|x| x / norm));
        let momentum_space = Bivector(momentum);
        if self.in_space {
            let momentum = rotor.reverse().apply_bivector(momentum_space) - at.driven;
            let phase = Phase { rotor, momentum, time: at.phase.time };
            return Carried { phase, momentum_space, driven: at.driven, center, lost: Bivector::default() };
        }
        Carried::new(Phase { rotor, momentum: Bivector(momentum), time: at.phase.time }, center)
    }
}

/// The measured amplification of rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Magnification {
    /// Ratio of the difference of two points to the noise of one step, per √n of n steps.
    per_step: f64,
    /// The relative rounding of one step.
    rounding: f64,
}

impl Magnification {
    /// From the difference caused by noise of a size over a number of steps.
    pub fn new(difference: f64, size: f64, steps: u64, rounding: f64) -> Magnification {
        Magnification { per_step: difference / (size * (steps.max(1) as f64).sqrt()), rounding }
    }

    /// The rounding error of a number of steps, with a margin.
    pub fn rounding_error(&self, steps: u64) -> f64 {
        SAFETY * self.rounding * (self.per_step * (steps as f64).sqrt()).max(1.0)
    }

    /// Bound of the ratio of the motion's error to the sum of the errors of its steps.
    pub fn of_sums(&self) -> f64 {
        SAFETY * self.per_step.max(1.0)
    }
}

#[cfg(test)]
mod tests;
