//! Motion at given times: exact where there is a closed form, else by steps to a tolerance, with a certificate of
//! what was conserved.

use crate::certificate::{Certificate, Watch, off_unit};
use crate::closed_form::{ClosedForm, Fall, check_kept};
use crate::conserved::{Conserved, energy};
use crate::converge::{Aim, Convergence};
use crate::ensemble::Own;
use crate::event::{Event, Happened};
use crate::force::{Center, Force, Translation};
use crate::inertia::Inertia;
use crate::method::{Engine, Method, fastest_rate};
use crate::phase::{Gyrostat, Phase};
use crate::runge_kutta::Carried;
use crate::simulate_error::SimulateError;
use crate::torque::{Torque, wheel};
pub use crate::walk::Progress;
use crate::walk::{Pace, Pass, Walker, is_finite};
use polhode_ga::{Bivector, Rotor, Vector};

/// What to solve: a body and its state at time 0. Kept in principal axes.
#[derive(Clone, Debug)]
pub struct Problem {
    frame: Rotor,
    body: Gyrostat,
    rotor: Rotor,
    omega: Bivector,
    torques: Vec<Torque>,
    center: Center,
    /// NaN where nobody said it.
    mass: f64,
    translation: Option<Translation>,
}

/// How to solve it.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `None` is the closed form where there is one and no step is given, and else the best method for the laws.
    pub method: Option<Method>,
    /// A fixed step in s; `None` lets the tolerance choose it.
    pub step: Option<f64>,
    /// The relative error to reach where it chooses the step; `None` aims at 1e-10 and takes what rounding
    /// leaves of it.
    pub rtol: Option<f64>,
    /// Whether nothing but the closed form will do.
    pub exact: bool,
    /// What to look for on the way, with body components in body axes.
    pub events: Vec<Event>,
}

impl Options {
    /// What is wrong with them, or with the times, for any body.
    pub(crate) fn check(&self, times: &[f64]) -> Result<(), SimulateError> {
        for (index, &time) in times.iter().enumerate() {
            if !time.is_finite() || index > 0 && time < times[index - 1] {
                return Err(SimulateError::BadTime { index, time });
            }
        }
        for (what, value) in [("step", self.step.unwrap_or(1.0)), ("rtol", self.rtol.unwrap_or(1.0))] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SimulateError::BadValue { what, value });
            }
        }
        Ok(())
    }
}

pub(crate) const NO_CLOSED_FORM: &str = "is for motions in closed form, without a step: free bodies, symmetric ones under heavy along \
                              their axis, damping alone, spheres under larmor, and constant forces; leave the method \
                              out for others";

/// A motion at its output times, which may be asked for any other between them.
#[derive(Clone, Debug)]
pub struct Motion {
    problem: Problem,
    engine: Engine,
    pace: Pace,
    /// In principal axes, at the output times, fewer if an event ended the motion.
    states: Vec<Carried>,
    /// The events, in the order in which they were met.
    pub events: Vec<Happened>,
    /// What was conserved.
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

/// Times must not lie beyond the horizons, backwards and forwards, of an exact motion.
pub fn check_horizons(times: &[f64], horizons: [f64; 2]) -> Result<(), SimulateError> {
    let horizon = |time: f64| horizons[usize::from(time > 0.0)];
    match times.iter().position(|&t| t.abs() > horizon(t)) {
        Some(index) => {
            Err(SimulateError::BeyondHorizon { index, time: times[index], horizon: horizon(times[index]) })
        }
        None => Ok(()),
    }
}

/// Moments must be positive to turn momentum into rate.
pub(crate) fn check_moments(moments: [f64; 3]) -> Result<(), SimulateError> {
    if moments.iter().all(|i| *i > 0.0 && i.is_finite()) {
        return Ok(());
    }
    Err(SimulateError::SingularInertia { moments })
}

/// A body, its angular velocity and what turns it must be usable.
pub(crate) fn check_body(body: &Gyrostat, omega: Bivector, torques: &[Torque]) -> Result<(), SimulateError> {
    check_moments(body.moments)?;
    if let Some(&value) = omega.0.iter().find(|x| !x.is_finite()) {
        return Err(SimulateError::BadValue { what: "a component of the angular velocity", value });
    }
    let momentum = body.momentum(omega);
    let value = body.kinetic(momentum) + momentum.norm_squared();
    if !value.is_finite() {
        return Err(SimulateError::BadValue { what: "the energy of the rotation", value });
    }
    for torque in torques {
        let value = torque.size(body) + torque.damping_rate();
        if !value.is_finite() {
            return Err(SimulateError::BadValue { what: "the size of a torque", value });
        }
    }
    Ok(())
}

impl Problem {
    /// A body with its rotor (body axes to space) and its angular velocity and torques in body axes. The
    /// inertia is about the centre of mass, or about the fixed point if there is one.
    pub fn new(inertia: &Inertia, rotor: Rotor, omega: Bivector, torques: &[Torque]) -> Problem {
        let frame = inertia.principal_frame();
        let torques: Vec<Torque> = torques.iter().map(|t| t.clone().in_axes(frame)).collect();
        Problem {
            frame,
            body: Gyrostat { moments: inertia.principal_moments(), wheel: wheel(&torques) },
            rotor: rotor * frame,
            omega: frame.reverse().apply_bivector(omega),
            torques,
            center: Center::default(),
            mass: f64::NAN,
            translation: None,
        }
    }

    /// The same with the centre of mass at a place in space, and forces, with body components in body axes, on a mass
    /// in kg, which is NaN where nobody knows it.
    pub fn with_center(mut self, center: Center, mass: f64, forces: &[Force]) -> Problem {
        let forces: Vec<Force> = forces.iter().map(|f| f.clone().in_axes(self.frame)).collect();
        self.center = center;
        self.mass = mass;
        self.translation = (!forces.is_empty()).then_some(Translation { mass, forces });
        self
    }

    /// The motion at `times` (s, not decreasing, of either sign); the state given is that at time 0.
    ///
    /// Exact where there is a closed form, if nothing else is asked for. With no fixed step, runs with ever shorter steps
    /// until two of them agree within the tolerance in the rotor (of size 1) and in the angular velocity relative to its
    /// largest size.
    pub fn simulate(
        &self,
        times: &[f64],
        options: Options,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Motion, SimulateError> {
        self.check(times, &options)?;
        let closed = self.closed_form().filter(|_| options.method.is_none() && options.step.is_none());
        let neglected = closed.as_ref().and_then(|closed| closed.neglected(times));
        let fine = neglected.unwrap_or(0.0) <= options.rtol.unwrap_or(f64::INFINITY);
        let closed = closed.filter(|_| options.exact || fine);
        if options.exact && closed.is_none() {
            return Err(SimulateError::Unfit { method: "exact", reason: NO_CLOSED_FORM });
        }
        let fall = self.fall();
        let method = options.method.unwrap_or_else(|| self.best());
        let translation = self.translation.clone().filter(|_| fall.is_none());
        let (engine, name) = match closed {
            Some(closed) => {
                check_horizons(times, closed.horizons())?;
                (Engine::ClosedForm(closed), "exact")
            }
            None => (
                Engine::new(method, self.body, &self.torques, translation, &self.start().phase)?,
                method.name(),
            ),
        };
        let rate = self.rate();
        let longest = times.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
        let long = |turn: f64| Pace::Step(if rate > 0.0 { turn / rate } else { longest.max(1.0) });
        let events: Vec<Event> = options.events.into_iter().map(|event| event.in_axes(self.frame)).collect();
        let (pace, pass, error) = match (&engine, options.step) {
            (Engine::ClosedForm(closed), _) if events.is_empty() => {
                (long(1.0), self.sampled(closed, times)?, neglected)
            }
            (Engine::ClosedForm(_), _) => {
                let pace = long(1.0);
                (pace, self.pass(&engine, times, (pace, 1), &events, progress)?, neglected)
            }
            (_, Some(step)) => {
                let pace = Pace::Step(step);
                (pace, self.pass(&engine, times, (pace, 1), &events, progress)?, None)
            }
            (_, None) => {
                let aim = Aim::new(method.order(), options.rtol);
                let first = if method.adapts() { aim.tolerance() } else { long(method.first_turn()) };
                let follow = |from: &Carried, time: f64| {
                    let mut to = engine.step(from, time - from.phase.time, 0.0).map_or(*from, |(to, _)| to);
                    fall.iter().for_each(|fall| to.center = fall.at(time));
                    to
                };
                let mut passes = Convergence::new(self.start(), first, aim);
                let found = loop {
                    let (pace, start, number) = passes.next();
                    let pass = self.pass_from(start, &engine, times, (pace, number), &events, progress)?;
                    if let Some(found) = passes.take(pass, &self.body, &follow)? {
                        break found;
                    }
                };
                (found.pace, found.pass, Some(found.error))
            }
        };
        if let Some(state) = pass.states.iter().find(|s| !is_finite(s)) {
            return Err(SimulateError::Diverged { time: state.phase.time });
        }
        let exact = name == "exact";
        let certificate = Certificate {
            method: name,
            step: if exact { 0.0 } else { pass.longest },
            steps: if exact { 0 } else { pass.steps },
            evaluations: pass.evaluations,
            error_estimate: error,
            drifts: pass.drifts,
            norm_drift: pass.states.iter().map(|s| off_unit(s.phase.rotor)).fold(0.0, f64::max),
        };
        Ok(Motion {
            problem: self.clone(),
            engine,
            pace,
            states: pass.states,
            events: pass.events,
            certificate,
        })
    }

    /// The best method of steps.
    pub(crate) fn best(&self) -> Method {
        Method::best(&self.body, &self.torques, self.fall().is_none(), &self.start().phase)
    }

    /// One pass over the times.
    fn pass(
        &self,
        engine: &Engine,
        times: &[f64],
        rules: (Pace, u32),
        events: &[Event],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Pass, SimulateError> {
        self.pass_from(self.start(), engine, times, rules, events, progress)
    }

    fn pass_from(
        &self,
        start: Carried,
        engine: &Engine,
        times: &[f64],
        (pace, number): (Pace, u32),
        events: &[Event],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Pass, SimulateError> {
        let mut breaks: Vec<f64> = self.torques.iter().flat_map(|t| t.breaks()).copied().collect();
        breaks.sort_by(f64::total_cmp);
        let watch = Watch::new(self.body, &self.torques, self.start().phase);
        let first = 0.1 / self.rate().max(f64::MIN_POSITIVE);
        let walker = Walker {
            body: self.body,
            engine,
            watch,
            pace,
            first,
            breaks: &breaks,
            events,
            fall: self.fall(),
            mass: self.mass,
            number,
            progress,
        };
        walker.pass(start, times)
    }

    /// The closed form at all times, as a pass without steps. An error if it does not keep what the motion conserves.
    fn sampled(&self, closed: &ClosedForm, times: &[f64]) -> Result<Pass, SimulateError> {
        let states: Vec<Carried> = times.iter().map(|&time| closed.at(time)).collect();
        let mut watch = Watch::new(self.body, &self.torques, self.start().phase);
        states.iter().for_each(|state| watch.look(&state.phase));
        let drifts = watch.finish();
        check_kept(&drifts)?;
        Ok(Pass { states, drifts, ..Pass::default() })
    }

    fn closed_form(&self) -> Option<ClosedForm> {
        ClosedForm::of(self.body, self.rotor, self.omega, &self.torques, self.fall()?)
    }

    /// The rate of the fastest turn and of the fastest change of way, in 1/s: a scale for steps.
    fn rate(&self) -> f64 {
        let translation = self.translation.as_ref().map_or(0.0, |t| t.rate(&self.center));
        fastest_rate(&self.body, &self.torques, &self.start().phase).max(translation)
    }

    /// The motion of the centre of mass, if the forces are constant.
    fn fall(&self) -> Option<Fall> {
        let start = self.center;
        let Some(translation) = &self.translation else {
            return Some(Fall { start, acceleration: Vector::default() });
        };
        let constant = translation.forces.iter().map(|force| match force {
            Force::Constant(force) => Some(*force),
            _ => None,
        });
        let sum: Option<Vec<Vector>> = constant.collect();
        let sum = sum?.into_iter().fold(Vector::default(), |sum, force| sum + force);
        Some(Fall { start, acceleration: sum / translation.mass })
    }

    fn check(&self, times: &[f64], options: &Options) -> Result<(), SimulateError> {
        options.check(times)?;
        check_body(&self.body, self.omega, &self.torques)
    }

    fn start(&self) -> Carried {
        let phase = Phase { rotor: self.rotor, momentum: self.body.momentum(self.omega), time: 0.0 };
        Carried::new(phase, self.center)
    }

    /// In body axes.
    fn states(&self, states: &[Carried]) -> States {
        let mut all = States::default();
        for Carried { phase, center, .. } in states {
            all.times.push(phase.time);
            all.rotors.push(phase.rotor * self.frame.reverse());
            all.omegas.push(self.frame.apply_bivector(self.body.omega(phase.momentum)));
            all.momenta_space.push(phase.rotor.apply_bivector(phase.momentum));
            all.energies.push(energy(&self.body, &self.torques, phase));
            all.centers.push(*center);
        }
        all
    }
}

impl Motion {
    /// Writes the points at the output times.
    pub(crate) fn write(&self, own: &mut Own) {
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
        let watch = Watch::new(*body, torques, self.problem.start().phase);
        watch.changes(self.states.iter().map(|state| &state.phase))
    }

    /// The points at which events happened.
    pub fn event_states(&self) -> States {
        let states: Vec<Carried> = self.events.iter().map(|happened| happened.at).collect();
        self.problem.states(&states)
    }

    /// The motion at any times between the first and the last, 0 and the events included: by the same method and the same steps from the
    /// nearest output time before.
    pub fn at(
        &self,
        times: &[f64],
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<States, SimulateError> {
        // A motion that an event ends is known up to there.
        let known = self.states.iter().chain(self.events.iter().map(|happened| &happened.at));
        let (first, last) =
            known.fold((0.0, 0.0), |(a, b): (f64, f64), s| (a.min(s.phase.time), b.max(s.phase.time)));
        if let Some(index) = times.iter().position(|t| !(first..=last).contains(t)) {
            return Err(SimulateError::OutsideMotion { index, time: times[index], first, last });
        }
        if let Some(states) = self.exactly(times) {
            return states;
        }
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|&i, &j| times[i].total_cmp(&times[j]));
        let mut found = vec![self.problem.start(); times.len()];
        for group in order.chunk_by(|&i, &j| self.nearest(times[i]) == self.nearest(times[j])) {
            let from = self.nearest(times[group[0]]).map_or(self.problem.start(), |k| self.states[k]);
            let wanted: Vec<f64> = group.iter().map(|&i| times[i]).collect();
            let pass = self.problem.pass_from(from, &self.engine, &wanted, (self.pace, 1), &[], progress)?;
            group.iter().zip(pass.states).for_each(|(&i, state)| found[i] = state);
        }
        Ok(self.problem.states(&found))
    }

    /// How far in time, in s, an exact motion is known backwards and forwards; none for one that was stepped.
    pub fn horizons(&self) -> Option<[f64; 2]> {
        match &self.engine {
            Engine::ClosedForm(closed) => Some(closed.horizons()),
            _ => None,
        }
    }

    /// An exact motion at any times within its horizons; none for one that was stepped.
    pub fn exactly(&self, times: &[f64]) -> Option<Result<States, SimulateError>> {
        let Engine::ClosedForm(closed) = &self.engine else { return None };
        let known = check_horizons(times, closed.horizons());
        Some(known.map(|()| {
            let states: Vec<Carried> = times.iter().map(|&t| closed.at(t)).collect();
            self.problem.states(&states)
        }))
    }

    /// The output time nearest to a time on the way from 0; none if that is 0 itself.
    fn nearest(&self, time: f64) -> Option<usize> {
        let at = |k: usize| self.states[k].phase.time;
        let k = if time >= 0.0 {
            self.states.partition_point(|s| s.phase.time <= time).checked_sub(1).filter(|&k| at(k) >= 0.0)
        } else {
            Some(self.states.partition_point(|s| s.phase.time < time))
                .filter(|&k| k < self.states.len() && at(k) <= 0.0)
        };
        k.filter(|&k| at(k) != 0.0)
    }
}
