//! Bodies of an ensemble under torques in closed form.

use super::member::{Member, Outcome};
use super::scheduler::Scheduler;
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
use std::slice;

/// The name of the method in certificates.
pub(super) const METHOD: &str = "exact";

/// Members with what their closed form needs.
type Members<'a> = Vec<(Member<'a>, ExactBody)>;

impl<'a> Scheduler<'a> {
    /// Writes the motions of bodies under torques, at most as many as there are lanes, and leaves none.
    pub fn exact(&self, members: &mut Members<'a>, progress: &mut dyn FnMut(Progress) -> bool) {
        if members.is_empty() {
            return;
        }
        if members.len() == TOGETHER
            && let Some(tile) = ExactBody::tile(members.iter().map(|(_, body)| body))
        {
            self.under_torques(members, &tile);
        }
        for (member, body) in members.drain(..) {
            self.alone(member, &body, progress);
        }
        self.report(progress);
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
        if let Err(error) = check_kept(drifts.iter().map(|(quantity, _, change)| (*quantity, *change))) {
            return self.fail(body, own, METHOD, error);
        }
        let certificate =
            Certificate { method: METHOD, error_estimate, drifts, norm_drift, ..Certificate::default() };
        self.count(&mut 0, 1.0, 1);
        self.record([Outcome { body, certificate, failure: None }]);
    }
}
