//! Motion: the solution of a problem, at and between its output times.

use super::certificate::{Certificate, DriftMonitor};
use super::engine::Engine;
use super::limits::StepBounds;
use super::output::BodyOutput;
use super::refine::SweepPlan;
use super::sweep::StepRule;
use super::{Problem, Progress};
use crate::error::SimulateError;
use crate::laws::conserved::Conserved;
use crate::laws::event::Occurrence;
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::checks::check_horizons;
use polhode_ga::{Bivector, Rotor};

/// A solved motion, which can be evaluated at and between its output times.
#[derive(Clone, Debug)]
pub struct Motion {
    pub(super) problem: Problem,
    pub(super) engine: Engine,
    pub(super) rule: StepRule,
    pub(super) bounds: StepBounds,
    /// In principal axes, at the output times, fewer if an event ended the motion.
    pub(super) states: Vec<Carried>,
    /// The events, in the order of integration.
    pub events: Vec<Occurrence>,
    /// Drift of conserved quantities and other data of the run.
    pub certificate: Certificate,
}

/// Points of a motion, in body axes.
#[derive(Clone, Debug, Default)]
pub struct States {
    /// In s.
    pub times: Vec<f64>,
    /// From body axes to space.
    pub rotors: Vec<Rotor>,
    /// Angular velocities in body axes, rad/s.
    pub omegas: Vec<Bivector>,
    /// Angular momenta in space, those of wheels included, kg m²/s.
    pub momenta_space: Vec<Bivector>,
    /// Kinetic energy and the potential energy of the laws that have one, J.
    pub energies: Vec<f64>,
    /// The centre of mass: m and m/s.
    pub centers: Vec<Center>,
}

impl Motion {
    /// Writes the states at the output times.
    pub(crate) fn write(&self, own: &mut BodyOutput) {
        let Problem { frame, body, torques, .. } = &self.problem;
        for (index, state) in self.states.iter().enumerate() {
            own.write(index, (*frame, body, torques), &state.phase, &state.center);
        }
    }

    /// The motion at its output times.
    pub fn states(&self) -> States {
        self.problem.states(&self.states)
    }

    /// Each conserved quantity, and its change since the start at the output times, relative as in the certificate.
    pub fn drifts(&self) -> Vec<(Conserved, Vec<f64>)> {
        let Problem { body, torques, .. } = &self.problem;
        let monitor = DriftMonitor::new(*body, torques, self.problem.start().phase);
        monitor.changes(self.states.iter().map(|state| &state.phase))
    }

    /// The points of the events.
    pub fn event_states(&self) -> States {
        let states: Vec<Carried> = self.events.iter().map(|occurrence| occurrence.at).collect();
        self.problem.states(&states)
    }

    /// The motion at any times between the first and the last, the start and the events included: by the same method
    /// and the same steps from the nearest output time before.
    pub fn at(
        &self,
        times: &[f64],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<States, SimulateError> {
        // A motion ended by an event extends to the event.
        let known = self.states.iter().chain(self.events.iter().map(|occurrence| &occurrence.at));
        let (first, last) = known.fold((self.problem.time, self.problem.time), |(a, b): (f64, f64), s| {
            (a.min(s.phase.time), b.max(s.phase.time))
        });
        if let Some(index) = times.iter().position(|t| !(first..=last).contains(t)) {
            return Err(SimulateError::OutsideMotion { index, time: times[index], first, last });
        }
        if let Some(states) = self.exactly(times) {
            return states;
        }
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|&i, &j| times[i].total_cmp(&times[j]));
        let rate = |state: &Carried| self.problem.body.omega(state.phase.momentum).norm();
        let known_rate = self.states.iter().map(rate).fold(0.0, f64::max);
        let rules = (SweepPlan { known_rate, ..SweepPlan::only(self.rule) }, &self.bounds);
        let mut found = vec![self.problem.start(); times.len()];
        for group in order.chunk_by(|&i, &j| self.nearest(times[i]) == self.nearest(times[j])) {
            let from = self.nearest(times[group[0]]).map_or(self.problem.start(), |k| self.states[k]);
            let wanted: Vec<f64> = group.iter().map(|&i| times[i]).collect();
            let sweep = self.problem.sweep_from(from, &self.engine, &wanted, rules, &[], progress)?;
            group.iter().zip(sweep.states).for_each(|(&i, state)| found[i] = state);
        }
        Ok(self.problem.states(&found))
    }

    /// How far from the start, in s, a motion in closed form is known backwards and forwards; none for others.
    pub fn horizons(&self) -> Option<[f64; 2]> {
        match &self.engine {
            Engine::ClosedForm(closed) => Some(closed.horizons()),
            _ => None,
        }
    }

    /// A motion in closed form at any times within its horizons; none for others.
    pub fn exactly(&self, times: &[f64]) -> Option<Result<States, SimulateError>> {
        let Engine::ClosedForm(closed) = &self.engine else { return None };
        let known = check_horizons(self.problem.time, times, closed.horizons());
        Some(known.map(|()| self.problem.states(&closed.at_many(times))))
    }

    /// The output time nearest to a time on the way from the start; none if that is the start itself.
    fn nearest(&self, time: f64) -> Option<usize> {
        let (start, at) = (self.problem.time, |k: usize| self.states[k].phase.time);
        let k = if time >= start {
            self.states.partition_point(|s| s.phase.time <= time).checked_sub(1).filter(|&k| at(k) >= start)
        } else {
            Some(self.states.partition_point(|s| s.phase.time < time))
                .filter(|&k| k < self.states.len() && at(k) <= start)
        };
        k.filter(|&k| at(k) != start)
    }
}
