//! Bodies stepped by a caller, who holds a torque over each step: loops of control and of learning.
//!
//! A step of length Δt consists of equal steps of one method, no longer than a given bound. Many bodies are stepped by
//! the classical method in SIMD lanes, others one by one; no body depends on the others.

mod alone;
mod lanes;

use crate::ensemble::{Ensemble, Start};
use crate::error::SimulateError;
use crate::exact::center::CenterLaw;
use crate::laws::driven_wheels::carrier;
use crate::laws::force::Translation;
use crate::laws::torque::{Axes, Torque, Wheels, wheel};
use crate::methods::Method;
use crate::methods::step_control::{next_stop, step_count};
use crate::run::center::center_law;
use crate::run::check_body;
use crate::run::engine::Engine;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use alone::Alone;
use lanes::Groups;
use polhode_ga::simd::double::two_sum;
use polhode_ga::{Bivector, Rotor, Vector};
use std::sync::Arc;

/// The largest turn in a step of the method, in rad. Beyond it no method has its order.
const LARGEST_TURN: f64 = 1.0;

/// Torques held over a step, in N m: none, one for all bodies, or one for each.
#[derive(Clone, Copy, Debug)]
pub struct Held<'a> {
    /// Components of the axial vectors.
    pub torques: &'a [[f64; 3]],
    /// Their axes.
    pub axes: Axes,
}

impl Held<'_> {
    fn of(&self, body: usize) -> Bivector {
        match self.torques {
            [] => Bivector::default(),
            [one] => Bivector(*one),
            each => Bivector(each[body]),
        }
    }
}

/// A body in principal axes, with its torques.
#[derive(Clone, Debug)]
struct Member {
    /// From principal axes to those of the body.
    frame: Rotor,
    gyrostat: Gyrostat,
    torques: Vec<Torque>,
    /// Those without commands of the caller.
    given: Vec<Torque>,
    center: Center,
    /// The law of its motion, if that has a closed form.
    law: Option<CenterLaw>,
    /// Forces without one.
    translation: Option<Translation>,
}

enum Bodies {
    Alone(Vec<Alone>),
    Lanes(Box<dyn Groups>),
}

/// Bodies with their states at a common time.
pub struct Stepper {
    members: Vec<Member>,
    bodies: Bodies,
    method: Method,
    longest: f64,
    /// Ascending times at which a law jumps: steps of the method end there.
    jumps: Vec<f64>,
    /// The sum of the start and all steps: rounded, and the rest.
    time: [f64; 2],
    moves: bool,
}

/// A body, by its number, and its error.
pub type Failed = (usize, SimulateError);

impl Stepper {
    /// Bodies that start at the time of the first. Steps of the method are at most `longest` seconds long.
    pub fn new(ensemble: &Ensemble, method: Method, longest: f64) -> Result<Stepper, Failed> {
        let count = ensemble.starts.len();
        let members: Vec<Member> = (0..count)
            .map(|body| Member::new(ensemble, body).map_err(|error| (body, error)))
            .collect::<Result<_, _>>()?;
        for (body, (member, start)) in members.iter().zip(&ensemble.starts).enumerate() {
            let begin = member.phase(start);
            check_body(&member.gyrostat, start.omega, &member.torques).map_err(|error| (body, error))?;
            Engine::new(method, member.gyrostat, &member.torques, member.translation.clone(), &begin)
                .map_err(|error| (body, error))?;
        }
        let moved = members.iter().any(|member| member.translation.is_some());
        let driven = members.iter().any(|member| member.wheels().next().is_some());
        let in_lanes = count > 1 && method == Method::Classical && !moved && !driven;
        let bodies = if in_lanes {
            Bodies::Lanes(lanes::groups(&members))
        } else {
            Bodies::Alone(members.iter().map(Alone::new).collect())
        };
        let (jumps, time, moves) = (Vec::new(), [0.0; 2], false);
        let mut stepper = Stepper { members, bodies, method, longest, jumps, time, moves };
        stepper.reset(&ensemble.starts);
        Ok(stepper)
    }

    /// Sets the states of all bodies.
    pub fn reset(&mut self, starts: &[Start]) {
        self.time = [starts.first().map_or(0.0, |start| start.time), 0.0];
        for (body, (member, start)) in self.members.iter_mut().zip(starts).enumerate() {
            member.center = start.center;
            if member.wheels().next().is_some() {
                member.torques.clone_from(&member.given);
            }
            match &mut self.bodies {
                Bodies::Alone(bodies) => bodies[body].reset(member, member.phase(start), start.center),
                Bodies::Lanes(groups) => groups.reset(body, &member.phase(start)),
            }
        }
        self.moves = self.members.iter().any(Member::moves);
        self.find_jumps();
    }

    fn find_jumps(&mut self) {
        let laws = self.members.iter().flat_map(|member| &member.torques);
        self.jumps = laws.flat_map(Torque::jumps).copied().collect();
        self.jumps.sort_by(f64::total_cmp);
        self.jumps.dedup();
    }

    /// The number of wheels with motors of each body.
    pub fn wheels(&self) -> usize {
        self.members.first().map_or(0, |member| member.wheels().map(Wheels::count).sum())
    }

    /// Commands the motors of all wheels from now on: a row of torques in N m for all bodies, or one for each.
    pub fn command(&mut self, torques: &[f64]) {
        let (count, [time, _]) = (self.wheels(), self.time);
        let shared = torques.len() == count;
        for (body, member) in self.members.iter_mut().enumerate() {
            let mut row = if shared { torques } else { &torques[body * count..][..count] };
            for law in &mut member.torques {
                if let Torque::Wheels(wheels) = law {
                    let (own, rest) = row.split_at(wheels.count());
                    *law = Torque::Wheels(Arc::new(wheels.commanded(time, own)));
                    row = rest;
                }
            }
        }
        self.find_jumps();
    }

    /// The speeds of all wheels with motors relative to their bodies, in rad/s, body by body.
    pub fn wheel_speeds(&self) -> Vec<f64> {
        let Bodies::Alone(bodies) = &self.bodies else { return Vec::new() };
        let mut speeds = Vec::new();
        for (body, member) in bodies.iter().zip(&self.members) {
            let omega = body.principal_omega(member);
            speeds.extend(member.wheels().flat_map(|wheels| wheels.speeds(self.time(), omega)));
        }
        speeds
    }

    /// The number of bodies.
    pub fn count(&self) -> usize {
        self.members.len()
    }

    /// The time in s.
    pub fn time(&self) -> f64 {
        self.time[0]
    }

    /// The time after a step, in two parts, so that the rounding errors of many steps do not add up.
    fn time_after(&self, dt: f64) -> [f64; 2] {
        let [time, rest] = self.time;
        two_sum(time, dt + rest).into()
    }

    /// Whether the centres of mass move.
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// One step of length `dt` in s, which may be negative. On an error no state has changed.
    pub fn step(&mut self, dt: f64, held: Held<'_>) -> Result<(), Failed> {
        self.step_while(dt, held, &mut || true)
    }

    /// As [`Stepper::step`]; if `go_on`, called every few milliseconds, returns false, the step ends with
    /// [`SimulateError::Interrupted`].
    pub fn step_while(
        &mut self,
        dt: f64,
        held: Held<'_>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), Failed> {
        let pieces = self.pieces(dt);
        for piece in &pieces {
            self.check_turns(piece.dt / piece.count as f64)?;
        }
        let centers = self.centers_after(dt)?;
        match &mut self.bodies {
            Bodies::Alone(bodies) => {
                let mut after = Vec::with_capacity(bodies.len());
                for (number, (body, member)) in bodies.iter().zip(&self.members).enumerate() {
                    let torque = member.held(held, number);
                    let next = body.stepped(self.method, member, torque, &pieces, go_on);
                    after.push(next.map_err(|error| (number, error))?);
                }
                *bodies = after;
            }
            Bodies::Lanes(groups) => {
                let count: u64 = pieces.iter().map(|steps| steps.count).sum();
                let together = (TOGETHER / self.members.len() as u64).max(1);
                let before = (count > together).then(|| groups.states());
                for steps in &pieces {
                    for first in (0..steps.count).step_by(together as usize) {
                        let last = steps.count.min(first + together);
                        groups.step(&self.members, held, steps, first..last);
                        if let Some(before) = &before
                            && !go_on()
                        {
                            groups.restore(before);
                            return Err((0, SimulateError::Interrupted));
                        }
                    }
                }
            }
        }
        for (member, center) in self.members.iter_mut().zip(centers) {
            member.center = center;
        }
        if let Bodies::Alone(bodies) = &self.bodies {
            for (member, body) in
                self.members.iter_mut().zip(bodies).filter(|(member, _)| member.law.is_none())
            {
                member.center = body.center();
            }
        }
        self.time = self.time_after(dt);
        Ok(())
    }

    /// The centres of mass that move in closed form after a step, none if all rest.
    fn centers_after(&self, dt: f64) -> Result<Vec<Center>, Failed> {
        let moving = if self.moves { &self.members[..] } else { &[] };
        let after = |(body, member): (usize, &Member)| {
            let center = member.law.map_or(member.center, |law| law.after(&member.center, dt.into()));
            let [time, _] = self.time_after(dt);
            if center.is_finite() { Ok(center) } else { Err((body, SimulateError::Diverged { time })) }
        };
        moving.iter().enumerate().map(after).collect()
    }

    /// A step of length `dt` in pieces of equal steps, which end where a law jumps.
    fn pieces(&self, dt: f64) -> Vec<Steps> {
        let (from, [to, _]) = (self.time(), self.time_after(dt));
        let mut pieces = Vec::with_capacity(1);
        let mut begin = from;
        while begin != to || pieces.is_empty() {
            let end = next_stop(&self.jumps, begin, to);
            let dt = if (begin, end) == (from, to) { dt } else { end - begin };
            let count = step_count(dt, self.longest) as u64;
            pieces.push(Steps { from: begin, to: end, dt, count });
            begin = end;
        }
        pieces
    }

    /// Writes rotors (body axes to space) and angular velocities in body axes.
    pub fn write(&self, rotors: &mut [[f64; 4]], omegas: &mut [[f64; 3]]) {
        match &self.bodies {
            Bodies::Alone(bodies) => {
                for (number, (body, member)) in bodies.iter().zip(&self.members).enumerate() {
                    let (rotor, omega) = body.spin(member);
                    (rotors[number], omegas[number]) = (rotor.components(), omega.0);
                }
            }
            Bodies::Lanes(groups) => groups.write(rotors, omegas),
        }
    }

    /// The centres of mass.
    pub fn centers(&self) -> impl ExactSizeIterator<Item = Center> + '_ {
        self.members.iter().map(|member| member.center)
    }

    /// A step of the method that turns a body too far is an error.
    fn check_turns(&self, h: f64) -> Result<(), Failed> {
        let fastest = LARGEST_TURN / h.abs();
        let too_fast = match &self.bodies {
            Bodies::Alone(bodies) => bodies
                .iter()
                .zip(&self.members)
                .map(|(body, member)| body.spin(member).1.norm())
                .enumerate()
                .find(|(_, rate)| *rate > fastest),
            Bodies::Lanes(groups) => groups.faster_than(fastest),
        };
        match too_fast {
            Some((body, rate)) => {
                Err((body, SimulateError::StepTurnsTooFar { step: h, turn: rate * h.abs() }))
            }
            None => Ok(()),
        }
    }
}

/// Steps of bodies in lanes that take some milliseconds.
const TOGETHER: u64 = 1 << 15;

/// Equal steps from one time to another, dt later.
#[derive(Clone, Copy, Debug)]
struct Steps {
    from: f64,
    to: f64,
    dt: f64,
    count: u64,
}

impl Steps {
    /// Begin and length of each; the lengths are differences of rounded times, so that they add up.
    #[inline(always)]
    fn nth(&self, k: u64) -> (f64, f64) {
        let time = |k: u64| {
            if k == self.count { self.to } else { self.from + self.dt * (k as f64 / self.count as f64) }
        };
        (time(k), time(k + 1) - time(k))
    }
}

impl Member {
    /// Its wheels with motors.
    fn wheels(&self) -> impl Iterator<Item = &Wheels> {
        self.torques
            .iter()
            .filter_map(|law| if let Torque::Wheels(wheels) = law { Some(&**wheels) } else { None })
    }

    fn new(ensemble: &Ensemble, body: usize) -> Result<Member, SimulateError> {
        let laws: Vec<Torque> = ensemble.laws.iter().map(|law| law.of(body).clone()).collect();
        let (inertia, laws) = carrier(ensemble.inertias.of(body), &laws);
        let frame = inertia.principal_frame();
        let mass = *ensemble.masses.of(body);
        let torques: Vec<Torque> = laws.into_iter().map(|law| law.in_axes(frame).with_mass(mass)).collect();
        let law = if torques.iter().any(Torque::reads_center) {
            None
        } else {
            center_law(ensemble.forces_on(body), mass)
        };
        let other = || Translation {
            mass,
            forces: ensemble.forces_on(body).map(|force| force.clone().in_axes(frame)).collect(),
        };
        Ok(Member {
            frame,
            gyrostat: Gyrostat { moments: inertia.principal_moments(), wheel: wheel(&torques) },
            given: torques.clone(),
            torques,
            center: Center::default(),
            law,
            translation: law.is_none().then(other),
        })
    }

    /// A start in principal axes.
    fn phase(&self, start: &Start) -> Phase {
        let omega = self.frame.reverse().apply_bivector(start.omega);
        Phase { rotor: start.rotor * self.frame, momentum: self.gyrostat.momentum(omega), time: start.time }
    }

    /// Whether its centre of mass moves.
    fn moves(&self) -> bool {
        !self.law.is_some_and(|law| law.is_zero()) || self.center.velocity != Vector::default()
    }

    /// The held torque of a body, in principal axes or in space.
    fn held(&self, held: Held<'_>, body: usize) -> Option<Torque> {
        let torque = held.of(body);
        (torque != Bivector::default()).then(|| match held.axes {
            Axes::Body => Torque::ConstantBody(self.frame.reverse().apply_bivector(torque)),
            Axes::Space => Torque::ConstantSpace(torque),
        })
    }
}
