//! Motion at given times: exact where there is a closed form, else by steps to a tolerance, with a certificate of
//! what was conserved.

use crate::certificate::{Certificate, Watch};
use crate::conserved::energy;
use crate::converge::{DEFAULT_RTOL, LEAST_TOLERANCE, WORST_UNASKED, converge};
use crate::free::FreeMotion;
use crate::inertia::Inertia;
use crate::method::{Engine, Method, fastest_rate};
use crate::phase::{Gyrostat, Phase};
use crate::simulate_error::SimulateError;
use crate::torque::{Torque, wheel};
pub use crate::walk::Progress;
use crate::walk::{Pace, Pass, Walker};
use polhode_ga::{Bivector, Rotor};

/// What to solve: a body and its state at time 0. Kept in principal axes.
#[derive(Clone, Debug)]
pub struct Problem {
    frame: Rotor,
    body: Gyrostat,
    rotor: Rotor,
    omega: Bivector,
    torques: Vec<Torque>,
}

/// How to solve it.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// `None` is the exact solution where there is one and no step is given, and else the best method for the laws.
    pub method: Option<Method>,
    /// A fixed step in s; `None` lets the tolerance choose it.
    pub step: Option<f64>,
    /// The relative error to reach where it chooses the step; `None` aims at 1e-10 and takes what rounding
    /// leaves of it.
    pub rtol: Option<f64>,
}

/// A motion at its output times.
#[derive(Clone, Debug)]
pub struct Motion {
    /// From body axes to space.
    pub rotors: Vec<Rotor>,
    /// Angular velocities in body axes, rad/s.
    pub omegas: Vec<Bivector>,
    /// Angular momenta in space, those of wheels included, kg m²/s.
    pub momenta_space: Vec<Bivector>,
    /// Kinetic energy and the potential energy of the laws that have one, J.
    pub energies: Vec<f64>,
    /// What was conserved.
    pub certificate: Certificate,
}

/// Times must not lie beyond the horizon of an exact motion.
pub fn check_horizon(times: &[f64], horizon: f64) -> Result<(), SimulateError> {
    match times.iter().position(|t| t.abs() > horizon) {
        Some(index) => Err(SimulateError::BeyondHorizon { index, time: times[index], horizon }),
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
        }
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
        self.check(times, options)?;
        if options.method.is_none() && options.step.is_none() && self.torques.is_empty() {
            return Ok(self.motion(self.exact(times)?, "exact", None));
        }
        let method = options.method.unwrap_or_else(|| Method::best(&self.body, &self.torques));
        let engine = Engine::new(method, self.body, &self.torques, &self.start())?;
        let mut breaks: Vec<f64> = self.torques.iter().flat_map(|t| t.breaks()).copied().collect();
        breaks.sort_by(f64::total_cmp);
        let rate = fastest_rate(&self.body, &self.torques, &self.start());
        let mut number = 0;
        let mut run = |pace: Pace| {
            number += 1;
            let watch = Watch::new(self.body, &self.torques, self.start());
            let walker =
                Walker { body: self.body, engine: &engine, watch, pace, breaks: &breaks, number, progress };
            walker.pass(self.start(), times, 0.1 / rate.max(f64::MIN_POSITIVE))
        };
        match options.step {
            Some(step) => Ok(self.motion(run(Pace::Step(step))?, method.name(), None)),
            None => {
                let goal = options.rtol.unwrap_or(DEFAULT_RTOL);
                let acceptable = options.rtol.unwrap_or(WORST_UNASKED);
                let longest = times.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
                let first = if method.adapts() {
                    Pace::Tolerance(goal.max(1e3 * LEAST_TOLERANCE))
                } else {
                    Pace::Step(if rate > 0.0 { method.first_turn() / rate } else { longest.max(1.0) })
                };
                let (pass, error) =
                    converge(&mut run, first, (method.order(), goal, acceptable), &self.body)?;
                Ok(self.motion(pass, method.name(), Some(error)))
            }
        }
    }

    /// The exact states of a free body, as a pass without steps.
    fn exact(&self, times: &[f64]) -> Result<Pass, SimulateError> {
        let motion = FreeMotion::in_principal_axes(self.body.moments, self.rotor, self.omega);
        check_horizon(times, motion.horizon())?;
        let phase = |&time: &f64| {
            let (rotor, omega) = motion.at(time);
            Phase { rotor, momentum: self.body.momentum(omega), time }
        };
        let states: Vec<Phase> = times.iter().map(phase).collect();
        let mut watch = Watch::new(self.body, &self.torques, self.start());
        states.iter().for_each(|state| watch.look(state));
        if let Some(state) = states.iter().find(|s| !is_finite(s)) {
            return Err(SimulateError::Diverged { time: state.time });
        }
        Ok(Pass { states, drifts: watch.finish(), ..Pass::default() })
    }

    fn motion(&self, pass: Pass, method: &'static str, error_estimate: Option<f64>) -> Motion {
        let (states, frame) = (pass.states, self.frame);
        let omega = |s: &Phase| self.body.omega(s.momentum);
        let off_unit = |s: &Phase| s.rotor.components().iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0;
        Motion {
            rotors: states.iter().map(|s| s.rotor * frame.reverse()).collect(),
            omegas: states.iter().map(|s| frame.apply_bivector(omega(s))).collect(),
            momenta_space: states.iter().map(|s| s.rotor.apply_bivector(s.momentum)).collect(),
            energies: states.iter().map(|s| energy(&self.body, &self.torques, s)).collect(),
            certificate: Certificate {
                method,
                step: pass.longest,
                steps: pass.steps,
                evaluations: pass.evaluations,
                error_estimate,
                drifts: pass.drifts,
                norm_drift: states.iter().map(|s| off_unit(s).abs()).fold(0.0, f64::max),
            },
        }
    }

    fn check(&self, times: &[f64], options: Options) -> Result<(), SimulateError> {
        check_moments(self.body.moments)?;
        for (index, &time) in times.iter().enumerate() {
            if !time.is_finite() || index > 0 && time < times[index - 1] {
                return Err(SimulateError::BadTime { index, time });
            }
        }
        if let Some(&value) = self.omega.0.iter().find(|x| !x.is_finite()) {
            return Err(SimulateError::BadValue { what: "a component of the angular velocity", value });
        }
        let start = self.start();
        let value = self.body.kinetic(start.momentum) + start.momentum.norm_squared();
        if !value.is_finite() {
            return Err(SimulateError::BadValue { what: "the energy of the rotation", value });
        }
        for torque in &self.torques {
            let value = torque.size(&self.body) + torque.damping_rate();
            if !value.is_finite() {
                return Err(SimulateError::BadValue { what: "the size of a torque", value });
            }
        }
        for (what, value) in [("step", options.step.unwrap_or(1.0)), ("rtol", options.rtol.unwrap_or(1.0))] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SimulateError::BadValue { what, value });
            }
        }
        Ok(())
    }

    fn start(&self) -> Phase {
        Phase { rotor: self.rotor, momentum: self.body.momentum(self.omega), time: 0.0 }
    }
}

fn is_finite(state: &Phase) -> bool {
    state.momentum.0.iter().chain(&state.rotor.components()).all(|x| x.is_finite())
}
