//! Closed form of a motion, if it has one.

use super::center::CenterMotion;
use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::exact::damped::DampedTop;
use crate::exact::free::FreeBody;
use crate::exact::lagrange::HeavyTop;
use crate::exact::larmor::LarmorSphere;
use crate::exact::motion::ExactMotion;
use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::methods::runge_kutta::RungeKutta;
use crate::numerics::double_double::DoubleDouble;
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use std::borrow::Cow;
use std::sync::Arc;

/// Largest turn in rad of a step whose error is rounding.
const LONGEST_TURN: f64 = 0.1;

/// Rotation and motion of the centre of mass in closed form.
#[derive(Clone, Debug)]
pub(crate) struct ClosedForm {
    body: Gyrostat,
    /// In principal axes.
    rotation: Arc<dyn ExactMotion>,
    center: CenterMotion,
    since: ElapsedTime<'static>,
}

impl ClosedForm {
    /// The closed form of this motion, if it has one; everything in principal axes.
    pub fn of(
        body: Gyrostat,
        rotor: Rotor,
        omega: Bivector,
        torques: &[Torque],
        center: CenterMotion,
    ) -> Option<ClosedForm> {
        let rotation = ExactBody::of(body.moments, rotor, omega, torques)?.motion()?;
        Some(ClosedForm::with(body, rotation, torques, center))
    }

    /// With the rotation in principal axes.
    pub fn with(
        body: Gyrostat,
        rotation: Arc<dyn ExactMotion>,
        torques: &[Torque],
        center: CenterMotion,
    ) -> ClosedForm {
        let since = ElapsedTime::new(center.time, body, torques.to_vec());
        ClosedForm { body, rotation, center, since }
    }

    /// How far from the start, in s, the phases are known backwards and forwards.
    pub fn horizons(&self) -> [f64; 2] {
        self.rotation.horizons().map(|horizon| horizon.min(self.center.law.horizon()))
    }

    /// The error at these times of treating moments that differ by rounding as equal; none without such an error.
    pub fn neglected(&self, times: &[f64]) -> Option<f64> {
        let at = |time: f64| self.rotation.neglected(self.since.elapsed(time).hi);
        // A completely different motion has no larger error.
        Some(times.iter().map(|&time| at(time)).fold(0.0, f64::max).min(1.0)).filter(|&error| error > 0.0)
    }

    /// The point of the motion at a time in s.
    pub fn at(&self, time: f64) -> Carried {
        // None of the laws depends on time.
        let (rotor, omega) = self.rotation.at(self.since.elapsed(time).hi);
        self.point(rotor, omega, time)
    }

    /// The points of the motion at times in s, with the times in lanes: the same bits as [`ClosedForm::at`].
    pub fn at_many(&self, times: &[f64]) -> Vec<Carried> {
        /// Times whose states stay in the caches.
        const TOGETHER: usize = 1024;
        let mut points = Vec::with_capacity(times.len());
        let room = times.len().min(TOGETHER);
        let (mut rotors, mut omegas) = (vec![[0.0; 4]; room], vec![[0.0; 3]; room]);
        for times in times.chunks(TOGETHER) {
            let elapsed: Vec<f64> = times.iter().map(|&time| self.since.elapsed(time).hi).collect();
            let (rotors, omegas) = (&mut rotors[..times.len()], &mut omegas[..times.len()]);
            let rows = (rotors.as_flattened_mut(), omegas.as_flattened_mut());
            self.rotation.at_many(Threads::ONE, &elapsed, rows.0, rows.1);
            points.extend(times.iter().zip(rotors).zip(omegas).map(|((&time, rotor), omega)| {
                self.point(Rotor::from_unit_components(*rotor), Bivector(*omega), time)
            }));
        }
        points
    }

    /// The point at a time, from the state at the rounded time since the start.
    fn point(&self, rotor: Rotor, omega: Bivector, time: f64) -> Carried {
        let phase = Phase { rotor, momentum: self.body.momentum(omega), time };
        Carried::new(self.since.at(phase), self.center.at(time))
    }
}

/// A body whose rotation has a closed form, before it is set up; everything in principal axes.
#[derive(Clone, Debug)]
pub(crate) enum ExactBody {
    Free(FreeBody),
    Heavy(HeavyTop),
    /// With the g of its torque.
    Damped(FreeBody, f64),
    Larmor(Arc<LarmorSphere>),
}

impl ExactBody {
    /// A body under these laws, if its rotation has a closed form.
    pub fn of(moments: [f64; 3], rotor: Rotor, omega: Bivector, torques: &[Torque]) -> Option<ExactBody> {
        let Some(first) = torques.first() else {
            return Some(ExactBody::Free(FreeBody::in_frame(Rotor::IDENTITY, moments, rotor, omega)));
        };
        let inertia = Inertia::from_principal_moments(moments).ok()?;
        // Laws of one kind add up.
        match first {
            Torque::Heavy(_) => {
                let add = |sum, t: &Torque| if let Torque::Heavy(c) = t { Some(sum + *c) } else { None };
                let c = torques.iter().try_fold(Vector::default(), add)?;
                Some(ExactBody::Heavy(HeavyTop::new(&inertia, rotor, omega, c).ok()?))
            }
            Torque::Damping(_) => {
                let each = torques.iter().map(|t| if let Torque::Damping(g) = t { Some(*g) } else { None });
                let damping = each.sum::<Option<f64>>()?;
                Some(ExactBody::Damped(DampedTop::body(&inertia, rotor, omega, damping).ok()?, damping))
            }
            Torque::Larmor(_) => {
                let add = |sum, t: &Torque| if let Torque::Larmor(b) = t { Some(sum + *b) } else { None };
                let b = torques.iter().try_fold(Vector::default(), add)?;
                Some(ExactBody::Larmor(Arc::new(LarmorSphere::new(&inertia, rotor, omega, b).ok()?)))
            }
            _ => None,
        }
    }

    /// The heavy top that it is.
    pub fn heavy(&self) -> Option<HeavyTop> {
        if let ExactBody::Heavy(top) = self { Some(*top) } else { None }
    }

    /// The damped body that it is, with the g of its torque.
    pub fn damped(&self) -> Option<(FreeBody, f64)> {
        if let ExactBody::Damped(body, damping) = self { Some((*body, *damping)) } else { None }
    }

    /// Its rotation, unless it is not resolved.
    pub fn motion(&self) -> Option<Arc<dyn ExactMotion>> {
        Some(match self {
            ExactBody::Free(body) => Arc::new(body.motion()),
            ExactBody::Heavy(top) => Arc::new(top.motion().ok()?),
            ExactBody::Damped(body, damping) => Arc::new(DampedTop::of(body, *damping).ok()?),
            ExactBody::Larmor(motion) => motion.clone(),
        })
    }
}

/// The time since the start of a motion in closed form, whose laws do not depend on time. The difference of two times is
/// rounded; a step covers the remainder.
#[derive(Clone, Debug)]
pub(crate) struct ElapsedTime<'a> {
    start: f64,
    body: Gyrostat,
    torques: Cow<'a, [Torque]>,
}

impl<'a> ElapsedTime<'a> {
    /// In principal axes; the start in s.
    pub fn new(start: f64, body: Gyrostat, torques: impl Into<Cow<'a, [Torque]>>) -> ElapsedTime<'a> {
        ElapsedTime { start, body, torques: torques.into() }
    }

    /// The rounded time since the start, and the remainder.
    pub fn elapsed(&self, time: f64) -> DoubleDouble {
        DoubleDouble::two_sum(time, -self.start)
    }

    /// The remainder of the time since a start.
    pub fn remainder(start: f64, time: f64) -> f64 {
        DoubleDouble::two_sum(time, -start).lo
    }

    /// The point at its time, from the state at the rounded time since the start.
    pub fn at(&self, phase: Phase) -> Phase {
        let rest = ElapsedTime::remainder(self.start, phase.time);
        if rest == 0.0 {
            return phase;
        }
        let stepper = RungeKutta::new(self.body, self.torques.to_vec(), None);
        let turn = self.body.omega(phase.momentum).norm() * rest.abs();
        let count = (turn / LONGEST_TURN).ceil().max(1.0);
        let mut at = Carried::new(phase, Center::default());
        for _ in 0..count as u64 {
            at = stepper.step(&at, rest / count, 0.0).map_or(at, |(next, _)| next);
        }
        Phase { time: phase.time, ..at.phase }
    }
}

/// An error if a closed form drifts in a conserved quantity, from each and its largest relative change.
pub(crate) fn check_kept(drifts: impl IntoIterator<Item = (Conserved, f64)>) -> Result<(), SimulateError> {
    /// Far above rounding.
    const MOST: f64 = 1e-9;
    match drifts.into_iter().find(|(_, drift)| drift.is_nan() || *drift > MOST) {
        Some((quantity, drift)) => Err(SimulateError::Drifted { quantity: quantity.name(), drift }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
