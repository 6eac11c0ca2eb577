//! Free bodies of an ensemble, in closed form.

use super::member::{Member, Outcome};
use super::scheduler::Scheduler;
use crate::exact::free::FreeMotion;
use crate::run::certificate::{Certificate, DriftMonitor, off_unit};
use crate::run::closed_form::{ElapsedTime, check_kept};
use crate::state::checks::check_horizons;
use crate::state::phase::Phase;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use std::borrow::Cow;

impl<'a> Scheduler<'a> {
    /// Writes the motion of a free body, with the times in lanes; its momentum and energy are those of the start.
    pub fn free(&self, mut member: Member<'a>) {
        let Member { body, frame, gyrostat, start, ref mut own, .. } = member;
        let motion = FreeMotion::in_frame(frame, gyrostat.moments, start.rotor, member.omega);
        let method = "exact";
        if let Err(error) = check_horizons(start.time, self.times, [motion.horizon(); 2]) {
            return self.fail(body, own, method, error);
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
            own.place(index, &self.center(body, time));
        }
        let drifts = monitor.finish();
        if let Err(error) = check_kept(&drifts) {
            return self.fail(body, own, method, error);
        }
        let certificate = Certificate { method, drifts, norm_drift, ..Certificate::default() };
        self.count(&mut 0, 1.0, 1);
        self.record([Outcome { body, certificate, failure: None }]);
    }
}
