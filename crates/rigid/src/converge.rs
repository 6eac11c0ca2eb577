//! Passes with ever shorter steps, until two of them agree.

use crate::phase::{Gyrostat, Phase};
use crate::runge_kutta::Carried;
use crate::simulate_error::SimulateError;
use crate::walk::{Pace, Pass};
use polhode_ga::{Bivector, Rotor};

/// Below this two passes may differ by rounding, which the motion magnifies and a shorter step does not reduce.
const ROUNDING_OF_RUNS: f64 = 1e-10;

/// The relative error aimed at when no tolerance is asked for.
pub(crate) const DEFAULT_RTOL: f64 = 1e-10;

/// The relative error that still counts when none is asked for and rounding lets no smaller one through:
/// a motion along a separatrix magnifies it a thousandfold and more. The certificate tells the estimate.
pub(crate) const WORST_UNASKED: f64 = 1e-6;

/// How many times shorter the steps of the second pass are.
const SECOND: f64 = 1.6;

/// Passes whose steps are so many times shorter tell of each other's error.
const TELLING: f64 = 1.1;

/// The error falls as the step to the order times this at least, where passes have shown that it falls so: a margin.
const TRUSTED: f64 = 0.75;

/// An estimate of the error of a step is rounding below this.
pub(crate) const LEAST_TOLERANCE: f64 = 1e-16;

/// So many passes are enough.
const MOST_PASSES: u32 = 30;

/// So many may differ altogether. Where more do, and a step turns the body by less than what leaves rounding of its
/// error, `turn^(q+1) < ε`, the motion is chaotic and shorter steps tell no more.
const FEW_PASSES: u32 = 8;

impl Pace {
    /// Steps that are so many times shorter. A local error goes as the eighth power of the step.
    fn refined(self, by: f64) -> Pace {
        match self {
            Pace::Step(step) => Pace::Step(step / by),
            Pace::Tolerance(tolerance) => Pace::Tolerance((tolerance / by.powi(8)).max(LEAST_TOLERANCE)),
        }
    }
}

/// What is to be reached, and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// Of the method.
    pub order: i32,
    pub goal: f64,
    /// What will do where passes differ by rounding alone.
    pub acceptable: f64,
}

impl Aim {
    /// The relative error to be reached by a method of this order, where one is asked for.
    pub fn new(order: i32, rtol: Option<f64>) -> Aim {
        Aim { order, goal: rtol.unwrap_or(DEFAULT_RTOL), acceptable: rtol.unwrap_or(WORST_UNASKED) }
    }

    /// The first pace of steps that keep to a tolerance: the errors of all of them add up.
    pub fn tolerance(&self) -> Pace {
        Pace::Tolerance((0.1 * self.goal).max(1e3 * LEAST_TOLERANCE))
    }
}

/// A pass that is good enough.
pub(crate) struct Converged {
    pub pace: Pace,
    /// With the steps and evaluations of all passes.
    pub pass: Pass,
    /// A cautious estimate of its error.
    pub error: f64,
}

/// Passes until two agree: says how and from where to run the next, and takes what it found.
///
/// At events, too, what passes differ by is told at one time: `follow` leads a point a little way to another time.
///
/// What the motion magnifies, it magnifies in all passes alike, and their agreement would not show it: every other pass
/// starts a few roundings away.
///
/// With steps h and h/s the passes differ by `e (s^q − 1)`, where `e` is the error of the second. Of the order q half is
/// taken for granted; once two differences have shown an order, three quarters of that. So is the next step foretold,
/// and few passes are needed.
///
/// Steps that keep to a tolerance are bounded by the output times too, and may hardly change with it. Of them s is the
/// ratio of their numbers; where that is nearly 1 the passes tell nothing, and the sum of the tolerances has to be small.
pub(crate) struct Convergence {
    aim: Aim,
    start: Carried,
    /// Of the next pass, as its start and its number.
    pace: Pace,
    begin: Carried,
    number: u32,
    /// The pass before.
    coarse: Option<Pass>,
    /// Of all passes.
    steps: u64,
    evaluations: u64,
    /// How many times shorter the steps of the next pass are.
    by: f64,
    /// The last difference, and how many times shorter its steps were.
    last: Option<(f64, f64)>,
    /// The least error so far, and whether the pass before lowered it.
    previous: f64,
    before: bool,
    /// The error of the last pass.
    reached: f64,
}

impl Convergence {
    pub fn new(start: Carried, first: Pace, aim: Aim) -> Convergence {
        Convergence {
            aim,
            start,
            pace: first,
            begin: moved(start, 0),
            number: 1,
            coarse: None,
            steps: 0,
            evaluations: 0,
            by: SECOND,
            last: None,
            previous: f64::INFINITY,
            before: true,
            reached: f64::INFINITY,
        }
    }

    /// The pace, the start and the number of the pass to be run, which count from 1.
    pub fn next(&self) -> (Pace, Carried, u32) {
        (self.pace, self.begin, self.number)
    }

    /// Takes the pass that was run. Gives the last one, once it is good enough.
    pub fn take(
        &mut self,
        mut pass: Pass,
        body: &Gyrostat,
        follow: &dyn Fn(&Carried, f64) -> Carried,
    ) -> Result<Option<Converged>, SimulateError> {
        self.steps += pass.steps;
        self.evaluations += pass.evaluations;
        if let Some(coarse) = self.coarse.take() {
            let start = self.start;
            pass.states.iter_mut().filter(|s| s.phase.time == start.phase.time).for_each(|s| *s = start);
            let difference = difference(body, &coarse, &pass, follow);
            if let Some(error) = self.judge(difference, &coarse, &pass)? {
                return Ok(Some(self.converged(pass, error)));
            }
        }
        self.refine(pass)
    }

    fn converged(&self, pass: Pass, error: f64) -> Converged {
        let (steps, evaluations) = (self.steps, self.evaluations);
        Converged { pace: self.pace, pass: Pass { steps, evaluations, ..pass }, error }
    }

    /// The error of a pass, if that is good enough.
    fn judge(&mut self, difference: f64, coarse: &Pass, fine: &Pass) -> Result<Option<f64>, SimulateError> {
        let Aim { goal, acceptable, .. } = self.aim;
        let order = f64::from(self.aim.order);
        let mut shorter = self.by;
        if let Pace::Tolerance(tolerance) = self.pace {
            shorter = fine.steps as f64 / coarse.steps.max(1) as f64;
            if shorter < TELLING {
                let sum = fine.steps as f64 * tolerance;
                self.by = 2.0;
                let enough = sum <= 0.1 * goal || tolerance == LEAST_TOLERANCE && difference <= acceptable;
                return Ok(enough.then(|| difference.max(sum.min(goal)).max(f64::EPSILON)));
            }
        }
        let shown = self.last.map(|(before, by): (f64, f64)| (before / difference).ln() / by.ln());
        let (exponent, converging) = match shown {
            Some(shown) => (TRUSTED * shown.clamp(0.0, order), shown > 0.6 * order),
            None => (0.5 * order, false),
        };
        let truncation = difference / (shorter.powf(exponent) - 1.0).max(1.0);
        // Where rounding may rule, the difference itself tells the error.
        let rounding = if converging { 0.1 * ROUNDING_OF_RUNS } else { ROUNDING_OF_RUNS };
        let error = truncation.max(difference.min(rounding));
        let error = error.max(f64::EPSILON * (fine.steps as f64).sqrt());
        // One pass may be lucky; two that gain nothing are ruled by rounding.
        // Passes with long steps may gain nothing yet.
        let shortest_turn = f64::EPSILON.powf(1.0 / (order + 1.0));
        let unresolved = self.number <= FEW_PASSES || fine.largest[0] * fine.longest > shortest_turn;
        let gained = error <= 0.5 * self.previous || self.previous >= 1e-2 && unresolved;
        let stuck = !gained && !self.before || self.number > MOST_PASSES;
        if error <= goal || stuck && error <= acceptable {
            return Ok(Some(error));
        }
        if stuck {
            return Err(SimulateError::NotConverged { rtol: goal, reached: error, step: fine.longest });
        }
        (self.last, self.previous) = (Some((difference, shorter)), error.min(self.previous));
        (self.before, self.reached) = (gained, error);
        self.by = if difference < 0.1 {
            let likely = difference * self.by.powf(-0.9 * order);
            (1.1 * (likely / goal).powf(1.0 / (TRUSTED * order))).clamp(1.3, 6.0)
        } else {
            2.0
        };
        Ok(None)
    }

    /// Goes on to shorter steps. Where there are none, the last pass has to do.
    fn refine(&mut self, coarse: Pass) -> Result<Option<Converged>, SimulateError> {
        if let Pace::Step(step) = &mut self.pace
            && coarse.longest > 0.0
        {
            // Where output times are closer than the step, they set it.
            *step = step.min(coarse.longest);
        }
        let finer = self.pace.refined(self.by);
        if finer == self.pace {
            if self.reached <= self.aim.acceptable {
                return Ok(Some(self.converged(coarse, self.reached)));
            }
            let (rtol, reached) = (self.aim.goal, self.previous);
            return Err(SimulateError::NotConverged { rtol, reached, step: coarse.longest });
        }
        self.pace = finer;
        self.number += 1;
        self.begin = if self.number.is_multiple_of(2) { self.start } else { moved(self.start, coarse.steps) };
        self.coarse = Some(coarse);
        Ok(None)
    }
}

/// The start moved by what so many steps round; what is zero stays zero.
fn moved(start: Carried, steps: u64) -> Carried {
    let by = f64::EPSILON * (0.3 * (steps as f64).sqrt()).max(4.0);
    let [x, y, z] = start.phase.momentum.0;
    let momentum = Bivector([x * (1.0 + by), y * (1.0 - 0.7 * by), z * (1.0 + 0.4 * by)]);
    let turn = Rotor::exp(Bivector([0.3 * by, -0.6 * by, 0.4 * by]));
    Carried::new(Phase { rotor: turn * start.phase.rotor, momentum, ..start.phase }, start.center)
}

/// Largest difference of two passes at the output times and at events: in the rotor, and in angular velocity, place and
/// velocity relative to the largest on the way.
fn difference(body: &Gyrostat, coarse: &Pass, fine: &Pass, follow: &dyn Fn(&Carried, f64) -> Carried) -> f64 {
    // An event ended one of them and not the other.
    if coarse.ends != fine.ends {
        return 1.0;
    }
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
