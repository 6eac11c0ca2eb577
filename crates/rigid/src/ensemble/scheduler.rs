//! Scheduler: assigns the bodies of an ensemble to threads and collects their outcomes.

use super::Ensemble;
use super::columns::{Columns, lock};
use super::member::{METHOD, Member, Outcome, Plan, SIDE_BY_SIDE, Strategy, WIDE, Waiting};
use super::output::{Outputs, Share};
use crate::error::SimulateError;
use crate::exact::many::TIMES_IN_LANES;
use crate::laws::torque::{Torque, wheel};
use crate::methods::Method;
use crate::methods::splitting::turns::Kind;
use crate::run::center::{CenterMotion, center_law};
use crate::run::certificate::Certificate;
use crate::run::closed_form::ExactBody;
use crate::run::limits::{Samples, StepBounds, samples};
use crate::run::output::BodyOutput;
use crate::run::{Options, Progress, check_body};
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::threads::Threads;
use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, OnceLock};

/// Parts into which the progress of a body is divided.
const PARTS: f64 = 1024.0;

/// What all bodies share.
pub(super) struct Shared<'a> {
    /// The laws in principal axes, with an inertia.
    pub laws: Option<&'a [Torque]>,
    /// Whether they start at one time.
    pub start: bool,
}

/// State shared by the threads.
pub(super) struct Scheduler<'a> {
    pub ensemble: &'a Ensemble,
    pub times: &'a [f64],
    pub options: &'a Options,
    /// Number of threads, at most one for each body.
    pub(super) threads: usize,
    /// Unassigned bodies.
    queue: Mutex<Share<'a>>,
    pub(super) columns: Columns,
    pub(super) stopped: AtomicBool,
    /// In parts of bodies.
    done: AtomicU64,
    /// Number of running threads; `ended` is notified when one ends.
    pub(super) running: Mutex<usize>,
    pub(super) ended: Condvar,
    /// The laws in principal axes, if all bodies share them and an inertia.
    shared: Option<&'a [Torque]>,
    /// Their samples in time, if all bodies also start at one time.
    samples: Option<OnceLock<Samples>>,
}

impl<'a> Scheduler<'a> {
    pub fn new(
        ensemble: &'a Ensemble,
        shared: Shared<'a>,
        times: &'a [f64],
        options: &'a Options,
        outputs: Outputs<'a>,
        threads: Threads,
    ) -> Scheduler<'a> {
        let all = Share::all(outputs, times.len());
        Scheduler {
            ensemble,
            times,
            options,
            threads: threads.count().min(ensemble.starts.len()).max(1),
            columns: Columns::new(all.len()),
            queue: Mutex::new(all),
            stopped: AtomicBool::new(false),
            done: AtomicU64::new(0),
            running: Mutex::new(0),
            ended: Condvar::new(),
            shared: shared.laws,
            samples: (shared.laws.is_some() && shared.start).then(OnceLock::new),
        }
    }

    /// The next unassigned bodies: at most a number of them, or a part of the last ones, of which the others of `threads` get
    /// as many.
    pub fn next_bodies(&self, threads: usize, most: usize) -> Option<Share<'a>> {
        if self.is_stopped() {
            return None;
        }
        let mut queue = lock(&self.queue);
        let count = queue.len().div_ceil(threads.max(1)).min(most);
        if count == 0 { None } else { Some(queue.take_first(count)) }
    }

    /// The number of bodies with this plan that are integrated together.
    pub fn together(&self, plan: &Plan) -> usize {
        let wide = plan.method == Method::Classical && !self.ensemble.laws.is_empty();
        if wide { WIDE } else { SIDE_BY_SIDE }
    }

    /// The number of bodies in closed form that a thread computes together: as many as there are lanes; one if motions are
    /// long, or if some threads would have none.
    pub fn exact_together(&self) -> usize {
        let enough = self.ensemble.starts.len() >= self.threads * TOGETHER;
        if enough && self.times.len() < TIMES_IN_LANES { TOGETHER } else { 1 }
    }

    /// Whether the lanes hold this number of bodies at a time rather than the times of one.
    pub fn are_together(&self, bodies: usize) -> bool {
        bodies > 1 && bodies * self.times.len().div_ceil(TOGETHER) > self.times.len() / 2
    }

    /// Whether the run was stopped.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// The next unassigned body, with its output arrays.
    pub fn next_body(&self) -> Option<(usize, BodyOutput<'a>)> {
        if self.is_stopped() { None } else { lock(&self.queue).next() }
    }

    /// The next body for adaptive steps in lanes. Bodies before it that they do not support are solved at once, those in
    /// closed form as many at a time as there are lanes.
    pub fn next_member(&self, progress: &mut dyn FnMut(Progress) -> bool) -> Option<Member<'a>> {
        let method = self.options.method.unwrap_or(METHOD);
        let adapts = method == METHOD && self.ensemble.in_lanes(false);
        let (mut waiting, mut next) = (Waiting::default(), None);
        while let Some((body, own)) = self.next_body() {
            if !adapts {
                self.run_single(body, own, progress);
                continue;
            }
            let member = self.member(body, own);
            match self.strategy(&member) {
                Strategy::Lanes => {
                    next = Some(member);
                    break;
                }
                Strategy::Exact(body) => self.exact(&mut waiting, (member, body), progress),
                Strategy::Single => self.run_single(body, member.own, progress),
            }
        }
        self.write_exact(&mut waiting, progress);
        next
    }

    /// The plan of a body for equal steps in lanes, if they are supported.
    pub fn plan(&self, member: &Member, step: f64) -> Option<Plan> {
        let Member { gyrostat, torques, start, .. } = member;
        if !self.ensemble.in_lanes(true) || !self.knows_center(member.body) {
            return None;
        }
        let best = || Method::best(gyrostat, torques, false, start);
        let method = self.options.method.unwrap_or_else(best);
        let kind = match method {
            Method::Classical => None,
            Method::Splitting(sequence) => {
                let kind = Kind::of(gyrostat);
                let exact_drift = sequence.is_nystrom() && !kind.is_symmetric();
                if exact_drift || method.unfit(gyrostat, torques).is_some() {
                    return None;
                }
                Some(kind)
            }
            _ => return None,
        };
        Some(Plan { start: start.time, step, method, kind })
    }

    /// Solution strategy of a body without a given step.
    fn strategy(&self, member: &Member) -> Strategy {
        let Member { gyrostat, torques, start, omega, .. } = member;
        let chosen = self.options.method.is_some() && !self.options.exact;
        if !self.is_sound(member) {
            // The error is reported as for a single body.
            Strategy::Single
        } else if chosen {
            Strategy::Lanes
        } else {
            match ExactBody::of(gyrostat.moments, start.rotor, *omega, torques) {
                Some(body) => Strategy::Exact(body),
                None if !self.options.exact => Strategy::Lanes,
                None => Strategy::Single,
            }
        }
    }

    /// Whether the motion of a body is defined at all times.
    pub fn is_sound(&self, Member { body, gyrostat, torques, omega, .. }: &Member) -> bool {
        check_body(gyrostat, *omega, torques).is_ok() && self.knows_center(*body)
    }

    /// Whether the bodies turn without torques, and are solved in closed form.
    pub fn is_free(&self) -> bool {
        let exact = self.options.method.is_none_or(|method| self.options.exact && method == METHOD);
        self.ensemble.laws.is_empty() && exact && self.ensemble.in_lanes(false)
    }

    /// The laws of a body in principal axes.
    fn torques(&self, body: usize) -> Cow<'a, [Torque]> {
        if let Some(shared) = self.shared {
            return shared.into();
        }
        let frame = self.ensemble.inertias.of(body).principal_frame();
        self.ensemble.laws.iter().map(|law| law.of(body).clone().in_axes(frame)).collect()
    }

    pub fn member(&self, body: usize, own: BodyOutput<'a>) -> Member<'a> {
        let (inertia, start) = (self.ensemble.inertias.of(body), &self.ensemble.starts[body]);
        let frame = inertia.principal_frame();
        let torques = self.torques(body);
        let gyrostat = Gyrostat { moments: inertia.principal_moments(), wheel: wheel(&torques) };
        let omega = frame.reverse().apply_bivector(start.omega);
        let (rotor, momentum) = (start.rotor * frame, gyrostat.momentum(omega));
        let start = Phase { rotor, momentum, time: start.time };
        Member { body, frame, gyrostat, torques, omega, start, own }
    }

    /// Bounds of the steps of a body under its torques. Laws in lanes are not user functions, so sampling does not fail.
    pub fn bounds(&self, member: &Member, torques: &[Torque]) -> StepBounds {
        let Member { gyrostat, start, .. } = member;
        // Bodies in lanes have linear forces only, and laws that do not depend on the centre of mass.
        let at = Point::at_rest(gyrostat, start);
        let sample = || samples(torques, &[], &at, self.times, self.options, true).unwrap_or_default();
        let own;
        // They depend on the law alone, which the bodies may share.
        let samples = match &self.samples {
            Some(shared) => shared.get_or_init(sample),
            None => {
                own = sample();
                &own
            }
        };
        StepBounds::new(torques, samples, &at, self.options)
    }

    /// Solves a body alone.
    pub fn run_single(
        &self,
        body: usize,
        mut own: BodyOutput<'a>,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) {
        let problem = self.ensemble.problem(body);
        let mut so_far = 0;
        let mut go_on = |at: Progress| {
            self.count(&mut so_far, at.fraction, 1);
            self.report(progress)
        };
        let found = problem.simulate(self.times, self.options.clone(), &mut go_on);
        self.count(&mut so_far, 1.0, 1);
        match found {
            Ok(motion) => {
                motion.write(&mut own);
                self.record([Outcome { body, certificate: motion.certificate, failure: None }]);
            }
            Err(error) => self.fail(body, &mut own, "", error),
        }
    }

    /// Records that a body failed with a method, and writes NaN as its points.
    pub fn fail(&self, body: usize, own: &mut BodyOutput<'a>, method: &'static str, error: SimulateError) {
        (0..self.times.len()).for_each(|index| own.unknown(index));
        let time = error.time().unwrap_or(self.ensemble.starts[body].time);
        let certificate = Certificate { method, ..Certificate::default() };
        self.record([Outcome { body, certificate, failure: Some((time, error)) }]);
    }

    /// The motion of the centre of mass, which has a closed form in lanes.
    pub fn center(&self, body: usize) -> CenterMotion {
        let (start, mass) = (&self.ensemble.starts[body], *self.ensemble.masses.of(body));
        let law = center_law(self.ensemble.forces_on(body), mass).unwrap_or_default();
        CenterMotion { time: start.time, start: start.center, law }
    }

    /// Whether the centre of mass is known at all times; if not, the run of a single body reports the error.
    fn knows_center(&self, body: usize) -> bool {
        self.ensemble.forces.is_empty() || self.center(body).is_known_at(self.times)
    }

    pub fn record(&self, outcomes: impl IntoIterator<Item = Outcome>) {
        outcomes.into_iter().for_each(|outcome| self.columns.take(outcome));
    }

    /// Counts a number of bodies as done to this fraction; `so_far` holds the parts of each counted before.
    pub fn count(&self, so_far: &mut u64, fraction: f64, bodies: usize) {
        let parts = (fraction * PARTS) as u64;
        self.done.fetch_add(parts.saturating_sub(*so_far) * bodies as u64, Ordering::Relaxed);
        *so_far = parts.max(*so_far);
    }

    /// Calls `progress`. False if the run is to stop.
    pub fn report(&self, progress: &mut dyn FnMut(Progress) -> bool) -> bool {
        let whole = PARTS * self.ensemble.starts.len() as f64;
        let fraction = (self.done.load(Ordering::Relaxed) as f64 / whole).min(1.0);
        if !progress(Progress { pass: 1, fraction }) {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.is_stopped()
    }
}
