//! A body stepped by itself, by any method.

use super::{Member, Steps};
use crate::error::SimulateError;
use crate::laws::driven_wheels::driven;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::run::engine::Engine;
use crate::run::sweep::is_finite;
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::Phase;
use polhode_ga::{Bivector, Rotor};

/// Its state.
#[derive(Clone, Debug)]
pub(super) struct Alone {
    at: Carried,
}

impl Alone {
    pub fn new(_: &Member) -> Alone {
        let start = Phase { rotor: Rotor::IDENTITY, momentum: Bivector::default(), time: 0.0 };
        Alone { at: Carried::new(start, Center::default()) }
    }

    pub fn reset(&mut self, member: &Member, phase: Phase, center: Center) {
        self.at = Carried::new(phase, center).with_wheels(driven(&member.torques, phase.time));
    }

    pub fn center(&self) -> Center {
        self.at.center
    }

    /// The angular velocity in principal axes.
    pub fn principal_omega(&self, member: &Member) -> Bivector {
        member.gyrostat.omega(self.at.phase.momentum)
    }

    /// Rotor (body axes to space) and angular velocity in body axes.
    pub fn spin(&self, member: &Member) -> (Rotor, Bivector) {
        let (rotor, omega) = (self.at.phase.rotor, member.gyrostat.omega(self.at.phase.momentum));
        if member.frame == Rotor::IDENTITY {
            return (rotor, omega);
        }
        (rotor * member.frame.reverse(), member.frame.apply_bivector(omega))
    }

    /// The state after equal steps, pieces of a step of the caller, under a held torque.
    pub fn stepped(
        &self,
        method: Method,
        member: &Member,
        held: Option<Torque>,
        pieces: &[Steps],
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<Alone, SimulateError> {
        /// Steps between calls of `go_on`.
        const BETWEEN_CHECKS: u64 = 256;
        let mut torques = member.torques.clone();
        torques.extend(held);
        let translation = member.translation.clone();
        let engine = Engine::new(method, member.gyrostat, &torques, translation, &self.at.phase)?;
        let mut at = self.at;
        for steps in pieces {
            for k in 0..steps.count {
                let (from, h) = steps.nth(k);
                at.phase.time = from;
                let (next, error) = engine.step(&at, h, 0.0)?;
                if error.is_nan() || !is_finite(&next) {
                    return Err(SimulateError::Diverged { time: from + h });
                }
                at = next;
                if k % BETWEEN_CHECKS == BETWEEN_CHECKS - 1 && !go_on() {
                    return Err(SimulateError::Interrupted);
                }
            }
            at.phase.time = steps.to;
        }
        Ok(Alone { at })
    }
}
