//! Engine: a method, or a closed form, that advances one body.

use super::closed_form::ClosedForm;
use crate::error::SimulateError;
use crate::laws::force::Translation;
use crate::laws::torque::Torque;
use crate::methods::classical::Classical;
use crate::methods::midpoint::Midpoint;
use crate::methods::moser_veselov::MoserVeselov;
use crate::methods::runge_kutta::{RungeKutta, STAGES};
use crate::methods::splitting::Splitting;
use crate::methods::{Method, ROUNDING_OF_RUNGE_KUTTA};
use crate::state::carried::Carried;
use crate::state::phase::{Gyrostat, Phase};

/// A method with its body and laws, or a closed form.
#[derive(Clone, Debug)]
pub(crate) enum Engine {
    Splitting(Splitting),
    Classical(Classical),
    RungeKutta(RungeKutta),
    Midpoint(Midpoint),
    MoserVeselov(MoserVeselov),
    /// The closed form, evaluated in steps.
    ClosedForm(Box<ClosedForm>),
}

impl Engine {
    /// An error if the method does not support the laws.
    pub fn new(
        method: Method,
        body: Gyrostat,
        torques: &[Torque],
        translation: Option<Translation>,
        start: &Phase,
    ) -> Result<Engine, SimulateError> {
        let moving = if torques.iter().any(Torque::reads_center) {
            "does not support torques that depend on position or velocity; use auto, dop853 or rk4"
        } else {
            "supports no other forces than constant ones, drag and springs; use auto, dop853 or rk4"
        };
        let moving = (translation.is_some() && !matches!(method, Method::Classical | Method::RungeKutta))
            .then_some(moving);
        if let Some(reason) = moving.or(method.unfit(&body, torques)) {
            return Err(SimulateError::Unfit { method: method.name(), reason });
        }
        Ok(match method {
            Method::Splitting(sequence) => {
                Engine::Splitting(Splitting::new(body, torques.to_vec(), sequence, start))
            }
            Method::Classical => Engine::Classical(Classical::new(body, torques.to_vec(), translation)),
            Method::RungeKutta => Engine::RungeKutta(RungeKutta::new(body, torques.to_vec(), translation)),
            Method::Midpoint => Engine::Midpoint(Midpoint::new(body, torques.to_vec(), start)),
            Method::MoserVeselov => Engine::MoserVeselov(MoserVeselov::new(body, torques.to_vec(), start)),
        })
    }

    /// The same with a lower bound of the scale of speeds, for estimates of errors.
    pub fn with_least_speed(self, least_speed: f64) -> Engine {
        match self {
            Engine::RungeKutta(method) => Engine::RungeKutta(method.with_least_speed(least_speed)),
            other => other,
        }
    }

    /// One step of length `h`, and an estimate of its error where the method has one, relative to the angular velocity
    /// `fastest` in rad/s, else 0.
    pub fn step(&self, from: &Carried, h: f64, fastest: f64) -> Result<(Carried, f64), SimulateError> {
        let mut to = *from;
        match self {
            Engine::Splitting(splitting) => splitting.step(&mut to.phase, &mut to.lost, h)?,
            Engine::Classical(classical) => to = classical.step(from, h)?,
            Engine::RungeKutta(runge_kutta) => return runge_kutta.step(from, h, fastest),
            Engine::ClosedForm(motion) => to = motion.at(from.phase.time + h),
            Engine::Midpoint(midpoint) => midpoint.step(&mut to.phase, h)?,
            Engine::MoserVeselov(moser_veselov) => moser_veselov.step(&mut to.phase, h)?,
        }
        Ok((to, 0.0))
    }

    /// The typical rounding of one step, relative to the size of the components.
    ///
    /// A turn changes two components of the momentum and all of the rotor, each by a few roundings of ε/√12 of its
    /// binade; their signs are random, so that a composition of s stages of three turns rounds as a walk of 3 s steps of
    /// 0.12 ε. The exact free motion of an asymmetric body is rounded by some ulps.
    pub fn rounding(&self) -> f64 {
        let turns = match self {
            Engine::Splitting(splitting) => splitting.turns_per_step(),
            Engine::RungeKutta(_) => return ROUNDING_OF_RUNGE_KUTTA,
            Engine::Classical(_) => 4.0,
            Engine::Midpoint(_) | Engine::MoserVeselov(_) => 3.0,
            Engine::ClosedForm(_) => 0.0,
        };
        0.12 * f64::EPSILON * turns.sqrt()
    }

    /// Whether steps carry the momentum in space, and not in the body.
    pub fn is_in_space(&self) -> bool {
        matches!(self, Engine::RungeKutta(_))
    }

    /// Evaluations of the torque in a step.
    pub fn evaluations(&self) -> u64 {
        match self {
            Engine::Splitting(splitting) => splitting.evaluations(),
            Engine::Classical(_) => 4,
            Engine::RungeKutta(_) => STAGES as u64,
            Engine::ClosedForm(_) => 0,
            // About one per iteration.
            Engine::Midpoint(_) => 5,
            Engine::MoserVeselov(_) => 2,
        }
    }
}
