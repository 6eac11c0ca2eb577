//! Records of bodies that are integrated in lanes by fixed steps: states, certificates, failures and warnings.

use super::columns::Record;
use super::member::{Member, Plan};
use super::monitor::{Acted, LaneMonitor, LaneStates};
use super::observe::{LaneBodies, LanePhases};
use super::scheduler::Scheduler;
use super::steppers::Segment;
use crate::error::SimulateError;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::run::center::CenterMotion;
use crate::run::engine::Engine;
use crate::run::stops::{aliasing_warning, is_aliased, turn_warning};
use crate::run::sweep::is_finite;
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::Phase;
use crate::state::point::Point;
use std::ops::Range;

/// The bodies in lanes, with what is recorded of their motions.
pub(super) struct Recorder<'r, 'a, const W: usize> {
    pub scheduler: &'r Scheduler<'a>,
    pub plan: Plan,
    pub members: Vec<Member<'a>>,
    pub bodies: LaneBodies<W>,
    /// Whether the products of the bodies' numbers with those of a moderate state are finite.
    pub are_moderate: bool,
    acted: Acted<'r>,
    /// Of bodies that move; the others have none.
    centers: Vec<CenterMotion>,
    monitor: LaneMonitor<W>,
    /// The largest so far.
    squared_rates: [f64; W],
    norm_drifts: [f64; W],
    /// The bodies that failed on this side of the start. They are integrated on the other.
    lost: [bool; W],
    failures: [Option<(f64, SimulateError)>; W],
}

impl<'r, 'a, const W: usize> Recorder<'r, 'a, W> {
    pub fn new(
        scheduler: &'r Scheduler<'a>,
        plan: Plan,
        members: Vec<Member<'a>>,
        acted: Acted<'r>,
    ) -> Recorder<'r, 'a, W> {
        let bodies = LaneBodies::new(&members);
        let moving = if members[0].own.centers.is_some() { &members[..] } else { &[] };
        let centers = moving.iter().map(|member| scheduler.center(member.body)).collect();
        let at_start = bodies.points(LanePhases::starts(&members));
        Recorder {
            are_moderate: moderate(bodies.numbers()),
            monitor: LaneMonitor::new(&LaneStates::new(&at_start, acted, plan.start)),
            squared_rates: at_start.squared_rates(),
            norm_drifts: [0.0; W],
            lost: [false; W],
            failures: [const { None }; W],
            scheduler,
            plan,
            members,
            bodies,
            acted,
            centers,
        }
    }

    /// Begins again at the start, for the times on its other side.
    pub fn turn_back(&mut self) {
        self.lost = [false; W];
    }

    /// Finds the bodies that failed in some steps of a segment, from their states before and after these.
    #[cold]
    pub fn check(&mut self, [before, after]: [LanePhases<W>; 2], segment: &Segment, steps: Range<u64>) {
        for (l, member) in self.members.iter().enumerate() {
            let now = after.phase(l, segment.begin(steps.end));
            if !self.lost[l] && !is_finite(&Carried::new(now, Center::default())) {
                self.lost[l] = true;
                let from = before.phase(l, segment.begin(steps.start));
                let part = (segment, steps.clone());
                let failure = diagnose(self.plan.method, member, &self.acted.1[l], from, part);
                self.failures[l].get_or_insert(failure);
            }
        }
    }

    /// Records the bodies at an output time.
    pub fn record(&mut self, phases: LanePhases<W>, index: usize) {
        let time = self.scheduler.times[index];
        let points = self.bodies.points(phases);
        let states = LaneStates::new(&points, self.acted, time);
        self.monitor.record(&states, &self.lost);
        let rates = points.squared_rates();
        (0..W).for_each(|l| self.squared_rates[l] = self.squared_rates[l].max(rates[l]));
        for (l, member) in self.members.iter_mut().enumerate() {
            if self.lost[l] {
                member.own.unknown(index);
                continue;
            }
            self.norm_drifts[l] = self.norm_drifts[l].max(points.off_unit.0[l]);
            let (rotor, omega) = points.in_body(l);
            member.own.put(index, rotor, omega, points.momentum_of(l), states.energy[l]);
            if let Some(center) = self.centers.get(l) {
                member.own.place(index, &center.at(time));
            }
        }
    }

    /// Reports the certificates, failures and warnings of all bodies after a number of steps, the longest of which is given in
    /// s, over a span of time.
    pub fn finish(self, span: [f64; 2], steps: u64, longest: f64) {
        self.warn(span, longest);
        let columns = &self.scheduler.columns;
        let (method, evaluations) =
            (columns.method(self.plan.method.name()), steps * self.plan.evaluations());
        for (l, Member { body, .. }) in self.members.iter().enumerate() {
            let (estimate, norm_drift) = (f64::NAN, self.norm_drifts[l]);
            columns.record(*body, Record { method, longest, steps, evaluations, estimate, norm_drift });
            self.monitor.finish(l).for_each(|(quantity, numbers)| columns.drift(*body, quantity, numbers));
        }
        for (member, failure) in self.members.iter().zip(self.failures) {
            failure.into_iter().for_each(|failure| columns.fail(member.body, failure));
        }
    }

    /// Warns of steps that are too long for the laws, or for the turns of a body.
    fn warn(&self, span: [f64; 2], longest: f64) {
        let Plan { step, method, .. } = self.plan;
        let (gyrostats, torques) = self.acted;
        let columns = &self.scheduler.columns;
        // Laws are of the same kinds for all bodies: the first body stands for all.
        let first = &self.members[0];
        let start = Point::at_rest(&first.gyrostat, &first.start);
        let is_aliased = |law: &&Torque| is_aliased(law, &start, span, step);
        let aliased = torques[0].iter().filter(is_aliased);
        columns.warn(first.body, aliased.map(|law| aliasing_warning(law, step)));
        let turns_too_far = |l: &usize| {
            // A failure is reported already.
            let rate = self.squared_rates[*l].sqrt();
            self.failures[*l].is_none() && method.turns_too_far(&gyrostats[*l], rate, longest)
        };
        if let Some(l) = (0..self.members.len()).find(turns_too_far) {
            columns.warn(self.members[l].body, [turn_warning(step)]);
        }
    }
}

/// Whether products of two of the numbers in the lanes are finite.
#[inline]
pub(super) fn moderate<'a, const W: usize>(mut lanes: impl Iterator<Item = &'a [f64; W]>) -> bool {
    lanes.all(|numbers| numbers.iter().fold(true, |all, x| all & (x.abs() < 1e100)))
}

/// Time and cause of a failure: repeats the steps for the single body.
#[cold]
fn diagnose(
    method: Method,
    member: &Member,
    torques: &[Torque],
    from: Phase,
    (segment, steps): (&Segment, Range<u64>),
) -> (f64, SimulateError) {
    let mut at = Carried::new(from, Center::default());
    let alone = match Engine::new(method, member.gyrostat, torques, None, &member.start) {
        Ok(alone) => alone,
        Err(error) => return (from.time, error),
    };
    for i in steps {
        let (begin, end) = (segment.begin(i), segment.begin(i + 1));
        match alone.step(&at, end - begin, 0.0) {
            Ok((next, _)) if is_finite(&next) => at = next,
            Ok(_) => return (begin, SimulateError::Diverged { time: end }),
            Err(error) => return (begin, error),
        }
    }
    (at.phase.time, SimulateError::Diverged { time: at.phase.time })
}
