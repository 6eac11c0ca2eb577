//! Bodies of an ensemble in closed form.

use super::member::{Member, Outcome};
use super::scheduler::Scheduler;
use crate::exact::free::{FreeBody, FreeMotions};
use crate::exact::many::{Tile, Times, at_each};
use crate::run::Progress;
use crate::run::certificate::{Certificate, DriftMonitor, off_unit};
use crate::run::closed_form::{ClosedForm, ElapsedTime, ExactBody, check_kept};
use crate::state::carried::Carried;
use crate::state::checks::check_horizons;
use crate::state::phase::Phase;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use std::{array, slice};

/// The name of the method in certificates.
const METHOD: &str = "exact";

/// Members with what their closed form needs.
type Members<'a> = Vec<(Member<'a>, ExactBody)>;

impl<'a> Scheduler<'a> {
    /// Writes the motions of bodies in closed form, at most as many as there are lanes, and leaves none.
    pub fn exact(&self, members: &mut Members<'a>, progress: &mut dyn FnMut(Progress) -> bool) {
        if members.is_empty() {
            return;
        }
        if members.len() == TOGETHER {
            if let Some((_, ExactBody::Free(_))) = members.first() {
                self.free(members);
            } else if let Some(tile) = ExactBody::tile(members.iter().map(|(_, body)| body)) {
                self.under_torques(members, &tile);
            }
        }
        for (member, body) in members.drain(..) {
            if let ExactBody::Free(_) = body {
                self.free_alone(member);
            } else {
                self.alone(member, &body, progress);
            }
        }
        self.report(progress);
    }

    /// Writes the motions of free bodies in lanes.
    fn free(&self, members: &mut Members<'a>) {
        let bodies: [FreeBody; TOGETHER] = array::from_fn(|l| free_body(&members[l].0));
        let mut motions = FreeMotions::default();
        motions.set_up(&bodies);
        let (mut rotors, mut omegas) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
        for (index, &time) in self.times.iter().enumerate() {
            let elapsed = array::from_fn(|l| time - members[l].0.start.time);
            motions.at(&elapsed, &mut rotors, &mut omegas);
            for (l, (Member { own, .. }, _)) in members.iter_mut().enumerate() {
                own.rotors.as_chunks_mut().0[index] = rotors[l];
                own.omegas.as_chunks_mut().0[index] = omegas[l];
            }
        }
        for (l, (member, _)) in members.drain(..).enumerate() {
            self.finish_free(member, motions.horizon(l, &bodies[l]));
        }
    }

    /// Writes the motion of a free body.
    fn free_alone(&self, member: Member<'a>) {
        let (motion, start) = (free_body(&member).motion(), member.start.time);
        let elapsed: Vec<f64> = self.times.iter().map(|time| time - start).collect();
        motion.at_many(Threads::ONE, &elapsed, member.own.rotors, member.own.omegas);
        self.finish_free(member, motion.horizon());
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
            if since.elapsed(time).lo != 0.0 {
                phase = since.at(phase);
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

    /// Writes the motions of bodies under torques, from their rotations in lanes.
    fn under_torques(&self, members: &mut Members<'a>, tile: &Tile) {
        let (each, all) = (self.times.len(), members.len() * self.times.len());
        let starts = members.iter().map(|(member, _)| member.start.time);
        let elapsed: Vec<f64> = starts.flat_map(|start| self.times.iter().map(move |t| t - start)).collect();
        let (mut rotors, mut omegas) = (vec![[0.0; 4]; all], vec![[0.0; 3]; all]);
        let rows = (rotors.as_flattened_mut(), omegas.as_flattened_mut());
        let times = Times::Own(&elapsed, each);
        at_each(Threads::ONE, slice::from_ref(tile), times, 0..all, rows.0, rows.1);
        for (l, (member, _)) in members.drain(..).enumerate() {
            let Member { body, gyrostat, start, .. } = member;
            let (since, center) =
                (ElapsedTime::new(start.time, gyrostat, member.torques.clone()), self.center(body));
            let states = rotors[l * each..].iter().zip(&omegas[l * each..]).zip(self.times);
            let points = states.map(|((rotor, omega), &time)| {
                let momentum = gyrostat.momentum(Bivector(*omega));
                let phase = Phase { rotor: Rotor::from_unit_components(*rotor), momentum, time };
                Carried::new(since.at(phase), center.at(time))
            });
            self.finish(member, tile.horizons()[l], points, None);
        }
    }

    /// Writes the motion of a body under torques, by the rules for a single body, or integrates it as one.
    fn alone(&self, member: Member<'a>, body: &ExactBody, progress: &mut dyn FnMut(Progress) -> bool) {
        let center = self.center(member.body);
        let closed =
            body.motion().map(|motion| ClosedForm::with(member.gyrostat, motion, &member.torques, center));
        let most = self.options.rtol.filter(|_| !self.options.exact).unwrap_or(f64::INFINITY);
        let neglected = closed.as_ref().and_then(|closed| closed.neglected(self.times));
        match closed {
            Some(closed) if neglected.unwrap_or(0.0) <= most => {
                self.finish(member, closed.horizons(), closed.at_many(self.times), neglected);
            }
            _ => self.run_single(member.body, member.own, progress),
        }
    }

    /// Writes the points of a body under torques, with the error of what its closed form neglects.
    fn finish(
        &self,
        mut member: Member<'a>,
        horizons: [f64; 2],
        points: impl IntoIterator<Item = Carried>,
        error_estimate: Option<f64>,
    ) {
        let Member { body, frame, gyrostat, start, ref torques, ref mut own, .. } = member;
        if let Err(error) = check_horizons(start.time, self.times, horizons) {
            return self.fail(body, own, METHOD, error);
        }
        let mut monitor = DriftMonitor::new(gyrostat, torques, start);
        let mut norm_drift = 0.0_f64;
        for (index, Carried { phase, center, .. }) in points.into_iter().enumerate() {
            monitor.record(&phase);
            norm_drift = norm_drift.max(off_unit(phase.rotor));
            own.write(index, (frame, &gyrostat, torques), &phase, &center);
        }
        let drifts = monitor.finish();
        if let Err(error) = check_kept(&drifts) {
            return self.fail(body, own, METHOD, error);
        }
        let certificate =
            Certificate { method: METHOD, error_estimate, drifts, norm_drift, ..Certificate::default() };
        self.count(&mut 0, 1.0, 1);
        self.record([Outcome { body, certificate, failure: None }]);
    }
}

fn free_body(Member { frame, gyrostat, start, omega, .. }: &Member<'_>) -> FreeBody {
    FreeBody::in_frame(*frame, gyrostat.moments, start.rotor, *omega)
}
