//! Equal steps of bodies side by side, one after the other.

use super::steppers::Stepper;
use polhode_ga::lanes::Work;
use std::ops::Range;

/// So many steps get their times at once, by one division for many.
const TIMED: usize = 32;

/// Equal steps from one time to another.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub from: f64,
    pub to: f64,
    pub count: u64,
}

impl Stretch {
    /// Where a step begins, and the one before it ends. The differences of these rounded times are the steps, so that they
    /// add up to the time.
    #[inline(always)]
    pub fn begin(&self, step: u64) -> f64 {
        if step == self.count {
            self.to
        } else {
            self.from + (self.to - self.from) * (step as f64 / self.count as f64)
        }
    }
}

/// Some of the steps of a stretch. Apart from what is done between them, so that the compiler has the registers for the
/// steps alone.
pub(super) struct Advance<'a, S: Stepper<F>, const F: bool> {
    pub stepper: &'a mut S,
    pub state: &'a mut S::State,
    pub stretch: Stretch,
    pub steps: Range<u64>,
}

/// Times in whole registers: memory that is aligned makes all of the function's so.
#[repr(align(64))]
struct Times([f64; TIMED + 1]);

impl<S: Stepper<F>, const F: bool> Work for Advance<'_, S, F> {
    type Output = ();

    /// Fused as the caller is, who is on the same path.
    #[inline(always)]
    fn run<const SAME: bool>(self) {
        let Advance { stepper, state, stretch, steps } = self;
        for first in steps.clone().step_by(TIMED) {
            let mut times = Times([0.0; TIMED + 1]);
            for k in 0..=TIMED {
                times.0[k] = stretch.begin(first + k as u64);
            }
            let count = TIMED.min((steps.end - first) as usize);
            stepper.walk(state, &times.0[..count + 1]);
        }
    }
}
