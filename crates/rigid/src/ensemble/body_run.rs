//! Sweeps of one body in a lane, by the rules for a single body.

use super::member::{METHOD, Member, Outcome};
use super::scheduler::Scheduler;
use crate::error::SimulateError;
use crate::laws::torque::Torque;
use crate::methods::runge_kutta::{Points, RungeKutta};
use crate::methods::step_control::{StepController, next_stop};
use crate::methods::{ROUNDING_OF_RUNGE_KUTTA, fastest_rate};
use crate::run::accuracy::{Accuracy, Scales};
use crate::run::certificate::{Certificate, DriftMonitor, off_unit};
use crate::run::limits::{StepBounds, span};
use crate::run::noise::Noise;
use crate::run::refine::{Converged, Convergence, SweepPlan};
use crate::run::sweep::{StepRule, Sweep};
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::point::Point;
use std::mem;

/// A body in a lane, with the state of its sweeps.
pub(super) struct BodyRun<'a> {
    pub member: Member<'a>,
    bounds: StepBounds,
    /// The fastest rate of the laws and the body at the start, in rad/s.
    first_rate: f64,
    sweeps: Convergence,
    /// The current sweep, with its points in the order of integration.
    pub sweep: Sweep,
    /// Noise added to its points.
    pub noise: Option<Noise>,
    /// The start of all sweeps.
    begin: Carried,
    /// The largest angular velocity in the previous sweep.
    known_rate: f64,
    rule: StepRule,
    pub controller: StepController,
    /// The next stop.
    pub stop: f64,
    /// Why the last step was refused, if a law has no value within it.
    pub undefined: Option<SimulateError>,
    /// Parts of the run counted as done.
    so_far: u64,
}

impl<'a> BodyRun<'a> {
    pub fn new(member: Member<'a>, torques: &[Torque], scheduler: &Scheduler<'a>) -> BodyRun<'a> {
        let start = Carried::new(member.start, Center::default());
        let bounds = scheduler.bounds(&member, torques);
        let first_rate = fastest_rate(torques, &Point::at_rest(&member.gyrostat, &member.start));
        let accuracy = Accuracy::new(METHOD.order(), scheduler.options.rtol);
        let [first, last] = span(scheduler.times, member.start.time);
        let scales = Scales {
            body: member.gyrostat,
            duration: last - first,
            rounding: ROUNDING_OF_RUNGE_KUTTA,
            in_space: true,
            is_smooth: bounds.is_smooth() && !torques.iter().any(Torque::has_kinks),
        };
        let rule = accuracy.first_steps();
        BodyRun {
            rule,
            controller: rule.controller(first_rate, &bounds),
            member,
            bounds,
            first_rate,
            sweeps: Convergence::new(rule, accuracy, scales),
            sweep: Sweep::default(),
            noise: None,
            begin: start,
            known_rate: 0.0,
            stop: start.phase.time,
            undefined: None,
            so_far: 0,
        }
    }

    /// Begins the next sweep and returns its start.
    pub fn begin_sweep(&mut self) -> Carried {
        let SweepPlan { rule, known_rate, noise, .. } = self.sweeps.next();
        (self.rule, self.known_rate, self.noise) = (rule, known_rate, noise);
        self.leave_start();
        self.begin
    }

    /// Begins the integration on a side of the start.
    fn leave_start(&mut self) {
        self.controller = self.rule.controller(self.first_rate, &self.bounds);
        self.stop = self.begin.phase.time;
    }

    /// The magnitude of the angular velocity, bounded below by its scale, in rad/s.
    pub fn rate(&self, at: &Carried) -> f64 {
        self.member.gyrostat.omega(at.phase.momentum).norm().max(self.bounds.least_rate).max(self.known_rate)
    }

    /// Records the points at output times and sets the next stop, also on the other side of the start and in the next
    /// sweep. Returns the last sweep once it is accurate enough.
    pub fn proceed(
        &mut self,
        at: &mut Carried,
        fastest: &mut f64,
        times: &[f64],
    ) -> Result<Option<Converged>, SimulateError> {
        let early = times.partition_point(|&t| t < self.begin.phase.time);
        loop {
            let taken = self.sweep.states.len();
            self.sweep.update_largest(*fastest, &at.center);
            if taken == times.len() {
                let mut sweep = mem::take(&mut self.sweep);
                sweep.states[..early].reverse();
                if let Some(found) = self.sweeps.take(sweep, &|from, _| *from)? {
                    return Ok(Some(found));
                }
                *at = self.begin_sweep();
                *fastest = self.rate(at);
                continue;
            }
            let time = times[if taken < early { early - 1 - taken } else { taken }];
            if at.phase.time != time {
                let stop = next_stop(&self.bounds.breaks, at.phase.time, time);
                // A body that has changed lanes is on its way to this stop.
                if stop != self.stop {
                    self.controller.head_for(at.phase.time, stop);
                    self.stop = stop;
                }
                return Ok(None);
            }
            self.sweep.states.push(*at);
            if taken + 1 == early {
                *at = self.begin;
                self.leave_start();
                *fastest = self.rate(at);
            }
        }
    }

    /// Counts an accepted step.
    pub fn arrive<const W: usize, const F: bool>(
        &mut self,
        h: f64,
        next: &Points<W, F>,
        l: usize,
        scheduler: &Scheduler<'a>,
    ) -> Result<(), SimulateError> {
        self.sweep.steps += 1;
        self.sweep.longest = self.sweep.longest.max(h.abs());
        if !next.is_finite(l) {
            return Err(SimulateError::Diverged { time: next.time.0[l] });
        }
        let turn = self.member.gyrostat.omega(next.get(l).phase.momentum).norm() * h;
        let time = next.time.0[l];
        self.bounds.limit.check(self.sweep.steps, h, turn, || self.fraction(time, scheduler))
    }

    /// The error of a law that cannot be evaluated at the start of a step, from a single-body step; none if the step is just
    /// too long.
    #[cold]
    pub fn diagnose(&mut self, at: &Carried, h: f64, torques: &[Torque]) -> Result<(), SimulateError> {
        let alone = RungeKutta::new(self.member.gyrostat, torques.to_vec(), None);
        match alone.step(at, h, self.rate(at)) {
            Err(error @ SimulateError::Undefined { time, .. }) if time != at.phase.time => {
                self.undefined = Some(error);
                Ok(())
            }
            step => step.map(|_| ()),
        }
    }

    /// Updates the progress.
    pub fn count(&mut self, time: f64, scheduler: &Scheduler<'a>) {
        let fraction = self.fraction(time, scheduler);
        scheduler.count(&mut self.so_far, fraction, 1);
    }

    /// The fraction of a sweep done at a time.
    fn fraction(&self, time: f64, scheduler: &Scheduler<'a>) -> f64 {
        let start = self.begin.phase.time;
        let [first, last] = span(scheduler.times, start);
        let total = (last - first).max(f64::MIN_POSITIVE);
        (if self.stop < start { start - time } else { time - first }) / total
    }

    /// Writes the points and records the outcome.
    pub fn done(mut self, found: Converged, torques: &[Torque], scheduler: &Scheduler<'a>) {
        let Member { body, frame, gyrostat, start, ref mut own, .. } = self.member;
        let mut monitor = DriftMonitor::new(gyrostat, torques, start);
        let mut norm_drift = 0.0_f64;
        let center = scheduler.center(body);
        for (index, Carried { phase, .. }) in found.sweep.states.iter().enumerate() {
            monitor.record(phase);
            norm_drift = norm_drift.max(off_unit(phase.rotor));
            own.write(index, (frame, &gyrostat, torques), phase, &center.at(phase.time));
        }
        let certificate = Certificate {
            method: METHOD.name(),
            step: found.sweep.longest,
            steps: found.sweep.steps,
            evaluations: found.sweep.evaluations,
            error_estimate: Some(found.error),
            drifts: monitor.finish(),
            norm_drift,
            warnings: Vec::new(),
        };
        scheduler.count(&mut self.so_far, 1.0, 1);
        scheduler.record([Outcome { body, certificate, failure: None }]);
    }

    pub fn failed(mut self, error: SimulateError, scheduler: &Scheduler<'a>) {
        if let SimulateError::Stiff { .. } = error {
            // A single body is integrated by another method then.
            return scheduler.run_single(self.member.body, self.member.own, &mut |_| true);
        }
        scheduler.count(&mut self.so_far, 1.0, 1);
        scheduler.fail(self.member.body, &mut self.member.own, METHOD.name(), error);
    }
}
