//! Convergence: sweeps with ever shorter steps until two of them agree.
//!
//! The error of a sweep has two parts, and both are measured. *Truncation* falls with the step: with steps h and h/s the
//! sweeps differ by `e (s^q − 1)`, where `e` is the truncation of the second. *Rounding* does not; its amplification by
//! the motion is measured once by sweeps with noise ([`super::noise`]), as soon as two sweeps are close. A motion that
//! amplifies rounding beyond the tolerance is rejected then, before further sweeps.

use super::accuracy::{Accuracy, Scales, agreement, difference};
use super::noise::{FIRST_SIZE, LINEAR, Magnification, Noise};
use super::sweep::{LEAST_TOLERANCE, StepRule, Sweep};
use crate::error::SimulateError;
use crate::state::carried::Carried;

/// Refinement factor of the second sweep.
const SECOND: f64 = 1.6;

/// Sweeps whose numbers of steps differ by less do not reveal the truncation.
const COMPARABLE: f64 = 1.1;

/// Two sweeps that differ by less resolve the same motion.
const RESOLVED: f64 = 0.05;

/// The fraction of the method's order assumed for truncation until it has been observed, and the fraction of the
/// observed order that is relied on.
const ASSUMED: f64 = 0.5;
const TRUSTED: f64 = 0.75;

/// The next sweep is to have an error smaller by at least this factor.
const LEAST_GAIN: f64 = 2.2;

/// Maximum refinement factor of the next sweep.
const LEAP: f64 = 6.0;

/// A difference that falls faster than this multiple of the order is small by chance.
const FASTEST_FALL: f64 = 1.25;

/// The errors of two sweeps may agree by chance. So the sum of the error estimates of all steps counts too, up to this part
/// of the goal: without this limit long runs would need further sweeps, since the errors of their steps hardly add up.
const COUNTED: f64 = 1e-3;

/// The same where the method does not show its order: under a law that is not smooth, and in fewer steps than this.
const COUNTED_WITHOUT_ORDER: f64 = 0.1;
const FEW_STEPS: u64 = 16;

/// The same for the sum of the steps that stops cut short. Many keep their lengths from sweep to sweep, so that the
/// difference does not show their errors.
const COUNTED_OF_CUT_STEPS: f64 = 0.5;

/// The orders of any method where a law has kinks, and where it jumps.
const ORDER_AT_KINKS: f64 = 2.0;
const ORDER_AT_JUMPS: f64 = 1.0;

/// Safety factor of the errors caused by jumps: they change the times of later jumps.
const MARGIN_AT_JUMPS: f64 = 2.0;

/// Sweeps that differ by less than this part of the accepted error agree: with a margin, so that a run up to there, which
/// has other sweeps, reaches it.
const AGREEING: f64 = 0.1;

/// Maximum number of sweeps with different steps.
const MOST_SWEEPS: u32 = 30;

/// How often steps are halved with which a first sweep fails.
const MOST_HALVINGS: u32 = 8;

/// After this many sweeps without agreement, sweeps with noise show whether rounding is the cause.
const FEW_SWEEPS: u32 = 5;

impl StepRule {
    /// Steps shorter by a factor.
    fn refined(self, by: f64) -> StepRule {
        match self {
            StepRule::Step(steps) => StepRule::Step(steps.refined(by)),
            StepRule::Tolerance(steps) => StepRule::Tolerance(steps.refined(by)),
        }
    }
}

/// The next sweep to run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepPlan {
    pub rule: StepRule,
    /// Number of the sweep, from 1.
    pub number: u32,
    /// The largest angular velocity of the previous sweep, in rad/s: the scale of errors from the start on. Otherwise a
    /// body at rest until it is pushed would need a tolerance relative to nearly zero.
    pub known_rate: f64,
    pub noise: Option<Noise>,
    /// Whether the errors of equal steps in which a law jumps are added up.
    pub watches_jumps: bool,
}

impl SweepPlan {
    /// The plan of a single sweep.
    pub fn only(rule: StepRule) -> SweepPlan {
        SweepPlan { rule, number: 1, known_rate: 0.0, noise: None, watches_jumps: false }
    }
}

/// The final sweep.
pub(crate) struct Converged {
    pub rule: StepRule,
    /// With the steps and evaluations of all sweeps.
    pub sweep: Sweep,
    /// A conservative estimate of its error.
    pub error: f64,
}

/// Two sweeps to be compared once sweeps with noise have measured the rounding.
struct Pair {
    coarse: Sweep,
    /// Of the coarse sweep.
    rule: StepRule,
    known_rate: f64,
    fine: Sweep,
    difference: f64,
    /// Size and number of the current noise, and the largest difference that noise of this size has caused.
    size: f64,
    repeats: u32,
    response: f64,
}

/// Controls the sweeps until two agree: plans the next and takes its result.
///
/// Half of the order q is assumed at first; once two differences have shown an order, three quarters of it. This predicts
/// the next step, so that few sweeps are needed.
///
/// Adaptive steps are also bounded by the output times, and may hardly change with the tolerance. For them s is the ratio
/// of the numbers of steps; where it is nearly 1, the sum of the error estimates of all steps must be small instead.
pub(crate) struct Convergence {
    accuracy: Accuracy,
    scales: Scales,
    /// Of the next sweep without noise, and its number among those.
    rule: StepRule,
    number: u32,
    known_rate: f64,
    /// The previous sweep, with its step rule and known rate.
    coarse: Option<(Sweep, StepRule, f64)>,
    pair: Option<Pair>,
    magnification: Option<Magnification>,
    /// The number of the sweep from which unresolved sweeps are repeated with noise.
    noise_from: u32,
    /// Of all sweeps.
    sweeps: u32,
    steps: u64,
    evaluations: u64,
    /// Refinement factor of the next sweep.
    by: f64,
    /// The last difference and its refinement factor.
    last: Option<(f64, f64)>,
    /// The least error so far, and whether the previous sweep lowered it.
    previous: f64,
    before: bool,
    /// The error of the last sweep.
    reached: f64,
    /// How often steps were halved because a sweep failed.
    halvings: u32,
}

type SweepResult = Result<Option<Converged>, SimulateError>;

impl Convergence {
    pub fn new(first: StepRule, accuracy: Accuracy, scales: Scales) -> Convergence {
        Convergence {
            accuracy,
            scales,
            rule: first,
            number: 1,
            known_rate: 0.0,
            coarse: None,
            pair: None,
            magnification: None,
            noise_from: FEW_SWEEPS,
            sweeps: 0,
            steps: 0,
            evaluations: 0,
            by: SECOND,
            last: None,
            previous: f64::INFINITY,
            before: true,
            reached: f64::INFINITY,
            halvings: 0,
        }
    }

    /// Takes the error of a sweep. Equal steps that are too long may diverge, or meet points at which a law has no value:
    /// shorter ones are next. Any other error is returned, and in the end the last one.
    pub fn take_error(&mut self, error: SimulateError) -> Result<(), SimulateError> {
        let by_steps = matches!(error, SimulateError::Undefined { .. } | SimulateError::Diverged { .. });
        let finer = self.rule.refined(2.0);
        let equal = matches!(self.rule, StepRule::Step(_)) && self.pair.is_none();
        if !(by_steps && equal) || self.halvings == MOST_HALVINGS || finer == self.rule {
            return Err(error);
        }
        self.halvings += 1;
        (self.rule, self.coarse) = (finer, None);
        Ok(())
    }

    /// The sweep to run next.
    pub fn next(&self) -> SweepPlan {
        let plan = SweepPlan {
            rule: self.rule,
            number: self.sweeps + 1,
            known_rate: self.known_rate,
            noise: None,
            watches_jumps: true,
        };
        match &self.pair {
            Some(pair) => {
                let noise = Noise::new(pair.size, self.scales.in_space, u64::from(pair.repeats));
                SweepPlan { rule: pair.rule, known_rate: pair.known_rate, noise: Some(noise), ..plan }
            }
            None => plan,
        }
    }

    /// Takes the result of a sweep. Returns the final sweep once it is accurate enough.
    ///
    /// Events of two sweeps are compared at one time: `follow` advances a point to a nearby time.
    pub fn take(&mut self, sweep: Sweep, follow: &dyn Fn(&Carried, f64) -> Carried) -> SweepResult {
        self.sweeps += 1;
        self.steps += sweep.steps;
        self.evaluations += sweep.evaluations;
        if let Some(mut pair) = self.pair.take() {
            let response = difference(&self.scales, &pair.coarse, &sweep, follow);
            pair.response = pair.response.max(response);
            return self.take_noisy(pair);
        }
        let Some((coarse, rule, known_rate)) = self.coarse.take() else { return self.refine(sweep) };
        let difference = difference(&self.scales, &coarse, &sweep, follow);
        let resolved = difference <= RESOLVED.max(self.accuracy.goal);
        let shorter_than_turns = sweep.largest[0] * sweep.longest < 1.0;
        if self.magnification.is_none() && (resolved || self.number >= self.noise_from && shorter_than_turns)
        {
            let (size, repeats, response) = (FIRST_SIZE, 0, 0.0);
            self.pair =
                Some(Pair { coarse, rule, known_rate, fine: sweep, difference, size, repeats, response });
            return Ok(None);
        }
        self.compare(difference, &coarse, sweep)
    }

    /// Takes the response to noise: reduces the noise if it is not linear, repeats it if rounding matters.
    fn take_noisy(&mut self, mut pair: Pair) -> SweepResult {
        let Scales { rounding, .. } = self.scales;
        if pair.response > LINEAR && pair.size > rounding {
            pair.size = (1e-3 * pair.size / pair.response).max(rounding);
            (pair.repeats, pair.response) = (pair.repeats + 1, 0.0);
            self.pair = Some(pair);
            return Ok(None);
        }
        let found = Magnification::new(pair.response, pair.size, pair.coarse.steps, rounding);
        // The response to one noise may be a hundred times smaller than to another, but hardly more.
        let matters = 100.0 * found.rounding_error(pair.fine.steps) > self.accuracy.goal;
        if matters && pair.repeats.is_multiple_of(2) {
            pair.repeats += 1;
            self.pair = Some(pair);
            return Ok(None);
        }
        let resolved = pair.difference <= RESOLVED.max(self.accuracy.goal);
        if resolved || pair.response > LINEAR {
            self.magnification = Some(found);
        }
        self.noise_from = self.number + 3;
        self.compare(pair.difference, &pair.coarse, pair.fine)
    }

    /// Compares two sweeps. Returns the finer one if it is accurate enough.
    fn compare(&mut self, difference: f64, coarse: &Sweep, fine: Sweep) -> SweepResult {
        let mut rounding = self.magnification.map_or(0.0, |known| known.rounding_error(fine.steps));
        let (truncation, shorter) = self.truncation(difference, coarse, &fine);
        // Explicit steps that turn the body far amplify noise themselves: it is measured again in shorter ones.
        let equal = matches!(self.rule, StepRule::Step(_));
        let turns_far = equal && coarse.largest[0] * coarse.longest >= 1.0;
        if turns_far && rounding.min(truncation) > self.accuracy.acceptable {
            (self.magnification, rounding) = (None, 0.0);
        }
        let jumps = fine.errors_of_jumps > 0.0 && equal;
        let error = (truncation + rounding).max(f64::EPSILON * (fine.steps as f64).sqrt());
        let goal = self.accuracy.reachable(rounding);
        if error <= goal && self.magnification.is_some() {
            return Ok(Some(self.converged(fine, error)));
        }
        // One sweep may agree by chance. Sweeps with long steps may gain nothing yet.
        let gained = error <= 0.5 * self.previous || self.previous >= 1e-2;
        let stuck = !gained && !self.before || self.number > MOST_SWEEPS;
        if stuck || rounding > self.accuracy.acceptable {
            if error <= self.accuracy.acceptable && self.magnification.is_some() {
                return Ok(Some(self.converged(fine, error)));
            }
            let least = if stuck { error } else { self.floor(error / rounding, fine.steps) };
            let reached = least.max(if rounding > LINEAR { 1.0 } else { self.accuracy.goal });
            return Err(SimulateError::NotConverged {
                rtol: self.accuracy.goal,
                reached,
                step: fine.longest,
                agreed: agreement(&self.scales, coarse, &fine, AGREEING * self.accuracy.acceptable),
            });
        }
        self.last = shorter.map(|by| (difference, by));
        (self.before, self.reached, self.previous) = (gained, error, error.min(self.previous));
        self.by = match shorter {
            None => 2.0,
            Some(_) if difference >= 0.1 => 2.0,
            Some(_) => {
                let order = if jumps { ORDER_AT_JUMPS } else { f64::from(self.accuracy.order) };
                // Errors of a low order fall little from sweep to sweep.
                let slow = self.by.powf(TRUSTED * order) < 2.0;
                let likely = if slow { truncation } else { difference * self.by.powf(-0.9 * order) };
                let wanted = (goal - rounding).max(0.3 * goal);
                let by = 1.1 * (likely / wanted).powf(1.0 / (TRUSTED * order));
                by.clamp(LEAST_GAIN.powf(1.0 / order).max(1.3), LEAP)
            }
        };
        self.refine(fine)
    }

    /// The rounding error where further sweeps would end: of the steps whose truncation is smaller by this factor.
    fn floor(&self, factor: f64, steps: u64) -> f64 {
        let more = factor.max(1.0).powf(1.0 / f64::from(self.accuracy.order));
        self.magnification.map_or(0.0, |known| known.rounding_error((more * steps as f64) as u64))
    }

    /// The truncation of the finer of two sweeps, and its refinement factor if its steps are shorter.
    fn truncation(&self, difference: f64, coarse: &Sweep, fine: &Sweep) -> (f64, Option<f64>) {
        let magnified = self.magnification.map_or(1.0, |known| known.of_sums());
        let is_smooth = self.scales.is_smooth && fine.errors_of_jumps == 0.0;
        let (mut shorter, mut least_truncation) = (self.by, self.error_by_jumps(fine));
        if let StepRule::Tolerance(steps) = self.rule {
            shorter = fine.steps as f64 / coarse.steps.max(1) as f64;
            // Steps cannot meet a smaller tolerance; the difference is used.
            let counts = steps.tolerance > LEAST_TOLERANCE;
            let magnified = if counts { magnified } else { 0.0 };
            let (sum, of_cut_steps) = (fine.errors * magnified, fine.errors_of_cut_steps * magnified);
            if shorter < COMPARABLE {
                return (difference.max(sum).max(least_truncation), None);
            }
            let shows_order = is_smooth && fine.steps >= FEW_STEPS;
            let counted = if shows_order { COUNTED } else { COUNTED_WITHOUT_ORDER };
            let of_all = sum.min(counted * self.accuracy.goal);
            let of_cut_steps = of_cut_steps.min(COUNTED_OF_CUT_STEPS * self.accuracy.goal);
            least_truncation = least_truncation.max(of_all).max(of_cut_steps);
            if !is_smooth {
                return (difference.max(least_truncation), Some(shorter));
            }
        }
        let order = f64::from(self.accuracy.order);
        // Sweeps with steps of s differ by less than the error if s^q < 2.
        let least = |order: f64| (shorter.powf(TRUSTED * order) - 1.0).min(1.0);
        if !is_smooth {
            let by_difference = difference / least(order.min(ORDER_AT_KINKS));
            return (by_difference.max(least_truncation), Some(shorter));
        }
        let last = self.last.filter(|&(before, _)| before <= RESOLVED);
        let lucky = last.map_or(0.0, |(before, _)| before * shorter.powf(-FASTEST_FALL * order));
        let difference = difference.max(lucky);
        let exponent = last.map_or(ASSUMED * order, |(before, by)| {
            TRUSTED * ((before / difference).ln() / by.ln()).clamp(0.0, order)
        });
        let truncation = difference / (shorter.powf(exponent) - 1.0).max(least(order));
        (truncation.max(least_truncation), Some(shorter))
    }

    /// A bound of the error caused by steps in which laws jump. A wrong angular velocity turns the body by ever more; the
    /// response to noise would not show this, since it changes the steps at jumps too.
    fn error_by_jumps(&self, sweep: &Sweep) -> f64 {
        let turned = sweep.largest[0] * self.scales.duration;
        MARGIN_AT_JUMPS * sweep.errors_of_jumps * (1.0 + 0.5 * turned)
    }

    fn converged(&self, sweep: Sweep, error: f64) -> Converged {
        let (steps, evaluations) = (self.steps, self.evaluations);
        Converged { rule: self.rule, sweep: Sweep { steps, evaluations, ..sweep }, error }
    }

    /// Continues with shorter steps. If there are none, the last sweep is final.
    fn refine(&mut self, coarse: Sweep) -> SweepResult {
        let finer = self.rule.refined(self.by);
        if finer == self.rule {
            if self.reached <= self.accuracy.acceptable && self.magnification.is_some() {
                return Ok(Some(self.converged(coarse, self.reached)));
            }
            let (rtol, reached) = (self.accuracy.goal, self.previous);
            return Err(SimulateError::NotConverged { rtol, reached, step: coarse.longest, agreed: None });
        }
        // Fixed steps may have met a wrong rate.
        let adapts = matches!(self.rule, StepRule::Tolerance(_));
        let known_rate = if adapts { coarse.largest[0] } else { 0.0 };
        self.coarse = Some((coarse, self.rule, self.known_rate));
        self.known_rate = known_rate;
        self.rule = finer;
        self.number += 1;
        Ok(None)
    }
}
