//! Methods by name, and what each is fit for.

use crate::closed_form::ClosedForm;
use crate::force::Translation;
use crate::phase::{Gyrostat, Phase};
use crate::runge_kutta::{Carried, DOP853, RK4, RungeKutta, Tableau};
use crate::simulate_error::SimulateError;
use crate::splitting::{COMPOSITIONS, RKN6, Sequence, Splitting};
use crate::symmetric_top::equal;
use crate::torque::{Dependence, Torque};

/// How a motion is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Exact turns and kicks.
    Splitting(Sequence),
    /// Runge–Kutta on the group of rotors.
    RungeKutta(&'static Tableau),
}

/// Every method, splittings first, each kind by rising order.
pub fn methods() -> impl Iterator<Item = Method> {
    let compositions = COMPOSITIONS.iter().map(|c| Method::Splitting(Sequence::Composition(c)));
    let others =
        [Method::Splitting(Sequence::Nystrom(&RKN6)), Method::RungeKutta(&RK4), Method::RungeKutta(&DOP853)];
    compositions.chain(others)
}

impl Method {
    /// The method of this name.
    pub fn from_name(name: &str) -> Option<Method> {
        methods().find(|m| m.name() == name)
    }

    /// The name it is asked for by.
    pub fn name(self) -> &'static str {
        match self {
            Method::Splitting(Sequence::Composition(composition)) => composition.name,
            Method::Splitting(Sequence::Nystrom(nystrom)) => nystrom.name,
            Method::RungeKutta(tableau) => tableau.name,
        }
    }

    /// Its order of convergence.
    pub fn order(self) -> i32 {
        match self {
            Method::Splitting(Sequence::Composition(composition)) => composition.order,
            Method::Splitting(Sequence::Nystrom(nystrom)) => nystrom.order,
            Method::RungeKutta(tableau) => tableau.order,
        }
    }

    /// Whether it estimates the error of each step, and chooses the next by it.
    pub fn adapts(self) -> bool {
        matches!(self, Method::RungeKutta(tableau) if !tableau.fifth.is_empty())
    }

    /// The method for these laws: a splitting where they depend on attitude and time alone and are smooth, for it
    /// keeps the energy of long runs; Runge–Kutta for others.
    pub fn best(body: &Gyrostat, torques: &[Torque], translated: bool) -> Method {
        let kicks = !translated
            && torques.iter().all(|t| t.dependence() == Dependence::Attitude && t.breaks().is_empty());
        if !kicks {
            Method::RungeKutta(&DOP853)
        } else if Method::unfit(Method::Splitting(Sequence::Nystrom(&RKN6)), body, torques).is_none()
            && symmetric(body)
        {
            Method::Splitting(Sequence::Nystrom(&RKN6))
        } else {
            Method::Splitting(Sequence::Composition(&COMPOSITIONS[COMPOSITIONS.len() - 1]))
        }
    }

    /// Why it is not fit for this body and these laws, and what is.
    fn unfit(self, body: &Gyrostat, torques: &[Torque]) -> Option<&'static str> {
        let Method::Splitting(sequence) = self else { return None };
        if torques.iter().any(|t| t.dependence() == Dependence::Rate) {
            return Some(
                "kicks at fixed attitude, but a torque depends on the rate of turning; use auto or dop853",
            );
        }
        let Sequence::Nystrom(_) = sequence else { return None };
        if torques.iter().any(|t| t.damping_rate() != 0.0) {
            return Some(
                "is of its order for torques that depend on the attitude alone, not with damping; use kahan_li8",
            );
        }
        (body.wheel != Default::default())
            .then_some("needs the exact free motion, which a wheel has not; use kahan_li8")
    }
}

fn symmetric(body: &Gyrostat) -> bool {
    let [a, b, c] = body.moments;
    equal(a, b) || equal(b, c) || equal(c, a)
}

/// A method at work on a body and its laws.
#[derive(Clone, Debug)]
pub(crate) enum Engine {
    Splitting(Splitting),
    RungeKutta(RungeKutta),
    /// The closed form, looked at in steps.
    ClosedForm(ClosedForm),
}

impl Engine {
    /// An error if the method is not fit.
    pub fn new(
        method: Method,
        body: Gyrostat,
        torques: &[Torque],
        translation: Option<Translation>,
        start: &Phase,
    ) -> Result<Engine, SimulateError> {
        let moving =
            "leaves the centre of mass to its closed form, which these forces have not; use auto or dop853";
        let moving = (translation.is_some() && matches!(method, Method::Splitting(_))).then_some(moving);
        if let Some(reason) = method.unfit(&body, torques).or(moving) {
            return Err(SimulateError::Unfit { method: method.name(), reason });
        }
        Ok(match method {
            Method::Splitting(sequence) => {
                Engine::Splitting(Splitting::new(body, torques.to_vec(), sequence, start))
            }
            Method::RungeKutta(tableau) => {
                Engine::RungeKutta(RungeKutta::new(body, torques.to_vec(), translation, tableau))
            }
        })
    }

    /// One step of length `h`, and an estimate of its error where the method has one, relative to the angular velocity
    /// `fastest` in rad/s, else 0.
    pub fn step(&self, from: &Carried, h: f64, fastest: f64) -> Result<(Carried, f64), SimulateError> {
        match self {
            Engine::Splitting(splitting) => {
                let mut to = *from;
                splitting.step(&mut to.phase, h)?;
                Ok((to, 0.0))
            }
            Engine::RungeKutta(runge_kutta) => runge_kutta.step(from, h, fastest),
            Engine::ClosedForm(motion) => Ok((motion.at(from.phase.time + h), 0.0)),
        }
    }

    /// Evaluations of the torque in a step.
    pub fn evaluations(&self) -> u64 {
        match self {
            Engine::Splitting(splitting) => splitting.evaluations(),
            Engine::RungeKutta(runge_kutta) => runge_kutta.tableau().rows.len() as u64,
            Engine::ClosedForm(_) => 0,
        }
    }
}

/// The rate of the fastest turn, in rad/s, a scale for steps: what the momentum and the energy allow, and the swing in
/// the torque.
pub(crate) fn fastest_rate(body: &Gyrostat, torques: &[Torque], start: &Phase) -> f64 {
    let torque: f64 = torques.iter().map(|t| t.size(body)).sum();
    let damping: f64 = torques.iter().map(Torque::damping_rate).sum();
    let smallest = body.moments.iter().fold(f64::INFINITY, |m: f64, x| m.min(*x));
    let omega = body.omega(start.momentum).norm().max(body.wheel.norm() / smallest);
    omega.hypot((2.0 * torque / smallest).sqrt()) + damping.abs()
}
