//! A momentum that the laws conserve, and its restoration after steps.

use crate::laws::torque::Torque;
use crate::state::phase::Phase;
use polhode_ga::{Bivector, Rotor};

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
