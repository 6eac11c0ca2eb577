//! Errors of equal steps in which a law jumps or has a kink.
//!
//! The error of a step with a jump N₂ − N₁ of the torque is about `h (N₂ − N₁)`, whatever the order of the method, and
//! depends on where in the step the jump is: the errors of two sweeps may be equal by chance, and their difference small.
//! So jumps are found by the mean torque and acceleration of each step. Of three steps the second has the mean of its
//! neighbours, up to the second derivative of a law that is smooth; where there is a jump, that derivative is larger than
//! that three steps before and after.

use crate::state::carried::Carried;
use crate::state::phase::Gyrostat;
use polhode_ga::{Bivector, Vector};

/// A second derivative larger by this factor than those beside it is that of a jump or a kink.
const SPIKE: f64 = 10.0;

/// A jump reaches this many steps.
const REACH: usize = 3;

/// Steps with smaller errors show rounding.
const LEAST_ERROR: f64 = 1e-13;

/// The mean torque and acceleration of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    /// The middle of the step, and its length, in s.
    time: f64,
    h: f64,
    torque: Bivector,
    acceleration: Vector,
}

impl Mean {
    fn of(from: &Carried, to: &Carried) -> Mean {
        let (start, end) = (from.phase.time, to.phase.time);
        let momentum = |at: &Carried| at.phase.rotor.apply_bivector(at.phase.momentum + at.driven);
        let per = 1.0 / (end - start);
        let torque = (momentum(to) - momentum(from)) * per;
        let acceleration = (to.center.velocity - from.center.velocity) * per;
        Mean { time: start + 0.5 * (end - start), h: end - start, torque, acceleration }
    }
}

/// How much a step departs from its neighbours.
#[derive(Clone, Copy, Debug, Default)]
struct Departure {
    /// The second derivative of the law, relative to the angular velocity or the velocity, in 1/s².
    bend: f64,
    /// The error of the step if the law jumps in it, relative to the same.
    error: f64,
}

/// Finds steps in which a law jumps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Jumps {
    means: [Mean; 3],
    departures: [Option<Departure>; 2 * REACH + 1],
    /// Steps since the last stop.
    count: usize,
}

impl Jumps {
    /// Takes a step. Returns the error by a jump that it shows in an earlier one, relative to the largest angular velocity
    /// or velocity so far.
    pub fn take(&mut self, from: &Carried, to: &Carried, body: &Gyrostat, largest: [f64; 2]) -> f64 {
        self.means = [self.means[1], self.means[2], Mean::of(from, to)];
        self.count += 1;
        if self.count < self.means.len() {
            return 0.0;
        }
        let departure = self.departure(body, to, largest);
        self.push(Some(departure))
    }

    /// Ends a row of steps at a stop, where laws may jump. Returns the errors by jumps in its last steps.
    pub fn end(&mut self) -> f64 {
        let rest = (0..REACH).map(|_| self.push(None)).sum();
        *self = Jumps::default();
        rest
    }

    /// The departure of the middle one of three steps from the mean of the others.
    fn departure(&self, body: &Gyrostat, to: &Carried, [fastest, swiftest]: [f64; 2]) -> Departure {
        let [a, b, c] = &self.means;
        let part = (b.time - a.time) / (c.time - a.time);
        let torque = b.torque - (a.torque + (c.torque - a.torque) * part);
        let torque = to.phase.rotor.reverse().apply_bivector(torque);
        let turning = Bivector([0, 1, 2].map(|k| torque.0[k] / body.moments[k])).norm() / fastest;
        let linear = b.acceleration - (a.acceleration + (c.acceleration - a.acceleration) * part);
        let linear = if swiftest > 0.0 { linear.norm() / swiftest } else { 0.0 };
        let size = turning.max(linear);
        let spans = ((b.time - a.time) * (c.time - b.time)).abs();
        Departure { bend: size / spans, error: size * b.h.abs() }
    }

    /// Takes the next departure. Returns the error of the one in the middle if it is that of a jump.
    fn push(&mut self, departure: Option<Departure>) -> f64 {
        self.departures.rotate_left(1);
        self.departures[2 * REACH] = departure;
        let [before, middle, after] = [0, REACH, 2 * REACH].map(|k| self.departures[k]);
        // The first steps may be those of a fast decay.
        let (Some(Departure { bend, error }), Some(_)) = (middle, before) else { return 0.0 };
        let is_jump = [before, after].iter().flatten().all(|other| bend > SPIKE * other.bend);
        if is_jump && error > LEAST_ERROR { error } else { 0.0 }
    }
}
