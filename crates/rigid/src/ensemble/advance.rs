//! Sequences of equal steps of bodies in SIMD lanes.

use polhode_ga::simd::lanes::Work;
use std::ops::Range;

/// Number of steps whose times are computed together, with one division.
const TIMED: usize = 32;

/// Equal steps from one time to another.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    pub from: f64,
    pub to: f64,
    pub count: u64,
}

impl Segment {
    /// The time at which a step begins. The steps are the differences of these rounded times, so that they add up.
    #[inline(always)]
    pub fn begin(&self, step: u64) -> f64 {
        if step == self.count {
            self.to
        } else {
            self.from + (self.to - self.from) * (step as f64 / self.count as f64)
        }
    }
}

/// Some of the steps of a segment, compiled apart from the work between them so that the steps have all registers.
pub(super) struct Advance<'a, M, const F: bool> {
    pub method: M,
    pub segment: Segment,
    pub steps: &'a Range<u64>,
}

/// A method that steps from each time to the next.
pub(super) trait Steps {
    /// `#[inline(always)]`.
    fn advance_over(&mut self, times: &[f64]);
}

impl<M: Steps, const F: bool> Work for Advance<'_, M, F> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        // The caller is on the same path; other paths are not compiled.
        if FUSED == F {
            for first in self.steps.clone().step_by(TIMED) {
                let mut times = [0.0; TIMED + 1];
                for k in 0..=TIMED {
                    times[k] = self.segment.begin(first + k as u64);
                }
                let count = TIMED.min((self.steps.end - first) as usize);
                self.method.advance_over(&times[..count + 1]);
            }
        }
    }
}
