//! Free bodies of an ensemble in closed form: side by side at few times, otherwise each with its times in lanes.

use super::columns::Record;
use super::exact::METHOD;
use super::member::{Member, of};
use super::monitor::{LaneMonitor, LaneStates};
use super::observe::{LaneBodies, LanePhases};
use super::scheduler::Scheduler;
use crate::exact::free::{FreeBody, FreeMotions};
use crate::exact::many::TIMES_IN_LANES;
use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::run::Progress;
use crate::run::certificate::larger;
use crate::run::closed_form::{ElapsedTime, check_kept};
use crate::state::checks::check_horizons;
use crate::state::phase::Gyrostat;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::threads::Threads;
use std::array::from_fn;
use std::borrow::Cow;
use std::slice;

impl<'a> Scheduler<'a> {
    /// Writes the motions of the unassigned bodies, none of which has a torque, until none is left.
    pub(super) fn free_bodies(&self, threads: usize, progress: &mut dyn FnMut(Progress) -> bool) {
        let together = if self.times.len() < TIMES_IN_LANES { TOGETHER } else { 1 };
        let mut motions = FreeMotions::default();
        let mut members = Vec::with_capacity(together);
        while let Some(share) = self.next_bodies(threads, together) {
            for (body, own) in share {
                let member = self.member(body, own);
                if !self.is_sound(&member) {
                    // The error is reported as for a single body.
                    self.run_single(body, member.own, progress);
                    continue;
                }
                members.push(member);
                if members.len() == together {
                    self.free(&mut members, &mut motions);
                }
            }
            self.report(progress);
        }
        if !members.is_empty() && !self.is_stopped() {
            self.free(&mut members, &mut motions);
            self.report(progress);
        }
    }

    /// Writes the motions of free bodies, at most as many as there are lanes, and leaves none.
    fn free(&self, members: &mut Vec<Member<'a>>, motions: &mut FreeMotions<TOGETHER>) {
        // The lanes hold all bodies at a time, or the times of one body.
        let alone = members.len() * self.times.len().div_ceil(TOGETHER);
        if alone <= self.times.len() / 2 || members.len() == 1 {
            return members.drain(..).for_each(|member| self.free_alone(member));
        }
        motions.set_up(&from_fn(|l| free_body(of(members, l))));
        let (mut checks, mut rows) = (Checks::new(members), Rows::default());
        let starts: [f64; TOGETHER] = from_fn(|l| of(members, l).start.time);
        for (index, &time) in self.times.iter().enumerate() {
            motions.at(&starts.map(|start| time - start), &mut rows.rotors, &mut rows.omegas);
            checks.record(&[time; TOGETHER], members.len(), &mut rows);
            for (l, Member { own, .. }) in members.iter_mut().enumerate() {
                own.rotors.as_chunks_mut().0[index] = rows.rotors[l];
                own.omegas.as_chunks_mut().0[index] = rows.omegas[l];
            }
        }
        let method = self.columns.method(METHOD);
        self.count(&mut 0, 1.0, members.len());
        for (l, member) in members.iter_mut().enumerate() {
            let (horizon, norm_drift) = (motions.horizons[l], checks.norm_drifts[l]);
            self.finish_free(member, method, horizon, norm_drift, checks.monitor.finish(l));
        }
        members.clear();
    }

    /// Writes the motion of a free body.
    fn free_alone(&self, mut member: Member<'a>) {
        let (motion, start) = (free_body(&member).motion(), member.start.time);
        let mut checks = Checks::new(slice::from_ref(&member));
        let elapsed: Vec<f64> = self.times.iter().map(|time| time - start).collect();
        let own = &mut member.own;
        motion.at_many(Threads::ONE, &elapsed, own.rotors, own.omegas);
        let rotors = own.rotors.as_chunks_mut().0.chunks_mut(TOGETHER);
        let omegas = own.omegas.as_chunks_mut().0.chunks_mut(TOGETHER);
        let mut rows = Rows::default();
        for ((times, rotors), omegas) in self.times.chunks(TOGETHER).zip(rotors).zip(omegas) {
            let count = times.len();
            rows.rotors[..count].copy_from_slice(rotors);
            rows.omegas[..count].copy_from_slice(omegas);
            checks.record(&from_fn(|l| times[l.min(count - 1)]), count, &mut rows);
            rotors.copy_from_slice(&rows.rotors[..count]);
            omegas.copy_from_slice(&rows.omegas[..count]);
        }
        let (norm_drift, drifts) = checks.of_all_lanes();
        self.count(&mut 0, 1.0, 1);
        self.finish_free(&mut member, self.columns.method(METHOD), motion.horizon(), norm_drift, drifts);
    }

    /// Completes the motion of a free body, whose rotors and angular velocities are written: momentum and energy are those
    /// of the start.
    fn finish_free(
        &self,
        member: &mut Member<'a>,
        method: usize,
        horizon: f64,
        norm_drift: f64,
        drifts: impl Iterator<Item = (Conserved, [f64; 2])> + Clone,
    ) {
        let Member { body, gyrostat, start, ref mut own, .. } = *member;
        let checked = check_horizons(start.time, self.times, [horizon; 2]);
        let changes = drifts.clone().map(|(quantity, [_, change])| (quantity, change));
        if let Err(error) = checked.and_then(|()| check_kept(changes)) {
            return self.fail(body, own, METHOD, error);
        }
        let momentum = start.rotor.apply_bivector(start.momentum);
        own.momenta.as_chunks_mut::<3>().0.fill(momentum.0);
        own.energies.fill(gyrostat.kinetic(start.momentum));
        if own.centers.is_some() {
            let center = self.center(body);
            for (index, &time) in self.times.iter().enumerate() {
                own.place(index, &center.at(time));
            }
        }
        let estimate = f64::NAN;
        let record = Record { method, longest: 0.0, steps: 0, evaluations: 0, estimate, norm_drift };
        self.columns.record(body, record);
        drifts.for_each(|(quantity, numbers)| self.columns.drift(body, quantity, numbers));
    }
}

fn free_body(Member { frame, gyrostat, start, omega, .. }: &Member<'_>) -> FreeBody {
    FreeBody::in_frame(*frame, gyrostat.moments, start.rotor, *omega)
}

/// States of the lanes: rotors from body axes to space, and angular velocities in body axes.
struct Rows {
    rotors: [[f64; 4]; TOGETHER],
    omegas: [[f64; 3]; TOGETHER],
}

impl Default for Rows {
    fn default() -> Rows {
        Rows { rotors: [[1.0, 0.0, 0.0, 0.0]; TOGETHER], omegas: [[0.0; 3]; TOGETHER] }
    }
}

/// Measures states of free bodies in lanes, with the bits of a single body.
struct Checks {
    bodies: LaneBodies<TOGETHER>,
    gyrostats: [Gyrostat; TOGETHER],
    starts: [f64; TOGETHER],
    monitor: LaneMonitor<TOGETHER>,
    norm_drifts: [f64; TOGETHER],
}

/// The torques of the lanes: none.
const NO_TORQUES: [Cow<'static, [Torque]>; TOGETHER] = [const { Cow::Borrowed(&[]) }; TOGETHER];

impl Checks {
    /// Lanes beyond the members are of the first one.
    fn new(members: &[Member]) -> Checks {
        let gyrostats = from_fn(|l| of(members, l).gyrostat);
        let bodies = LaneBodies::new(members);
        let starts = bodies.points(LanePhases::starts(members));
        Checks {
            monitor: LaneMonitor::new(&LaneStates::new(&starts, (&gyrostats, &NO_TORQUES), 0.0)),
            starts: from_fn(|l| of(members, l).start.time),
            norm_drifts: [0.0; TOGETHER],
            bodies,
            gyrostats,
        }
    }

    /// Measures the first lanes, with states at the rounded times since the start, and moves these to the exact times.
    fn record(&mut self, times: &[f64; TOGETHER], count: usize, rows: &mut Rows) {
        let mut phases = self.bodies.phases(&rows.rotors, &rows.omegas);
        let since = |l: usize| ElapsedTime::new(self.starts[l], self.gyrostats[l], &[]);
        let moved: [bool; TOGETHER] = from_fn(|l| since(l).elapsed(times[l]).lo != 0.0);
        for l in (0..count).filter(|&l| moved[l]) {
            phases.set(l, &since(l).at(phases.phase(l, times[l])));
        }
        let points = self.bodies.points(phases);
        for l in (0..count).filter(|&l| moved[l]) {
            let (rotor, omega) = points.in_body(l);
            (rows.rotors[l], rows.omegas[l]) = (rotor.components(), omega.0);
        }
        for l in 0..count {
            self.norm_drifts[l] = self.norm_drifts[l].max(points.off_unit.0[l]);
        }
        let states = LaneStates::new(&points, (&self.gyrostats, &NO_TORQUES), 0.0);
        self.monitor.record(&states, &from_fn(|l| l >= count));
    }

    /// The largest change of the norm and the drifts of a body that has all lanes.
    fn of_all_lanes(&self) -> (f64, impl Iterator<Item = (Conserved, [f64; 2])> + Clone) {
        let mut drifts: Vec<_> = self.monitor.finish(0).collect();
        for l in 1..TOGETHER {
            for ((_, [_, drift]), (_, [_, own])) in drifts.iter_mut().zip(self.monitor.finish(l)) {
                *drift = larger(*drift, own);
            }
        }
        (self.norm_drifts.iter().fold(0.0, |most, x| x.max(most)), drifts.into_iter())
    }
}
