//! Stepping methods: names, orders, and the laws that each supports.

pub mod classical;
pub mod midpoint;
pub(crate) mod momentum;
pub mod moser_veselov;
pub mod runge_kutta;
pub mod splitting;
pub(crate) mod step_control;

use crate::body::inertia::equal;
use crate::laws::torque::{Dependence, Torque, damping_rate};
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use splitting::turns::Kind;
use splitting::{COMPOSITIONS, RKN6, Sequence};

/// The turn of a body in an equal step, in rad, beyond which the error of a few steps is of the size of the motion.
pub(crate) const LARGEST_TURN: f64 = 2.0;

/// A stepping method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Exact turns and kicks.
    Splitting(&'static Sequence),
    /// The classical Runge–Kutta method on components.
    Classical,
    /// Runge–Kutta on the group of rotors, of order 8.
    RungeKutta,
    /// The implicit midpoint rule.
    Midpoint,
    /// Discrete Moser–Veselov.
    MoserVeselov,
}

/// All methods, splittings first, each kind in ascending order.
pub fn methods() -> impl Iterator<Item = Method> {
    let others = [Method::Classical, Method::RungeKutta, Method::Midpoint, Method::MoserVeselov];
    COMPOSITIONS.iter().chain([&RKN6]).map(Method::Splitting).chain(others)
}

impl Method {
    /// Whether a body that turns at this rate (rad/s) turns too far in a step (s). Splittings turn symmetric bodies exactly.
    pub(crate) fn turns_too_far(&self, body: &Gyrostat, rate: f64, step: f64) -> bool {
        let is_exact = matches!(self, Method::Splitting(_)) && Kind::of(body).is_symmetric();
        rate * step > LARGEST_TURN && !is_exact
    }

    /// The method of this name.
    pub fn from_name(name: &str) -> Option<Method> {
        methods().find(|m| m.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Method::Splitting(sequence) => sequence.name,
            Method::Classical => "rk4",
            Method::RungeKutta => "dop853",
            Method::Midpoint => "midpoint",
            Method::MoserVeselov => "dmv",
        }
    }

    /// Its order of convergence.
    pub fn order(self) -> i32 {
        match self {
            Method::Splitting(sequence) => sequence.order,
            Method::Classical => 4,
            Method::RungeKutta => 8,
            Method::Midpoint | Method::MoserVeselov => 2,
        }
    }

    /// Whether it estimates the error of each step and adapts the next.
    pub fn adapts(self) -> bool {
        self == Method::RungeKutta
    }

    /// The largest turn in the first step tried, in rad: implicit equations have a solution for short steps only.
    pub(crate) fn first_turn(self) -> f64 {
        if matches!(self, Method::Midpoint | Method::MoserVeselov) { 0.4 } else { 1.5 }
    }

    /// The default method for these laws: a splitting with equal steps if the torque depends on the attitude only, or
    /// rotates with a circular orbit, because it conserves energy in long runs; else adaptive Runge–Kutta. Equal steps
    /// would lose their order where a spring reaches half a turn, at which its torque jumps.
    pub fn best(body: &Gyrostat, torques: &[Torque], translated: bool, start: &Phase) -> Method {
        let steady =
            |t: &Torque| t.is_autonomous() || matches!(t, Torque::GravityGradient(o) if o.is_circular());
        let kicks =
            !translated && torques.iter().all(|t| t.dependence() == Dependence::Attitude && steady(t));
        let kicks = kicks && !may_jump(body, torques, start);
        if !kicks {
            Method::RungeKutta
        } else if Method::Splitting(&RKN6).unfit(body, torques).is_none() && symmetric(body) {
            Method::Splitting(&RKN6)
        } else {
            Method::Splitting(&COMPOSITIONS[COMPOSITIONS.len() - 1])
        }
    }

    /// Why it does not support this body and these laws, with an alternative.
    pub(crate) fn unfit(self, body: &Gyrostat, torques: &[Torque]) -> Option<&'static str> {
        if matches!(self, Method::Classical | Method::RungeKutta | Method::Midpoint) {
            return None;
        }
        if torques.iter().any(|t| t.dependence() == Dependence::Rate) {
            return Some(
                "does not support torques that depend on the angular velocity; use auto, dop853 or midpoint",
            );
        }
        let wheel = body.wheel != Default::default();
        match self {
            Method::Splitting(sequence) if !sequence.is_nystrom() => None,
            Method::Splitting(_) if torques.iter().any(|t| t.damping_rate() != 0.0) => {
                Some("does not support damping; use kahan_li8")
            }
            Method::Splitting(_) if wheel => Some("does not support wheels; use kahan_li8"),
            Method::MoserVeselov if wheel => {
                Some("does not support wheels; use midpoint, which conserves as much, or kahan_li8")
            }
            _ => None,
        }
    }
}

/// Whether the energy allows a spring to turn by π.
fn may_jump(body: &Gyrostat, torques: &[Torque], start: &Phase) -> bool {
    let half_a_turn = |t: &Torque| match t {
        Torque::TorsionSpring { stiffness, .. } if *stiffness > 0.0 => Some(t.potential_range()),
        Torque::TorsionSpring { .. } | Torque::Control { .. } => Some(0.0),
        _ => None,
    };
    let known = torques.iter().all(|t| t.potential(body, start).is_some());
    // Other laws may release the full range of their potentials.
    let range: f64 = torques.iter().filter(|t| half_a_turn(t).is_none()).map(Torque::potential_range).sum();
    let springs = |t: &&Torque| half_a_turn(t).is_some();
    let at_start: f64 = torques.iter().filter(springs).filter_map(|t| t.potential(body, start)).sum();
    let energy = body.kinetic(start.momentum) + at_start + range;
    torques.iter().filter_map(half_a_turn).any(|needed| !known || energy >= needed)
}

fn symmetric(body: &Gyrostat) -> bool {
    let [a, b, c] = body.moments;
    equal(a, b) || equal(b, c) || equal(c, a)
}

/// Typical relative rounding of one step: that of the sum and of the last turn.
pub(crate) const ROUNDING_OF_RUNGE_KUTTA: f64 = 0.4 * f64::EPSILON;

/// The rate of the fastest turn, in rad/s, a scale for steps: bounded by momentum, energy and torque.
pub(crate) fn fastest_rate(torques: &[Torque], start: &Point) -> f64 {
    let torque: f64 = torques.iter().map(|t| t.size_at(start)).sum();
    let Point { body, phase: start, .. } = *start;
    let smallest = body.moments.iter().fold(f64::INFINITY, |m: f64, x| m.min(*x));
    let omega = body.omega(start.momentum).norm().max(body.wheel.norm() / smallest);
    omega.hypot((2.0 * torque / smallest).sqrt()) + damping_rate(torques).abs()
}

#[cfg(test)]
mod tests;
