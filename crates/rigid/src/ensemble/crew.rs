//! What the threads that work on an ensemble share: the bodies that nobody has taken yet, and what is told of the
//! others.

use super::Ensemble;
use super::output::Outputs;
use crate::run::output::Own;
use crate::error::SimulateError;
use crate::run::closed_form::{ClosedForm, Fall};
use crate::laws::force::Force;
use crate::laws::torque::{Torque, wheel};
use crate::methods::Method;
use crate::methods::runge_kutta::DOP853;
use crate::methods::splitting::Sequence;
use crate::methods::splitting::turns::Kind;
use crate::run::certificate::Certificate;
use crate::run::limits::{Course, Samples, samples};
use crate::run::{Options, Progress, check_body};
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Rotor, Vector};
use std::borrow::Cow;
use std::iter::Enumerate;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, OnceLock, PoisonError};

/// Bodies side by side: two registers of the widest machines, so that each waits for the other's results.
pub(super) const SIDE_BY_SIDE: usize = 16;

/// The method that the bodies are stepped by.
pub(super) const METHOD: Method = Method::RungeKutta(&DOP853);

/// Parts of a body's way, for the count of what is done.
const PARTS: f64 = 1024.0;

/// A body that is stepped in lanes, in principal axes.
#[derive(Debug)]
pub(super) struct Member<'a> {
    pub body: usize,
    /// From principal axes to those of the body.
    pub frame: Rotor,
    pub gyrostat: Gyrostat,
    pub torques: Vec<Torque>,
    /// At the start, rad/s.
    pub omega: Bivector,
    pub start: Phase,
    /// What bounds its own steps.
    pub course: Course,
    pub own: Own<'a>,
}

/// How a body is followed without a step.
enum Way {
    /// In the lanes.
    Lanes,
    /// It is free: known at all times.
    Free,
    /// As a single one.
    Alone,
}

/// What is told of a body.
pub(super) struct Told {
    pub body: usize,
    pub certificate: Certificate,
    pub failure: Option<(f64, SimulateError)>,
}

/// How bodies are stepped side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plan {
    /// In s.
    pub start: f64,
    /// In s.
    pub step: f64,
    pub method: Method,
    /// About which axes a splitting turns them.
    kind: Option<Kind>,
}

impl Plan {
    /// Evaluations of the torque in a step.
    pub fn evaluations(&self) -> u64 {
        match self.method {
            Method::Splitting(sequence) => sequence.stages().0.len() as u64 + 1,
            _ => 4,
        }
    }
}

type Queue<'a> = Enumerate<Box<dyn Iterator<Item = Own<'a>> + Send + 'a>>;

/// All that threads share.
pub(super) struct Crew<'a> {
    pub ensemble: &'a Ensemble,
    pub times: &'a [f64],
    pub options: &'a Options,
    queue: Mutex<Queue<'a>>,
    pub(super) told: Mutex<Vec<Told>>,
    pub(super) stopped: AtomicBool,
    /// In parts of bodies.
    done: AtomicU64,
    /// How many threads are at work; told where one ends.
    pub(super) running: Mutex<usize>,
    pub(super) ended: Condvar,
    /// The laws in principal axes, where all bodies share them and an inertia.
    shared: Option<Vec<Torque>>,
    /// Those along time, where all bodies start at one time too.
    samples: Option<OnceLock<Samples>>,
}

pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<'a> Crew<'a> {
    pub fn new(
        ensemble: &'a Ensemble,
        times: &'a [f64],
        options: &'a Options,
        outputs: Outputs<'a>,
    ) -> Crew<'a> {
        let each: Box<dyn Iterator<Item = Own<'a>> + Send + 'a> = Box::new(outputs.each(times.len().max(1)));
        let alike = ensemble.inertias.is_one() && ensemble.laws.iter().all(|law| law.is_one());
        let one_clock = ensemble.starts.iter().all(|start| start.time == ensemble.starts[0].time);
        let frame = ensemble.inertias.of(0).principal_frame();
        let turned = || ensemble.laws.iter().map(|law| law.of(0).clone().in_axes(frame)).collect();
        Crew {
            ensemble,
            times,
            options,
            queue: Mutex::new(each.enumerate()),
            told: Mutex::new(Vec::with_capacity(ensemble.starts.len())),
            stopped: AtomicBool::new(false),
            done: AtomicU64::new(0),
            running: Mutex::new(0),
            ended: Condvar::new(),
            shared: alike.then(turned),
            samples: (alike && one_clock).then(OnceLock::new),
        }
    }

    /// A body that nobody has taken yet, with the room for its points.
    pub fn take(&self) -> Option<(usize, Own<'a>)> {
        if self.stopped.load(Ordering::Relaxed) { None } else { lock(&self.queue).next() }
    }

    /// The next body for steps of its own in the lanes. Those before it that are not for them are followed at once.
    pub fn next(&self, progress: &mut dyn FnMut(Progress) -> bool) -> Option<Member<'a>> {
        let method = self.options.method.unwrap_or(METHOD);
        let adapts = method == METHOD && self.ensemble.in_lanes(false);
        while let Some((body, own)) = self.take() {
            if !adapts {
                self.alone(body, own, progress);
                continue;
            }
            let mut member = self.member(body, own);
            match self.way(&member) {
                Way::Lanes => {
                    member.course = self.course(&member);
                    return Some(member);
                }
                Way::Free => {
                    self.free(member);
                    self.report(progress);
                }
                Way::Alone => self.alone(body, member.own, progress),
            }
        }
        None
    }

    /// How a body is stepped by equal steps in lanes, if it is.
    pub fn plan(&self, body: usize, step: f64) -> Option<Plan> {
        if !self.ensemble.in_lanes(true) {
            return None;
        }
        let method = self.options.method.unwrap_or_else(|| self.ensemble.problem(body).best());
        let kind = match method {
            Method::Classical => None,
            Method::Splitting(sequence) => {
                let torques = self.torques(body);
                let moments = self.ensemble.inertias.of(body).principal_moments();
                let gyrostat = Gyrostat { moments, wheel: wheel(&torques) };
                let kind = Kind::of(&gyrostat);
                let exact_drift = matches!(sequence, Sequence::Nystrom(_)) && !kind.is_symmetric();
                if exact_drift || method.unfit(&gyrostat, &torques).is_some() {
                    return None;
                }
                Some(kind)
            }
            _ => return None,
        };
        Some(Plan { start: self.ensemble.starts[body].time, step, method, kind })
    }

    /// How a body is followed without a step.
    fn way(&self, member: &Member) -> Way {
        let Member { gyrostat, torques, start, omega, .. } = member;
        let chosen = self.options.method.is_some() && !self.options.exact;
        if check_body(gyrostat, *omega, torques).is_err() {
            // What is wrong is told as for a single body.
            Way::Alone
        } else if chosen {
            Way::Lanes
        } else if torques.is_empty() {
            Way::Free
        } else {
            let (center, acceleration) = (Center::default(), Vector::default());
            let fall = Fall { time: start.time, start: center, acceleration };
            let closed = ClosedForm::of(*gyrostat, start.rotor, *omega, torques, fall);
            if closed.is_some() || self.options.exact { Way::Alone } else { Way::Lanes }
        }
    }

    /// The laws of a body in principal axes.
    fn torques(&self, body: usize) -> Cow<'_, [Torque]> {
        if let Some(shared) = &self.shared {
            return shared.into();
        }
        let frame = self.ensemble.inertias.of(body).principal_frame();
        self.ensemble.laws.iter().map(|law| law.of(body).clone().in_axes(frame)).collect()
    }

    pub fn member(&self, body: usize, own: Own<'a>) -> Member<'a> {
        let (inertia, start) = (self.ensemble.inertias.of(body), &self.ensemble.starts[body]);
        let frame = inertia.principal_frame();
        let torques = self.torques(body).into_owned();
        let gyrostat = Gyrostat { moments: inertia.principal_moments(), wheel: wheel(&torques) };
        let omega = frame.reverse().apply_bivector(start.omega);
        let (rotor, momentum) = (start.rotor * frame, gyrostat.momentum(omega));
        let start = Phase { rotor, momentum, time: start.time };
        Member { body, frame, gyrostat, torques, omega, start, course: Course::default(), own }
    }

    /// What bounds the steps of a body. Laws in lanes are not functions of the caller: sampling them does not fail.
    fn course(&self, member: &Member) -> Course {
        let Member { gyrostat, torques, start, .. } = member;
        let sample = || samples(torques, gyrostat, start, self.times, self.options).unwrap_or_default();
        let own;
        // They depend on the law alone, which the bodies may share.
        let samples = match &self.samples {
            Some(shared) => shared.get_or_init(sample),
            None => {
                own = sample();
                &own
            }
        };
        Course::new(torques, samples, gyrostat, start, self.options)
    }

    /// Follows a body alone.
    pub fn alone(&self, body: usize, mut own: Own<'a>, progress: &mut dyn FnMut(Progress) -> bool) {
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
                self.tell([Told { body, certificate: motion.certificate, failure: None }]);
            }
            Err(error) => self.fail(body, &mut own, "", error),
        }
    }

    /// Tells that a body could not be followed by a method; nothing is known of it.
    pub fn fail(&self, body: usize, own: &mut Own<'a>, method: &'static str, error: SimulateError) {
        (0..self.times.len()).for_each(|index| own.unknown(index));
        let time = error.time().unwrap_or(self.ensemble.starts[body].time);
        let certificate = Certificate { method, ..Certificate::default() };
        self.tell([Told { body, certificate, failure: Some((time, error)) }]);
    }

    /// Where the centre of mass of a body that only constant forces move is at a time.
    pub fn center(&self, body: usize, time: f64) -> Center {
        let (start, mass) = (&self.ensemble.starts[body], *self.ensemble.masses.of(body));
        let force = self.ensemble.forces.iter().fold(Vector::default(), |sum, force| match force {
            Force::Constant(force) => sum + *force,
            _ => sum,
        });
        let acceleration = if self.ensemble.forces.is_empty() { Vector::default() } else { force / mass };
        Fall { time: start.time, start: start.center, acceleration }.at(time)
    }

    pub fn tell(&self, told: impl IntoIterator<Item = Told>) {
        lock(&self.told).extend(told);
    }

    /// Counts so many bodies as done to this fraction; `so_far` are the parts that were counted of each before.
    pub fn count(&self, so_far: &mut u64, fraction: f64, bodies: usize) {
        let parts = (fraction * PARTS) as u64;
        self.done.fetch_add(parts.saturating_sub(*so_far) * bodies as u64, Ordering::Relaxed);
        *so_far = parts.max(*so_far);
    }

    /// Tells how much is done; whether to go on.
    pub fn report(&self, progress: &mut dyn FnMut(Progress) -> bool) -> bool {
        let whole = PARTS * self.ensemble.starts.len() as f64;
        let fraction = (self.done.load(Ordering::Relaxed) as f64 / whole).min(1.0);
        if !progress(Progress { pass: 1, fraction }) {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.stopped.load(Ordering::Relaxed)
    }
}
