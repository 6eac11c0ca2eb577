//! Simulation of one body: in closed form if there is one, else by integration, with a certificate.

pub(crate) mod accuracy;
pub(crate) mod center;
pub mod certificate;
pub(crate) mod closed_form;
pub(crate) mod engine;
pub(crate) mod limits;
mod motion;
pub(crate) mod noise;
mod options;
pub(crate) mod output;
pub(crate) mod refine;
mod solver;
pub(crate) mod stops;
pub(crate) mod sweep;

use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::laws::conserved::{energy, momentum};
use crate::laws::driven_wheels::{carrier, driven};
use crate::laws::event::Quantity;
use crate::laws::force::{Force, Translation};
use crate::laws::formula::Formula;
use crate::laws::torque::{Torque, wheel};
use crate::methods::step_control::Limit;
use crate::methods::{Method, fastest_rate};
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::checks::{check_horizons, check_moments};
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use center::{CenterMotion, center_law};
use closed_form::ClosedForm;
use limits::{StepBounds, samples, span};
use polhode_ga::{Bivector, Rotor};
pub use sweep::Progress;
use sweep::check_pieces;

pub use motion::{Motion, States};
pub use options::{MAX_STEPS, Options};

/// Inertia, start and torques of a rotating body, in body axes.
#[derive(Clone, Debug)]
pub struct Setup {
    /// About the centre of mass, or about the fixed point if there is one.
    pub inertia: Inertia,
    /// From body axes to space at the start.
    pub rotor: Rotor,
    /// The angular velocity at the start, in rad/s.
    pub omega: Bivector,
    /// The time of the start, in s.
    pub time: f64,
    /// The torques, those of off-centre thrusts included.
    pub torques: Vec<Torque>,
    /// In kg; NaN if unknown.
    pub mass: f64,
    /// Whether forces move the centre of mass.
    pub has_forces: bool,
}

/// A body with its start, time 0 unless another is given, torques and forces. Stored in principal axes.
#[derive(Clone, Debug)]
pub struct Problem {
    frame: Rotor,
    body: Gyrostat,
    /// Of the start, in s.
    time: f64,
    rotor: Rotor,
    omega: Bivector,
    torques: Vec<Torque>,
    center: Center,
    /// NaN where unknown.
    mass: f64,
    translation: Option<Translation>,
}

pub(crate) const NO_CLOSED_FORM: &str = "needs a motion in closed form and no step: free bodies, symmetric ones under heavy along their \
                              axis, damping alone, spheres under larmor, and constant forces, drag and springs; omit the method for others";

/// The start time must be finite.
pub(crate) fn check_start_time(value: f64) -> Result<(), SimulateError> {
    let what = "the time of the start";
    if value.is_finite() { Ok(()) } else { Err(SimulateError::BadValue { what, value }) }
}

/// A body, its angular velocity and its torques must be valid.
pub(crate) fn check_body(body: &Gyrostat, omega: Bivector, torques: &[Torque]) -> Result<(), SimulateError> {
    check_motors(body, torques)?;
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

/// Wheels with motors must be lighter than the body, and other laws must not need the inertia with the wheels.
fn check_motors(body: &Gyrostat, torques: &[Torque]) -> Result<(), SimulateError> {
    if !torques.iter().any(|law| matches!(law, Torque::Wheels(_))) {
        return Ok(());
    }
    let unfit = |reason| Err(SimulateError::Unfit { method: "reaction_wheels", reason });
    if body.moments.iter().any(|moment| *moment <= 0.0) {
        return unfit(
            "have larger moments about their axes than the body about the same axes, but the inertia of the body \
             includes its wheels; check the units",
        );
    }
    let unclear = |law: &Torque| {
        matches!(law, Torque::Damping(_) | Torque::Larmor(_))
            || law.formula().is_some_and(Formula::needs_inertia)
    };
    if torques.iter().any(unclear) {
        return unfit(NO_MOMENTUM);
    }
    Ok(())
}

const NO_MOMENTUM: &str = "cannot be combined with damping, larmor and formulas of L or I(…), whose momentum has parts of \
                           the wheels; use viscous_damping, and Ω in formulas";

impl Problem {
    /// A body with its rotor (body axes to space) and its angular velocity and torques in body axes. The
    /// inertia is about the centre of mass, or about the fixed point if there is one.
    pub fn new(inertia: &Inertia, rotor: Rotor, omega: Bivector, torques: &[Torque]) -> Problem {
        let (inertia, torques) = carrier(inertia, torques);
        let frame = inertia.principal_frame();
        let torques: Vec<Torque> = torques.into_iter().map(|t| t.in_axes(frame)).collect();
        Problem {
            frame,
            body: Gyrostat { moments: inertia.principal_moments(), wheel: wheel(&torques) },
            time: 0.0,
            rotor: rotor * frame,
            omega: frame.reverse().apply_bivector(omega),
            torques,
            center: Center::default(),
            mass: f64::NAN,
            translation: None,
        }
    }

    /// The rotation of a body from its start time on.
    pub fn of(setup: &Setup) -> Problem {
        Problem::new(&setup.inertia, setup.rotor, setup.omega, &setup.torques).starting_at(setup.time)
    }

    /// The same with another start time, in s. Laws that depend on time, output times and events still count from time 0.
    pub fn starting_at(mut self, time: f64) -> Problem {
        self.time = time;
        self
    }

    /// The same with a centre of mass in space, and forces, with body components in body axes, on a mass in kg, NaN if
    /// unknown.
    pub fn with_center(mut self, center: Center, mass: f64, forces: &[Force]) -> Problem {
        let forces: Vec<Force> = forces.iter().map(|f| f.clone().in_axes(self.frame)).collect();
        self.center = center;
        self.mass = mass;
        self.torques = self.torques.into_iter().map(|law| law.with_mass(mass)).collect();
        let follows = !forces.is_empty() || self.reads_center();
        self.translation = follows.then_some(Translation { mass, forces });
        self
    }

    /// The motion at `times` (s, not decreasing); those before the start are reached backwards.
    ///
    /// In closed form by default if there is one. Without a fixed step, steps are refined until two sweeps agree within the
    /// tolerance in the rotor (of norm 1) and in the angular velocity relative to its maximum.
    pub fn simulate(
        &self,
        times: &[f64],
        options: Options,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Motion, SimulateError> {
        self.check(times, &options)?;
        let begin = self.start();
        let adapts = options.method.unwrap_or_else(|| self.best()).adapts();
        let point = self.point(&begin);
        let samples = samples(&self.torques, self.forces(), &point, times, &options, adapts)?;
        let of_forces = samples.get(self.torques.len()..).unwrap_or_default();
        let mut bounds =
            StepBounds::new(&self.torques, &samples, &point, &options).with_forces(of_forces, self.mass);
        let center = self.center_motion();
        bounds.limit.reports_stiffness &= center.is_some();
        if let Some(center) = &center {
            check_horizons(self.time, times, [center.law.horizon(); 2])?;
            if options.events.iter().any(|event| event.quantity.reads_center()) {
                let [first, last] = span(times, self.time);
                check_pieces(&center.law, (self.time - first).max(last - self.time), &bounds)?;
            }
        }
        for event in &options.events {
            let quantity = event.clone().in_axes(self.frame).quantity;
            bounds.piece = bounds.piece.min(0.5 * quantity.oscillates_within(&point, span(times, self.time)));
        }
        let limit = bounds.limit;
        match self.run(times, &options, bounds.clone(), progress) {
            Err(SimulateError::Stiff { steps }) => {
                // Implicit steps are cheaper and may be longer. If they fail or need as many steps, explicit steps are used.
                let implicit = Options { method: Some(Method::Midpoint), ..options.clone() };
                bounds.limit = Limit { steps: steps.min(limit.steps), reports_stiffness: false };
                match self.run(times, &implicit, bounds.clone(), progress) {
                    Err(SimulateError::Interrupted) => Err(SimulateError::Interrupted),
                    Err(_) => {
                        bounds.limit = Limit { reports_stiffness: false, ..limit };
                        self.run(times, &options, bounds, progress)
                    }
                    found => found,
                }
            }
            found => found,
        }
    }

    /// The best stepping method.
    pub(crate) fn best(&self) -> Method {
        Method::best(&self.body, &self.torques, self.center_motion().is_none(), &self.start().phase)
    }

    fn closed_form(&self) -> Option<ClosedForm> {
        ClosedForm::of(self.body, self.rotor, self.omega, &self.torques, self.center_motion()?)
    }

    /// The largest rate of rotation and of translation by steps, in 1/s: a scale for steps.
    fn rate(&self) -> f64 {
        let stepped = self.translation.as_ref().filter(|_| self.center_motion().is_none());
        let translation = stepped.map_or(0.0, |t| t.rate(&self.center));
        let start = self.start();
        fastest_rate(&self.torques, &self.point(&start)).max(translation)
    }

    fn point<'a>(&'a self, at: &'a Carried) -> Point<'a> {
        Point { body: &self.body, mass: self.mass, phase: &at.phase, center: &at.center }
    }

    fn forces(&self) -> &[Force] {
        self.translation.as_ref().map_or(&[], |translation| &translation.forces)
    }

    fn reads_center(&self) -> bool {
        self.torques.iter().any(Torque::reads_center)
    }

    /// The motion of the centre of mass, if it has a closed form and no torque depends on it: then steps follow both.
    fn center_motion(&self) -> Option<CenterMotion> {
        if self.reads_center() {
            return None;
        }
        let law = center_law(self.translation.iter().flat_map(|translation| &translation.forces), self.mass)?;
        Some(CenterMotion { time: self.time, start: self.center, law })
    }

    fn check(&self, times: &[f64], options: &Options) -> Result<(), SimulateError> {
        options.check(times)?;
        check_start_time(self.time)?;
        let motors = self.torques.iter().any(|law| matches!(law, Torque::Wheels(_)));
        let events = options.events.iter().filter_map(|event| match &event.quantity {
            Quantity::Formula(formula) => Some(formula),
            _ => None,
        });
        let forces = self.translation.iter().flat_map(|translation| &translation.forces);
        let forces =
            forces.filter_map(|force| if let Force::Formula(formula) = force { Some(formula) } else { None });
        if motors && events.chain(forces).any(Formula::needs_inertia) {
            return Err(SimulateError::Unfit { method: "reaction_wheels", reason: NO_MOMENTUM });
        }
        check_body(&self.body, self.omega, &self.torques)
    }

    fn start(&self) -> Carried {
        let phase = Phase { rotor: self.rotor, momentum: self.body.momentum(self.omega), time: self.time };
        Carried::new(phase, self.center).with_wheels(driven(&self.torques, self.time))
    }

    /// In body axes.
    fn states(&self, states: &[Carried]) -> States {
        let mut all = States::default();
        for Carried { phase, center, .. } in states {
            all.times.push(phase.time);
            all.rotors.push(phase.rotor * self.frame.reverse());
            all.omegas.push(self.frame.apply_bivector(self.body.omega(phase.momentum)));
            all.momenta_space.push(phase.rotor.apply_bivector(momentum(&self.torques, phase)));
            all.energies.push(energy(&self.body, &self.torques, phase));
            all.centers.push(*center);
        }
        all
    }
}
