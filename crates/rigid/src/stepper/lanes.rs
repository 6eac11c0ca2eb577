//! Bodies stepped side by side in SIMD lanes by the classical method.

use super::{Held, Member, Steps};
use crate::ensemble::laws::Laws;
use crate::laws::forcing::{Forcing, Place};
use crate::laws::torque::lanes::{Three, seen};
use crate::laws::torque::{Axes, Torque};
use crate::methods::classical::{self, Bodies, State};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::lanes::{Lanes, Work, dot, fastest};
use polhode_ga::{Bivector, Rotor};
use std::array;
use std::fmt::Debug;

/// Bodies of a group: a cache line of each number.
const W: usize = 8;

/// Groups of bodies, with the arithmetic of the machine's best instructions.
pub(super) trait Groups: Debug + Send + Sync {
    fn reset(&mut self, body: usize, phase: &Phase);
    fn step(&mut self, members: &[Member], held: Held<'_>, steps: &Steps);
    /// Rotor and angular velocity of a body in principal axes.
    fn spin(&self, body: usize) -> (Rotor, Bivector);
    /// The first body that turns faster than a rate, and its rate, in rad/s.
    fn faster_than(&self, rate: f64) -> Option<(usize, f64)>;
}

/// The groups of all bodies.
pub(super) fn groups(members: &[Member]) -> Box<dyn Groups> {
    fastest(Make { members })
}

struct Make<'a> {
    members: &'a [Member],
}

impl Work for Make<'_> {
    type Output = Box<dyn Groups>;

    #[inline(always)]
    fn run<const F: bool>(self) -> Box<dyn Groups> {
        Box::new(All::<F>(self.members.chunks(W).map(Group::new).collect()))
    }
}

#[derive(Debug)]
struct All<const F: bool>(Vec<Group<F>>);

/// At most W bodies; lanes without a body repeat the first one.
#[derive(Debug)]
struct Group<const F: bool> {
    bodies: Bodies<W, F>,
    gyrostats: [Gyrostat; W],
    state: State<7, W, F>,
    count: usize,
}

impl<const F: bool> Group<F> {
    fn new(members: &[Member]) -> Group<F> {
        let member = |l: usize| members.get(l).unwrap_or(&members[0]);
        let damping = |l: usize| member(l).torques.iter().map(Torque::damping_rate).sum();
        let gyrostats = array::from_fn(|l| member(l).gyrostat);
        Group {
            bodies: Bodies::new(array::from_fn(|l| (gyrostats[l], damping(l)))),
            gyrostats,
            state: [Lanes::ZERO; 7],
            count: members.len(),
        }
    }
}

/// The laws of a group, and the torques that are held over the step.
struct Holding<'a, 't, const F: bool> {
    laws: &'a mut Laws<'t, W, F>,
    held: Three<W, F>,
    in_space: bool,
}

impl<const F: bool> Forcing<W, F> for Holding<'_, '_, F> {
    const ACTS: bool = true;

    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>) -> Three<W, F> {
        let mut sum = if self.in_space { seen(&at.rotor, &self.held) } else { self.held };
        if !self.laws.is_empty() {
            let torque = self.laws.torque(at);
            for k in 0..3 {
                sum[k] += torque[k];
            }
        }
        sum
    }
}

struct Go<'a, const F: bool> {
    groups: &'a mut [Group<F>],
    members: &'a [Member],
    held: Held<'a>,
    steps: &'a Steps,
}

impl<const F: bool> Work for Go<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        // The caller is on the same path; other paths are not compiled.
        if FUSED == F {
            let Go { groups, members, held, steps } = self;
            for (number, group) in groups.iter_mut().enumerate() {
                let first = number * W;
                let members = &members[first..first + group.count];
                let member = |l: usize| if l < members.len() { &members[l] } else { &members[0] };
                let mut laws = Laws::new(group.gyrostats, array::from_fn(|l| &member(l).torques[..]));
                let mut torque = [Lanes::ZERO; 3];
                if !held.torques.is_empty() {
                    for (l, member) in members.iter().enumerate() {
                        let mut own = held.of(first + l);
                        if held.axes == Axes::Body && member.frame != Rotor::IDENTITY {
                            own = member.frame.reverse().apply_bivector(own);
                        }
                        for k in 0..3 {
                            torque[k].0[l] = own.0[k];
                        }
                    }
                }
                let in_space = held.axes == Axes::Space;
                let mut forcing = Holding { laws: &mut laws, held: torque, in_space };
                // Copies, which the compiler may keep in registers.
                let (bodies, mut now) = (group.bodies, group.state);
                for k in 0..steps.count {
                    let (time, h) = steps.nth(k);
                    classical::step(&bodies, &mut forcing, &mut now, time, h);
                }
                group.state = now;
            }
        }
    }
}

impl<const F: bool> Groups for All<F> {
    fn reset(&mut self, body: usize, phase: &Phase) {
        let group = &mut self.0[body / W];
        let (rotor, omega) = (phase.rotor.components(), group.gyrostats[body % W].omega(phase.momentum).0);
        let idle = if body % W == 0 { group.count..W } else { 0..0 };
        for l in idle.chain([body % W]) {
            for k in 0..7 {
                group.state[k].0[l] = if k < 4 { rotor[k] } else { omega[k - 4] };
            }
        }
    }

    fn step(&mut self, members: &[Member], held: Held<'_>, steps: &Steps) {
        fastest(Go { groups: &mut self.0, members, held, steps });
    }

    fn spin(&self, body: usize) -> (Rotor, Bivector) {
        let number = |k: usize| self.0[body / W].state[k].0[body % W];
        (Rotor::from_unit_components(array::from_fn(number)), Bivector(array::from_fn(|k| number(4 + k))))
    }

    fn faster_than(&self, rate: f64) -> Option<(usize, f64)> {
        self.0.iter().enumerate().find_map(|(number, group)| {
            let omega = [group.state[4], group.state[5], group.state[6]];
            let square = dot(&omega, &omega).0;
            let lane = (0..group.count).find(|&l| square[l] > rate * rate)?;
            Some((number * W + lane, square[lane].sqrt()))
        })
    }
}
