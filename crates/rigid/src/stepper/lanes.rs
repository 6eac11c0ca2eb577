//! Bodies stepped side by side in SIMD lanes by the classical method.

use super::{Held, Member, Steps};
use crate::ensemble::laws::{Laws, NoForcing};
use crate::laws::forcing::{Forcing, Place};
use crate::laws::torque::lanes::{Three, seen};
use crate::laws::torque::{Axes, Torque};
use crate::methods::classical::{self, Bodies, State};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::lanes::{Lanes, Work, fastest};
use polhode_ga::{Bivector, Rotor};
use std::array;
use std::ops::Range;

/// Bodies of a group: a cache line of each number.
const W: usize = 8;

/// Groups of bodies, with the arithmetic of the machine's best instructions.
pub(super) trait Groups: Send + Sync {
    fn reset(&mut self, body: usize, phase: &Phase);
    /// Some of the equal steps, by their numbers.
    fn step(&mut self, members: &[Member], held: Held<'_>, steps: &Steps, some: Range<u64>);
    /// The states of all bodies, for `restore`.
    fn states(&self) -> Vec<[f64; 7 * W]>;
    fn restore(&mut self, states: &[[f64; 7 * W]]);
    /// Writes rotors (body axes to space) and angular velocities in body axes.
    fn write(&self, rotors: &mut [[f64; 4]], omegas: &mut [[f64; 3]]);
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

struct All<const F: bool>(Vec<Group<F>>);

/// At most W bodies; lanes without a body repeat the first one.
struct Group<const F: bool> {
    bodies: Bodies<W, F>,
    gyrostats: [Gyrostat; W],
    /// From principal axes to those of the bodies, unless they are the same for all.
    frames: Option<[Rotor; W]>,
    free: bool,
    /// Its laws, unless they borrow from the members.
    laws: Option<Laws<'static, W, F>>,
    state: State<7, W, F>,
    count: usize,
}

impl<const F: bool> Group<F> {
    fn new(members: &[Member]) -> Group<F> {
        let member = |l: usize| members.get(l).unwrap_or(&members[0]);
        let damping = |l: usize| member(l).torques.iter().map(Torque::damping_rate).sum();
        let gyrostats = array::from_fn(|l| member(l).gyrostat);
        let free = members.iter().all(|member| member.torques.is_empty());
        let laws = || Laws::new(gyrostats, array::from_fn(|l| &member(l).torques[..]));
        Group {
            bodies: Bodies::new(array::from_fn(|l| (gyrostats[l], damping(l)))),
            gyrostats,
            frames: members
                .iter()
                .any(|member| member.frame != Rotor::IDENTITY)
                .then(|| array::from_fn(|l| member(l).frame)),
            free,
            laws: if free { None } else { laws().kept() },
            state: [Lanes::ZERO; 7],
            count: members.len(),
        }
    }
}

impl<const F: bool> Group<F> {
    /// The held torques in principal axes, or in space.
    fn held(&self, first: usize, held: Held<'_>) -> Three<W, F> {
        let mut torque = [Lanes::ZERO; 3];
        if held.torques.is_empty() {
            return torque;
        }
        for l in 0..self.count {
            let mut own = held.of(first + l);
            if let (Axes::Body, Some(frames)) = (held.axes, &self.frames) {
                own = frames[l].reverse().apply_bivector(own);
            }
            for k in 0..3 {
                torque[k].0[l] = own.0[k];
            }
        }
        torque
    }
}

/// The laws of a group, and the torques that are held over the step.
struct Holding<'a, E, const F: bool> {
    laws: &'a mut E,
    held: Three<W, F>,
    in_space: bool,
}

impl<E: Forcing<W, F>, const F: bool> Forcing<W, F> for Holding<'_, E, F> {
    const ACTS: bool = true;
    const WHEELS: bool = E::ACTS;

    #[inline(always)]
    fn begin(&mut self, middle: Lanes<W, F>) {
        self.laws.begin(middle);
    }

    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>, center: &[Lanes<W, F>; 6]) -> Three<W, F> {
        let mut sum = if self.in_space { seen(&at.rotor, &self.held) } else { self.held };
        if E::ACTS {
            let torque = self.laws.torque(at, center);
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
    steps: (&'a Steps, Range<u64>),
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
                let held = (group.held(first, held), held.axes == Axes::Space);
                let (bodies, state) = (&group.bodies, &mut group.state);
                if group.free {
                    march(bodies, state, &mut NoForcing, held, &steps);
                } else if let Some(laws) = &mut group.laws {
                    march(bodies, state, laws, held, &steps);
                } else {
                    let member = |l: usize| &members[first + if l < group.count { l } else { 0 }];
                    let torques = array::from_fn(|l| &member(l).torques[..]);
                    march(bodies, state, &mut Laws::new(group.gyrostats, torques), held, &steps);
                }
            }
        }
    }
}

/// The steps of a group; a held torque is in principal axes, or in space.
#[inline(always)]
fn march<E: Forcing<W, F>, const F: bool>(
    bodies: &Bodies<W, F>,
    state: &mut State<7, W, F>,
    laws: &mut E,
    (held, in_space): (Three<W, F>, bool),
    (steps, some): &(&Steps, Range<u64>),
) {
    let mut forcing = Holding { laws, held, in_space };
    // Copies, which the compiler may keep in registers.
    let (bodies, mut now) = (*bodies, classical::halved(state));
    for k in some.clone() {
        let (time, h) = steps.nth(k);
        classical::step(&bodies, &mut forcing, &mut now, time, [h, h / 6.0]);
    }
    *state = classical::doubled(&now);
}

impl<const F: bool> Groups for All<F> {
    fn reset(&mut self, body: usize, phase: &Phase) {
        let group = &mut self.0[body / W];
        let (rotor, omega) = (phase.rotor.components(), group.gyrostats[body % W].omega(phase.momentum).0);
        let idle = if body.is_multiple_of(W) { group.count..W } else { 0..0 };
        for l in idle.chain([body % W]) {
            for k in 0..7 {
                group.state[k].0[l] = if k < 4 { rotor[k] } else { omega[k - 4] };
            }
        }
    }

    fn step(&mut self, members: &[Member], held: Held<'_>, steps: &Steps, some: Range<u64>) {
        fastest(Go { groups: &mut self.0, members, held, steps: (steps, some) });
    }

    fn states(&self) -> Vec<[f64; 7 * W]> {
        self.0.iter().map(|group| array::from_fn(|k| group.state[k / W].0[k % W])).collect()
    }

    fn restore(&mut self, states: &[[f64; 7 * W]]) {
        for (group, state) in self.0.iter_mut().zip(states) {
            for (k, x) in state.iter().enumerate() {
                group.state[k / W].0[k % W] = *x;
            }
        }
    }

    fn write(&self, rotors: &mut [[f64; 4]], omegas: &mut [[f64; 3]]) {
        for (group, (rotors, omegas)) in self.0.iter().zip(rotors.chunks_mut(W).zip(omegas.chunks_mut(W))) {
            for (l, (rotor, omega)) in rotors.iter_mut().zip(omegas).enumerate() {
                *rotor = array::from_fn(|k| group.state[k].0[l]);
                *omega = array::from_fn(|k| group.state[4 + k].0[l]);
                if let Some(frames) = &group.frames {
                    *rotor = (Rotor::from_unit_components(*rotor) * frames[l].reverse()).components();
                    *omega = frames[l].apply_bivector(Bivector(*omega)).0;
                }
            }
        }
    }

    fn faster_than(&self, rate: f64) -> Option<(usize, f64)> {
        self.0.iter().enumerate().find_map(|(number, group)| {
            let [x, y, z] = [4, 5, 6].map(|k| group.state[k].0);
            let square = |l: usize| x[l] * x[l] + y[l] * y[l] + z[l] * z[l];
            let lane = (0..group.count).find(|&l| square(l) > rate * rate)?;
            Some((number * W + lane, square(lane).sqrt()))
        })
    }
}
