//! The accuracy of a run, and the difference of two sweeps.

use super::sweep::{LEAST_TOLERANCE, StepRule, Sweep};
use crate::state::carried::Carried;
use crate::state::phase::Gyrostat;

/// The default relative tolerance.
const DEFAULT_RTOL: f64 = 1e-10;

/// The largest relative error accepted by default where rounding allows no less: a motion along a separatrix amplifies
/// it a thousandfold and more. The certificate has the estimate.
const WORST_BY_DEFAULT: f64 = 1e-6;

/// The accuracy to reach.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accuracy {
    /// Of the method.
    pub order: i32,
    pub goal: f64,
    /// The largest accepted error, where rounding allows no less.
    pub acceptable: f64,
}

impl Accuracy {
    /// The accuracy of a method of this order for a relative tolerance, or by default.
    pub fn new(order: i32, rtol: Option<f64>) -> Accuracy {
        Accuracy { order, goal: rtol.unwrap_or(DEFAULT_RTOL), acceptable: rtol.unwrap_or(WORST_BY_DEFAULT) }
    }

    /// Adaptive steps of the first sweep, whose errors add up.
    pub fn first_steps(&self) -> StepRule {
        StepRule::adapted((0.1 * self.goal).max(1e3 * LEAST_TOLERANCE))
    }

    /// The error to reach given this rounding: by default, at least twice the rounding.
    pub fn reachable(&self, rounding: f64) -> f64 {
        self.goal.max(2.0 * rounding).min(self.acceptable)
    }
}

/// Data of a problem for the comparison of sweeps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    pub body: Gyrostat,
    /// The relative rounding of one step.
    pub rounding: f64,
    /// Whether steps carry the momentum in space.
    pub in_space: bool,
    /// The time from the first output or the start to the last, in s.
    pub duration: f64,
    /// Whether the laws change slowly at the scale of steps and are not known to have kinks. Otherwise a difference need not
    /// scale with the order and is taken as the error itself.
    pub is_smooth: bool,
}

/// Largest difference of two sweeps at the output times and events.
pub(crate) fn difference(
    scales: &Scales,
    coarse: &Sweep,
    fine: &Sweep,
    follow: &dyn Fn(&Carried, f64) -> Carried,
) -> f64 {
    // An event ended one of them and not the other.
    if coarse.ends != fine.ends {
        return 1.0;
    }
    let outputs = coarse.states.iter().zip(&fine.states).map(|(a, b)| apart(scales, fine, a, b));
    // A grazing event may be missing in one of them.
    let same = coarse.events.len() == fine.events.len();
    let events = coarse.events.iter().zip(&fine.events).filter(|(a, b)| same && a.event == b.event);
    let events = events.map(|(a, b)| apart(scales, fine, &follow(&a.at, b.at.phase.time), &b.at));
    outputs.chain(events).fold(0.0, f64::max)
}

/// The last output time up to which two sweeps differ by no more than this, in s; None if they do not differ by more
/// later, or not agree after the start.
pub(crate) fn agreement(scales: &Scales, coarse: &Sweep, fine: &Sweep, within: f64) -> Option<f64> {
    let pairs = coarse.states.iter().zip(&fine.states);
    let differences: Vec<f64> = pairs.map(|(a, b)| apart(scales, fine, a, b)).collect();
    let last = differences.iter().position(|difference| *difference > within)?.checked_sub(1)?;
    // The states at the start are equal.
    (differences[last] > 0.0).then(|| fine.states[last].phase.time)
}

/// The difference of two states of sweeps: in the rotor, and in angular velocity, position and velocity relative to the
/// largest magnitudes of the finer sweep.
fn apart(scales: &Scales, fine: &Sweep, a: &Carried, b: &Carried) -> f64 {
    let body = &scales.body;
    let [fastest, farthest, swiftest] = fine.largest.map(|x| x.max(f64::MIN_POSITIVE));
    let fastest = fastest.max(body.least_rate());
    let (r, s) = (a.phase.rotor.components(), b.phase.rotor.components());
    let turn = (0..4).map(|k| (r[k] - s[k]) * (r[k] - s[k])).sum::<f64>().sqrt();
    let spin = (body.omega(a.phase.momentum) - body.omega(b.phase.momentum)).norm() / fastest;
    let place = (a.center.position - b.center.position).norm() / farthest;
    let velocity = (a.center.velocity - b.center.velocity).norm() / swiftest;
    turn.max(spin).max(place).max(velocity)
}
