//! Stops of the steps, found by sampling laws that depend on time.
//!
//! A step evaluates a law a dozen times. A short pulse between the evaluations of a long step would be missed, also by
//! the error estimate, which uses the same values. So a law is sampled first, and intervals in which coarse samples do
//! not predict the others are bisected: around a pulse the steps are as short as the pulse, elsewhere they are free. The
//! finest intervals are sampled again and bisected further, so that a change sharper than the samples lies between close
//! stops: the error estimate of a step across it may be small by chance.

use crate::error::{SimulateError, TorqueError};
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::methods::LARGEST_TURN;
use crate::methods::step_control::step_count;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::{Bivector, Rotor, Vector};
use std::array;
use std::ops::Range;

/// Intervals between samples on each side of the start: a power of 2. A pulse shorter than one may be missed.
const SAMPLES: usize = 4096;

/// An interval of this many samples is not bisected.
const FINEST: usize = 4;

/// Intervals between samples of such an interval, and how often intervals are sampled again in all and in one of the first
/// samples. Functions of the caller are slow.
const FINER: usize = 8;
const MOST_FINER: usize = 4096;
const MOST_FINER_OF_FUNCTIONS: usize = 256;
const MOST_FINER_EACH: usize = 128;

/// Intervals this small, relative to the run, are not bisected: steps across a jump in one have a negligible error.
const LEAST: f64 = 1e-12;

/// Number of coarse intervals in an interval.
const COARSE: usize = 8;

/// The deviation from the coarse samples, relative to the largest torque, that counts.
const DEVIATION: f64 = 1e-3;

/// Samples of a law in time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sampled {
    /// Ascending times at which steps stop.
    pub stops: Vec<f64>,
    /// Time of the largest torque, if it depends on time.
    pub peak: Option<f64>,
    /// The largest size of its integral since the start, roughly.
    pub impulse: f64,
}

/// Values of a law at times.
type Values<'a> = dyn Fn(&[f64]) -> Result<Vec<Bivector>, (f64, TorqueError)> + 'a;

/// A law that depends on time, at one state; forces are written as bivectors of their components.
///
/// User functions, which may be defined for such states only, are evaluated at the start. Formulas and orbits are evaluated in
/// general position, so that the stops of torques depend on the law alone; positions and velocities are near the start.
pub(crate) struct InTime<'a> {
    values: Box<Values<'a>>,
    is_function: bool,
}

impl<'a> InTime<'a> {
    /// None for a law that does not depend on time, or is not smooth at known times.
    pub fn of_torque(law: &'a Torque, &Point { body, mass, phase, center }: &Point) -> Option<InTime<'a>> {
        let circular = matches!(law, Torque::GravityGradient(orbit) if orbit.is_circular());
        if circular || !is_to_be_sampled(law) {
            return None;
        }
        let is_function = matches!(law, Torque::Function(_));
        let (body, phase, center) = if is_function {
            (*body, *phase, *center)
        } else {
            (GENERAL, general(phase.time), aside(center))
        };
        let values = move |times: &[f64]| {
            law.values(&Point { body: &body, mass, phase: &phase, center: &center }, times)
        };
        Some(InTime { values: Box::new(values), is_function })
    }

    /// None for a force that does not depend on time.
    pub fn of_force(force: &'a Force, &Point { body, mass, phase, center }: &Point) -> Option<InTime<'a>> {
        if force.is_autonomous() {
            return None;
        }
        let is_function = matches!(force, Force::Function(_));
        let (body, phase, center) =
            if is_function { (*body, *phase, *center) } else { (*body, general(phase.time), aside(center)) };
        let values = move |times: &[f64]| {
            let at = Point { body: &body, mass, phase: &phase, center: &center };
            Ok(force.values(&at, times)?.into_iter().map(|force| Bivector(force.0)).collect())
        };
        Some(InTime { values: Box::new(values), is_function })
    }
}

/// A body and a state without symmetry.
const GENERAL: Gyrostat = Gyrostat { moments: [1.0, 1.25, 1.75], wheel: Bivector([0.0; 3]) };

fn aside(Center { position, velocity }: &Center) -> Center {
    let [position, velocity] = [*position, *velocity]
        .map(|x| x + Vector([0.37, -0.21, 0.29]) * if x.norm() > 0.0 { x.norm() } else { 1.0 });
    Center { position, velocity }
}

fn general(time: f64) -> Phase {
    let rotor = Rotor::from_unit_components([0.76, 0.48, -0.24, 0.36]).renormalized();
    Phase { rotor, momentum: Bivector([0.6, -0.5, 0.9]), time }
}

/// Samples a law between two times.
///
/// The finest intervals are sampled again if the method `adapts` its steps: equal steps become shorter everywhere, whatever
/// their error estimates are.
pub(crate) fn sampled(law: &InTime, [from, to]: [f64; 2], adapts: bool) -> Result<Sampled, SimulateError> {
    if from == to {
        return Ok(Sampled::default());
    }
    let time = |k: usize| from + (to - from) * (k as f64 / SAMPLES as f64);
    let times: Vec<f64> = (0..=SAMPLES).map(time).collect();
    let values = match (law.values)(&times) {
        Ok(values) => values,
        // An error of a user's function is reported; a formula may fail at this state only.
        Err((time, error)) if law.is_function => {
            return Err(error.at(time));
        }
        Err(_) => return Ok(Sampled::default()),
    };
    let (peak, largest) = values
        .iter()
        .map(|value| value.norm())
        .enumerate()
        .fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
    let allowed = DEVIATION * largest;
    let (mut found, mut finest) = (Vec::new(), Vec::new());
    bisect(&values, 0..SAMPLES, allowed, &mut found, &mut finest);
    let mut stops: Vec<f64> = found.into_iter().map(time).collect();
    let most = if law.is_function { MOST_FINER_OF_FUNCTIONS } else { MOST_FINER };
    let finer =
        Finer { values: &|times| (law.values)(times).ok(), allowed, least: LEAST * (to - from).abs() };
    for part in finest.iter().filter(|_| adapts) {
        let mut left = (most / finest.len()).min(MOST_FINER_EACH);
        finer.bisect([time(part.start), time(part.end)], &mut left, &mut stops);
    }
    let impulse = largest_sum(&values) * (to - from).abs() / SAMPLES as f64;
    Ok(Sampled { stops, peak: Some(time(peak)), impulse })
}

/// The largest size of the sums of the first values, by the trapezoidal rule.
fn largest_sum(values: &[Bivector]) -> f64 {
    let (mut sum, mut largest) = (Bivector::default(), 0.0_f64);
    for pair in values.windows(2) {
        sum += (pair[0] + pair[1]) * 0.5;
        largest = largest.max(sum.norm());
    }
    largest
}

/// Bisects intervals of samples in which the coarse ones do not predict the others; collects the midpoints, and the finest of
/// these intervals.
fn bisect(
    values: &[Bivector],
    part: Range<usize>,
    allowed: f64,
    found: &mut Vec<usize>,
    finest: &mut Vec<Range<usize>>,
) {
    if part.len() <= FINEST {
        finest.push(part);
        return;
    }
    if is_predicted(&values[part.start..=part.end], allowed) {
        return;
    }
    let middle = (part.start + part.end) / 2;
    bisect(values, part.start..middle, allowed, found, finest);
    found.push(middle);
    bisect(values, middle..part.end, allowed, found, finest);
}

/// Bisects intervals that are sampled anew.
struct Finer<'a> {
    /// The law at times; none if it has no value.
    values: &'a dyn Fn(&[f64]) -> Option<Vec<Bivector>>,
    /// The deviation that is allowed.
    allowed: f64,
    /// The shortest interval that is bisected, in s.
    least: f64,
}

impl Finer<'_> {
    /// Collects the midpoints of intervals in which the coarse samples do not predict the others, while any are left.
    fn bisect(&self, [from, to]: [f64; 2], left: &mut usize, found: &mut Vec<f64>) {
        if *left == 0 || (to - from).abs() <= self.least {
            return;
        }
        *left -= 1;
        let times: [f64; FINER + 1] = array::from_fn(|k| from + (to - from) * (k as f64 / FINER as f64));
        match (self.values)(&times) {
            Some(values) if !is_predicted(&values, self.allowed) => {}
            _ => return,
        }
        let middle = times[FINER / 2];
        self.bisect([from, middle], left, found);
        found.push(middle);
        self.bisect([middle, to], left, found);
    }
}

/// Whether cubics through coarse samples approximate the others.
fn is_predicted(values: &[Bivector], allowed: f64) -> bool {
    let count = values.len() - 1;
    let stride = count / COARSE.min(count / 2);
    (0..count).all(|k| {
        // The four coarse samples around it, or those at the end.
        let first = (k / stride).saturating_sub(1).min((count / stride).saturating_sub(3)) * stride;
        let nodes = [0, 1, 2, 3].map(|j| (first + j * stride).min(count));
        let x = (k - first) as f64 / stride as f64;
        let weights = [
            -(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0,
            x * (x - 2.0) * (x - 3.0) / 2.0,
            -x * (x - 1.0) * (x - 3.0) / 2.0,
            x * (x - 1.0) * (x - 2.0) / 6.0,
        ];
        let predicted =
            nodes.iter().zip(weights).fold(Bivector::default(), |sum, (&j, w)| sum + values[j] * w);
        (predicted - values[k]).norm() <= allowed
    })
}

/// Number of steps checked for aliasing, and samples in each.
const CHECKED_STEPS: usize = 256;
const INSIDE: usize = 12;

/// The parts of a step at which Simpson's rule evaluates a law, and then those of the samples.
const PARTS: [f64; 3 + INSIDE] = {
    let (mut parts, mut k) = ([0.0; 3 + INSIDE], 0);
    (parts[1], parts[2]) = (0.5, 1.0);
    while k < INSIDE {
        parts[3 + k] = (k as f64 + 0.5) / INSIDE as f64;
        k += 1;
    }
    parts
};

/// Whether a law depends on time in an unknown way; tables and wheels have their own stops.
fn is_to_be_sampled(law: &Torque) -> bool {
    !law.is_autonomous() && !matches!(law, Torque::Tabulated(_) | Torque::Wheels(_))
}

/// The warning for an aliased law.
pub(crate) fn aliasing_warning(law: &Torque, step: f64) -> String {
    let what = match law {
        Torque::Formula(formula) => format!("the torque `{}`", formula.text()),
        Torque::Registered(law) => format!("the torque {}", law.name),
        Torque::Function(_) => "the torque of a function".to_owned(),
        _ => "a torque".to_owned(),
    };
    too_fast(&what, step)
}

/// The warning for an aliased force.
pub(crate) fn force_aliasing_warning(force: &Force, step: f64) -> String {
    match force {
        Force::Formula(formula) => too_fast(&format!("the force `{}`", formula.text()), step),
        _ => too_fast("the force of a function", step),
    }
}

fn too_fast(what: &str, step: f64) -> String {
    format!("{what} changes too fast for step = {step} s; use a shorter step, or omit step")
}

/// The warning for equal steps in which a body turns too far.
pub(crate) fn turn_warning(step: f64) -> String {
    format!(
        "with step = {step} s the body turns by more than {LARGEST_TURN} rad in a step, which is not accurate; use a \
         shorter step, or omit step"
    )
}

/// Whether fixed steps miss more than a tenth of the impulse of a law that depends on time.
pub(crate) fn is_aliased(law: &Torque, start: &Point, [from, to]: [f64; 2], step: f64) -> bool {
    // Along an orbit a gradient has harmonics of the true anomaly up to the fifth, and Simpson's rule misses
    // `h⁴/2880` of the fourth derivative: of steps this short, less than a thousandth.
    if let Torque::GravityGradient(orbit) = law
        && orbit.fastest_turn() * (to - from) / step_count(to - from, step) <= 0.1
    {
        return false;
    }
    is_to_be_sampled(law) && misses_impulse(&|times| law.values(start, times), [from, to], step)
}

/// The same for a force, at a point.
pub(crate) fn is_aliased_force(force: &Force, at: &Point, span: [f64; 2], step: f64) -> bool {
    let values =
        |times: &[f64]| Ok(force.values(at, times)?.into_iter().map(|force| Bivector(force.0)).collect());
    !force.is_autonomous() && misses_impulse(&values, span, step)
}

/// Compares Simpson's rule, which a method's evaluations amount to, with the mean of finer samples.
fn misses_impulse(values: &Values, [from, to]: [f64; 2], step: f64) -> bool {
    if to <= from {
        return false;
    }
    let steps = step_count(to - from, step);
    let h = (to - from) / steps;
    let checked = (steps as usize).min(CHECKED_STEPS);
    let mut times = Vec::with_capacity(checked * PARTS.len());
    for k in 0..checked {
        let begin = from + h * (steps * k as f64 / checked as f64).floor();
        times.extend(PARTS.map(|part| begin + h * part));
    }
    let Ok(values) = values(&times) else { return false };
    let (mut missed, mut all) = (0.0, 0.0);
    for of_step in values.chunks_exact(PARTS.len()) {
        let (seen, inside) = of_step.split_at(3);
        let mean = inside.iter().fold(Bivector::default(), |sum, &value| sum + value) * (1.0 / INSIDE as f64);
        all += inside.iter().map(|value| value.norm()).sum::<f64>() / INSIDE as f64;
        missed += ((seen[0] + seen[1] * 4.0 + seen[2]) * (1.0 / 6.0) - mean).norm();
    }
    missed > 0.1 * all
}

#[cfg(test)]
mod tests;
