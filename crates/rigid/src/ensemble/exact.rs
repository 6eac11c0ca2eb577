//! Bodies of an ensemble under torques in closed form.

use super::checks::{Checks, Rows};
use super::member::{Member, Outcome, Waiting, of};
use super::scheduler::Scheduler;
use crate::exact::damped::DampedMotions;
use crate::exact::lagrange::{HeavyTop, LagrangeTops};
use crate::exact::lanes::SetUp;
use crate::run::Progress;
use crate::run::certificate::{Certificate, DriftMonitor, off_unit};
use crate::run::closed_form::{ClosedForm, ExactBody, check_kept};
use crate::state::carried::Carried;
use crate::state::checks::check_horizons;
use polhode_ga::rows::curve::TOGETHER;
use std::array::from_fn;

/// The name of the method in certificates.
pub(super) const METHOD: &str = "exact";

impl<'a> Scheduler<'a> {
    /// Takes a body. Writes the motions of those that wait as soon as there are as many as are computed together.
    pub fn exact(
        &self,
        waiting: &mut Waiting<'a>,
        member: (Member<'a>, ExactBody),
        progress: &mut dyn FnMut(Progress) -> bool,
    ) {
        waiting.members.push(member);
        if waiting.members.len() == self.exact_together() {
            self.write_exact(waiting, progress);
        }
    }

    /// Writes the motions of the bodies that wait, at most as many as there are lanes.
    pub fn write_exact(&self, waiting: &mut Waiting<'a>, progress: &mut dyn FnMut(Progress) -> bool) {
        let Waiting { members, tops, damped } = waiting;
        if members.is_empty() {
            return;
        }
        if self.are_together(members.len()) {
            self.side_by_side(members, tops, damped);
        }
        for (member, body) in members.drain(..) {
            self.alone(member, &body, progress);
        }
        self.report(progress);
    }

    /// Writes the motions of the bodies whose closed forms have lanes, and leaves the others.
    fn side_by_side(
        &self,
        members: &mut Vec<(Member<'a>, ExactBody)>,
        tops: &mut Option<Box<LagrangeTops<TOGETHER>>>,
        damped: &mut Option<Box<DampedMotions>>,
    ) {
        let bodies = || members.iter().map(|(_, body)| body);
        if let Some(bodies) = bodies().map(ExactBody::heavy).collect::<Option<Vec<HeavyTop>>>() {
            let motions = tops.get_or_insert_default();
            motions.set_up(&in_lanes(&bodies), bodies.len());
            let is_known = |l: usize| motions.has(l) && bodies[l].is_exact();
            let horizons = |l: usize| is_known(l).then_some([motions.horizons[l]; 2]);
            let at = |times: &_, rows: &mut Rows| motions.at(times, &mut rows.rotors, &mut rows.omegas);
            self.under_torques(members, horizons, at);
        } else if let Some(bodies) = bodies().map(ExactBody::damped).collect::<Option<Vec<_>>>() {
            let motions = damped.get_or_insert_default();
            motions.set_up(&in_lanes(&bodies), bodies.len());
            let horizons = |l: usize| motions.horizons[l].as_ref().ok().copied();
            let at = |times: &_, rows: &mut Rows| motions.at(times, &mut rows.rotors, &mut rows.omegas);
            self.under_torques(members, horizons, at);
        }
    }

    /// Writes the motions of the bodies whose horizons are known, from states in principal axes at the times of the lanes since
    /// their starts, and leaves the others.
    fn under_torques(
        &self,
        all: &mut Vec<(Member<'a>, ExactBody)>,
        horizons: impl Fn(usize) -> Option<[f64; 2]>,
        at: impl Fn(&[f64; TOGETHER], &mut Rows),
    ) {
        let count = all.len();
        let (mut members, bodies): (Vec<_>, Vec<_>) = all.drain(..).unzip();
        let torques = from_fn(|l| of(&members, l).torques.clone());
        let known = self.known(&members, |l| if l < count { horizons(l) } else { None });
        let (mut checks, mut rows) = (Checks::new(&members, torques, known), Rows::default());
        let centers: Vec<_> = members.iter().map(|member| self.center(member.body)).collect();
        let starts: [f64; TOGETHER] = from_fn(|l| of(&members, l).start.time);
        for (index, &time) in self.times.iter().enumerate() {
            at(&starts.map(|start| time - start), &mut rows);
            let (points, energies) = checks.under_torques(time, count, &rows);
            for (l, Member { own, .. }) in members.iter_mut().enumerate() {
                let (rotor, omega) = points.in_body(l);
                own.put(index, rotor, omega, points.momentum_of(l), energies[l]);
                own.place(index, &centers[l].at(time));
            }
        }
        let method = self.columns.method(METHOD);
        for (l, (mut member, body)) in members.into_iter().zip(bodies).enumerate() {
            let Some(horizons) = horizons(l) else {
                all.push((member, body));
                continue;
            };
            self.count(&mut 0, 1.0, 1);
            let found = (checks.norm_drifts[l], checks.monitor.finish(l));
            if let Err(error) = self.kept(&member, method, horizons, found) {
                self.fail(member.body, &mut member.own, METHOD, error);
            }
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
            Some(closed) if neglected.unwrap_or(0.0) <= most => self.finish(member, &closed, neglected),
            _ => self.run_single(member.body, member.own, progress),
        }
    }

    /// Writes the points of a body under torques, with the error of what its closed form neglects.
    fn finish(&self, mut member: Member<'a>, closed: &ClosedForm, error_estimate: Option<f64>) {
        let Member { body, frame, gyrostat, start, ref torques, ref mut own, .. } = member;
        self.count(&mut 0, 1.0, 1);
        if let Err(error) = check_horizons(start.time, self.times, closed.horizons()) {
            return self.fail(body, own, METHOD, error);
        }
        let mut monitor = DriftMonitor::new(gyrostat, torques, start);
        let mut norm_drift = 0.0_f64;
        for (index, Carried { phase, center, .. }) in closed.at_many(self.times).into_iter().enumerate() {
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
        self.record([Outcome { body, certificate, failure: None }]);
    }
}

/// One of some bodies for each lane, the first one for those beyond.
fn in_lanes<B: Copy>(bodies: &[B]) -> [B; TOGETHER] {
    from_fn(|l| bodies[if l < bodies.len() { l } else { 0 }])
}
