//! Steps of many bodies whose torques are computed in memory, not in registers.

use super::{Bodies, State, drive, free_slope, halved, moved, place, renormalize, stage_times};
use crate::laws::forcing::{Forcing, Place};
use crate::laws::torque::lanes::{part, put};
use polhode_ga::simd::lanes::{Lanes, PerLane};

/// Bodies for which the numbers of a stage stay in registers.
const PART: usize = 8;

/// Many bodies whose torques are computed in memory. Their steps have the bits of [`step`](super::step), and go part by part
/// between two torques: all at once they would be read and written at each operation, in code larger than the cache for
/// instructions.
///
/// All numbers begin at cache lines: a register that spans two takes twice as long to read.
#[repr(C, align(64))]
pub(crate) struct Parts<const W: usize, const F: bool> {
    bodies: Bodies<W, F>,
    /// With a in the place of ω.
    state: State<7, W, F>,
    /// Of the stages of a step so far.
    sum: State<7, W, F>,
    torque: [Lanes<W, F>; 3],
    /// Where the next torque is computed.
    at: Place<W, F>,
}

impl<const W: usize, const F: bool> Parts<W, F> {
    /// Bodies in a state with a in the place of ω.
    #[inline(always)]
    pub fn new(bodies: &Bodies<W, F>, state: &State<7, W, F>) -> Parts<W, F> {
        let at = place(state, 0.0);
        Parts { bodies: *bodies, state: *state, at, torque: [Lanes::ZERO; 3], sum: *state }
    }

    /// The state after the last step.
    #[inline(always)]
    pub fn state(&self) -> &State<7, W, F> {
        &self.state
    }

    /// One step of length h, given with `h/6`.
    #[inline(always)]
    pub fn step<E: Forcing<W, F>>(&mut self, forcing: &mut E, time: f64, [h, sixth]: [f64; 2]) {
        let [begin, middle, end] = stage_times(time, h);
        let third = sixth + sixth;
        // Of each stage its time, its part of the sum, and the step to the next stage.
        let times = [begin, middle, middle, end];
        let (parts_of_sum, to_next) = ([sixth, third, third, sixth], [0.5 * h, 0.5 * h, h, 0.0]);
        let last = times.len() - 1;
        forcing.begin(Lanes::all(middle));
        for stage in 0..=last {
            self.at.time = PerLane::Common(times[stage]);
            self.torque = forcing.torque(&self.at, &[Lanes::ZERO; 6]);
            let (part_of_sum, to_next) = (Lanes::all(parts_of_sum[stage]), Lanes::all(to_next[stage]));
            for first in (0..W).step_by(PART) {
                let ([s, a, b, c], [p, q, r]) = (part(&self.at.rotor, first), part(&self.at.omega, first));
                let here = halved::<7, PART, F>(&[s, a, b, c, p, q, r]);
                let bodies = self.bodies.part(first);
                let mut slope = free_slope(&bodies, &here);
                drive(&bodies, E::WHEELS, &here, part(&self.torque, first), &mut slope);
                let before = part(&self.state, first);
                if stage < last {
                    let so_far = if stage == 0 { before } else { part(&self.sum, first) };
                    put(&mut self.sum, first, &moved(&so_far, &slope, part_of_sum));
                    self.put_place(first, &moved(&before, &slope, to_next));
                } else {
                    let mut next = moved(&part(&self.sum, first), &slope, part_of_sum);
                    renormalize(&mut next);
                    put(&mut self.state, first, &next);
                    self.put_place(first, &next);
                }
            }
        }
    }

    /// Puts the place of a state, except for its time.
    #[inline(always)]
    fn put_place(&mut self, first: usize, state: &State<7, PART, F>) {
        let next = place(state, 0.0);
        put(&mut self.at.rotor, first, &next.rotor);
        put(&mut self.at.omega, first, &next.omega);
    }
}

#[cfg(test)]
mod tests;
