//! Fixed-step methods for bodies in SIMD lanes.

use super::laws::{Divisible, Laws};
use super::member::{Member, SIDE_BY_SIDE, of};
use super::observe::{LaneBodies, LanePhases};
use crate::laws::forcing::Forcing;
use crate::laws::torque::lanes::{in_lanes, part, put};
use crate::methods::classical::parts::Parts;
use crate::methods::classical::{self, Bodies, State};
use crate::methods::splitting::turns::{Spin, Turns, stage_times};
use polhode_ga::simd::lanes::{Lanes, Work};
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

    /// The times at which a step and the next ones begin, with the bits of [`Segment::begin`].
    #[inline(always)]
    fn begins(&self, first: u64) -> [f64; TIMED + 1] {
        let mut times = [self.begin(first + TIMED as u64); TIMED + 1];
        let (from, span, start, count) = (self.from, self.to - self.from, first as f64, self.count as f64);
        for k in 0..TIMED {
            times[k] = from + span * ((start + k as f64) / count);
        }
        let left = (self.count - first) as usize;
        if left < TIMED {
            times[left] = self.to;
        }
        times
    }
}

/// A fixed-step method.
pub(super) trait Stepper<const W: usize> {
    /// The state between steps.
    type State: Copy;

    /// The states at the start; lanes without a body hold the first one's.
    fn start(&self, members: &[Member]) -> Self::State;

    /// A number of steps, from each time to the next. `#[inline(always)]`.
    fn advance(&mut self, state: &mut Self::State, times: &[f64; TIMED + 1], count: usize);

    /// All numbers of a state, lane by lane.
    fn numbers(state: &Self::State) -> impl Iterator<Item = &[f64; W]>;

    /// The rotors and momenta of the bodies.
    fn phases(&self, bodies: &LaneBodies<W>, state: &Self::State) -> LanePhases<W>;
}

/// Some of the steps of a segment, compiled apart from the work between them so that the steps have all registers.
pub(super) struct Advance<'a, S: Stepper<W>, const W: usize, const F: bool> {
    pub stepper: &'a mut S,
    pub state: &'a mut S::State,
    pub segment: Segment,
    pub steps: Range<u64>,
}

impl<S: Stepper<W>, const W: usize, const F: bool> Work for Advance<'_, S, W, F> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        // The caller is on the same path; other paths are not compiled.
        if FUSED == F {
            for first in self.steps.clone().step_by(TIMED) {
                let times = self.segment.begins(first);
                let count = TIMED.min((self.steps.end - first) as usize);
                self.stepper.advance(self.state, &times, count);
            }
        }
    }
}

/// The classical method.
pub(super) struct Components<M, const W: usize, const F: bool> {
    pub bodies: Bodies<W, F>,
    pub acting: M,
}

/// Torques with the way in which the classical method steps under them.
pub(super) trait Marching<const W: usize, const F: bool> {
    /// A number of steps, from each time to the next. `#[inline(always)]`.
    fn march(
        &mut self,
        bodies: &Bodies<W, F>,
        state: &mut State<7, W, F>,
        times: &[f64; TIMED + 1],
        count: usize,
    );
}

/// Torques that are computed in registers with the steps, for as many bodies at a time as have room there.
pub(super) struct InRegisters<E>(pub E);

/// Torques that are computed in memory, for all bodies at a time.
pub(super) struct InMemory<E>(pub E);

/// The lengths of steps from each time to the next, and their sixths.
#[inline(always)]
fn lengths(times: &[f64; TIMED + 1]) -> [[f64; TIMED]; 2] {
    // One division of many lanes instead of many of one.
    let mut lengths = [[0.0; TIMED]; 2];
    for k in 0..TIMED {
        lengths[0][k] = times[k + 1] - times[k];
        lengths[1][k] = lengths[0][k] / 6.0;
    }
    lengths
}

impl<E: Divisible<W, F>, const W: usize, const F: bool> Marching<W, F> for InRegisters<E> {
    #[inline(always)]
    fn march(
        &mut self,
        bodies: &Bodies<W, F>,
        state: &mut State<7, W, F>,
        times: &[f64; TIMED + 1],
        count: usize,
    ) {
        const { assert!(W.is_multiple_of(SIDE_BY_SIDE), "whole groups") };
        let lengths = lengths(times);
        for group in 0..W / SIDE_BY_SIDE {
            let first = group * SIDE_BY_SIDE;
            // Copies, which the compiler may keep in registers.
            let (bodies, mut now) = (bodies.part(first), classical::halved(&part(state, first)));
            let mut forcing = self.0.part::<SIDE_BY_SIDE>(first);
            for k in 0..count {
                let length = [lengths[0][k], lengths[1][k]];
                classical::step(&bodies, &mut forcing, &mut now, times[k], length);
            }
            put(state, first, &classical::doubled(&now));
        }
    }
}

impl<E: Forcing<W, F>, const W: usize, const F: bool> Marching<W, F> for InMemory<E> {
    #[inline(always)]
    fn march(
        &mut self,
        bodies: &Bodies<W, F>,
        state: &mut State<7, W, F>,
        times: &[f64; TIMED + 1],
        count: usize,
    ) {
        let steps = times[..=count].windows(2);
        self.0.ahead(steps.flat_map(|t| classical::stage_times(t[0], t[1] - t[0])));
        let lengths = lengths(times);
        let mut parts = Parts::new(bodies, &classical::halved(state));
        for k in 0..count {
            parts.step(&mut self.0, times[k], [lengths[0][k], lengths[1][k]]);
        }
        *state = classical::doubled(parts.state());
    }
}

/// A splitting, with its kicks and drifts.
pub(super) struct Kicks<'t, const W: usize, const F: bool> {
    pub turns: Turns<W, F>,
    pub stages: (&'t [(f64, f64)], f64),
    pub laws: Laws<'t, W, F>,
}

impl<M: Marching<W, F>, const W: usize, const F: bool> Stepper<W> for Components<M, W, F> {
    type State = State<7, W, F>;

    fn start(&self, members: &[Member]) -> Self::State {
        in_lanes(|l| {
            let Member { start, gyrostat, .. } = of(members, l);
            let ([s, x, y, z], [p, q, r]) = (start.rotor.components(), gyrostat.omega(start.momentum).0);
            [s, x, y, z, p, q, r]
        })
    }

    #[inline(always)]
    fn advance(&mut self, state: &mut Self::State, times: &[f64; TIMED + 1], count: usize) {
        self.acting.march(&self.bodies, state, times, count);
    }

    fn numbers(state: &Self::State) -> impl Iterator<Item = &[f64; W]> {
        state.iter().map(|lanes| &lanes.0)
    }

    fn phases(&self, bodies: &LaneBodies<W>, [s, x, y, z, p, q, r]: &Self::State) -> LanePhases<W> {
        LanePhases { rotor: [s.0, x.0, y.0, z.0], momentum: bodies.momentum([*p, *q, *r]) }
    }
}

impl<const W: usize, const F: bool> Stepper<W> for Kicks<'_, W, F> {
    type State = Spin<W, F>;

    fn start(&self, members: &[Member]) -> Self::State {
        Spin {
            rotor: in_lanes(|l| of(members, l).start.rotor.components()),
            momentum: in_lanes(|l| of(members, l).start.momentum.0),
            lost: [Lanes::ZERO; 3],
        }
    }

    #[inline(always)]
    fn advance(&mut self, state: &mut Self::State, times: &[f64; TIMED + 1], count: usize) {
        let (stages, steps) = (self.stages, times[..=count].windows(2));
        self.laws.ahead(steps.flat_map(|t| stage_times(stages, t[0], t[1] - t[0])));
        let mut now = *state;
        for k in 0..count {
            self.turns.step(self.stages, &mut self.laws, &mut now, times[k], times[k + 1] - times[k]);
        }
        *state = now;
    }

    fn numbers(state: &Self::State) -> impl Iterator<Item = &[f64; W]> {
        state.rotor.iter().chain(&state.momentum).map(|lanes| &lanes.0)
    }

    fn phases(&self, _: &LaneBodies<W>, state: &Self::State) -> LanePhases<W> {
        LanePhases { rotor: state.rotor.map(|lanes| lanes.0), momentum: state.momentum.map(|lanes| lanes.0) }
    }
}
