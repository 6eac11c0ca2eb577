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
    /// Whether the previous step was rejected.
    refused: bool,
    /// Whether a stop or the longest length cut the last accepted step short.
    is_cut: bool,
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
            is_cut: false,
        }
    }

    /// Whether a stop or the longest length cut the last accepted step short: its length was not chosen by the tolerance.
    pub fn is_cut(&self) -> bool {
        self.is_cut
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
        let cut = if next >= rest { rest } else { next.min(0.5 * rest.max(next)) };
        let to = if cut >= rest { time } else { from + (time - from).signum() * cut };
        if to == from || self.refused && cut < 1e-14 * from.abs() {
            return Err(SimulateError::StepTooSmall { time: from, step: cut });
        }
        self.cut = cut;
        Ok(to)
    }

    /// Whether a step of length h is accepted, by the estimate of its error. The next one is the longest whose error should
    /// be 0.9⁸ of the tolerance.
    pub fn judge(&mut self, h: f64, estimate: f64) -> bool {
        let (h, error) = (h.abs(), estimate / self.tolerance);
        // NaN too.
        if error.is_nan() || error > 1.0 {
            self.next = h * if error.is_finite() { (0.9 * error.powf(-ROOT)).max(0.2) } else { 0.2 };
            self.refused = true;
            return false;
        }
        let growth = (0.9 * error.powf(-ROOT)).clamp(0.3, if self.refused { 1.0 } else { 6.0 });
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
