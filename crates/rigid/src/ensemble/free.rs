//! Free bodies of an ensemble in closed form: side by side at few times, otherwise each with its times in lanes.

use super::checks::{Checks, Drift, NO_TORQUES, Rows};
use super::exact::METHOD;
use super::member::{Member, of};
use super::scheduler::Scheduler;
use crate::exact::free::{FreeBody, FreeMotions};
use crate::exact::lanes::SetUp;
use crate::exact::many::TIMES_IN_LANES;
use crate::run::Progress;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::threads::Threads;
use std::array::from_fn;
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
        if !self.are_together(members.len()) {
            return members.drain(..).for_each(|member| self.free_alone(member));
        }
        motions.set_up(&from_fn(|l| free_body(of(members, l))), members.len());
        let known = self.known(members, |l| Some([motions.horizons[l]; 2]));
        let (mut checks, mut rows) = (Checks::new(members, NO_TORQUES, known), Rows::default());
        let starts: [f64; TOGETHER] = from_fn(|l| of(members, l).start.time);
        for (index, &time) in self.times.iter().enumerate() {
            motions.at(&starts.map(|start| time - start), &mut rows.rotors, &mut rows.omegas);
            checks.free(&[time; TOGETHER], members.len(), &mut rows);
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
        let alone = slice::from_ref(&member);
        let known = self.known(alone, |_| Some([motion.horizon(); 2]));
        let mut checks = Checks::new(alone, NO_TORQUES, known);
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
            checks.free(&from_fn(|l| times[l.min(count - 1)]), count, &mut rows);
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
        drifts: impl Iterator<Item = Drift> + Clone,
    ) {
        let kept = self.kept(member, method, [horizon; 2], (norm_drift, drifts));
        let Member { body, gyrostat, start, ref mut own, .. } = *member;
        if let Err(error) = kept {
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
    }
}

fn free_body(Member { frame, gyrostat, start, omega, .. }: &Member<'_>) -> FreeBody {
    FreeBody::in_frame(*frame, gyrostat.moments, start.rotor, *omega)
}
