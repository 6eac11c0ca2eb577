//! Many bodies at once: each as alone, many side by side in lanes.
//!
//! A body has its own inertia, start and laws, or shares them with the others. What becomes of one never depends on the
//! others, on how many there are, or on how many threads share them. Without a step and a method, a
//! motion in closed form is known at any time, and others are stepped by `dop853`, each by its own steps to its own
//! tolerance: in the lanes, where the drifts of what is conserved are looked at at the output times. What the lanes have
//! no form for is followed one by one. A body that fails is told, and the others go on.

mod adaptive;
mod advance;
mod body_run;
mod exact;
mod fixed;
mod laws;
mod member;
mod output;
mod scheduler;
mod steppers;

use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::run::limits::span;
use crate::run::{NO_CLOSED_FORM, Options, Problem, Progress, check_start_time};
use crate::state::center::Center;
use crate::state::checks::check_moments;
pub use output::{Outputs, Summary};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use scheduler::Scheduler;

/// One value for all bodies, or one for each.
#[derive(Clone, Debug)]
pub struct Rows<T>(Vec<T>);

impl<T> Rows<T> {
    /// One at least.
    ///
    /// # Panics
    /// If there is none.
    pub fn new(rows: Vec<T>) -> Rows<T> {
        assert!(!rows.is_empty(), "one for all, or one for each");
        Rows(rows)
    }

    /// That of a body.
    pub fn of(&self, body: usize) -> &T {
        &self.0[if self.is_one() { 0 } else { body }]
    }

    /// Whether all share one.
    pub fn is_one(&self) -> bool {
        self.0.len() == 1
    }

    /// All of them.
    pub fn all(&self) -> &[T] {
        &self.0
    }
}

/// How a body starts.
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

/// Bodies, their starts and what acts on them. Vectors of a body are in body axes.
#[derive(Clone, Debug)]
pub struct Ensemble {
    /// About the centres of mass, or about fixed points.
    pub inertias: Rows<Inertia>,
    /// One for each body.
    pub starts: Vec<Start>,
    /// Laws that add up.
    pub laws: Vec<Rows<Torque>>,
    /// In kg; NaN where nobody said it.
    pub masses: Rows<f64>,
    /// What moves the centres of mass.
    pub forces: Vec<Force>,
}

/// A body that could not be followed to the end.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Its number.
    pub body: usize,
    /// Up to where it was followed, in s.
    pub time: f64,
    /// Why no further.
    pub error: SimulateError,
}

impl Ensemble {
    /// A body with its laws, to be followed alone.
    pub fn problem(&self, body: usize) -> Problem {
        let start = &self.starts[body];
        let laws: Vec<Torque> = self.laws.iter().map(|law| law.of(body).clone()).collect();
        Problem::new(self.inertias.of(body), start.rotor, start.omega, &laws)
            .with_center(start.center, *self.masses.of(body), &self.forces)
            .starting_at(start.time)
    }

    /// Follows all bodies to the times (s, not decreasing; those before a body's start are reached backwards), with
    /// options as for one body, by so many threads. `progress` is asked now and then by the calling thread; at false all
    /// ends with [`SimulateError::Interrupted`]. An error for what none of the bodies could be followed with.
    ///
    /// # Panics
    /// If numbers of rows do not fit together.
    pub fn run(
        &self,
        times: &[f64],
        options: &Options,
        threads: Threads,
        outputs: Outputs,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Summary, SimulateError> {
        self.check(times, options)?;
        let rows = [self.inertias.0.len(), self.masses.0.len()];
        let rows = rows.into_iter().chain(self.laws.iter().map(|law| law.0.len()));
        assert!(rows.into_iter().all(|n| n == 1 || n == self.starts.len()), "one for all, or one for each");
        Scheduler::new(self, times, options, outputs).work(threads, progress)
    }

    /// What is wrong for all bodies alike.
    fn check(&self, times: &[f64], options: &Options) -> Result<(), SimulateError> {
        options.check(times)?;
        self.starts.iter().try_for_each(|start| check_start_time(start.time))?;
        let Some(step) = options.step else { return Ok(()) };
        if options.exact {
            return Err(SimulateError::Unfit { method: "exact", reason: NO_CLOSED_FORM });
        }
        let span = self.starts.iter().map(|start| span(times, start.time)).map(|[a, b]| b - a);
        let span = span.fold(0.0, f64::max);
        let steps = span / step + times.len() as f64;
        let limit = options.most_steps();
        if steps > limit {
            return Err(SimulateError::TooManySteps { steps, step, limit });
        }
        Ok(())
    }

    /// A body whose number comes with what is wrong with it, before anything is computed.
    pub fn first_unusable(&self) -> Option<(usize, SimulateError)> {
        (0..self.starts.len()).find_map(|body| {
            let inertia = self.inertias.of(body);
            let moments = inertia.principal_moments();
            check_moments(moments).err().map(|error| (body, error))
        })
    }

    /// Whether lanes can step these bodies, by equal steps or by steps of their own: only constant forces move them.
    fn in_lanes(&self, equal: bool) -> bool {
        // Laws are of one kind for all bodies, so that one of them tells; to ask them all would take, body by body, the
        // square of their number. A table of its own gives each body its own steps.
        let apart = |law: &Rows<Torque>| equal && !law.is_one() && !law.of(0).breaks().is_empty();
        // A function is called for one body at a time.
        let called = |law: &Rows<Torque>| !equal && matches!(law.of(0), Torque::Function(_));
        let moved = self.forces.iter().any(|force| !matches!(force, Force::Constant(_)));
        !moved && !self.laws.iter().any(|law| apart(law) || called(law))
    }
}
