//! One pass over the output times, by fixed steps or by steps that keep to a tolerance.

use crate::certificate::Watch;
use crate::conserved::Conserved;
use crate::method::Engine;
use crate::phase::{Gyrostat, Phase};
use crate::runge_kutta::Carried;
use crate::simulate_error::{MAX_STEPS, SimulateError};

/// How often, in steps, a run asks whether to go on.
const STEPS_BETWEEN_CALLS: u64 = 256;

/// Where a run stands: which pass, and the fraction of it done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Passes count from 1.
    pub pass: u32,
    /// From 0 to 1.
    pub fraction: f64,
}

/// What rules the steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Pace {
    /// Equal steps of at most this length in s, ending on the output times.
    Step(f64),
    /// Steps whose estimated error is at most this.
    Tolerance(f64),
}

/// What a pass found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pass {
    pub states: Vec<Phase>,
    /// Each conserved quantity with its value at the start and its largest relative change.
    pub drifts: Vec<(Conserved, f64, f64)>,
    /// The longest step.
    pub longest: f64,
    pub steps: u64,
    pub evaluations: u64,
}

/// A pass under way.
pub(crate) struct Walker<'a> {
    pub body: Gyrostat,
    pub engine: &'a Engine,
    pub watch: Watch<'a>,
    pub pace: Pace,
    /// Times at which the laws are not smooth, rising.
    pub breaks: &'a [f64],
    pub number: u32,
    pub progress: &'a mut dyn FnMut(Progress) -> bool,
}

/// Where a walk in one direction of time stands.
struct Walk {
    at: Carried,
    /// The next step, if nothing is in its way.
    next: f64,
    /// The largest angular velocity so far, in rad/s.
    fastest: f64,
}

impl Walker<'_> {
    /// The states at all times, which do not fall; `first` is a guess of the first step.
    pub fn pass(mut self, start: Phase, times: &[f64], first: f64) -> Result<Pass, SimulateError> {
        let (begin, end) =
            (times.first().copied().unwrap_or(0.0).min(0.0), times.last().copied().unwrap_or(0.0).max(0.0));
        let total = end - begin;
        if let Pace::Step(step) = self.pace {
            let steps = total / step + times.len() as f64;
            if steps > MAX_STEPS {
                return Err(SimulateError::TooManySteps { steps, step });
            }
        }
        let mut pass = Pass::default();
        let fastest = self.body.omega(start.momentum).norm();
        let fresh = || Walk { at: Carried::new(start), next: first, fastest };
        let split = times.partition_point(|&t| t < 0.0);
        let mut walk = fresh();
        for &time in times[..split].iter().rev() {
            self.walk(&mut walk, time, &mut pass, total)?;
            pass.states.push(walk.at.phase);
        }
        pass.states.reverse();
        walk = fresh();
        for &time in &times[split..] {
            self.walk(&mut walk, time, &mut pass, total)?;
            pass.states.push(walk.at.phase);
        }
        pass.drifts = self.watch.finish();
        Ok(pass)
    }

    /// Walks to a time, stopping wherever a law is not smooth.
    fn walk(&mut self, walk: &mut Walk, time: f64, pass: &mut Pass, total: f64) -> Result<(), SimulateError> {
        loop {
            let from = walk.at.phase.time;
            let (breaks, forward) = (self.breaks, time > from);
            let between = if forward {
                breaks.get(breaks.partition_point(|&b| b <= from)).filter(|&&b| b < time)
            } else {
                breaks[..breaks.partition_point(|&b| b < from)].last().filter(|&&b| b > time)
            };
            let to = between.copied().unwrap_or(time);
            match self.pace {
                Pace::Step(step) => self.equal_steps(walk, to, step, pass, total)?,
                Pace::Tolerance(tolerance) => self.adapted_steps(walk, to, tolerance, pass, total)?,
            }
            if between.is_none() {
                return Ok(());
            }
        }
    }

    fn equal_steps(
        &mut self,
        walk: &mut Walk,
        time: f64,
        step: f64,
        pass: &mut Pass,
        total: f64,
    ) -> Result<(), SimulateError> {
        let (from, span) = (walk.at.phase.time, time - walk.at.phase.time);
        let count = (span.abs() / step).ceil().max(1.0);
        if span == 0.0 {
            return Ok(());
        }
        for i in 0..count as u64 {
            let last = i + 1 == count as u64;
            let to = if last { time } else { from + span * ((i + 1) as f64 / count) };
            // The difference of the rounded times, so that the steps add up to the time.
            let (next, _) = self.step(&walk.at, to - walk.at.phase.time, walk.fastest, pass)?;
            self.arrive(walk, next, to, pass, total)?;
        }
        Ok(())
    }

    /// Each next step is the longest whose error should be 0.9⁸ of the tolerance.
    fn adapted_steps(
        &mut self,
        walk: &mut Walk,
        time: f64,
        tolerance: f64,
        pass: &mut Pass,
        total: f64,
    ) -> Result<(), SimulateError> {
        let direction = (time - walk.at.phase.time).signum();
        let mut refused = false;
        while walk.at.phase.time != time {
            let rest = (time - walk.at.phase.time).abs();
            // A last step that is much shorter than the one before helps nobody.
            let cut = if walk.next >= rest { rest } else { walk.next.min(0.5 * rest.max(walk.next)) };
            let to = if cut >= rest { time } else { walk.at.phase.time + direction * cut };
            let h = to - walk.at.phase.time;
            if h == 0.0 || cut < 1e-14 * walk.at.phase.time.abs() {
                return Err(SimulateError::StepTooSmall { time: walk.at.phase.time, step: cut });
            }
            let (next, error) = self.step(&walk.at, h, walk.fastest, pass)?;
            let error = error / tolerance;
            // NaN too.
            if error.is_nan() || error > 1.0 {
                walk.next =
                    h.abs() * if error.is_finite() { (0.9 * error.powf(-0.125)).max(0.2) } else { 0.2 };
                refused = true;
                continue;
            }
            let growth = (0.9 * error.powf(-0.125)).clamp(0.3, if refused { 1.0 } else { 6.0 });
            // A step cut short by an output time says little of how long it might be.
            walk.next = if cut < walk.next { walk.next.max(h.abs() * growth) } else { h.abs() * growth };
            refused = false;
            self.arrive(walk, next, to, pass, total)?;
            if pass.steps as f64 > MAX_STEPS {
                return Err(SimulateError::TooManySteps { steps: pass.steps as f64, step: cut });
            }
        }
        Ok(())
    }

    fn step(
        &self,
        at: &Carried,
        h: f64,
        fastest: f64,
        pass: &mut Pass,
    ) -> Result<(Carried, f64), SimulateError> {
        pass.evaluations += self.engine.evaluations();
        let failed = |error: crate::torque::TorqueError| SimulateError::Torque {
            time: at.phase.time,
            message: error.0,
        };
        self.engine.step(at, h, fastest).map_err(failed)
    }

    /// Takes a step.
    fn arrive(
        &mut self,
        walk: &mut Walk,
        mut next: Carried,
        time: f64,
        pass: &mut Pass,
        total: f64,
    ) -> Result<(), SimulateError> {
        pass.longest = pass.longest.max((time - walk.at.phase.time).abs());
        pass.steps += 1;
        next.phase.time = time;
        walk.at = next;
        let state = &walk.at.phase;
        self.watch.look(state);
        let omega = self.body.omega(state.momentum).norm();
        if !(omega.is_finite() && state.rotor.components().iter().all(|x| x.is_finite())) {
            return Err(SimulateError::Diverged { time });
        }
        walk.fastest = walk.fastest.max(omega);
        if pass.steps.is_multiple_of(STEPS_BETWEEN_CALLS) {
            let behind = if time < 0.0 { -time } else { total - (total - time) };
            let fraction = (behind / total.max(f64::MIN_POSITIVE)).min(1.0);
            if !(self.progress)(Progress { pass: self.number, fraction }) {
                return Err(SimulateError::Interrupted);
            }
        }
        Ok(())
    }
}
