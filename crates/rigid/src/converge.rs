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
pub(crate) struct Aim {
    /// Of the method.
    pub order: i32,
    pub goal: f64,
    /// What will do where passes differ by rounding alone.
    pub acceptable: f64,
}

/// A pass that is good enough.
pub(crate) struct Converged {
    pub pace: Pace,
    /// With the steps and evaluations of all passes.
    pub pass: Pass,
    /// A cautious estimate of its error.
    pub error: f64,
}

/// Runs until two passes agree. Gives the last pass, with the steps of all, and a cautious estimate of its error.
///
/// At events, too, what they differ by is told at one time: `follow` leads a point a little way to another time.
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
pub(crate) fn converge(
    run: &mut dyn FnMut(Pace, Carried) -> Result<Pass, SimulateError>,
    start: Carried,
    first: Pace,
    aim: Aim,
    body: &Gyrostat,
    follow: &dyn Fn(&Carried, f64) -> Carried,
) -> Result<Converged, SimulateError> {
    let Aim { goal, acceptable, .. } = aim;
    let order = f64::from(aim.order);
    let shortest_turn = f64::EPSILON.powf(1.0 / (order + 1.0));
    let (mut pace, mut by) = (first, SECOND);
    let mut coarse = run(pace, moved(start, 0))?;
    let (mut steps, mut evaluations) = (coarse.steps, coarse.evaluations);
    // The last difference, and how many times shorter its steps were.
    let mut last: Option<(f64, f64)> = None;
    // The least error so far, and whether the pass before lowered it.
    let (mut previous, mut before) = (f64::INFINITY, true);
    // The error of the last pass.
    let mut reached = f64::INFINITY;
    for number in 2.. {
        if let Pace::Step(step) = &mut pace
            && coarse.longest > 0.0
        {
            // Where output times are closer than the step, they set it.
            *step = step.min(coarse.longest);
        }
        let finer = pace.refined(by);
        if finer == pace {
            if reached <= acceptable {
                return Ok(Converged { pace, pass: Pass { steps, evaluations, ..coarse }, error: reached });
            }
            return Err(SimulateError::NotConverged { rtol: goal, reached: previous, step: coarse.longest });
        }
        pace = finer;
        let begin = if number % 2 == 0 { start } else { moved(start, coarse.steps) };
        let mut fine = run(pace, begin)?;
        fine.states.iter_mut().filter(|s| s.phase.time == start.phase.time).for_each(|s| *s = start);
        steps += fine.steps;
        evaluations += fine.evaluations;
        let difference = difference(body, &coarse, &fine, follow);
        let mut shorter = by;
        if let Pace::Tolerance(tolerance) = pace {
            shorter = fine.steps as f64 / coarse.steps.max(1) as f64;
            if shorter < TELLING {
                let sum = fine.steps as f64 * tolerance;
                if sum <= 0.1 * goal || tolerance == LEAST_TOLERANCE && difference <= acceptable {
                    let error = difference.max(sum.min(goal)).max(f64::EPSILON);
                    return Ok(Converged { pace, pass: Pass { steps, evaluations, ..fine }, error });
                }
                (coarse, by) = (fine, 2.0);
                continue;
            }
        }
        let shown = last.map(|(before, by): (f64, f64)| (before / difference).ln() / by.ln());
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
        let unresolved = number <= FEW_PASSES || fine.largest[0] * fine.longest > shortest_turn;
        let gained = error <= 0.5 * previous || previous >= 1e-2 && unresolved;
        let stuck = !gained && !before || number > MOST_PASSES;
        if error <= goal || stuck && error <= acceptable {
            return Ok(Converged { pace, pass: Pass { steps, evaluations, ..fine }, error });
        }
        if stuck {
            return Err(SimulateError::NotConverged { rtol: goal, reached: error, step: fine.longest });
        }
        (last, previous, before, reached) = (Some((difference, shorter)), error.min(previous), gained, error);
        by = if difference < 0.1 {
            let likely = difference * by.powf(-0.9 * order);
            (1.1 * (likely / goal).powf(1.0 / (TRUSTED * order))).clamp(1.3, 6.0)
        } else {
            2.0
        };
        coarse = fine;
    }
    unreachable!("the loop returns")
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
