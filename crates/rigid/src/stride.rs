//! The lengths of steps that keep to a tolerance, and where they stop: for single bodies and for those side by side.

use crate::simulate_error::{MAX_STEPS, SimulateError};
use crate::walk::Pass;

/// How long the next of the steps that keep to a tolerance is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stride {
    /// In s, if nothing is in its way.
    next: f64,
    /// That of the step under way, in s.
    cut: f64,
    /// Whether the step before was too long.
    refused: bool,
}

impl Stride {
    /// With a guess of the first step, in s.
    pub fn new(first: f64) -> Stride {
        Stride { next: first, cut: first, refused: false }
    }

    /// Where a step ends on the way from one time to another.
    pub fn end(&mut self, from: f64, time: f64) -> Result<f64, SimulateError> {
        let rest = (time - from).abs();
        // A last step that is much shorter than the one before helps nobody.
        let cut = if self.next >= rest { rest } else { self.next.min(0.5 * rest.max(self.next)) };
        let to = if cut >= rest { time } else { from + (time - from).signum() * cut };
        // Output times may be as close as numbers are.
        if to == from || self.refused && cut < 1e-14 * from.abs() {
            return Err(SimulateError::StepTooSmall { time: from, step: cut });
        }
        self.cut = cut;
        Ok(to)
    }

    /// Whether a step of length h may stand, by its error relative to the tolerance. The next one is the longest whose
    /// error should be 0.9⁸ of the tolerance.
    pub fn judge(&mut self, h: f64, error: f64) -> bool {
        let h = h.abs();
        // NaN too.
        if error.is_nan() || error > 1.0 {
            self.next = h * if error.is_finite() { (0.9 * error.powf(-0.125)).max(0.2) } else { 0.2 };
            self.refused = true;
            return false;
        }
        let growth = (0.9 * error.powf(-0.125)).clamp(0.3, if self.refused { 1.0 } else { 6.0 });
        // A step cut short by an output time says little of how long it might be.
        self.next = if self.cut < self.next { self.next.max(h * growth) } else { h * growth };
        self.refused = false;
        true
    }
}

/// Where to stop next on the way from one time to another: there, or where a law is not smooth.
pub(crate) fn next_stop(breaks: &[f64], from: f64, time: f64) -> f64 {
    let between = if time > from {
        breaks.get(breaks.partition_point(|&b| b <= from)).filter(|&&b| b < time)
    } else {
        breaks[..breaks.partition_point(|&b| b < from)].last().filter(|&&b| b > time)
    };
    between.copied().unwrap_or(time)
}

/// Whether a pass may go on.
pub(crate) fn check_count(pass: &Pass) -> Result<(), SimulateError> {
    let steps = pass.steps as f64;
    if steps > MAX_STEPS {
        return Err(SimulateError::TooManySteps { steps, step: pass.longest });
    }
    Ok(())
}
