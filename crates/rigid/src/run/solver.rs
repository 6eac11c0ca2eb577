//! The motion of a problem by one method: in closed form, or by sweeps of steps.

use super::accuracy::{Accuracy, Scales};
use super::certificate::{Certificate, DriftMonitor, off_unit};
use super::closed_form::{ClosedForm, check_kept};
use super::engine::Engine;
use super::limits::{StepBounds, span};
use super::refine::{Converged, Convergence, SweepPlan};
use super::stops::{aliasing_warning, force_aliasing_warning, is_aliased, is_aliased_force, turn_warning};
use super::sweep::{Integrator, Progress, StepRule, Sweep, is_finite};
use super::{Motion, NO_CLOSED_FORM, Options, Problem};
use crate::error::SimulateError;
use crate::laws::event::Event;
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::state::carried::Carried;
use crate::state::checks::check_horizons;

impl Problem {
    /// The motion by one method.
    pub(super) fn run(
        &self,
        times: &[f64],
        options: &Options,
        bounds: StepBounds,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Motion, SimulateError> {
        let closed = self.closed_form().filter(|_| options.method.is_none() && options.step.is_none());
        let neglected = closed.as_ref().and_then(|closed| closed.neglected(times));
        let fine = neglected.unwrap_or(0.0) <= options.rtol.unwrap_or(f64::INFINITY);
        let closed = closed.filter(|_| options.exact || fine);
        if options.exact && closed.is_none() {
            return Err(SimulateError::Unfit { method: "exact", reason: NO_CLOSED_FORM });
        }
        let center = self.center_motion();
        let method = options.method.unwrap_or_else(|| self.best());
        let translation = self.translation.clone().filter(|_| center.is_none());
        let (engine, name) = match closed {
            Some(closed) => {
                check_horizons(self.time, times, closed.horizons())?;
                (Engine::ClosedForm(Box::new(closed)), "exact")
            }
            None => (
                Engine::new(method, self.body, &self.torques, translation, &self.start().phase)?
                    .with_least_speed(bounds.least_speed),
                method.name(),
            ),
        };
        let events: Vec<Event> =
            options.events.iter().map(|event| event.clone().in_axes(self.frame)).collect();
        let (rule, sweep, error) = match (&engine, options.step) {
            (Engine::ClosedForm(closed), _) => {
                let plan = SweepPlan::only(self.steps_of_turn(1.0, times, &bounds));
                let sweep = if events.is_empty() {
                    self.sampled(closed, times, progress)?
                } else {
                    self.sweep(&engine, times, (plan, &bounds), &events, progress)?
                };
                (plan.rule, sweep, neglected)
            }
            (_, Some(step)) => {
                let plan = SweepPlan::only(StepRule::equal(step.min(bounds.longest)));
                (plan.rule, self.sweep(&engine, times, (plan, &bounds), &events, progress)?, None)
            }
            (_, None) => {
                let accuracy = Accuracy::new(method.order(), options.rtol);
                let first = if method.adapts() {
                    accuracy.first_steps()
                } else {
                    self.steps_of_turn(method.first_turn(), times, &bounds)
                };
                let found = self.converge(&engine, times, (first, accuracy, &bounds), &events, progress)?;
                (found.rule, found.sweep, Some(found.error))
            }
        };
        if let Some(state) = sweep.states.iter().find(|s| !is_finite(s)) {
            return Err(SimulateError::Diverged { time: state.phase.time });
        }
        let exact = name == "exact";
        let warnings = options.step.map_or(Vec::new(), |step| self.warnings(times, step, (method, &sweep)));
        let certificate = Certificate {
            method: name,
            step: if exact { 0.0 } else { sweep.longest },
            steps: if exact { 0 } else { sweep.steps },
            evaluations: sweep.evaluations,
            error_estimate: error,
            drifts: sweep.drifts,
            norm_drift: sweep.states.iter().map(|s| off_unit(s.phase.rotor)).fold(0.0, f64::max),
            warnings,
        };
        Ok(Motion {
            problem: self.clone(),
            engine,
            rule,
            bounds,
            states: sweep.states,
            events: sweep.events,
            certificate,
        })
    }

    /// Equal steps in which the body turns by at most an angle in rad at first.
    fn steps_of_turn(&self, turn: f64, times: &[f64], bounds: &StepBounds) -> StepRule {
        let rate = self.rate();
        let longest = times.iter().fold(0.0, |m: f64, t| m.max((t - self.time).abs()));
        let step = if rate > 0.0 { turn / rate } else { longest.max(1.0) };
        StepRule::equal(step.min(bounds.longest))
    }

    /// Sweeps with ever shorter steps, until two of them agree.
    fn converge(
        &self,
        engine: &Engine,
        times: &[f64],
        (first, accuracy, bounds): (StepRule, Accuracy, &StepBounds),
        events: &[Event],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Converged, SimulateError> {
        let center = self.center_motion();
        let follow = |from: &Carried, time: f64| {
            let mut to = engine.step(from, time - from.phase.time, 0.0).map_or(*from, |(to, _)| to);
            center.iter().for_each(|center| to.center = center.at(time));
            to
        };
        let [begin, end] = span(times, self.time);
        let scales = Scales {
            body: self.body,
            duration: end - begin,
            rounding: engine.rounding(),
            in_space: engine.is_in_space(),
            is_smooth: bounds.is_smooth()
                && !self.torques.iter().any(Torque::has_kinks)
                && !self.forces().iter().any(Force::has_kinks),
        };
        let mut sweeps = Convergence::new(first, accuracy, scales);
        loop {
            match self.sweep(engine, times, (sweeps.next(), bounds), events, progress) {
                Err(error) => sweeps.take_error(error)?,
                Ok(sweep) => {
                    if let Some(found) = sweeps.take(sweep, &follow)? {
                        return Ok(found);
                    }
                }
            }
        }
    }

    /// Warnings for fixed steps that are too long for the laws, or for the turns of the body.
    fn warnings(&self, times: &[f64], step: f64, (method, sweep): (Method, &Sweep)) -> Vec<String> {
        let start = self.start();
        let span = span(times, start.phase.time);
        let at = self.point(&start);
        let is_aliased = |law: &&Torque| is_aliased(law, &at, span, step);
        let aliased = self.torques.iter().filter(is_aliased).map(|law| aliasing_warning(law, step));
        let forces = self.forces().iter().filter(|force| is_aliased_force(force, &at, span, step));
        let aliased = aliased.chain(forces.map(|force| force_aliasing_warning(force, step)));
        let states = [&start].into_iter().chain(&sweep.states);
        let fastest = states.map(|state| self.body.omega(state.phase.momentum).norm()).fold(0.0, f64::max);
        let too_far = method.turns_too_far(&self.body, fastest, sweep.longest);
        aliased.chain(too_far.then(|| turn_warning(step))).collect()
    }

    /// One sweep over the times.
    fn sweep(
        &self,
        engine: &Engine,
        times: &[f64],
        order: (SweepPlan, &StepBounds),
        events: &[Event],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Sweep, SimulateError> {
        self.sweep_from(self.start(), engine, times, order, events, progress)
    }

    pub(super) fn sweep_from(
        &self,
        start: Carried,
        engine: &Engine,
        times: &[f64],
        (SweepPlan { rule, number, known_rate, noise, watches_jumps }, bounds): (SweepPlan, &StepBounds),
        events: &[Event],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Sweep, SimulateError> {
        let monitor = DriftMonitor::new(self.body, &self.torques, self.start().phase);
        let integrator = Integrator {
            body: self.body,
            engine,
            monitor,
            rule,
            rate: self.rate(),
            least_rate: bounds.least_rate.max(known_rate),
            noise,
            bounds,
            events,
            center: self.center_motion(),
            watches_jumps,
            origin: self.time,
            mass: self.mass,
            number,
            progress,
        };
        integrator.sweep(start, times)
    }

    /// The closed form at all times, as a sweep without steps. An error if it drifts in a conserved quantity.
    fn sampled(
        &self,
        closed: &ClosedForm,
        times: &[f64],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Sweep, SimulateError> {
        /// Times between calls of `progress`.
        const TOGETHER: usize = 1 << 14;
        let mut states = Vec::with_capacity(times.len());
        let mut monitor = DriftMonitor::new(self.body, &self.torques, self.start().phase);
        for some in times.chunks(TOGETHER) {
            states.extend(closed.at_many(some));
            states[states.len() - some.len()..].iter().for_each(|state| monitor.record(&state.phase));
            let fraction = states.len() as f64 / times.len() as f64;
            if !progress(Progress { pass: 1, fraction }) {
                return Err(SimulateError::Interrupted);
            }
        }
        let drifts = monitor.finish();
        check_kept(drifts.iter().map(|(quantity, _, change)| (*quantity, *change)))?;
        Ok(Sweep { states, drifts, ..Sweep::default() })
    }
}
