//! Bodies of an ensemble in closed form.

use super::member::{Member, Outcome};
use super::scheduler::Scheduler;
use crate::exact::free::FreeMotion;
use crate::run::certificate::{Certificate, DriftMonitor, off_unit};
use crate::run::closed_form::{ClosedForm, ElapsedTime, check_kept};
use crate::state::carried::Carried;
use crate::state::checks::check_horizons;
use crate::state::phase::Phase;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use std::borrow::Cow;

/// The name of the method in certificates.
const METHOD: &str = "exact";

impl<'a> Scheduler<'a> {
    /// Writes the motion of a free body, with the times in lanes; its momentum and energy are those of the start.
    pub fn free(&self, mut member: Member<'a>) {
        let Member { body, frame, gyrostat, start, ref mut own, .. } = member;
        let motion = FreeMotion::in_frame(frame, gyrostat.moments, start.rotor, member.omega);
        let center = self.center(body);
        if let Err(error) = check_horizons(start.time, self.times, [motion.horizon(); 2]) {
            return self.fail(body, own, METHOD, error);
        }
        let since = ElapsedTime::new(start.time, gyrostat, &[]);
        let elapsed: Cow<'_, [f64]> = match start.time {
            0.0 => self.times.into(),
            _ => self.times.iter().map(|&time| since.elapsed(time).hi).collect(),
        };
        motion.at_many(Threads::ONE, &elapsed, own.rotors, own.omegas);
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
