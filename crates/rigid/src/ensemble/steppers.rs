//! Fixed-step methods for bodies in SIMD lanes.

use super::laws::Laws;
use super::member::{Member, SIDE_BY_SIDE as W};
use crate::laws::forcing::Forcing;
use crate::laws::torque::lanes::in_lanes;
use crate::methods::classical::{self, Bodies, State};
use crate::methods::splitting::turns::{Spin, Turns};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::lanes::{Lanes, Work};
use polhode_ga::{Bivector, Rotor};
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

/// A fixed-step method.
pub(super) trait Stepper {
    /// The state between steps.
    type State: Copy;

    /// The states at the start; lanes without a body hold the first one's.
    fn start(&self, members: &[Member]) -> Self::State;

    /// Steps from each time to the next. `#[inline(always)]`.
    fn advance(&mut self, state: &mut Self::State, times: &[f64]);

    /// The point of the body of a lane.
    fn phase(&self, body: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase;
}

/// Some of the steps of a segment, compiled apart from the work between them so that the steps have all registers.
pub(super) struct Advance<'a, S: Stepper, const F: bool> {
    pub stepper: &'a mut S,
    pub state: &'a mut S::State,
    pub segment: Segment,
    pub steps: Range<u64>,
}

impl<S: Stepper, const F: bool> Work for Advance<'_, S, F> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        // The caller is on the same path; other paths are not compiled.
        if FUSED == F {
            for first in self.steps.clone().step_by(TIMED) {
                let mut times = [0.0; TIMED + 1];
                for k in 0..=TIMED {
                    times[k] = self.segment.begin(first + k as u64);
                }
                let count = TIMED.min((self.steps.end - first) as usize);
                self.stepper.advance(self.state, &times[..count + 1]);
            }
        }
    }
}

/// The classical method.
pub(super) struct Components<E, const F: bool> {
    pub bodies: Bodies<W, F>,
    pub forcing: E,
}

/// A splitting, with its kicks and drifts.
pub(super) struct Kicks<'t, const F: bool> {
    pub turns: Turns<W, F>,
    pub stages: (&'t [(f64, f64)], f64),
    pub laws: Laws<'t, W, F>,
}

/// The member of each lane.
pub(super) fn of<'m, 'a>(members: &'m [Member<'a>], lane: usize) -> &'m Member<'a> {
    members.get(lane).unwrap_or(&members[0])
}

impl<E: Forcing<W, F>, const F: bool> Stepper for Components<E, F> {
    type State = State<7, W, F>;

    fn start(&self, members: &[Member]) -> Self::State {
        in_lanes(|l| {
            let Member { start, gyrostat, .. } = of(members, l);
            let ([s, x, y, z], [p, q, r]) = (start.rotor.components(), gyrostat.omega(start.momentum).0);
            [s, x, y, z, p, q, r]
        })
    }

    #[inline(always)]
    fn advance(&mut self, state: &mut Self::State, times: &[f64]) {
        // Copies, which the compiler may keep in registers.
        let (bodies, mut now) = (self.bodies, *state);
        for k in 1..times.len() {
            classical::step(&bodies, &mut self.forcing, &mut now, times[k - 1], times[k] - times[k - 1]);
        }
        *state = now;
    }

    fn phase(&self, body: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase {
        classical::phase(body, &state.map(|lanes| lanes.0[lane]), time)
    }
}

impl<const F: bool> Stepper for Kicks<'_, F> {
    type State = Spin<W, F>;

    fn start(&self, members: &[Member]) -> Self::State {
        Spin {
            rotor: in_lanes(|l| of(members, l).start.rotor.components()),
            momentum: in_lanes(|l| of(members, l).start.momentum.0),
            lost: [Lanes::ZERO; 3],
        }
    }

    #[inline(always)]
    fn advance(&mut self, state: &mut Self::State, times: &[f64]) {
        let mut now = *state;
        for k in 1..times.len() {
            self.turns.step(self.stages, &mut self.laws, &mut now, times[k - 1], times[k] - times[k - 1]);
        }
        *state = now;
    }

    fn phase(&self, _: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase {
        Phase {
            rotor: Rotor::from_unit_components(state.rotor.map(|lanes| lanes.0[lane])),
            momentum: Bivector(state.momentum.map(|lanes| lanes.0[lane])),
            time,
        }
    }
}
