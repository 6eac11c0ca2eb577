//! Motion at given times, to a tolerance, with a certificate of what was conserved.

use crate::certificate::{Certificate, Watch};
use crate::conserved::{Conserved, energy};
use crate::free::FreeMotion;
use crate::inertia::Inertia;
use crate::phase::{Gyrostat, Phase};
use crate::simulate_error::{MAX_STEPS, SimulateError};
use crate::splitting::{Method, Stepper};
use crate::torque::{Torque, wheel};
use polhode_ga::{Bivector, Rotor};

/// How often, in steps, a run asks whether to go on.
const STEPS_BETWEEN_CALLS: u64 = 256;

/// Below this two passes may differ by rounding, which the motion magnifies and halving the step does not
/// reduce.
const ROUNDING_OF_RUNS: f64 = 1e-10;

/// The relative error aimed at when no tolerance is asked for.
const DEFAULT_RTOL: f64 = 1e-10;

/// The relative error that still counts when none is asked for and rounding lets no smaller one through:
/// a motion along a separatrix magnifies it a thousandfold and more. The certificate tells the estimate.
const WORST_UNASKED: f64 = 1e-6;

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
    /// The composition; `None` is the exact solution for a free body without a fixed step, and else the
    /// composition of the highest order.
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
    /// Angular momenta in space, kg m²/s.
    pub momenta_space: Vec<Bivector>,
    /// Kinetic and gravitational energy, J.
    pub energies: Vec<f64>,
    /// What was conserved.
    pub certificate: Certificate,
}

/// Where a run stands: which pass, and the fraction of it done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Passes with halved steps count from 1.
    pub pass: u32,
    /// From 0 to 1.
    pub fraction: f64,
}

/// One pass over all output times with steps of at most `step`.
struct Pass {
    states: Vec<Phase>,
    drifts: Vec<(Conserved, f64, f64)>,
    longest: f64,
    steps: u64,
}

/// The steps of one pass, and who wants to know of them.
struct Walker<'a> {
    stepper: &'a Stepper,
    watch: Watch<'a>,
    longest: f64,
    steps: u64,
    total_time: f64,
    /// How much of it is behind, in both directions of time.
    time_done: f64,
    pass: u32,
    progress: &'a mut dyn FnMut(Progress) -> bool,
}

impl Walker<'_> {
    /// Steps `state` to `time` in equal steps of at most `step`, watching the conserved quantities.
    fn walk(&mut self, state: &mut Phase, time: f64, step: f64) -> Result<(), SimulateError> {
        let (from, span) = (state.time, time - state.time);
        let count = (span.abs() / step).ceil().max(1.0);
        if span == 0.0 {
            return Ok(());
        }
        let h = span / count;
        self.longest = self.longest.max(h.abs());
        for i in 0..count as u64 {
            self.stepper
                .step(state, h)
                .map_err(|error| SimulateError::Torque { time: state.time, message: error.0 })?;
            state.time = if i + 1 == count as u64 { time } else { from + span * ((i + 1) as f64 / count) };
            self.time_done += h.abs();
            self.after_step(state)?;
        }
        Ok(())
    }

    fn after_step(&mut self, state: &Phase) -> Result<(), SimulateError> {
        self.watch.look(state);
        if !is_finite(state) {
            return Err(SimulateError::Diverged { time: state.time });
        }
        self.steps += 1;
        if self.steps.is_multiple_of(STEPS_BETWEEN_CALLS) {
            let fraction = (self.time_done / self.total_time).min(1.0);
            if !(self.progress)(Progress { pass: self.pass, fraction }) {
                return Err(SimulateError::Interrupted);
            }
        }
        Ok(())
    }
}

fn is_finite(state: &Phase) -> bool {
    state.momentum.0.iter().chain(&state.rotor.components()).all(|x| x.is_finite())
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
    /// A free body moves exactly if nothing else is asked for. With no fixed step, runs with steps h, h/2,
    /// h/4 … until two of them agree within the tolerance in the rotor (of size 1) and in the angular
    /// velocity relative to its largest size.
    pub fn simulate(
        &self,
        times: &[f64],
        options: Options,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Motion, SimulateError> {
        self.check(times, options)?;
        if options.method.is_none() && options.step.is_none() && self.torques.is_empty() {
            return Ok(self.motion(self.exact(times)?, "exact", None, 0));
        }
        let method = options.method.unwrap_or(Method::best());
        let stepper = Stepper::new(self.body, self.torques.clone(), method, &self.start());
        let (pass, estimate, steps) = match options.step {
            Some(step) => {
                let pass = self.pass(&stepper, times, step, 1, progress)?;
                let steps = pass.steps;
                (pass, None, steps)
            }
            None => self.converge(&stepper, times, options.rtol, progress)?,
        };
        Ok(self.motion(pass, method.name, estimate, steps))
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
        let mut watch = self.watch();
        states.iter().for_each(|state| watch.look(state));
        if let Some(state) = states.iter().find(|s| !is_finite(s)) {
            return Err(SimulateError::Diverged { time: state.time });
        }
        Ok(Pass { states, drifts: watch.finish(), longest: 0.0, steps: 0 })
    }

    fn watch(&self) -> Watch<'_> {
        Watch::new(self.body, &self.torques, self.start())
    }

    /// A pass in body axes, with its certificate.
    fn motion(&self, pass: Pass, method: &'static str, error_estimate: Option<f64>, steps: u64) -> Motion {
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
                steps,
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

    fn pass(
        &self,
        stepper: &Stepper,
        times: &[f64],
        step: f64,
        number: u32,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Pass, SimulateError> {
        let (first, last) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
        let total_time = last.max(0.0) - first.min(0.0);
        let steps = total_time / step + times.len() as f64;
        if steps > MAX_STEPS {
            return Err(SimulateError::TooManySteps { steps, step });
        }
        let mut walker = Walker {
            stepper,
            watch: self.watch(),
            longest: 0.0,
            steps: 0,
            total_time: total_time.max(f64::MIN_POSITIVE),
            time_done: 0.0,
            pass: number,
            progress,
        };
        let split = times.partition_point(|&t| t < 0.0);
        let mut states = Vec::with_capacity(times.len());
        let mut state = self.start();
        for &time in times[..split].iter().rev() {
            walker.walk(&mut state, time, step)?;
            states.push(state);
        }
        states.reverse();
        state = self.start();
        for &time in &times[split..] {
            walker.walk(&mut state, time, step)?;
            states.push(state);
        }
        Ok(Pass { states, drifts: walker.watch.finish(), longest: walker.longest, steps: walker.steps })
    }

    /// Halves the step until two runs agree.
    fn converge(
        &self,
        stepper: &Stepper,
        times: &[f64],
        rtol: Option<f64>,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<(Pass, Option<f64>, u64), SimulateError> {
        let goal = rtol.unwrap_or(DEFAULT_RTOL);
        let acceptable = rtol.unwrap_or(WORST_UNASKED);
        let rate = stepper.fastest_rate(&self.start());
        let longest = times.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
        let mut step = if rate > 0.0 { 0.5 / rate } else { longest.max(1.0) };
        let mut coarse = self.pass(stepper, times, step, 1, progress)?;
        let mut steps = coarse.steps;
        let mut previous = f64::INFINITY;
        for number in 2.. {
            // Where output times are closer than the step, they set it: halve what was really taken.
            step = 0.5 * step.min(if coarse.longest > 0.0 { coarse.longest } else { step });
            let fine = self.pass(stepper, times, step, number, progress)?;
            steps += fine.steps;
            // The error of the finer run is about difference / 2^order; half the exponent is the margin.
            // Where rounding rules, the difference itself tells the error.
            let difference = self.difference(&coarse, &fine);
            let margin = f64::from(1 << (stepper.order() / 2));
            let error = (difference / margin).max(difference.min(ROUNDING_OF_RUNS));
            // Near convergence halving gains 2^order; gaining less than 2 is rounding.
            let stuck = error > 0.5 * previous && previous < 1e-2 || number > 30;
            if error <= goal || stuck && error <= acceptable {
                return Ok((fine, Some(error), steps));
            }
            if stuck {
                return Err(SimulateError::NotConverged { rtol: goal, reached: error, step });
            }
            previous = error;
            coarse = fine;
        }
        unreachable!("the loop returns")
    }

    /// Largest difference of two runs in rotor and relative angular velocity.
    fn difference(&self, coarse: &Pass, fine: &Pass) -> f64 {
        let omega = |s: &Phase| self.body.omega(s.momentum);
        let fastest = fine.states.iter().map(|s| omega(s).norm()).fold(f64::MIN_POSITIVE, f64::max);
        let apart = |(a, b): (&Phase, &Phase)| {
            let (r, s) = (a.rotor.components(), b.rotor.components());
            let turn = (0..4).map(|k| (r[k] - s[k]) * (r[k] - s[k])).sum::<f64>().sqrt();
            turn.max((omega(a) - omega(b)).norm() / fastest)
        };
        coarse.states.iter().zip(&fine.states).map(apart).fold(0.0, f64::max)
    }
}
