//! Methods of equal steps over bodies side by side.

use super::block::{Member, SIDE_BY_SIDE as W};
use crate::classical::{self, Bodies, State};
use crate::exert::Exert;
use crate::phase::{Gyrostat, Phase};
use crate::splitting::turns::{Spin, Turns};
use polhode_ga::lanes::Lanes;
use polhode_ga::{Bivector, Rotor};
use std::array;

/// A method at work.
pub(super) trait Stepper<const F: bool> {
    /// What is carried from step to step.
    type State: Copy;

    /// The bodies at time 0; lanes without a body hold the first one's.
    fn start(&self, members: &[Member]) -> Self::State;

    /// Steps from each of these times to the next.
    fn walk(&mut self, state: &mut Self::State, times: &[f64]);

    /// Where the body of a lane is.
    fn phase(&self, body: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase;
}

/// The classical method.
pub(super) struct Components<E, const F: bool> {
    pub bodies: Bodies<W, F>,
    pub exert: E,
}

/// A splitting, with its kicks and drifts.
pub(super) struct Kicks<'a, E, const F: bool> {
    pub turns: Turns<W, F>,
    pub stages: (&'a [(f64, f64)], f64),
    pub exert: E,
}

/// The member of each lane.
pub(super) fn of<'m, 'a>(members: &'m [Member<'a>], lane: usize) -> &'m Member<'a> {
    members.get(lane).unwrap_or(&members[0])
}

impl<E: Exert<W, F>, const F: bool> Stepper<F> for Components<E, F> {
    type State = State<7, W, F>;

    fn start(&self, members: &[Member]) -> Self::State {
        let mut state = [Lanes::ZERO; 7];
        for l in 0..W {
            let member = of(members, l);
            let rotor = member.start.rotor.components();
            let omega = member.gyrostat.omega(member.start.momentum).0;
            for k in 0..7 {
                state[k].0[l] = if k < 4 { rotor[k] } else { omega[k - 4] };
            }
        }
        state
    }

    #[inline(always)]
    fn walk(&mut self, state: &mut Self::State, times: &[f64]) {
        // Copies, which the compiler may keep in registers.
        let (bodies, mut now) = (self.bodies, *state);
        for k in 1..times.len() {
            classical::step(&bodies, &mut self.exert, &mut now, times[k - 1], times[k] - times[k - 1]);
        }
        *state = now;
    }

    fn phase(&self, body: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase {
        let numbers: [f64; 7] = array::from_fn(|k| state[k].0[lane]);
        classical::phase(body, &numbers, time)
    }
}

impl<E: Exert<W, F>, const F: bool> Stepper<F> for Kicks<'_, E, F> {
    type State = Spin<W, F>;

    fn start(&self, members: &[Member]) -> Self::State {
        let mut spin = Spin { rotor: [Lanes::ZERO; 4], momentum: [Lanes::ZERO; 3] };
        for l in 0..W {
            let start = &of(members, l).start;
            let (rotor, momentum) = (start.rotor.components(), start.momentum.0);
            for k in 0..4 {
                spin.rotor[k].0[l] = rotor[k];
            }
            for k in 0..3 {
                spin.momentum[k].0[l] = momentum[k];
            }
        }
        spin
    }

    #[inline(always)]
    fn walk(&mut self, state: &mut Self::State, times: &[f64]) {
        let mut now = *state;
        for k in 1..times.len() {
            self.turns.step(self.stages, &mut self.exert, &mut now, times[k - 1], times[k] - times[k - 1]);
        }
        *state = now;
    }

    fn phase(&self, _: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase {
        Phase {
            rotor: Rotor::from_unit_components(array::from_fn(|k| state.rotor[k].0[lane])),
            momentum: Bivector(array::from_fn(|k| state.momentum[k].0[lane])),
            time,
        }
    }
}
