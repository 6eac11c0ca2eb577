//! Fixed-step integration of bodies in SIMD lanes.

use super::laws::{LaneForcing, Laws};
use super::member::{Member, Plan, of};
use super::recorder::{Recorder, moderate};
use super::scheduler::Scheduler;
use super::steppers::{Advance, Components, InMemory, InRegisters, Kicks, Marching, Segment, Stepper};
use crate::laws::torque::{Torque, damping_rate};
use crate::methods::Method;
use crate::methods::classical::Bodies;
use crate::methods::momentum::fixed_momentum;
use crate::methods::splitting::turns::Turns;
use crate::methods::step_control::step_count;
use crate::run::Progress;
use crate::run::limits::span;
use crate::state::phase::Gyrostat;
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
            let bodies = Bodies::<W, F>::new(array::from_fn(|l| (gyrostats[l], damping(l))));
            match LaneForcing::new(gyrostats, array::from_fn(laws)) {
                LaneForcing::NoForcing(forcing) => self.march(bodies, InRegisters(forcing), &torques),
                LaneForcing::Weight(forcing) => self.march(bodies, InRegisters(forcing), &torques),
                LaneForcing::Controller(forcing) => self.march(bodies, InRegisters(forcing), &torques),
                LaneForcing::Gradient(forcing) => self.march(bodies, InMemory(forcing), &torques),
                LaneForcing::Formula(forcing) => self.march(bodies, InMemory(forcing), &torques),
                LaneForcing::Laws(forcing) => self.march(bodies, InMemory(forcing), &torques),
            }
        }
    }
}

impl<const W: usize> FixedSteps<'_, '_, W> {
    /// Steps by the classical method.
    fn march<const F: bool, M: Marching<W, F>>(
        self,
        bodies: Bodies<W, F>,
        acting: M,
        torques: &[Cow<[Torque]>],
    ) {
        self.advance_all::<F, _>(&mut Components { bodies, acting }, torques);
    }

    fn advance_all<const F: bool, S: Stepper<W>>(self, stepper: &mut S, torques: &[Cow<[Torque]>]) {
        let FixedSteps { scheduler, plan, members, progress } = self;
        let gyrostats: Vec<Gyrostat> = members.iter().map(|member| member.gyrostat).collect();
        let (start, times) = (plan.start, scheduler.times);
        let mut course = Course {
            breaks: breaks(torques, &scheduler.options.breaks),
            span: span(times, start),
            recorder: Recorder::new(scheduler, plan, members, (&gyrostats, torques)),
            steps: 0,
            longest: 0.0,
            so_far: 0,
            progress,
        };
        let early = times.partition_point(|&t| t < start);
        if course.side::<F, S>(stepper, (0..early).rev()) && course.side::<F, S>(stepper, early..times.len())
        {
            course.finish();
        }
    }
}

/// The steps of the bodies in lanes over all times.
struct Course<'r, 'a, const W: usize> {
    recorder: Recorder<'r, 'a, W>,
    /// Ascending times at which the laws are not smooth.
    breaks: Vec<f64>,
    /// The earliest and the latest time, in s.
    span: [f64; 2],
    /// Number of steps, and the longest in s.
    steps: u64,
    longest: f64,
    /// Parts of the work that are counted.
    so_far: u64,
    progress: &'r mut dyn FnMut(Progress) -> bool,
}

impl<const W: usize> Course<'_, '_, W> {
    /// Integrates and records the bodies at the times on one side of the start. False if the run was stopped.
    fn side<const F: bool, S: Stepper<W>>(
        &mut self,
        stepper: &mut S,
        indices: impl Iterator<Item = usize>,
    ) -> bool {
        let Plan { start, step, .. } = self.recorder.plan;
        let mut state = stepper.start(&self.recorder.members);
        self.recorder.turn_back();
        let mut time = start;
        for index in indices {
            let to = self.recorder.scheduler.times[index];
            for segment in segments(time, to, step, &self.breaks) {
                if !self.advance::<F, S>(stepper, &mut state, segment) {
                    return false;
                }
            }
            time = to;
            self.recorder.record(stepper.phases(&self.recorder.bodies, &state), index);
        }
        true
    }

    /// Integrates the bodies over a segment. False if the run was stopped.
    fn advance<const F: bool, S: Stepper<W>>(
        &mut self,
        stepper: &mut S,
        state: &mut S::State,
        segment: Segment,
    ) -> bool {
        self.longest = self.longest.max((segment.to - segment.from).abs() / segment.count as f64);
        for first in (0..segment.count).step_by(BETWEEN_CHECKS as usize) {
            let last = segment.count.min(first + BETWEEN_CHECKS);
            let before = *state;
            fastest(Advance::<_, W, F> { stepper, state, segment, steps: first..last });
            self.steps += last - first;
            if !self.recorder.are_moderate || !moderate(S::numbers(state)) {
                let phases = [&before, &*state].map(|state| stepper.phases(&self.recorder.bodies, state));
                self.recorder.check(phases, &segment, first..last);
            }
            if !self.report(segment.begin(last)) {
                return false;
            }
        }
        true
    }

    /// Reports the work done at a time. False if the run is to stop.
    fn report(&mut self, time: f64) -> bool {
        let Recorder { scheduler, ref members, plan: Plan { start, .. }, .. } = self.recorder;
        let [begin, end] = self.span;
        let passed = if time < start { start - time } else { time - begin };
        let fraction = passed / (end - begin).max(f64::MIN_POSITIVE);
        scheduler.count(&mut self.so_far, fraction, members.len());
        scheduler.report(self.progress)
    }

    fn finish(mut self) {
        let Recorder { scheduler, ref members, .. } = self.recorder;
        scheduler.count(&mut self.so_far, 1.0, members.len());
        self.recorder.finish(self.span, self.steps, self.longest);
    }
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
        let count = step_count(end - begin, step) as u64;
        let segment = Segment { from: begin, to: end, count };
        begin = end;
        segment
    };
    ends.into_iter().map(part).filter(|segment| segment.from != segment.to).collect()
}
