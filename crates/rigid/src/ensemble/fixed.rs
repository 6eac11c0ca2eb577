//! Equal steps of bodies side by side.

use super::block::{Crew, Member, SIDE_BY_SIDE, Told};
use super::laws::{Laws, Nothing};
use crate::certificate::{Certificate, Watch, off_unit};
use crate::classical::{self, Bodies, Classical, Exert, State};
use crate::force::Center;
use crate::method::Method;
use crate::phase::Phase;
use crate::runge_kutta::Carried;
use crate::simulate::Progress;
use crate::simulate_error::SimulateError;
use crate::torque::Torque;
use crate::walk::is_finite;
use polhode_ga::lanes::{Lanes, Work};
use std::array;

const W: usize = SIDE_BY_SIDE;

/// Steps between looks at whether all is finite, and whether to go on.
const BETWEEN_LOOKS: u64 = 1024;

/// At most [`SIDE_BY_SIDE`] bodies to be stepped over all times.
pub(super) struct FixedSteps<'a, 'b> {
    pub crew: &'b Crew<'a>,
    pub members: Vec<Member<'a>>,
    pub progress: &'b mut dyn FnMut(Progress) -> bool,
}

/// Equal steps from one time to another.
#[derive(Clone, Copy)]
struct Stretch {
    from: f64,
    to: f64,
    count: u64,
}

impl Stretch {
    /// Where a step ends. The differences of these rounded times are the steps, so that they add up to the time.
    #[inline(always)]
    fn end(&self, step: u64) -> f64 {
        if step + 1 == self.count {
            self.to
        } else {
            self.from + (self.to - self.from) * ((step + 1) as f64 / self.count as f64)
        }
    }

    #[inline(always)]
    fn begin(&self, step: u64) -> f64 {
        if step == 0 { self.from } else { self.end(step - 1) }
    }
}

impl Work for FixedSteps<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<const F: bool>(mut self) {
        let free = self.members.iter().all(|member| member.torques.is_empty());
        let torques: Vec<Vec<Torque>> =
            self.members.iter_mut().map(|m| std::mem::take(&mut m.torques)).collect();
        // Lanes without a body hold another one's.
        let of = |l: usize| if l < self.members.len() { l } else { 0 };
        let damping = |l: usize| torques[of(l)].iter().map(Torque::damping_rate).sum();
        let bodies: Bodies<W, F> =
            Bodies::new(array::from_fn(|l| (self.members[of(l)].gyrostat, damping(l))));
        if free {
            self.walk(&bodies, &mut Nothing, &torques);
        } else {
            let gyrostats = array::from_fn(|l| self.members[of(l)].gyrostat);
            let mut laws = Laws::new(gyrostats, array::from_fn(|l| &torques[of(l)][..]));
            self.walk(&bodies, &mut laws, &torques);
        }
    }
}

impl FixedSteps<'_, '_> {
    #[inline(always)]
    fn walk<const F: bool, E: Exert<W, F>>(
        self,
        bodies: &Bodies<W, F>,
        exert: &mut E,
        torques: &[Vec<Torque>],
    ) {
        let FixedSteps { crew, mut members, progress } = self;
        let Some(step) = crew.options.step else { return };
        let times = crew.times;
        let mut watches: Vec<Watch> =
            members.iter().zip(torques).map(|(m, t)| Watch::new(m.gyrostat, t, m.start)).collect();
        let mut failures: [Option<(f64, SimulateError)>; W] = [const { None }; W];
        let mut norm_drifts = [0.0_f64; W];
        let (mut steps, mut longest, mut so_far) = (0, 0.0_f64, 0);
        let breaks = breaks(torques);
        let begin = times.first().map_or(0.0, |t| t.min(0.0));
        let total = (times.last().map_or(0.0, |t| t.max(0.0)) - begin).max(f64::MIN_POSITIVE);
        let early = times.partition_point(|&t| t < 0.0);
        let sides: [&mut dyn Iterator<Item = usize>; 2] = [&mut (0..early).rev(), &mut (early..times.len())];
        for (side, indices) in sides.into_iter().enumerate() {
            let mut state: State<7, W, F> = load(&members);
            let mut time = 0.0;
            for index in indices {
                for stretch in stretches(time, times[index], step, &breaks) {
                    longest = longest.max((stretch.to - stretch.from).abs() / stretch.count as f64);
                    for first in (0..stretch.count).step_by(BETWEEN_LOOKS as usize) {
                        let last = stretch.count.min(first + BETWEEN_LOOKS);
                        let before = state;
                        for i in first..last {
                            let (from, to) = (stretch.begin(i), stretch.end(i));
                            classical::step(bodies, exert, &mut state, from, to - from);
                        }
                        steps += last - first;
                        for (l, member) in members.iter().enumerate() {
                            if failures[l].is_none() && !lane(&state, l).iter().all(|x| x.is_finite()) {
                                let from = phase(member, &before, l, stretch.begin(first));
                                let part = (&stretch, first..last);
                                failures[l] = Some(diagnose(member, &torques[l], from, part));
                            }
                        }
                        let gone = stretch.end(last - 1);
                        let walked = if side == 0 { -gone } else { gone - begin };
                        crew.count(&mut so_far, walked / total, members.len());
                        if !crew.report(progress) {
                            return;
                        }
                    }
                }
                time = times[index];
                for (l, member) in members.iter_mut().enumerate() {
                    if failures[l].is_some() {
                        member.own.unknown(index);
                        continue;
                    }
                    let phase = phase(member, &state, l, time);
                    norm_drifts[l] = norm_drifts[l].max(off_unit(phase.rotor));
                    watches[l].look(&phase);
                    let center = crew.center(member.body, time);
                    let of = (member.frame, &member.gyrostat, &torques[l][..]);
                    member.own.write(index, of, &phase, &center);
                }
            }
        }
        crew.count(&mut so_far, 1.0, members.len());
        let failures = failures.into_iter();
        let told = members.iter().zip(watches).zip(failures).zip(norm_drifts);
        crew.tell(told.map(|(((member, watch), failure), norm_drift)| Told {
            body: member.body,
            certificate: Certificate {
                method: Method::Classical.name(),
                step: longest,
                steps,
                evaluations: 4 * steps,
                error_estimate: None,
                drifts: watch.finish(),
                norm_drift,
            },
            failure,
        }));
    }
}

/// Where the laws are not smooth, rising; all bodies share such laws.
fn breaks(torques: &[Vec<Torque>]) -> Vec<f64> {
    let mut breaks: Vec<f64> = torques[0].iter().flat_map(|law| law.breaks()).copied().collect();
    breaks.sort_by(f64::total_cmp);
    breaks
}

/// The ways to a time, parted where a law is not smooth.
fn stretches(from: f64, to: f64, step: f64, breaks: &[f64]) -> Vec<Stretch> {
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
        let stretch = Stretch { from: begin, to: end, count };
        begin = end;
        stretch
    };
    ends.into_iter().map(part).filter(|stretch| stretch.from != stretch.to).collect()
}

fn load<const F: bool>(members: &[Member]) -> State<7, W, F> {
    let mut state = [Lanes::ZERO; 7];
    for l in 0..W {
        let member = &members[if l < members.len() { l } else { 0 }];
        let (rotor, omega) =
            (member.start.rotor.components(), member.gyrostat.omega(member.start.momentum).0);
        for k in 0..7 {
            state[k].0[l] = if k < 4 { rotor[k] } else { omega[k - 4] };
        }
    }
    state
}

fn lane<const F: bool>(state: &State<7, W, F>, l: usize) -> [f64; 7] {
    array::from_fn(|k| state[k].0[l])
}

fn phase<const F: bool>(member: &Member, state: &State<7, W, F>, l: usize, time: f64) -> Phase {
    classical::phase(&member.gyrostat, &lane(state, l), time)
}

/// When and why the steps from a point lead to nothing: steps them once more, alone.
#[cold]
fn diagnose(
    member: &Member,
    torques: &[Torque],
    from: Phase,
    (stretch, steps): (&Stretch, std::ops::Range<u64>),
) -> (f64, SimulateError) {
    let alone = Classical::new(member.gyrostat, torques.to_vec(), None);
    let mut at = Carried::new(from, Center::default());
    for i in steps {
        let (begin, end) = (stretch.begin(i), stretch.end(i));
        match alone.step(&at, end - begin) {
            Ok(next) if is_finite(&next) => at = next,
            Ok(_) => return (begin, SimulateError::Diverged { time: end }),
            Err(error) => return (begin, error),
        }
    }
    (at.phase.time, SimulateError::Diverged { time: at.phase.time })
}
