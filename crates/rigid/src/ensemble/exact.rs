//! Bodies of an ensemble in closed form.

use super::member::{Member, Outcome};
use super::scheduler::Scheduler;
use crate::exact::free::{FreeBody, FreeMotions};
use crate::run::Progress;
use crate::run::certificate::{Certificate, DriftMonitor, off_unit};
use crate::run::closed_form::{ClosedForm, ElapsedTime, check_kept};
use crate::state::carried::Carried;
use crate::state::checks::check_horizons;
use crate::state::phase::Phase;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use std::array;

/// The name of the method in certificates.
const METHOD: &str = "exact";

impl<'a> Scheduler<'a> {
    /// Writes the motions of free bodies, at most as many as there are lanes, and leaves none.
    pub fn free(&self, members: &mut Vec<Member<'a>>, progress: &mut dyn FnMut(Progress) -> bool) {
        if members.is_empty() {
            return;
        }
        if members.len() == TOGETHER {
            let bodies: [FreeBody; TOGETHER] = array::from_fn(|l| free_body(&members[l]));
            let mut motions = FreeMotions::default();
            motions.set_up(&bodies);
            let (mut rotors, mut omegas) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
            for (index, &time) in self.times.iter().enumerate() {
                let elapsed = array::from_fn(|l| time - members[l].start.time);
                motions.at(&elapsed, &mut rotors, &mut omegas);
                for (l, Member { own, .. }) in members.iter_mut().enumerate() {
                    own.rotors.as_chunks_mut().0[index] = rotors[l];
                    own.omegas.as_chunks_mut().0[index] = omegas[l];
                }
            }
            for (l, member) in members.drain(..).enumerate() {
                self.finish_free(member, motions.horizon(l, &bodies[l]));
            }
        }
        for member in members.drain(..) {
            let (motion, start) = (free_body(&member).motion(), member.start.time);
            let elapsed: Vec<f64> = self.times.iter().map(|time| time - start).collect();
            motion.at_many(Threads::ONE, &elapsed, member.own.rotors, member.own.omegas);
            self.finish_free(member, motion.horizon());
        }
        self.report(progress);
    }

    /// Completes the motion of a free body from its rotors and angular velocities at the rounded times since the start;
    /// momentum and energy are those of the start.
    fn finish_free(&self, mut member: Member<'a>, horizon: f64) {
        let Member { body, frame, gyrostat, start, ref mut own, .. } = member;
        let center = self.center(body);
        if let Err(error) = check_horizons(start.time, self.times, [horizon; 2]) {
            return self.fail(body, own, METHOD, error);
        }
        let since = ElapsedTime::new(start.time, gyrostat, &[]);
        let momentum = start.rotor.apply_bivector(start.momentum);
        own.momenta.as_chunks_mut::<3>().0.fill(momentum.0);
        own.energies.fill(gyrostat.kinetic(start.momentum));
        let mut monitor = DriftMonitor::new(gyrostat, &[], start);
        let mut norm_drift = 0.0_f64;
        let states = own.rotors.as_chunks_mut::<4>().0.iter_mut().zip(own.omegas.as_chunks_mut::<3>().0);
        for (&time, (rotor, omega)) in self.times.iter().zip(states) {
            let whole = Rotor::from_unit_components(*rotor);
            let principal = frame.reverse().apply_bivector(Bivector(*omega));
            let mut phase = Phase { rotor: whole * frame, momentum: gyrostat.momentum(principal), time };
            let rest = since.elapsed(time).lo;
            if rest != 0.0 {
                phase = since.later(phase, rest);
                *rotor = (phase.rotor * frame.reverse()).components();
                *omega = frame.apply_bivector(gyrostat.omega(phase.momentum)).0;
            }
            norm_drift = norm_drift.max(off_unit(Rotor::from_unit_components(*rotor)));
            monitor.record(&phase);
        }
        for (index, &time) in self.times.iter().enumerate() {
            own.place(index, &center.at(time));
        }
        let drifts = monitor.finish();
        if let Err(error) = check_kept(&drifts) {
            return self.fail(body, own, METHOD, error);
        }
        let certificate = Certificate { method: METHOD, drifts, norm_drift, ..Certificate::default() };
        self.count(&mut 0, 1.0, 1);
        self.record([Outcome { body, certificate, failure: None }]);
    }

    /// Writes the motion of a body under a torque, by the rules for a single body.
    pub fn exact(&self, mut member: Member<'a>, closed: &ClosedForm) {
        let Member { body, frame, gyrostat, start, ref torques, ref mut own, .. } = member;
        if let Err(error) = check_horizons(start.time, self.times, closed.horizons()) {
            return self.fail(body, own, METHOD, error);
        }
        let mut monitor = DriftMonitor::new(gyrostat, torques, start);
        let mut norm_drift = 0.0_f64;
        for (index, Carried { phase, center, .. }) in closed.at_many(self.times).iter().enumerate() {
            monitor.record(phase);
            norm_drift = norm_drift.max(off_unit(phase.rotor));
            own.write(index, (frame, &gyrostat, torques), phase, center);
        }
        let drifts = monitor.finish();
        if let Err(error) = check_kept(&drifts) {
            return self.fail(body, own, METHOD, error);
        }
        let error_estimate = closed.neglected(self.times);
        let certificate =
            Certificate { method: METHOD, error_estimate, drifts, norm_drift, ..Certificate::default() };
        self.count(&mut 0, 1.0, 1);
        self.record([Outcome { body, certificate, failure: None }]);
    }
}

fn free_body(Member { frame, gyrostat, start, omega, .. }: &Member<'_>) -> FreeBody {
    FreeBody::in_frame(*frame, gyrostat.moments, start.rotor, *omega)
}
