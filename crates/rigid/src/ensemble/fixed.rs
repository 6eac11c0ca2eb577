//! Fixed-step integration of bodies in SIMD lanes.

use super::columns::Record;
use super::laws::{LaneForcing, Laws};
use super::member::{Member, Plan, of};
use super::monitor::{LaneMonitor, LaneStates};
use super::observe::{LaneBodies, LanePhases};
use super::scheduler::Scheduler;
use super::steppers::{Advance, Components, Kicks, Segment, Stepper};
use crate::error::SimulateError;
use crate::laws::torque::{Torque, damping_rate};
use crate::methods::Method;
use crate::methods::classical::Bodies;
use crate::methods::momentum::fixed_momentum;
use crate::methods::splitting::turns::Turns;
use crate::run::Progress;
use crate::run::engine::Engine;
use crate::run::limits::span;
use crate::run::stops::{aliasing_warning, is_aliased, turn_warning};
use crate::run::sweep::is_finite;
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::lanes::{Work, fastest};
use std::array;
use std::borrow::Cow;

/// Steps between checks for finite states and calls of `progress`.
const BETWEEN_CHECKS: u64 = 1024;

/// Integration of at most `W` bodies over all times.
pub(super) struct FixedSteps<'a, 'b, const W: usize> {
    pub scheduler: &'b Scheduler<'a>,
    pub plan: Plan,
    pub members: Vec<Member<'a>>,
    pub progress: &'b mut dyn FnMut(Progress) -> bool,
}

impl<const W: usize> Work for FixedSteps<'_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn run<const F: bool>(mut self) {
        let torques: Vec<Cow<[Torque]>> =
            self.members.iter_mut().map(|m| std::mem::take(&mut m.torques)).collect();
        let laws = |l: usize| &torques[if l < torques.len() { l } else { 0 }][..];
        let damping = |l: usize| damping_rate(laws(l));
        let members = &self.members;
        let gyrostats = array::from_fn(|l| of(members, l).gyrostat);
        if let Method::Splitting(sequence) = self.plan.method {
            let (stages, last) = sequence.stages();
            let fixed = |l: usize| fixed_momentum(laws(l), &of(members, l).start).map(|momentum| momentum.0);
            let turns = Turns::new(array::from_fn(|l| (gyrostats[l], damping(l), fixed(l))));
            let (stages, laws) = ((&stages[..], last), Laws::new(gyrostats, array::from_fn(laws)));
            self.advance_all::<F, _>(&mut Kicks::<W, F> { turns, stages, laws }, &torques);
        } else {
            let bodies = Bodies::new(array::from_fn(|l| (gyrostats[l], damping(l))));
            match LaneForcing::new(gyrostats, array::from_fn(laws)) {
                LaneForcing::NoForcing(forcing) => {
                    self.advance_all::<F, _>(&mut Components::<_, W, F> { bodies, forcing }, &torques);
                }
                LaneForcing::Weight(forcing) => {
                    self.advance_all::<F, _>(&mut Components::<_, W, F> { bodies, forcing }, &torques);
                }
                LaneForcing::Gradient(forcing) => {
                    self.advance_all::<F, _>(&mut Components::<_, W, F> { bodies, forcing }, &torques);
                }
                LaneForcing::Controller(forcing) => {
                    self.advance_all::<F, _>(&mut Components::<_, W, F> { bodies, forcing }, &torques);
                }
                LaneForcing::Formula(forcing) => {
                    self.advance_all::<F, _>(&mut Components::<_, W, F> { bodies, forcing }, &torques);
                }
                LaneForcing::Laws(forcing) => {
                    self.advance_all::<F, _>(&mut Components::<_, W, F> { bodies, forcing }, &torques);
                }
            }
        }
    }
}

impl<const W: usize> FixedSteps<'_, '_, W> {
    fn advance_all<const F: bool, S: Stepper<W>>(self, stepper: &mut S, torques: &[Cow<[Torque]>]) {
        let FixedSteps { scheduler, plan, mut members, progress } = self;
        let Plan { start, step, method, .. } = plan;
        let times = scheduler.times;
        let (bodies, gyrostats): (LaneBodies<W>, Vec<Gyrostat>) =
            (LaneBodies::new(&members), members.iter().map(|member| member.gyrostat).collect());
        let states = |phases, time| LaneStates::new(bodies.points(phases), (&gyrostats[..], torques), time);
        // Of bodies that move; the others have none.
        let moving = if members[0].own.centers.is_some() { &members[..] } else { &[] };
        let centers: Vec<_> = moving.iter().map(|member| scheduler.center(member.body)).collect();
        let at_start = states(LanePhases::starts(&members), start);
        let (mut monitor, mut squared_rates) =
            (LaneMonitor::new(&at_start), at_start.points().squared_rates());
        // Their products with the numbers of a moderate state are finite.
        let are_moderate = moderate(bodies.numbers());
        let mut failures: [Option<(f64, SimulateError)>; W] = [const { None }; W];
        let mut norm_drifts = [0.0_f64; W];
        let (mut steps, mut longest, mut so_far) = (0, 0.0_f64, 0);
        let breaks = breaks(torques, &scheduler.options.breaks);
        let [begin, end] = span(times, start);
        let total = (end - begin).max(f64::MIN_POSITIVE);
        let early = times.partition_point(|&t| t < start);
        let sides: [&mut dyn Iterator<Item = usize>; 2] = [&mut (0..early).rev(), &mut (early..times.len())];
        for (side, indices) in sides.into_iter().enumerate() {
            let mut state = stepper.start(&members);
            // A body that failed on one side of the start is integrated on the other.
            let mut lost = [false; W];
            let mut time = start;
            for index in indices {
                for segment in segments(time, times[index], step, &breaks) {
                    longest = longest.max((segment.to - segment.from).abs() / segment.count as f64);
                    for first in (0..segment.count).step_by(BETWEEN_CHECKS as usize) {
                        let last = segment.count.min(first + BETWEEN_CHECKS);
                        let (part, before) = (first..last, state);
                        let advance =
                            Advance::<_, W, F> { stepper, state: &mut state, segment, steps: part.clone() };
                        fastest(advance);
                        steps += last - first;
                        let are_finite = are_moderate && moderate(S::numbers(&state));
                        for (l, member) in members.iter().enumerate() {
                            if are_finite {
                                break;
                            }
                            let phase =
                                |state, step| stepper.phases(&bodies, state).phase(l, segment.begin(step));
                            let now = phase(&state, last);
                            if !lost[l] && !is_finite(&Carried::new(now, Center::default())) {
                                let from = phase(&before, first);
                                lost[l] = true;
                                let part = (&segment, part.clone());
                                let failure = diagnose(method, member, &torques[l], from, part);
                                failures[l].get_or_insert(failure);
                            }
                        }
                        let gone = segment.begin(last);
                        let passed = if side == 0 { start - gone } else { gone - begin };
                        scheduler.count(&mut so_far, passed / total, members.len());
                        if !scheduler.report(progress) {
                            return;
                        }
                    }
                }
                time = times[index];
                let states = states(stepper.phases(&bodies, &state), time);
                monitor.record(&states, &lost);
                let points = states.points();
                let rates = points.squared_rates();
                (0..W).for_each(|l| squared_rates[l] = squared_rates[l].max(rates[l]));
                for (l, member) in members.iter_mut().enumerate() {
                    if lost[l] {
                        member.own.unknown(index);
                        continue;
                    }
                    norm_drifts[l] = norm_drifts[l].max(points.off_unit.0[l]);
                    let (rotor, omega) = points.in_body(l);
                    member.own.put(index, rotor, omega, points.momentum_of(l), states.energy[l]);
                    if let Some(center) = centers.get(l) {
                        member.own.place(index, &center.at(time));
                    }
                }
            }
        }
        scheduler.count(&mut so_far, 1.0, members.len());
        // Laws are of the same kinds for all bodies: the first body stands for all.
        let first = &members[0];
        let is_aliased = |law: &&Torque| is_aliased(law, &first.gyrostat, &first.start, [begin, end], step);
        let aliased = torques[0].iter().filter(is_aliased);
        let columns = &scheduler.columns;
        columns.warn(first.body, aliased.map(|law| aliasing_warning(law, step)));
        let turns_too_far = |l: &usize| {
            // A failure is reported already.
            let rate = squared_rates[*l].sqrt();
            failures[*l].is_none() && method.turns_too_far(&gyrostats[*l], rate, longest)
        };
        if let Some(l) = (0..members.len()).find(turns_too_far) {
            columns.warn(members[l].body, [turn_warning(step)]);
        }
        let (method, evaluations) = (columns.method(method.name()), steps * plan.evaluations());
        for (l, Member { body, .. }) in members.iter().enumerate() {
            let (estimate, norm_drift) = (f64::NAN, norm_drifts[l]);
            columns.record(*body, Record { method, longest, steps, evaluations, estimate, norm_drift });
            monitor.finish(l).for_each(|(quantity, numbers)| columns.drift(*body, quantity, numbers));
        }
        for (member, failure) in members.iter().zip(failures) {
            failure.into_iter().for_each(|failure| columns.fail(member.body, failure));
        }
    }
}

/// Whether products of two of the numbers in the lanes are finite.
#[inline]
fn moderate<'a, const W: usize>(mut lanes: impl Iterator<Item = &'a [f64; W]>) -> bool {
    lanes.all(|numbers| numbers.iter().fold(true, |all, x| all & (x.abs() < 1e100)))
}

/// Ascending times at which the laws are not smooth; all bodies share such laws.
fn breaks(torques: &[Cow<[Torque]>], extra: &[f64]) -> Vec<f64> {
    let laws = torques[0].iter().flat_map(|law| law.breaks());
    let mut breaks: Vec<f64> = laws.chain(extra).copied().collect();
    breaks.sort_by(f64::total_cmp);
    breaks
}

/// The segments up to a time, split where a law is not smooth.
fn segments(from: f64, to: f64, step: f64, breaks: &[f64]) -> Vec<Segment> {
    if from == to {
        return Vec::new();
    }
    let (low, high) = (from.min(to), from.max(to));
    let between = &breaks[breaks.partition_point(|&b| b <= low)..breaks.partition_point(|&b| b < high)];
    let mut ends: Vec<f64> = between.to_vec();
    if to < from {
        ends.reverse();
    }
    ends.push(to);
    let mut begin = from;
    let part = |end: f64| {
        let count = ((end - begin).abs() / step).ceil().max(1.0) as u64;
        let segment = Segment { from: begin, to: end, count };
        begin = end;
        segment
    };
    ends.into_iter().map(part).filter(|segment| segment.from != segment.to).collect()
}

/// Time and cause of a failure: repeats the steps for the single body.
#[cold]
fn diagnose(
    method: Method,
    member: &Member,
    torques: &[Torque],
    from: Phase,
    (segment, steps): (&Segment, std::ops::Range<u64>),
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
