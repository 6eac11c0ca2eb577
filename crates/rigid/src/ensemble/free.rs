//! Free bodies of an ensemble in closed form: side by side at few times, otherwise each with its times in lanes.

use super::exact::METHOD;
use super::member::{Member, Outcome, of};
use super::monitor::{LaneMonitor, LaneStates};
use super::observe::{LaneBodies, LanePhases};
use super::scheduler::Scheduler;
use crate::exact::free::{FreeBody, FreeMotions};
use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::run::certificate::{Certificate, larger};
use crate::run::closed_form::{ElapsedTime, check_kept};
use crate::state::checks::check_horizons;
use crate::state::phase::Gyrostat;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::threads::Threads;
use std::array::from_fn;
use std::borrow::Cow;
use std::slice;

impl<'a> Scheduler<'a> {
    /// Writes the motions of as many free bodies as there are lanes.
    pub(super) fn free(&self, mut members: Vec<Member<'a>>) {
        let bodies: [FreeBody; TOGETHER] = from_fn(|l| free_body(&members[l]));
        let mut motions = FreeMotions::default();
        motions.set_up(&bodies);
        let (mut checks, mut rows) = (Checks::new(&members), Rows::default());
        for (index, &time) in self.times.iter().enumerate() {
            let elapsed = from_fn(|l| time - members[l].start.time);
            motions.at(&elapsed, &mut rows.rotors, &mut rows.omegas);
            checks.record(&[time; TOGETHER], TOGETHER, &mut rows);
            for (l, Member { own, .. }) in members.iter_mut().enumerate() {
                own.rotors.as_chunks_mut().0[index] = rows.rotors[l];
                own.omegas.as_chunks_mut().0[index] = rows.omegas[l];
            }
        }
        for (l, member) in members.into_iter().enumerate() {
            self.finish_free(member, motions.horizon(l, &bodies[l]), checks.of_lane(l));
        }
    }

    /// Writes the motion of a free body.
    pub(super) fn free_alone(&self, mut member: Member<'a>) {
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
        self.finish_free(member, motion.horizon(), checks.of_all_lanes());
    }

    /// Completes the motion of a free body, whose rotors and angular velocities are written: momentum and energy are those
    /// of the start.
    fn finish_free(&self, mut member: Member<'a>, horizon: f64, certificate: Certificate) {
        let Member { body, gyrostat, start, ref mut own, .. } = member;
        let checked = check_horizons(start.time, self.times, [horizon; 2]);
        if let Err(error) = checked.and_then(|()| check_kept(&certificate.drifts)) {
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
        self.count(&mut 0, 1.0, 1);
        self.record([Outcome { body, certificate, failure: None }]);
    }
}

pub(super) fn free_body(Member { frame, gyrostat, start, omega, .. }: &Member<'_>) -> FreeBody {
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
    gyrostats: Vec<Gyrostat>,
    /// None.
    torques: Vec<Cow<'static, [Torque]>>,
    since: Vec<ElapsedTime<'static>>,
    monitor: LaneMonitor<TOGETHER>,
    norm_drifts: [f64; TOGETHER],
}

impl Checks {
    /// Lanes beyond the members are of the first one.
    fn new(members: &[Member]) -> Checks {
        let gyrostats: Vec<Gyrostat> = (0..TOGETHER).map(|l| of(members, l).gyrostat).collect();
        let torques = vec![Cow::Borrowed(&[][..]); TOGETHER];
        let since = |member: &Member| ElapsedTime::new(member.start.time, member.gyrostat, &[]);
        let bodies = LaneBodies::new(members);
        let starts = bodies.points(LanePhases::starts(members));
        Checks {
            monitor: LaneMonitor::new(&LaneStates::new(starts, (&gyrostats, &torques), 0.0)),
            since: (0..TOGETHER).map(|l| since(of(members, l))).collect(),
            norm_drifts: [0.0; TOGETHER],
            bodies,
            gyrostats,
            torques,
        }
    }

    /// Measures the first lanes, with states at the rounded times since the start, and moves these to the exact times.
    fn record(&mut self, times: &[f64; TOGETHER], count: usize, rows: &mut Rows) {
        let mut phases = self.bodies.phases(&rows.rotors, &rows.omegas);
        let mut moved = [false; TOGETHER];
        for l in 0..count {
            moved[l] = self.since[l].elapsed(times[l]).lo != 0.0;
            if moved[l] {
                phases.set(l, &self.since[l].at(phases.phase(l, times[l])));
            }
        }
        let points = self.bodies.points(phases);
        for l in (0..count).filter(|&l| moved[l]) {
            let (rotor, omega) = points.in_body(l);
            (rows.rotors[l], rows.omegas[l]) = (rotor.components(), omega.0);
        }
        for l in 0..count {
            self.norm_drifts[l] = self.norm_drifts[l].max(points.off_unit.0[l]);
        }
        let states = LaneStates::new(points, (&self.gyrostats, &self.torques), 0.0);
        self.monitor.record(&states, &from_fn(|l| l >= count));
    }

    /// The certificate of the body of a lane.
    fn of_lane(&self, l: usize) -> Certificate {
        let drifts = self.monitor.finish(l).map(|(quantity, [start, drift])| (quantity, start, drift));
        let (drifts, norm_drift) = (drifts.collect(), self.norm_drifts[l]);
        Certificate { method: METHOD, drifts, norm_drift, ..Certificate::default() }
    }

    /// The certificate of a body that has all lanes.
    fn of_all_lanes(&self) -> Certificate {
        let mut all = self.of_lane(0);
        for l in 1..TOGETHER {
            let one = self.of_lane(l);
            all.norm_drift = all.norm_drift.max(one.norm_drift);
            let pairs = all.drifts.iter_mut().zip(one.drifts);
            pairs.for_each(|(all, one): (&mut (Conserved, f64, f64), _)| all.2 = larger(all.2, one.2));
        }
        all
    }
}
