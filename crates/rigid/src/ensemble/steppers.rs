//! Fixed-step methods for bodies in SIMD lanes.

use super::advance::{Advance, Segment, Steps};
use super::laws::{LaneForcing, Laws, NoForcing};
use super::member::{Member, SIDE_BY_SIDE as W};
use crate::laws::forcing::Forcing;
use crate::methods::classical::{self, Bodies, State};
use crate::methods::splitting::turns::{Spin, Turns};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::lanes::{Lanes, fastest};
use polhode_ga::{Bivector, Rotor};
use std::array;
use std::ops::Range;

/// A fixed-step method.
pub(super) trait Stepper<const F: bool> {
    /// The state between steps.
    type State: Copy;

    /// The states at the start; lanes without a body hold the first one's.
    fn start(&self, members: &[Member]) -> Self::State;

    /// Some of the steps of a segment.
    fn advance(&mut self, state: &mut Self::State, segment: Segment, steps: &Range<u64>);

    /// The point of the body of a lane.
    fn phase(&self, body: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase;
}

/// The classical method.
pub(super) struct Components<'t, const F: bool> {
    pub bodies: Bodies<W, F>,
    pub forcing: LaneForcing<'t, W, F>,
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

impl<const F: bool> Stepper<F> for Components<'_, F> {
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

    fn advance(&mut self, state: &mut Self::State, segment: Segment, steps: &Range<u64>) {
        let bodies = &self.bodies;
        match &mut self.forcing {
            LaneForcing::NoForcing => {
                let method = OnComponents { bodies, forcing: &mut NoForcing, state };
                fastest(Advance::<_, F> { method, segment, steps });
            }
            LaneForcing::Weight(forcing) => {
                fastest(Advance::<_, F> { method: OnComponents { bodies, forcing, state }, segment, steps });
            }
            LaneForcing::Gradient(forcing) => {
                fastest(Advance::<_, F> { method: OnComponents { bodies, forcing, state }, segment, steps });
            }
            LaneForcing::Laws(forcing) => {
                fastest(Advance::<_, F> { method: OnComponents { bodies, forcing, state }, segment, steps });
            }
        }
    }

    fn phase(&self, body: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase {
        let numbers: [f64; 7] = array::from_fn(|k| state[k].0[lane]);
        classical::phase(body, &numbers, time)
    }
}

impl<const F: bool> Stepper<F> for Kicks<'_, F> {
    type State = Spin<W, F>;

    fn start(&self, members: &[Member]) -> Self::State {
        let mut spin = Spin { rotor: [Lanes::ZERO; 4], momentum: [Lanes::ZERO; 3], lost: [Lanes::ZERO; 3] };
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

    fn advance(&mut self, state: &mut Self::State, segment: Segment, steps: &Range<u64>) {
        let method = BySplitting { turns: &self.turns, stages: self.stages, laws: &mut self.laws, state };
        fastest(Advance::<_, F> { method, segment, steps });
    }

    fn phase(&self, _: &Gyrostat, state: &Self::State, lane: usize, time: f64) -> Phase {
        Phase {
            rotor: Rotor::from_unit_components(array::from_fn(|k| state.rotor[k].0[lane])),
            momentum: Bivector(array::from_fn(|k| state.momentum[k].0[lane])),
            time,
        }
    }
}

struct OnComponents<'a, E, const F: bool> {
    bodies: &'a Bodies<W, F>,
    forcing: &'a mut E,
    state: &'a mut State<7, W, F>,
}

impl<E: Forcing<W, F>, const F: bool> Steps for OnComponents<'_, E, F> {
    #[inline(always)]
    fn advance_over(&mut self, times: &[f64]) {
        // Copies, which the compiler may keep in registers.
        let (bodies, mut now) = (*self.bodies, *self.state);
        for k in 1..times.len() {
            classical::step(&bodies, self.forcing, &mut now, times[k - 1], times[k] - times[k - 1]);
        }
        *self.state = now;
    }
}

struct BySplitting<'a, 't, const F: bool> {
    turns: &'a Turns<W, F>,
    stages: (&'t [(f64, f64)], f64),
    laws: &'a mut Laws<'t, W, F>,
    state: &'a mut Spin<W, F>,
}

impl<const F: bool> Steps for BySplitting<'_, '_, F> {
    #[inline(always)]
    fn advance_over(&mut self, times: &[f64]) {
        let mut now = *self.state;
        for k in 1..times.len() {
            self.turns.step(self.stages, self.laws, &mut now, times[k - 1], times[k] - times[k - 1]);
        }
        *self.state = now;
    }
}
