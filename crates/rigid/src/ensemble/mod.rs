//! Ensembles: many bodies, integrated in SIMD lanes and threads.
//!
//! A body has its own inertia, start and laws, or shares them with the others. Its result never depends on the others,
//! on their number, or on the number of threads. Without a step and a method, motions in closed form are evaluated, and
//! others are integrated by `dop853` with steps of their own: in lanes, where drifts of conserved quantities are measured
//! at the output times. Bodies that lanes do not support are solved one by one. A body that fails does not stop the others.

mod adaptive;
pub mod bins;
mod body_run;
mod checks;
mod columns;
mod exact;
mod fixed;
mod free;
pub(crate) mod laws;
mod member;
mod monitor;
mod observe;
mod output;
mod recorder;
pub mod reduce;
mod scheduler;
mod steppers;
mod workers;

use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::run::limits::span;
use crate::run::{NO_CLOSED_FORM, Options, Problem, Progress, check_start_time};
use crate::state::center::Center;
use crate::state::checks::check_moments;
pub use output::{Drift, Outputs, Summary};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use scheduler::{Scheduler, Shared};

/// One value for all bodies, or one for each.
#[derive(Clone, Debug)]
pub struct Rows<T>(Vec<T>);

impl<T> Rows<T> {
    /// At least one row.
    ///
    /// # Panics
    /// If there are no rows.
    pub fn new(rows: Vec<T>) -> Rows<T> {
        assert!(!rows.is_empty(), "one for all, or one for each");
        Rows(rows)
    }

    /// The value of a body.
    pub fn of(&self, body: usize) -> &T {
        &self.0[if self.is_one() { 0 } else { body }]
    }

    /// Whether all bodies share one value.
    pub fn is_one(&self) -> bool {
        self.0.len() == 1
    }

    /// All rows.
    pub fn all(&self) -> &[T] {
        &self.0
    }
}

/// The start of a body.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// In s.
    pub time: f64,
    /// From body axes to space.
    pub rotor: Rotor,
    /// In body axes, rad/s.
    pub omega: Bivector,
    /// The centre of mass in space.
    pub center: Center,
}

/// Bodies, their starts, torques and forces. Vectors of a body are in body axes.
#[derive(Clone, Debug)]
pub struct Ensemble {
    /// About the centres of mass, or about fixed points.
    pub inertias: Rows<Inertia>,
    /// One for each body.
    pub starts: Vec<Start>,
    /// Torque laws, which add up.
    pub laws: Vec<Rows<Torque>>,
    /// In kg; NaN where unknown.
    pub masses: Rows<f64>,
    /// Forces on the centres of mass.
    pub forces: Vec<Rows<Force>>,
}

/// A body whose motion could not be computed to the end.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Its number.
    pub body: usize,
    /// Time up to which it was computed, in s.
    pub time: f64,
    /// The error.
    pub error: SimulateError,
}

impl Ensemble {
    /// The problem of one body.
    pub fn problem(&self, body: usize) -> Problem {
        let start = &self.starts[body];
        let laws: Vec<Torque> = self.laws.iter().map(|law| law.of(body).clone()).collect();
        let forces: Vec<Force> = self.forces_on(body).cloned().collect();
        Problem::new(self.inertias.of(body), start.rotor, start.omega, &laws)
            .with_center(start.center, *self.masses.of(body), &forces)
            .starting_at(start.time)
    }

    /// The forces on one body.
    pub(crate) fn forces_on(&self, body: usize) -> impl Iterator<Item = &Force> {
        self.forces.iter().map(move |force| force.of(body))
    }

    /// Computes the motions of all bodies at the times (s, not decreasing; those before a body's start are reached
    /// backwards), with options as for one body, using `threads`. The calling thread calls `progress` repeatedly; if it
    /// returns false, the run ends with [`SimulateError::Interrupted`]. Input that is invalid for all bodies is an error.
    ///
    /// # Panics
    /// If the numbers of rows do not match.
    pub fn run(
        &self,
        times: &[f64],
        options: &Options,
        threads: Threads,
        outputs: Outputs,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Summary, SimulateError> {
        options.check(times)?;
        let extremes = self.start_times()?;
        extremes.into_iter().try_for_each(|start| check_steps(times, start, options))?;
        let rows = [self.inertias.0.len(), self.masses.0.len()];
        let rows = rows.into_iter().chain(self.laws.iter().map(|law| law.0.len()));
        let rows = rows.chain(self.forces.iter().map(|force| force.0.len()));
        assert!(rows.into_iter().all(|n| n == 1 || n == self.starts.len()), "one for all, or one for each");
        let shared = self.shared_laws();
        let shared = Shared { laws: shared.as_deref(), start: extremes[0] == extremes[1] };
        Scheduler::new(self, shared, times, options, outputs, threads).work(progress)
    }

    /// The laws in principal axes, if all bodies share them and an inertia.
    fn shared_laws(&self) -> Option<Vec<Torque>> {
        let alike = self.inertias.is_one() && self.laws.iter().all(|law| law.is_one());
        let frame = self.inertias.of(0).principal_frame();
        alike.then(|| self.laws.iter().map(|law| law.of(0).clone().in_axes(frame)).collect())
    }

    /// The earliest and the latest start, in s; an error if one is not finite.
    fn start_times(&self) -> Result<[f64; 2], SimulateError> {
        let first = self.starts.first().map_or(0.0, |start| start.time);
        self.starts.iter().try_fold([first; 2], |[earliest, latest], start| {
            check_start_time(start.time)?;
            Ok([earliest.min(start.time), latest.max(start.time)])
        })
    }

    /// The first body that is invalid, by its number, and its error.
    pub fn first_unusable(&self) -> Option<(usize, SimulateError)> {
        (0..self.starts.len()).find_map(|body| {
            let inertia = self.inertias.of(body);
            let moments = inertia.principal_moments();
            check_moments(moments).err().map(|error| (body, error))
        })
    }

    /// Whether these bodies can be integrated in lanes, by equal or adaptive steps: their centres of mass must move in closed
    /// form, and torques must not depend on them or on the masses.
    fn in_lanes(&self, equal: bool) -> bool {
        // Laws are of the same kinds for all bodies, so one stands for all; checking all of them for each body would take
        // quadratic time. A table of its own gives each body its own steps.
        let apart = |law: &Rows<Torque>| equal && !law.is_one() && !law.of(0).breaks().is_empty();
        // A function is called for one body at a time.
        let called = |law: &Rows<Torque>| !equal && matches!(law.of(0), Torque::Function(_));
        let moved = self.forces.iter().any(|force| !force.of(0).is_linear());
        // Only steps of single bodies carry the momentum of wheels with motors.
        let driven = |law: &Rows<Torque>| matches!(law.of(0), Torque::Wheels(_));
        let follows = |law: &Rows<Torque>| law.of(0).reads_center() || law.of(0).reads_mass();
        !moved && !self.laws.iter().any(|law| apart(law) || called(law) || driven(law) || follows(law))
    }
}

/// Checks the number of equal steps, if they are given, of a body with this start; no other start between two needs more.
fn check_steps(times: &[f64], start: f64, options: &Options) -> Result<(), SimulateError> {
    let Some(step) = options.step else { return Ok(()) };
    if options.exact {
        return Err(SimulateError::Unfit { method: "exact", reason: NO_CLOSED_FORM });
    }
    let [begin, end] = span(times, start);
    let steps = (end - begin) / step + times.len() as f64;
    let limit = options.most_steps();
    if steps > limit { Err(SimulateError::TooManySteps { steps, step, limit }) } else { Ok(()) }
}
