//! Events within the steps of a sweep.

use super::{Cursor, Done, Integrator, Progress, Sweep};
use crate::error::{SimulateError, TorqueError};
use crate::exact::center::CenterLaw;
use crate::laws::event::{Occurrence, crossing, dip, root};
use crate::run::limits::StepBounds;
use crate::state::carried::Carried;
use crate::state::point::Point;
use std::cmp::Ordering;

/// Largest turn of the body, or of the path of its centre of mass, between evaluations of events, in rad.
const EVENT_TURN: f64 = 0.2;

/// An event this close to the start, relative to the time to the next evaluation, is at the start.
const ROUNDING_OF_START: f64 = 1e-12;

/// How far beyond a sample that is exactly zero its sign is taken, relative to the distance of samples.
const BEYOND: f64 = 1.0 / 64.0;

/// Pieces between calls of `progress`.
const PIECES_BETWEEN_CALLS: u64 = 4096;

/// An error if the oscillation of a centre of mass over a time in s needs too many pieces.
pub(crate) fn check_pieces(law: &CenterLaw, time: f64, bounds: &StepBounds) -> Result<(), SimulateError> {
    let pieces = law.oscillates(time) / (2.0 * EVENT_TURN);
    check_number(pieces, 2.0 * EVENT_TURN / law.rate_after(0.0), bounds)
}

fn check_number(steps: f64, step: f64, bounds: &StepBounds) -> Result<(), SimulateError> {
    let limit = bounds.most_pieces();
    if steps > limit { Err(SimulateError::TooManySteps { steps, step, limit }) } else { Ok(()) }
}

impl Integrator<'_> {
    /// Finds the events within a step. Returns its end, or the event that ends the motion.
    ///
    /// A point within a step is computed by a shorter step. A step may be a good part of a turn: events are evaluated at the
    /// ends and the middles of pieces of less than two [`EVENT_TURN`], and at a minimum suggested by three values in a row.
    pub(super) fn find_events(
        &mut self,
        cursor: &mut Cursor,
        next: Carried,
        sweep: &mut Sweep,
        done: Done,
    ) -> Result<Carried, SimulateError> {
        let (start, end) = (cursor.at, next.phase.time);
        let forwards = end >= start.phase.time;
        let whole = self.piece(cursor, &next);
        let mut before = (start.phase.time, std::mem::take(&mut cursor.values));
        while before.0 != end {
            let length = match self.longest_piece(before.0) {
                piece if piece < whole => {
                    sweep.pieces += 1;
                    self.count_pieces(sweep.pieces, piece, || done(before.0))?;
                    piece
                }
                _ => whole,
            };
            let after = before.0 + if forwards { length } else { -length };
            // A last piece of nearly this length is not divided.
            let is_last = (end - before.0).abs() <= length * (1.0 + 1e-9) || after == before.0;
            let after = if is_last { end } else { after };
            let middle = before.0 + 0.5 * (after - before.0);
            let middle = (middle, self.values(&self.within(&start, middle, cursor, sweep)?)?);
            let after = if is_last {
                (end, self.values(&next)?)
            } else {
                (after, self.values(&self.within(&start, after, cursor, sweep)?)?)
            };
            let mut found = Vec::new();
            for k in 0..self.events.len() {
                let samples = [&before, &middle, &after].map(|(time, values)| (*time, values[k]));
                self.crossings(k, samples, cursor, sweep, &mut found)?;
            }
            found.sort_by(|a, b| if forwards { by_time(a, b) } else { by_time(b, a) });
            for occurrence in found {
                sweep.events.push(occurrence);
                if self.events[occurrence.event].terminal {
                    cursor.ended = true;
                    return Ok(occurrence.at);
                }
            }
            before = after;
        }
        cursor.values = before.1;
        Ok(next)
    }

    /// The length in s of the equal pieces into which a step is divided for events.
    fn piece(&self, cursor: &Cursor, next: &Carried) -> f64 {
        let h = (next.phase.time - cursor.at.phase.time).abs();
        let turn = self.body.omega(next.phase.momentum).norm().max(cursor.fastest) * h;
        // How far the velocity turns, and the path leaves its tangent.
        let (a, b) = (cursor.at.center, next.center);
        let speed = a.velocity.norm().max(b.velocity.norm());
        let bend = if self.center.is_some() || speed == 0.0 {
            0.0
        } else {
            let leaves = (b.position - a.position) / (next.phase.time - cursor.at.phase.time) - a.velocity;
            (b.velocity - a.velocity).norm().max(leaves.norm()) / speed
        };
        h / (turn.max(bend) / (2.0 * EVENT_TURN)).ceil().clamp(1.0, 1e4)
    }

    /// The longest piece at a time that resolves quantities that change with time by themselves, and a motion of the centre of
    /// mass in closed form, if events depend on it. Three values resolve a parabola.
    fn longest_piece(&self, time: f64) -> f64 {
        let most = match &self.center {
            Some(center) if self.events.iter().any(|event| event.quantity.reads_center()) => {
                2.0 * EVENT_TURN / center.law.rate_after(time - center.time)
            }
            _ => f64::INFINITY,
        };
        most.min(self.bounds.piece)
    }

    /// An error if there are too many pieces, the last one of this length in s, or if the run is interrupted.
    fn count_pieces(
        &mut self,
        pieces: u64,
        length: f64,
        done: impl FnOnce() -> f64,
    ) -> Result<(), SimulateError> {
        if !pieces.is_multiple_of(PIECES_BETWEEN_CALLS) {
            return Ok(());
        }
        check_number(pieces as f64, length, self.bounds)?;
        let fraction = done().min(1.0);
        let goes_on = (self.progress)(Progress { pass: self.number, fraction });
        if goes_on { Ok(()) } else { Err(SimulateError::Interrupted) }
    }

    /// Finds the zeros of an event between three evaluations, pairs of time and value.
    fn crossings(
        &self,
        event: usize,
        samples: [(f64, f64); 3],
        cursor: &Cursor,
        sweep: &mut Sweep,
        found: &mut Vec<Occurrence>,
    ) -> Result<(), SimulateError> {
        let wanted = self.events[event].direction;
        let mut value = |time: f64| self.value(event, &self.within(&cursor.at, time, cursor, sweep)?);
        let mut samples = samples.to_vec();
        if let Some(lowest) = dip([samples[0], samples[1], samples[2]], &mut value)? {
            let between = if (lowest.0 - samples[1].0) * (samples[2].0 - samples[1].0) > 0.0 { 2 } else { 1 };
            samples.insert(between, lowest);
        }
        let mut times = Vec::new();
        for pair in samples.windows(2) {
            let ((low, at_low), (high, at_high)) = (pair[0], pair[1]);
            let Some(direction) = crossing(at_low, at_high) else { continue };
            if wanted.is_some_and(|wanted| wanted != direction) {
                continue;
            }
            // A quantity that has the same sign on the other side only touches zero. The point may lie beyond the step, and
            // beyond the times at which a function of the caller has a value.
            let mut touches = || value(high + BEYOND * (high - low)).is_ok_and(|y| y * at_low > 0.0);
            if at_high == 0.0 && touches() {
                continue;
            }
            let least = 2.0 * f64::EPSILON * low.abs().max(high.abs());
            let time = root((low, high), (at_low, at_high), least, &mut value)?;
            // Skip a zero at the start that rounding has shifted.
            let since = (time - self.origin).abs();
            let rounding = ROUNDING_OF_START * (high - low).abs() + 4.0 * f64::EPSILON * self.origin.abs();
            if cursor.at.phase.time != self.origin || since > rounding {
                times.push((direction, time));
            }
        }
        for (direction, time) in times {
            found.push(Occurrence { event, direction, at: self.within(&cursor.at, time, cursor, sweep)? });
        }
        Ok(())
    }

    /// The point at a time within the step that begins at `start`.
    fn within(
        &self,
        start: &Carried,
        time: f64,
        cursor: &Cursor,
        sweep: &mut Sweep,
    ) -> Result<Carried, SimulateError> {
        if time == start.phase.time {
            Ok(*start)
        } else {
            Ok(self.step(start, time, cursor.fastest, sweep)?.0)
        }
    }

    /// The quantities of all events at a point.
    pub(super) fn values(&self, at: &Carried) -> Result<Vec<f64>, SimulateError> {
        (0..self.events.len()).map(|k| self.value(k, at)).collect()
    }

    fn value(&self, event: usize, at: &Carried) -> Result<f64, SimulateError> {
        let point = Point { body: &self.body, mass: self.mass, phase: &at.phase, center: &at.center };
        let failed = |error: TorqueError| SimulateError::Torque {
            time: at.phase.time,
            message: format!("events[{event}]: {error}"),
        };
        self.events[event].quantity.value(&point).map_err(failed)
    }
}

fn by_time(a: &Occurrence, b: &Occurrence) -> Ordering {
    a.at.phase.time.total_cmp(&b.at.phase.time)
}
