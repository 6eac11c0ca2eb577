//! Bounds of steps: their stops, largest length and number.

use super::stops::{InTime, Sampled, sampled};
use super::{MAX_STEPS, Options};
use crate::error::SimulateError;
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::methods::step_control::Limit;
use crate::state::phase::Phase;
use crate::state::point::Point;

/// Bounds of the steps of a run.
#[derive(Clone, Debug)]
pub(crate) struct StepBounds {
    /// Ascending times at which steps end: the laws are not smooth there, or change fast.
    pub breaks: Vec<f64>,
    /// The longest step, in s.
    pub longest: f64,
    pub limit: Limit,
    /// The rate in rad/s of the swing of the largest moment under the torques, a lower bound of the scale of angular
    /// velocities: an error of the attitude causes an error of the rate that is larger by this factor.
    pub least_rate: f64,
    /// A small part of the speed in m/s that forces that depend on time give to a body at rest: a lower bound of the scale of
    /// errors, without which a step in which the body begins to move would have an error of its own size.
    pub least_speed: f64,
    /// The longest piece of a step in which events are sought at its ends and its middle, in s: half of the shortest
    /// oscillation of their quantities with time.
    pub piece: f64,
}

/// The part of a speed known roughly below which errors are not relative to smaller speeds.
const PART_OF_SPEED: f64 = 0.01;

/// The earliest and the latest of times and of the start.
pub(crate) fn span(times: &[f64], start: f64) -> [f64; 2] {
    [times.first().map_or(start, |t| t.min(start)), times.last().map_or(start, |t| t.max(start))]
}

impl Default for StepBounds {
    fn default() -> StepBounds {
        let limit = Limit { steps: MAX_STEPS, reports_stiffness: false };
        StepBounds {
            breaks: Vec::new(),
            longest: f64::INFINITY,
            limit,
            least_rate: 0.0,
            least_speed: 0.0,
            piece: f64::INFINITY,
        }
    }
}

/// Samples of laws in time, on both sides of the start.
pub(crate) type Samples = Vec<[Sampled; 2]>;

/// Samples the laws over the output times, for a method that `adapts` its steps or refines equal ones; given steps need no
/// samples. The torques come first, then the forces.
pub(crate) fn samples(
    torques: &[Torque],
    forces: &[Force],
    start: &Point,
    times: &[f64],
    options: &Options,
    adapts: bool,
) -> Result<Samples, SimulateError> {
    if options.step.is_some() {
        return Ok(Vec::new());
    }
    let time = start.phase.time;
    let [first, last] = span(times, time);
    let torques = torques.iter().map(|law| InTime::of_torque(law, start));
    let laws = torques.chain(forces.iter().map(|force| InTime::of_force(force, start)));
    let both = |law: Option<InTime>| -> Result<[Sampled; 2], SimulateError> {
        let Some(law) = law else { return Ok(Default::default()) };
        Ok([sampled(&law, [first, time], adapts)?, sampled(&law, [time, last], adapts)?])
    };
    laws.map(both).collect()
}

impl StepBounds {
    /// Whether the laws change slowly at the scale of steps at all times.
    pub fn is_smooth(&self) -> bool {
        self.breaks.is_empty()
    }

    /// The largest number of pieces of steps in which events of an oscillating centre of mass are sought.
    pub fn most_pieces(&self) -> f64 {
        self.limit.steps.max(MAX_STEPS)
    }

    /// The same with the scale of a centre of mass under forces, given their samples and the mass in kg.
    pub fn with_forces(self, samples: &[[Sampled; 2]], mass: f64) -> StepBounds {
        let impulse: f64 = samples.iter().flatten().map(|sampled| sampled.impulse).sum();
        StepBounds { least_speed: if impulse > 0.0 { PART_OF_SPEED * impulse / mass } else { 0.0 }, ..self }
    }

    /// For laws in principal axes, with their samples.
    pub fn new(torques: &[Torque], samples: &Samples, start: &Point, options: &Options) -> StepBounds {
        let mut breaks: Vec<f64> = torques.iter().flat_map(|law| law.breaks()).copied().collect();
        breaks.extend(&options.breaks);
        breaks.extend(samples.iter().flatten().flat_map(|sampled| &sampled.stops));
        breaks.sort_by(f64::total_cmp);
        let size = |(k, law): (usize, &Torque)| {
            let peaks = samples.get(k).into_iter().flatten().filter_map(|sampled| sampled.peak);
            let at = |time: f64| {
                let phase = &Phase { time, ..*start.phase };
                law.size_at(&Point { phase, ..*start })
            };
            peaks.map(at).fold(law.size_at(start), f64::max)
        };
        let torque: f64 = torques.iter().enumerate().map(size).sum();
        // Rounding of the momentum of wheels is 1e-12 of this rate, as for a gyrostat.
        let motors = |law: &Torque| if let Torque::Wheels(wheels) = law { wheels.sizes()[1] } else { 0.0 };
        let wheels: f64 = torques.iter().map(motors).sum();
        let smallest = start.body.moments.iter().fold(f64::INFINITY, |m: f64, x| m.min(*x));
        let largest = start.body.moments.iter().fold(0.0, |m: f64, x| m.max(*x));
        StepBounds {
            breaks,
            longest: options.max_step.unwrap_or(f64::INFINITY),
            limit: Limit { steps: options.most_steps(), reports_stiffness: options.may_change_method() },
            least_rate: (torque / largest).sqrt().max(1e-4 * wheels / smallest),
            least_speed: 0.0,
            piece: f64::INFINITY,
        }
    }
}
