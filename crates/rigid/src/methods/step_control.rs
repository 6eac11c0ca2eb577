//! Lengths of adaptive steps, stops and limits, for single bodies and lanes.

use crate::error::SimulateError;

/// Number of steps after which the total is predicted, and again at every doubling.
const FIRST_FORECAST: u64 = 20_000;

/// A prediction counts if it exceeds the limit by this over the steps taken, and by a factor of 2: a body may slow down.
const DOUBT: f64 = 2e7;

/// Steps that turn the body by less than this, in rad, are limited by stability: the laws are stiff.
const STIFF_TURN: f64 = 0.02;

/// Runs of fewer steps than this are completed even if stiff.
const MANY: f64 = 1e5;

/// The error of a step grows as its eighth power.
pub(crate) const ROOT: f64 = 0.125;

/// The first step turns a body by this angle, in rad, times the eighth root of the tolerance.
const FIRST_TURN: f64 = 2.0;

/// Parts of a way to a stop below this, relative to the times, are not divided: stops may be adjacent floats.
const LEAST_PART: f64 = 1e-14;

/// Shorter steps, relative to the time, are rounded away.
const LEAST_STEP: f64 = 1e-14;

/// A step of the least length with at most this error is accepted: a law jumps there.
const NEGLIGIBLE: f64 = 1e-12;

/// The error of a step that shortens falls at least with this power of its length where laws are smooth, once it is less than
/// [`RESOLVED`].
const SMOOTH: i32 = 4;
const RESOLVED: f64 = 0.1;

/// Steps that are hardly shorter show no power.
const MUCH_SHORTER: f64 = 0.7;

/// What counts of the error per length of a longer step that was refused, and how much less than by that the error is where a
/// step ends before the jump.
const FORGOTTEN: f64 = 0.1;
const BEFORE_JUMP: f64 = 1e-4;

/// The number of equal steps of at most this length in a span, both in s: k steps up to rounding are k.
pub(crate) fn step_count(span: f64, step: f64) -> f64 {
    (span.abs() / step * (1.0 - 4.0 * f64::EPSILON)).ceil().max(1.0)
}

/// Chooses the lengths of adaptive steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepController {
    /// The largest error estimate of an accepted step.
    tolerance: f64,
    /// The length without stops, in s.
    next: f64,
    /// The length of the current step, in s.
    cut: f64,
    /// The longest allowed, in s.
    longest: f64,
    /// The longest steps as fractions of the way, to the first stop and to later ones.
    fractions: [f64; 2],
    /// Whether the first stop is ahead.
    is_first: bool,
    /// The longest step to the next stop, in s.
    most: f64,
    /// Whether the last step was rejected, its length and its error estimate.
    refused: bool,
    refused_length: f64,
    estimate: f64,
    /// Whether a law seems to jump ahead, before the end of the last rejected step, in s; and the largest error estimate of
    /// such steps per length.
    is_jump_ahead: bool,
    refused_end: f64,
    per_length: f64,
    /// The end of the current step, in s.
    to: f64,
    /// Whether the step is as short as steps can be.
    is_least: bool,
    /// Whether a stop or the longest length cut the last accepted step short.
    is_cut: bool,
    /// A bound of its error if a law jumps in it, else 0.
    error_of_jump: f64,
}

impl StepController {
    /// For a tolerance, the fastest rate of the laws and the body in rad/s, and the longest step in s. Steps to the first
    /// stop are at most the first of these `fractions` of the way, and those to later stops the second.
    pub fn new(tolerance: f64, rate: f64, longest: f64, fractions: [f64; 2]) -> StepController {
        let first = FIRST_TURN * tolerance.powf(ROOT) / rate.max(f64::MIN_POSITIVE);
        StepController {
            tolerance,
            next: first,
            cut: first,
            longest,
            fractions,
            is_first: true,
            most: f64::INFINITY,
            refused: false,
            refused_length: 0.0,
            estimate: 0.0,
            is_jump_ahead: false,
            refused_end: 0.0,
            per_length: 0.0,
            to: 0.0,
            is_least: false,
            is_cut: false,
            error_of_jump: 0.0,
        }
    }

    /// Whether a stop or the longest length cut the last accepted step short: its length was not chosen by the tolerance.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// A bound of the error of the last accepted step if a law jumps in it, else 0. There the estimate of a step may be small
    /// by chance; but errors fall with the length only, and those of longer steps are known.
    pub fn error_of_jump(&self) -> f64 {
        self.error_of_jump
    }

    /// Heads for the next stop.
    pub fn head_for(&mut self, from: f64, stop: f64) {
        let rest = (stop - from).abs();
        let [first, later] = self.fractions;
        let fraction = if self.is_first { first } else { later };
        let least = (LEAST_PART * from.abs().max(stop.abs())).max(f64::MIN_POSITIVE);
        let divides = fraction * rest > least;
        self.most = if divides { fraction * rest } else { rest };
        self.is_first &= !divides;
    }

    /// Where a step ends on the way from one time to another.
    pub fn end(&mut self, from: f64, time: f64) -> Result<f64, SimulateError> {
        let rest = (time - from).abs();
        let next = self.next.min(self.most).min(self.longest);
        // Two steps of half the way avoid a tiny last one.
        let mut cut = if next >= rest { rest } else { next.min(0.5 * rest.max(next)) };
        let least = LEAST_STEP * from.abs();
        self.is_least = self.refused && cut < least;
        if self.is_least {
            if self.estimate.is_nan() || self.estimate > NEGLIGIBLE {
                return Err(SimulateError::StepTooSmall { time: from, step: cut });
            }
            cut = least.min(rest);
        }
        let to = if cut >= rest { time } else { from + (time - from).signum() * cut };
        if to == from {
            return Err(SimulateError::StepTooSmall { time: from, step: cut });
        }
        (self.cut, self.to) = (cut, to);
        Ok(to)
    }

    /// Whether the error of a step that follows a longer, rejected one has fallen less than where laws are smooth.
    fn is_sharp(&self, h: f64, estimate: f64) -> bool {
        let shorter = h / self.refused_length;
        self.refused
            && shorter < MUCH_SHORTER
            && self.estimate < RESOLVED
            && estimate > self.estimate * shorter.powi(SMOOTH)
    }

    /// Whether a step of length h is accepted, by the estimate of its error. The next one is the longest whose error should
    /// be 0.9⁸ of the tolerance.
    pub fn judge(&mut self, h: f64, estimate: f64) -> bool {
        let (h, direction, error) = (h.abs(), h.signum(), estimate / self.tolerance);
        let is_negligible = self.is_least && estimate <= NEGLIGIBLE;
        self.is_jump_ahead |= self.is_sharp(h, estimate);
        if error.is_nan() || error > 1.0 && !is_negligible {
            self.next = h * if error.is_finite() { (0.9 * error.powf(-ROOT)).max(0.2) } else { 0.2 };
            (self.refused, self.estimate, self.refused_length) = (true, estimate, h);
            self.refused_end = self.to;
            let per_length = if estimate.is_finite() { estimate / h } else { 0.0 };
            self.per_length = (FORGOTTEN * self.per_length).max(per_length);
            return false;
        }
        let growth = (0.9 * error.powf(-ROOT)).clamp(0.3, if self.refused { 1.0 } else { 6.0 });
        // A step that ends before the jump has a much smaller error.
        let bound = self.per_length * h;
        let is_at_jump = self.is_jump_ahead && estimate > BEFORE_JUMP * bound;
        self.error_of_jump = if is_at_jump { estimate.max(bound) } else { 0.0 };
        // The jump is before the end of the last refused step.
        if (self.to - self.refused_end) * direction >= 0.0 {
            (self.is_jump_ahead, self.per_length) = (false, 0.0);
        }
        self.is_cut = self.cut < self.next;
        // A step that is cut short says little about the possible length.
        self.next = if self.is_cut { self.next.max(h * growth) } else { h * growth };
        self.refused = false;
        true
    }
}

/// The limit of the steps of a sweep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    pub steps: f64,
    /// Whether stiffness is reported, so that another method can take over.
    pub reports_stiffness: bool,
}

impl Limit {
    /// An error if a sweep has taken too many steps, or is predicted to, after a step of length h that turned the body by
    /// `turn`, at a fraction of the run.
    pub fn check(
        &self,
        taken: u64,
        h: f64,
        turn: f64,
        fraction: impl FnOnce() -> f64,
    ) -> Result<(), SimulateError> {
        let steps = taken as f64;
        let step = h.abs();
        if steps > self.steps {
            return Err(SimulateError::TooManySteps { steps, step, limit: self.steps });
        }
        if !(taken.is_multiple_of(FIRST_FORECAST) && (taken / FIRST_FORECAST).is_power_of_two()) {
            return Ok(());
        }
        let predicted = steps / fraction().max(f64::MIN_POSITIVE);
        if self.reports_stiffness && turn.abs() < STIFF_TURN && predicted > MANY {
            return Err(SimulateError::Stiff { steps: predicted });
        }
        if predicted > self.steps * (DOUBT / steps).max(2.0) {
            return Err(SimulateError::TooManySteps { steps: predicted, step, limit: self.steps });
        }
        Ok(())
    }
}

/// The next stop from one time to another: the latter, or where a law is not smooth.
pub(crate) fn next_stop(breaks: &[f64], from: f64, time: f64) -> f64 {
    let between = if time > from {
        breaks.get(breaks.partition_point(|&b| b <= from)).filter(|&&b| b < time)
    } else {
        breaks[..breaks.partition_point(|&b| b < from)].last().filter(|&&b| b > time)
    };
    between.copied().unwrap_or(time)
}
