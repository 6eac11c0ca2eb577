//! Kicks: torques at fixed attitude, solved exactly, and the restoration of momentum after free steps.

use crate::error::SimulateError;
use crate::laws::torque::{Torque, total_torque};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Rotor};

/// Torques that kick the momentum at fixed attitude.
#[derive(Clone, Debug)]
pub(crate) struct Kicks {
    wheel: Bivector,
    body: Gyrostat,
    torques: Vec<Torque>,
    damping: f64,
}

impl Kicks {
    /// Torques in principal axes, each dependent on attitude and time at most.
    pub fn new(body: Gyrostat, torques: Vec<Torque>) -> Kicks {
        let damping = torques.iter().map(Torque::damping_rate).sum();
        Kicks { wheel: body.wheel, body, torques, damping }
    }

    /// Solves `m' = N − g (m − h)` for a time t: `m − h` becomes `(m − h) e^(−gt) + N (1 − e^(−gt))/g`.
    pub fn kick(&self, state: &mut Phase, h: f64) -> Result<(), SimulateError> {
        let torque = total_torque(&self.torques, &self.body, state)?;
        let mut impulse = h;
        let decay = -self.damping * h;
        if decay != 0.0 {
            // Multiplying m by e^(−gt) would round alike at every step.
            let lost = decay.exp_m1();
            state.momentum += (state.momentum - self.wheel) * lost;
            impulse = h * lost / decay;
        }
        state.momentum += torque * impulse;
        Ok(())
    }
}

/// L in space, if the laws conserve it.
pub(crate) fn fixed_momentum(torques: &[Torque], start: &Phase) -> Option<Bivector> {
    let free = torques.iter().all(|t| matches!(t, Torque::Wheel(_)));
    free.then(|| start.rotor.apply_bivector(start.momentum))
}

/// Removes the rounding of one free step from |m| and the direction of `R m ~R`, to first order.
///
/// The direction of m is left alone: on an unstable axis a component that is zero stays zero.
pub(crate) fn restore_momentum(state: &mut Phase, fixed: Bivector) {
    let size = fixed.norm_squared();
    if size > 0.0 {
        // Adding rounds shrinking and growing alike; multiplying by 1 + x would not.
        let missing = 0.5 * (size - state.momentum.norm_squared()) / size;
        state.momentum += state.momentum * missing;
        let drifted = state.rotor.apply_bivector(state.momentum);
        // exp(−½ a∧b/|a||b|) turns the axial vector a into b; the first term suffices for so small a turn.
        let [x, y, z] = (drifted.dual().wedge(fixed.dual()) * (-0.5 / size)).0;
        state.rotor = Rotor::from_unit_components([1.0, x, y, z]) * state.rotor;
    }
}
