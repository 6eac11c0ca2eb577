//! Equal steps of bodies side by side, one after the other.

use super::block::SIDE_BY_SIDE;
use crate::classical::{self, Bodies, Exert, State};
use polhode_ga::lanes::Work;
use std::ops::Range;

const W: usize = SIDE_BY_SIDE;

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
pub(super) struct Advance<'a, E, const F: bool> {
    pub bodies: &'a Bodies<W, F>,
    pub exert: &'a mut E,
    pub state: &'a mut State<7, W, F>,
    pub stretch: Stretch,
    pub steps: Range<u64>,
}

impl<E: Exert<W, F>, const F: bool> Work for Advance<'_, E, F> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        // The caller is on the same path; nothing need be compiled for others.
        if FUSED == F {
            self.steps();
        }
    }
}

impl<E: Exert<W, F>, const F: bool> Advance<'_, E, F> {
    #[inline(always)]
    fn steps(self) {
        let Advance { bodies, exert, state, stretch, steps } = self;
        let (bodies, mut now) = (*bodies, *state);
        for first in steps.clone().step_by(TIMED) {
            let mut times = [0.0; TIMED + 1];
            for k in 0..=TIMED {
                times[k] = stretch.begin(first + k as u64);
            }
            let count = TIMED.min((steps.end - first) as usize);
            for k in 0..count {
                let (from, to) = (times[k], times[k + 1]);
                classical::step(&bodies, exert, &mut now, from, to - from);
            }
        }
        *state = now;
    }
}
