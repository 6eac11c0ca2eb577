//! Passes with ever shorter steps, until two of them agree.
//!
//! The error of a sweep has two parts, and both are measured. *Truncation* falls with the step: with steps h and h/s the
//! sweeps differ by `e (s^q − 1)`, where `e` is the truncation of the second. *Rounding* does not; what the motion makes
//! of it is found once by shaken sweeps ([`super::noise`]), as soon as two sweeps are near each other. A motion that
//! magnifies rounding beyond what is asked is refused then, and not after sweeps that could not succeed.

use super::noise::{FIRST_SIZE, LINEAR, Magnification, Noise};
use super::sweep::{StepRule, Sweep};
use crate::error::SimulateError;
use crate::state::carried::Carried;
use crate::state::phase::Gyrostat;

/// The relative error aimed at when no tolerance is asked for.
pub(crate) const DEFAULT_RTOL: f64 = 1e-10;

/// The largest relative error that is returned when no tolerance is asked for and rounding allows no smaller one: a
/// motion along a separatrix magnifies it a thousandfold and more. The certificate has the estimate.
pub(crate) const WORST_UNASKED: f64 = 1e-6;

/// How many times shorter the steps of the second sweep are.
const SECOND: f64 = 1.6;

/// Passes whose numbers of steps differ by less show nothing of each other's truncation.
const COMPARABLE: f64 = 1.1;

/// Two sweeps that differ by less follow the same motion.
const RESOLVED: f64 = 0.05;

/// The part of the method's order by which truncation is taken to fall, until sweeps have shown how it falls; and the
/// part of the order shown that is relied on.
const ASSUMED: f64 = 0.5;
const TRUSTED: f64 = 0.75;

/// How many times shorter the steps of the next sweep are at most.
const LEAP: f64 = 6.0;

/// A difference that falls faster than by this multiple of the order is small by chance.
const FASTEST_FALL: f64 = 1.25;

/// An estimate of the error of a step is rounding below this.
pub(crate) const LEAST_TOLERANCE: f64 = 1e-16;

/// Maximum number of sweeps of different steps.
const MOST_SWEEPS: u32 = 30;

/// After so many sweeps that differ altogether, shaken sweeps show whether that is rounding.
const FEW_SWEEPS: u32 = 5;

impl StepRule {
    /// Steps that are so many times shorter. A local error goes as the eighth power of the step.
    fn refined(self, by: f64) -> StepRule {
        match self {
            StepRule::Step(steps) => StepRule::Step(steps.refined(by)),
            StepRule::Tolerance(tolerance) => {
                StepRule::Tolerance((tolerance / by.powi(8)).max(LEAST_TOLERANCE))
            }
        }
    }
}

/// What is to be reached, and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accuracy {
    /// Of the method.
    pub order: i32,
    pub goal: f64,
    /// The largest error that is returned, where rounding allows no smaller one.
    pub acceptable: f64,
}

impl Accuracy {
    /// The relative error to be reached by a method of this order, where one is asked for.
    pub fn new(order: i32, rtol: Option<f64>) -> Accuracy {
        Accuracy { order, goal: rtol.unwrap_or(DEFAULT_RTOL), acceptable: rtol.unwrap_or(WORST_UNASKED) }
    }

    /// The first rule of steps that keep to a tolerance: the errors of all of them add up.
    pub fn tolerance(&self) -> StepRule {
        StepRule::Tolerance((0.1 * self.goal).max(1e3 * LEAST_TOLERANCE))
    }

    /// The error to reach where rounding leaves this much: where no tolerance is asked for, no less than twice that.
    fn reachable(&self, rounding: f64) -> f64 {
        self.goal.max(2.0 * rounding).min(self.acceptable)
    }
}

/// What of a problem the comparison of sweeps needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    pub body: Gyrostat,
    /// The relative rounding of one step.
    pub rounding: f64,
    /// Whether steps carry the momentum in space.
    pub in_space: bool,
    /// Whether the laws change slowly at the scale of steps. Under others a difference need not fall as the order says,
    /// and is the error itself.
    pub is_smooth: bool,
}

/// The next sweep to run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepPlan {
    pub rule: StepRule,
    /// Passes count from 1.
    pub number: u32,
    /// The largest angular velocity that the sweep before met, in rad/s: errors are relative to it from the start on. A
    /// body that rests until it is pushed would else have to keep to a tolerance relative to nearly nothing.
    pub known_rate: f64,
    pub noise: Option<Noise>,
}

impl SweepPlan {
    /// A run of one sweep.
    pub fn only(rule: StepRule) -> SweepPlan {
        SweepPlan { rule, number: 1, known_rate: 0.0, noise: None }
    }
}

/// A sweep that is good enough.
pub(crate) struct Converged {
    pub rule: StepRule,
    /// With the steps and evaluations of all sweeps.
    pub sweep: Sweep,
    /// A cautious estimate of its error.
    pub error: f64,
}

/// Two sweeps that are compared once shaken sweeps have shown what rounding does.
struct Pair {
    coarse: Sweep,
    /// Of the coarse one.
    rule: StepRule,
    known_rate: f64,
    fine: Sweep,
    difference: f64,
    /// Of the noise under way, its number, and the largest difference that noise of this size made so far.
    size: f64,
    shaken: u32,
    response: f64,
}

/// Passes until two agree: gives the rule of the next, and takes its result.
///
/// Of the order q half is taken for granted; once two differences have shown an order, three quarters of that. So is
/// the next step foretold, and few sweeps are needed.
///
/// Steps that keep to a tolerance are bounded by the output times too, and may hardly change with it. Of them s is the
/// ratio of their numbers; where that is nearly 1 the sweeps show nothing, and the sum of the estimates of all steps has
/// to be small.
pub(crate) struct Convergence {
    accuracy: Accuracy,
    scales: Scales,
    /// Of the next sweep that is not shaken, and its number among those.
    rule: StepRule,
    number: u32,
    known_rate: f64,
    /// The sweep before, with its rule and the rate that was known to it.
    coarse: Option<(Sweep, StepRule, f64)>,
    pair: Option<Pair>,
    magnification: Option<Magnification>,
    /// The number of the sweep from which on unresolved sweeps are shaken.
    look_at: u32,
    /// Of all sweeps.
    sweeps: u32,
    steps: u64,
    evaluations: u64,
    /// How many times shorter the steps of the next sweep are.
    by: f64,
    /// The last difference, and how many times shorter its steps were.
    last: Option<(f64, f64)>,
    /// The least error so far, and whether the sweep before lowered it.
    previous: f64,
    before: bool,
    /// The error of the last sweep.
    reached: f64,
}

type Taken = Result<Option<Converged>, SimulateError>;

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
            look_at: FEW_SWEEPS,
            sweeps: 0,
            steps: 0,
            evaluations: 0,
            by: SECOND,
            last: None,
            previous: f64::INFINITY,
            before: true,
            reached: f64::INFINITY,
        }
    }

    /// The sweep to run next.
    pub fn next(&self) -> SweepPlan {
        let number = self.sweeps + 1;
        match &self.pair {
            Some(pair) => {
                let noise = Noise::new(pair.size, self.scales.in_space, u64::from(pair.shaken));
                SweepPlan { rule: pair.rule, number, known_rate: pair.known_rate, noise: Some(noise) }
            }
            None => SweepPlan { rule: self.rule, number, known_rate: self.known_rate, noise: None },
        }
    }

    /// Takes the sweep that was run. Gives the last one, once it is good enough.
    ///
    /// At events, too, sweeps are compared at one time: `follow` leads a point a little way to another time.
    pub fn take(&mut self, sweep: Sweep, follow: &dyn Fn(&Carried, f64) -> Carried) -> Taken {
        self.sweeps += 1;
        self.steps += sweep.steps;
        self.evaluations += sweep.evaluations;
        if let Some(mut pair) = self.pair.take() {
            let response = difference(&self.scales, &pair.coarse, &sweep, follow);
            pair.response = pair.response.max(response);
            return self.shaken(pair);
        }
        let Some((coarse, rule, known_rate)) = self.coarse.take() else { return self.refine(sweep) };
        let difference = difference(&self.scales, &coarse, &sweep, follow);
        let resolved = difference <= RESOLVED.max(self.accuracy.goal);
        let shorter_than_turns = sweep.largest[0] * sweep.longest < 1.0;
        if self.magnification.is_none() && (resolved || self.number >= self.look_at && shorter_than_turns) {
            let (size, shaken, response) = (FIRST_SIZE, 0, 0.0);
            self.pair =
                Some(Pair { coarse, rule, known_rate, fine: sweep, difference, size, shaken, response });
            return Ok(None);
        }
        self.compare(difference, &coarse, sweep)
    }

    /// Takes the response to the noise: less noise where it is not linear, a second shaken sweep where rounding matters.
    fn shaken(&mut self, mut pair: Pair) -> Taken {
        let Scales { rounding, .. } = self.scales;
        if pair.response > LINEAR && pair.size > rounding {
            pair.size = (1e-3 * pair.size / pair.response).max(rounding);
            (pair.shaken, pair.response) = (pair.shaken + 1, 0.0);
            self.pair = Some(pair);
            return Ok(None);
        }
        let found = Magnification::new(pair.response, pair.size, pair.coarse.steps, rounding);
        // The sum of one noise may be a hundred times smaller than that of another, but hardly more.
        let matters = 100.0 * found.rounding_error(pair.fine.steps) > self.accuracy.goal;
        if matters && pair.shaken.is_multiple_of(2) {
            pair.shaken += 1;
            self.pair = Some(pair);
            return Ok(None);
        }
        let resolved = pair.difference <= RESOLVED.max(self.accuracy.goal);
        if resolved || pair.response > LINEAR {
            self.magnification = Some(found);
        }
        self.look_at = self.number + 3;
        self.compare(pair.difference, &pair.coarse, pair.fine)
    }

    /// Compares two sweeps: the finer one, if it is good enough.
    fn compare(&mut self, difference: f64, coarse: &Sweep, fine: Sweep) -> Taken {
        let rounding = self.magnification.map_or(0.0, |known| known.rounding_error(fine.steps));
        let (truncation, shorter) = self.truncation(difference, coarse, &fine);
        let error = (truncation + rounding).max(f64::EPSILON * (fine.steps as f64).sqrt());
        let goal = self.accuracy.reachable(rounding);
        if error <= goal && self.magnification.is_some() {
            return Ok(Some(self.converged(fine, error)));
        }
        // One sweep may be lucky. Passes with long steps may gain nothing yet.
        let gained = error <= 0.5 * self.previous || self.previous >= 1e-2;
        let stuck = !gained && !self.before || self.number > MOST_SWEEPS;
        if stuck || rounding > self.accuracy.acceptable {
            if error <= self.accuracy.acceptable && self.magnification.is_some() {
                return Ok(Some(self.converged(fine, error)));
            }
            let reached = error.max(if rounding > LINEAR { 1.0 } else { 0.0 });
            return Err(SimulateError::NotConverged {
                rtol: self.accuracy.goal,
                reached,
                step: fine.longest,
            });
        }
        self.last = shorter.map(|by| (difference, by));
        (self.before, self.reached, self.previous) = (gained, error, error.min(self.previous));
        self.by = match shorter {
            None => 2.0,
            Some(_) if difference >= 0.1 => 2.0,
            Some(_) => {
                let order = f64::from(self.accuracy.order);
                let likely = difference * self.by.powf(-0.9 * order);
                let wanted = (goal - rounding).max(0.3 * goal);
                (1.1 * (likely / wanted).powf(1.0 / (TRUSTED * order))).clamp(1.3, LEAP)
            }
        };
        self.refine(fine)
    }

    /// The truncation of the finer of two sweeps, and how many times shorter its steps are, if they are.
    fn truncation(&self, difference: f64, coarse: &Sweep, fine: &Sweep) -> (f64, Option<f64>) {
        let mut shorter = self.by;
        if let StepRule::Tolerance(tolerance) = self.rule {
            shorter = fine.steps as f64 / coarse.steps.max(1) as f64;
            if shorter < COMPARABLE {
                let sum = fine.errors * self.magnification.map_or(1.0, |known| known.of_sums());
                // Steps cannot keep to less; there the difference has to do.
                let sum = if tolerance == LEAST_TOLERANCE { 0.0 } else { sum };
                return (difference.max(sum), None);
            }
        }
        if !self.scales.is_smooth {
            return (difference, Some(shorter));
        }
        let order = f64::from(self.accuracy.order);
        let last = self.last.filter(|&(before, _)| before <= RESOLVED);
        let lucky = last.map_or(0.0, |(before, _)| before * shorter.powf(-FASTEST_FALL * order));
        let difference = difference.max(lucky);
        let exponent = last.map_or(ASSUMED * order, |(before, by)| {
            TRUSTED * ((before / difference).ln() / by.ln()).clamp(0.0, order)
        });
        (difference / (shorter.powf(exponent) - 1.0).max(1.0), Some(shorter))
    }

    fn converged(&self, sweep: Sweep, error: f64) -> Converged {
        let (steps, evaluations) = (self.steps, self.evaluations);
        Converged { rule: self.rule, sweep: Sweep { steps, evaluations, ..sweep }, error }
    }

    /// Goes on to shorter steps. Where there are none, the last sweep has to do.
    fn refine(&mut self, coarse: Sweep) -> Taken {
        let finer = self.rule.refined(self.by);
        if finer == self.rule {
            if self.reached <= self.accuracy.acceptable && self.magnification.is_some() {
                return Ok(Some(self.converged(coarse, self.reached)));
            }
            let (rtol, reached) = (self.accuracy.goal, self.previous);
            return Err(SimulateError::NotConverged { rtol, reached, step: coarse.longest });
        }
        // Steps that keep to no tolerance may have met a wrong one.
        let adapts = matches!(self.rule, StepRule::Tolerance(_));
        let known_rate = if adapts { coarse.largest[0] } else { 0.0 };
        self.coarse = Some((coarse, self.rule, self.known_rate));
        self.known_rate = known_rate;
        self.rule = finer;
        self.number += 1;
        Ok(None)
    }
}

/// Largest difference of two sweeps at the output times and at events: in the rotor, and in angular velocity, place and
/// velocity relative to the largest on the way.
fn difference(
    scales: &Scales,
    coarse: &Sweep,
    fine: &Sweep,
    follow: &dyn Fn(&Carried, f64) -> Carried,
) -> f64 {
    // An event ended one of them and not the other.
    if coarse.ends != fine.ends {
        return 1.0;
    }
    let body = &scales.body;
    let [fastest, farthest, swiftest] = fine.largest.map(|x| x.max(f64::MIN_POSITIVE));
    let fastest = fastest.max(body.least_rate());
    let apart = |a: &Carried, b: &Carried| {
        let (r, s) = (a.phase.rotor.components(), b.phase.rotor.components());
        let turn = (0..4).map(|k| (r[k] - s[k]) * (r[k] - s[k])).sum::<f64>().sqrt();
        let spin = (body.omega(a.phase.momentum) - body.omega(b.phase.momentum)).norm() / fastest;
        let place = (a.center.position - b.center.position).norm() / farthest;
        let velocity = (a.center.velocity - b.center.velocity).norm() / swiftest;
        turn.max(spin).max(place).max(velocity)
    };
    let outputs = coarse.states.iter().zip(&fine.states).map(|(a, b)| apart(a, b));
    // An event that is barely one may be none in the other.
    let same = coarse.events.len() == fine.events.len();
    let events = coarse.events.iter().zip(&fine.events).filter(|(a, b)| same && a.event == b.event);
    let events = events.map(|(a, b)| apart(&follow(&a.at, b.at.phase.time), &b.at));
    outputs.chain(events).fold(0.0, f64::max)
}
