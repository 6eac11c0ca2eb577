//! Closed form of a motion, if it has one.

use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::exact::damped::DampedTop;
use crate::exact::free::FreeMotion;
use crate::exact::lagrange::LagrangeTop;
use crate::exact::larmor::LarmorSphere;
use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::methods::runge_kutta::RungeKutta;
use crate::numerics::double_double::DoubleDouble;
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Rotor, Vector};

/// Largest turn in rad of a step whose error is rounding.
const LONGEST_TURN: f64 = 0.1;

/// A rotation in closed form, in principal axes.
#[derive(Clone, Debug)]
pub(crate) enum Rotation {
    Free(Box<FreeMotion>),
    Lagrange(Box<LagrangeTop>),
    Damped(Box<DampedTop>),
    Larmor(LarmorSphere),
}

/// Rotation and uniformly accelerated translation in closed form.
#[derive(Clone, Debug)]
pub(crate) struct ClosedForm {
    body: Gyrostat,
    rotation: Rotation,
    fall: UniformAcceleration,
    since: ElapsedTime,
}

impl ClosedForm {
    /// The closed form of this motion, if it has one; everything in principal axes.
    pub fn of(
        body: Gyrostat,
        rotor: Rotor,
        omega: Bivector,
        torques: &[Torque],
        fall: UniformAcceleration,
    ) -> Option<ClosedForm> {
        let rotation = rotation(body.moments, rotor, omega, torques)?;
        Some(ClosedForm { body, rotation, fall, since: ElapsedTime::new(fall.time, body, torques) })
    }

    /// How far from the start, in s, the phase is known backwards and forwards.
    pub fn horizons(&self) -> [f64; 2] {
        match &self.rotation {
            Rotation::Free(motion) => [motion.horizon(); 2],
            Rotation::Lagrange(motion) => [motion.horizon(); 2],
            Rotation::Damped(motion) => motion.horizons(),
            Rotation::Larmor(motion) => [motion.horizon(); 2],
        }
    }

    /// The error at these times of treating moments that differ by rounding as equal; none without such an error.
    pub fn neglected(&self, times: &[f64]) -> Option<f64> {
        let at = |time: f64| match &self.rotation {
            Rotation::Free(_) | Rotation::Damped(_) => 0.0,
            Rotation::Lagrange(motion) => motion.neglected(self.since.elapsed(time).hi),
            Rotation::Larmor(motion) => motion.neglected(self.since.elapsed(time).hi),
        };
        // A completely different motion has no larger error.
        Some(times.iter().map(|&time| at(time)).fold(0.0, f64::max).min(1.0)).filter(|&error| error > 0.0)
    }

    /// The point of the motion at a time in s.
    pub fn at(&self, time: f64) -> Carried {
        // None of the laws depends on time.
        let DoubleDouble { hi: elapsed, lo: rest } = self.since.elapsed(time);
        let (rotor, omega) = match &self.rotation {
            Rotation::Free(motion) => motion.at(elapsed),
            Rotation::Lagrange(motion) => motion.at(elapsed),
            Rotation::Damped(motion) => motion.at(elapsed),
            Rotation::Larmor(motion) => motion.at(elapsed),
        };
        let phase = Phase { rotor, momentum: self.body.momentum(omega), time };
        Carried::new(self.since.later(phase, rest), self.fall.at(time))
    }
}

/// The closed form of the rotation under these laws, if there is one.
fn rotation(moments: [f64; 3], rotor: Rotor, omega: Bivector, torques: &[Torque]) -> Option<Rotation> {
    let Some(first) = torques.first() else {
        return Some(Rotation::Free(Box::new(FreeMotion::in_principal_axes(moments, rotor, omega))));
    };
    let inertia = Inertia::from_principal_moments(moments).ok()?;
    // Laws of one kind add up.
    match first {
        Torque::Heavy(_) => {
            let add = |sum, t: &Torque| if let Torque::Heavy(c) = t { Some(sum + *c) } else { None };
            let c = torques.iter().try_fold(Vector::default(), add)?;
            LagrangeTop::new(&inertia, rotor, omega, c).ok().map(Box::new).map(Rotation::Lagrange)
        }
        Torque::Damping(_) => {
            let each = torques.iter().map(|t| if let Torque::Damping(g) = t { Some(*g) } else { None });
            let damping = each.sum::<Option<f64>>()?;
            DampedTop::new(&inertia, rotor, omega, damping).ok().map(Box::new).map(Rotation::Damped)
        }
        Torque::Larmor(_) => {
            let add = |sum, t: &Torque| if let Torque::Larmor(b) = t { Some(sum + *b) } else { None };
            let b = torques.iter().try_fold(Vector::default(), add)?;
            LarmorSphere::new(&inertia, rotor, omega, b).ok().map(Rotation::Larmor)
        }
        _ => None,
    }
}

/// The time since the start of a motion in closed form, whose laws do not depend on time. The difference of two times is
/// rounded; a step covers the remainder.
#[derive(Clone, Debug)]
pub(crate) struct ElapsedTime {
    start: f64,
    body: Gyrostat,
    stepper: RungeKutta,
}

impl ElapsedTime {
    /// In principal axes; the start in s.
    pub fn new(start: f64, body: Gyrostat, torques: &[Torque]) -> ElapsedTime {
        ElapsedTime { start, body, stepper: RungeKutta::new(body, torques.to_vec(), None) }
    }

    /// The rounded time since the start, and the remainder.
    pub fn elapsed(&self, time: f64) -> DoubleDouble {
        DoubleDouble::two_sum(time, -self.start)
    }

    /// The point a remainder of time later, with the time unchanged.
    pub fn later(&self, phase: Phase, rest: f64) -> Phase {
        if rest == 0.0 {
            return phase;
        }
        let turn = self.body.omega(phase.momentum).norm() * rest.abs();
        let count = (turn / LONGEST_TURN).ceil().max(1.0);
        let mut at = Carried::new(phase, Center::default());
        for _ in 0..count as u64 {
            at = self.stepper.step(&at, rest / count, 0.0).map_or(at, |(next, _)| next);
        }
        Phase { time: phase.time, ..at.phase }
    }
}

/// An error if a closed form drifts in a conserved quantity.
pub(crate) fn check_kept(drifts: &[(Conserved, f64, f64)]) -> Result<(), SimulateError> {
    /// Far above rounding.
    const MOST: f64 = 1e-9;
    match drifts.iter().find(|(_, _, drift)| drift.is_nan() || *drift > MOST) {
        Some(&(quantity, _, drift)) => Err(SimulateError::Drifted { quantity: quantity.name(), drift }),
        None => Ok(()),
    }
}

/// The motion of a centre of mass under a constant force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UniformAcceleration {
    /// The time of the start, in s.
    pub time: f64,
    /// The centre of mass at the start.
    pub start: Center,
    /// In m/s².
    pub acceleration: Vector,
}

impl UniformAcceleration {
    /// The centre of mass at a time in s.
    pub fn at(&self, time: f64) -> Center {
        let UniformAcceleration { time: begin, start, acceleration } = *self;
        let time = time - begin;
        // t² may overflow where no force needs it.
        let fallen = |a: f64| if a == 0.0 { 0.0 } else { 0.5 * a * time * time };
        Center {
            position: start.position + start.velocity * time + Vector(acceleration.0.map(fallen)),
            velocity: start.velocity + acceleration * time,
        }
    }
}

#[cfg(test)]
mod tests;
