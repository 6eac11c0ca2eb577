//! Integrator: one sweep over the output times, by fixed or adaptive steps, with events.

mod events;
mod jumps;

use super::center::CenterMotion;
use super::certificate::DriftMonitor;
use super::engine::Engine;
use super::limits::{StepBounds, span};
use super::noise::Noise;
use crate::error::SimulateError;
use crate::laws::conserved::Conserved;
use crate::laws::event::{Event, Occurrence};
use crate::methods::step_control::{ROOT, StepController, next_stop, step_count};
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::Gyrostat;

pub(crate) use events::check_pieces;
use jumps::Jumps;

/// The fraction of the work done at a time.
type Done<'a> = &'a mut dyn FnMut(f64) -> f64;

/// Steps between calls of `progress`.
const STEPS_BETWEEN_CALLS: u64 = 256;

/// Progress of a run: the sweep, and the fraction of it done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Number of the sweep, from 1.
    pub pass: u32,
    /// From 0 to 1.
    pub fraction: f64,
}

/// How step sizes are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StepRule {
    /// Equal steps of at most this length in s between stops.
    Step(EqualSteps),
    /// Steps with an estimated error of at most a tolerance.
    Tolerance(ToleranceSteps),
}

/// Steps with an estimated error of at most a tolerance, with that of the first sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ToleranceSteps {
    pub tolerance: f64,
    first: f64,
}

/// Below this, the error estimate of a step is rounding.
pub(crate) const LEAST_TOLERANCE: f64 = 1e-16;

impl ToleranceSteps {
    /// Steps shorter by a factor.
    pub fn refined(self, by: f64) -> ToleranceSteps {
        ToleranceSteps { tolerance: (self.tolerance / by.powi(8)).max(LEAST_TOLERANCE), ..self }
    }

    /// The longest steps on the way to the first stop and to later ones, as fractions of the way.
    ///
    /// Steps shorten with the tolerance, also those that it does not limit: the first, those to the first stop, and under laws
    /// that are not smooth those to any stop. Two sweeps with the same steps there would also share their errors, which their
    /// difference would not show.
    fn fractions(self, is_smooth: bool) -> [f64; 2] {
        let shorter = (self.tolerance / self.first).powf(ROOT);
        [shorter, if is_smooth { 1.0 } else { shorter }]
    }
}

/// Equal steps, with those of the first sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EqualSteps {
    /// The longest, in s.
    pub step: f64,
    /// That of the first sweep.
    first: f64,
    /// Number of parts into which a step between close stops is divided since then.
    parts: f64,
}

/// A segment of fewer steps than this in the first sweep is refined by whole divisors: with fractions it might keep its
/// steps, and sweeps with the same steps do not reveal the error.
const FEW: f64 = 4.0;

impl EqualSteps {
    /// Steps shorter by a factor.
    pub fn refined(self, by: f64) -> EqualSteps {
        EqualSteps { step: self.step / by, parts: (self.parts * by).ceil(), ..self }
    }

    /// Number of steps between stops a distance `span` apart, in s.
    fn count(&self, span: f64) -> f64 {
        let first = step_count(span, self.first);
        if first < FEW { first * self.parts } else { step_count(span, self.step) }
    }
}

impl StepRule {
    /// The controller of a sweep with adaptive steps, with the fastest rate of the laws and the body in rad/s.
    pub fn controller(self, rate: f64, bounds: &StepBounds) -> StepController {
        let (tolerance, fractions) = match self {
            StepRule::Step(_) => (f64::INFINITY, [1.0; 2]),
            StepRule::Tolerance(steps) => (steps.tolerance, steps.fractions(bounds.is_smooth())),
        };
        StepController::new(tolerance, rate, bounds.longest, fractions)
    }

    /// Steps with an estimated error of at most this, in the first sweep.
    pub fn adapted(tolerance: f64) -> StepRule {
        StepRule::Tolerance(ToleranceSteps { tolerance, first: tolerance })
    }

    /// Equal steps of at most this length in s.
    pub fn equal(step: f64) -> StepRule {
        StepRule::Step(EqualSteps { step, first: step, parts: 1.0 })
    }
}

/// The result of one integration over all output times.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sweep {
    pub states: Vec<Carried>,
    /// The events, in the order of integration.
    pub events: Vec<Occurrence>,
    /// Number of sides of the start on which an event ended the motion.
    pub ends: u32,
    /// Each conserved quantity with its value at the start and its largest relative change.
    pub drifts: Vec<(Conserved, f64, f64)>,
    /// The largest angular velocity (rad/s), at least its scale, distance (m) and velocity (m/s).
    pub largest: [f64; 3],
    /// The sum of the error estimates of all steps, for methods with estimates.
    pub errors: f64,
    /// That of the steps that a stop has cut short.
    pub errors_of_cut_steps: f64,
    /// The sum of bounds of the errors of steps in which a law jumps.
    pub errors_of_jumps: f64,
    /// The longest step.
    pub longest: f64,
    pub steps: u64,
    /// Number of pieces of steps in which events of a centre of mass in closed form were sought.
    pub pieces: u64,
    pub evaluations: u64,
}

impl Sweep {
    /// Adds the error estimate of the step that this controller has just accepted.
    pub fn add_error(&mut self, error: f64, controller: &StepController) {
        self.errors += error;
        self.errors_of_jumps += controller.error_of_jump();
        if controller.is_cut() {
            self.errors_of_cut_steps += error;
        }
    }

    /// Updates the largest magnitudes with a point of the motion.
    pub fn update_largest(&mut self, omega: f64, center: &Center) {
        let sizes = [omega, center.position.norm(), center.velocity.norm()];
        self.largest = [0, 1, 2].map(|k| self.largest[k].max(sizes[k]));
    }
}

/// Integrates one body over one sweep.
pub(crate) struct Integrator<'a> {
    pub body: Gyrostat,
    pub engine: &'a Engine,
    pub monitor: DriftMonitor<'a>,
    pub rule: StepRule,
    /// The fastest rate of the laws and the body at the start, in rad/s.
    pub rate: f64,
    /// Lower bound of the scale of angular velocities, in rad/s.
    pub least_rate: f64,
    /// Noise added to the points after each step.
    pub noise: Option<Noise>,
    pub bounds: &'a StepBounds,
    pub events: &'a [Event],
    /// The motion of the centre of mass, where it has a closed form.
    pub center: Option<CenterMotion>,
    /// Whether the errors of equal steps in which a law jumps are added up.
    pub watches_jumps: bool,
    /// The start of the motion, in s.
    pub origin: f64,
    /// In kg; NaN where unknown.
    pub mass: f64,
    pub number: u32,
    pub progress: &'a mut dyn FnMut(Progress) -> bool,
}

/// The state of integration in one direction of time.
struct Cursor {
    at: Carried,
    /// Of adaptive steps.
    controller: StepController,
    /// The largest angular velocity so far, in rad/s.
    fastest: f64,
    /// The quantities of the events at this point.
    values: Vec<f64>,
    /// Of equal steps.
    jumps: Jumps,
    /// Whether an event has ended the motion.
    ended: bool,
}

impl Integrator<'_> {
    /// The states at all times, which must not decrease. Times on either side of the start are reached from there; those
    /// beyond an event that ends the motion are left out.
    pub fn sweep(mut self, start: Carried, times: &[f64]) -> Result<Sweep, SimulateError> {
        let origin = start.phase.time;
        let [begin, end] = span(times, origin);
        let total = end - begin;
        if let StepRule::Step(EqualSteps { step, parts, .. }) = self.rule {
            let stops = (times.len() + self.bounds.breaks.len()) as f64;
            let steps = total / step + parts * stops;
            let limit = self.bounds.limit.steps;
            if steps > limit {
                return Err(SimulateError::TooManySteps { steps, step, limit });
            }
        }
        let mut sweep = Sweep::default();
        let (early, late) = times.split_at(times.partition_point(|&t| t < origin));
        let part = |time: f64| (time - origin).abs() / total.max(f64::MIN_POSITIVE);
        let mut states = self.side(start, early.iter().rev(), &mut sweep, &mut |time| part(time))?;
        states.reverse();
        let before = part(begin);
        states.extend(self.side(start, late.iter(), &mut sweep, &mut |time| before + part(time))?);
        sweep.states = states;
        sweep.drifts = self.monitor.finish();
        Ok(sweep)
    }

    /// The states at times on one side of the start.
    fn side<'t>(
        &mut self,
        start: Carried,
        times: impl Iterator<Item = &'t f64>,
        sweep: &mut Sweep,
        done: Done,
    ) -> Result<Vec<Carried>, SimulateError> {
        let fastest = self.body.omega(start.phase.momentum).norm().max(self.least_rate);
        sweep.update_largest(fastest, &start.center);
        let mut times = times.peekable();
        if times.peek().is_none() {
            return Ok(Vec::new());
        }
        let values = self.values(&start)?;
        let mut cursor = Cursor {
            at: start,
            controller: self.rule.controller(self.rate, self.bounds),
            fastest,
            values,
            jumps: Jumps::default(),
            ended: false,
        };
        let mut states = Vec::new();
        for &time in times {
            self.advance_to(&mut cursor, time, sweep, done)?;
            if !cursor.ended || cursor.at.phase.time == time {
                states.push(cursor.at);
            }
            if cursor.ended {
                sweep.ends += 1;
                break;
            }
        }
        sweep.errors_of_jumps += cursor.jumps.end();
        Ok(states)
    }

    /// Integrates to a time, with a stop wherever a law is not smooth.
    fn advance_to(
        &mut self,
        cursor: &mut Cursor,
        time: f64,
        sweep: &mut Sweep,
        done: Done,
    ) -> Result<(), SimulateError> {
        loop {
            let to = next_stop(&self.bounds.breaks, cursor.at.phase.time, time);
            match self.rule {
                StepRule::Step(steps) => self.equal_steps(cursor, to, steps, sweep, done)?,
                StepRule::Tolerance(_) => {
                    cursor.controller.head_for(cursor.at.phase.time, to);
                    self.adapted_steps(cursor, to, sweep, done)?;
                }
            }
            if to == time || cursor.ended {
                return Ok(());
            }
            sweep.errors_of_jumps += cursor.jumps.end();
        }
    }

    fn equal_steps(
        &mut self,
        cursor: &mut Cursor,
        time: f64,
        steps: EqualSteps,
        sweep: &mut Sweep,
        done: Done,
    ) -> Result<(), SimulateError> {
        let (from, span) = (cursor.at.phase.time, time - cursor.at.phase.time);
        let count = steps.count(span.abs());
        if span == 0.0 {
            return Ok(());
        }
        sweep.longest = sweep.longest.max(span.abs() / count);
        for i in 0..count as u64 {
            let last = i + 1 == count as u64;
            let to = if last { time } else { from + span * ((i + 1) as f64 / count) };
            // Differences of rounded times add up to the time.
            let (next, _) = self.step(&cursor.at, to, cursor.fastest, sweep)?;
            if self.watches_jumps {
                // A centre of mass in closed form has no errors of steps.
                let swiftest = if self.center.is_some() { 0.0 } else { sweep.largest[2] };
                let largest = [cursor.fastest, swiftest];
                sweep.errors_of_jumps += cursor.jumps.take(&cursor.at, &next, &self.body, largest);
            }
            self.arrive(cursor, next, sweep, done)?;
            if cursor.ended {
                break;
            }
        }
        Ok(())
    }

    fn adapted_steps(
        &mut self,
        cursor: &mut Cursor,
        time: f64,
        sweep: &mut Sweep,
        done: Done,
    ) -> Result<(), SimulateError> {
        let mut undefined = None;
        while cursor.at.phase.time != time && !cursor.ended {
            let from = cursor.at.phase.time;
            let to = cursor.controller.end(from, time).map_err(|error| undefined.take().unwrap_or(error))?;
            let (next, error) = match self.step(&cursor.at, to, cursor.fastest, sweep) {
                // A step that is too long may lead out of the domain of a law.
                Err(error @ SimulateError::Undefined { time, .. }) if time != from => {
                    undefined = Some(error);
                    (cursor.at, f64::NAN)
                }
                step => step?,
            };
            if cursor.controller.judge(to - from, error) {
                undefined = None;
                sweep.longest = sweep.longest.max((to - from).abs());
                sweep.add_error(error, &cursor.controller);
                self.arrive(cursor, next, sweep, done)?;
                let turn = self.body.omega(next.phase.momentum).norm() * (to - from);
                self.bounds.limit.check(sweep.steps, to - from, turn, || done(to))?;
            }
        }
        Ok(())
    }

    /// One step to a time.
    fn step(
        &self,
        at: &Carried,
        time: f64,
        fastest: f64,
        sweep: &mut Sweep,
    ) -> Result<(Carried, f64), SimulateError> {
        sweep.evaluations += self.engine.evaluations();
        let (mut next, error) = self.engine.step(at, time - at.phase.time, fastest)?;
        next.phase.time = time;
        if let Some(center) = &self.center {
            next.center = center.at(time);
        }
        Ok((next, error))
    }

    /// Completes an accepted step, up to an event that ends the motion.
    fn arrive(
        &mut self,
        cursor: &mut Cursor,
        mut next: Carried,
        sweep: &mut Sweep,
        done: Done,
    ) -> Result<(), SimulateError> {
        sweep.steps += 1;
        let time = next.phase.time;
        if !is_finite(&next) {
            return Err(SimulateError::Diverged { time });
        }
        if !self.events.is_empty() {
            next = self.find_events(cursor, next, sweep, done)?;
        }
        self.monitor.record(&next.phase);
        cursor.fastest = cursor.fastest.max(self.body.omega(next.phase.momentum).norm());
        cursor.at = match &mut self.noise {
            Some(noise) => noise.perturb(&next),
            None => next,
        };
        sweep.update_largest(cursor.fastest, &cursor.at.center);
        if sweep.steps.is_multiple_of(STEPS_BETWEEN_CALLS) {
            let fraction = done(time).min(1.0);
            if !(self.progress)(Progress { pass: self.number, fraction }) {
                return Err(SimulateError::Interrupted);
            }
        }
        Ok(())
    }
}

pub(crate) fn is_finite(at: &Carried) -> bool {
    let mut turning = at.phase.momentum.0.into_iter().chain(at.phase.rotor.components());
    turning.all(f64::is_finite) && at.center.is_finite()
}
