//! Torques and accelerations for steppers: of bodies in lanes, or of one body.

use super::driven_wheels::driven;
use super::force::Translation;
use super::torque::{Torque, total_torque};
use crate::error::SimulateError;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::simd::lanes::{Lanes, One, PerLane};
use polhode_ga::{Bivector, Rotor};

/// States of bodies in lanes. The fields stay in this order, so that rotor and ω begin at cache lines if the whole does.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct Place<const W: usize, const F: bool> {
    /// From principal axes to space; |R| is 1 up to the error of a step.
    pub rotor: [Lanes<W, F>; 4],
    /// In principal axes, rad/s.
    pub omega: [Lanes<W, F>; 3],
    /// In s.
    pub time: PerLane<W>,
}

/// Torques and accelerations of bodies in lanes.
pub(crate) trait Forcing<const W: usize, const F: bool> {
    /// Whether there are torques, wheels or damping.
    const ACTS: bool;

    /// Whether there may be wheels.
    const WHEELS: bool = true;

    /// Begins a step with this middle, in s: laws that jump in time are taken on its side of the jump. By default laws
    /// do not jump.
    #[inline(always)]
    fn begin(&mut self, _: Lanes<W, F>) {}

    /// Announces the times of the next evaluations, in order: what depends on time alone may be computed for many at once.
    /// Evaluations at other times are possible.
    #[inline(always)]
    fn ahead(&mut self, _: impl Iterator<Item = f64> + Clone) {}

    /// The torque in principal axes, without damping `−g I(Ω)` and the reaction of a wheel, at position and velocity of
    /// the centre of mass; zeros where steps do not follow it.
    fn torque(&mut self, at: &Place<W, F>, center: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3];

    /// The momentum of all wheels in principal axes, from that of those without motors.
    #[inline(always)]
    fn wheel(&self, steady: &[Lanes<W, F>; 3], _: &Lanes<W, F>) -> [Lanes<W, F>; 3] {
        *steady
    }

    /// The acceleration in space of a centre of mass with this position and velocity; zero by default.
    #[inline(always)]
    fn acceleration(&mut self, _: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        [Lanes::ZERO; 3]
    }

    /// The speed of a centre of mass below which errors are not relative to smaller ones; zero by default.
    #[inline(always)]
    fn least_speed(&self) -> Lanes<W, F> {
        Lanes::ZERO
    }
}

/// Forcing of a single body. The first failure is stored; after it, no law is evaluated.
pub(crate) struct BodyForcing<'a> {
    body: &'a Gyrostat,
    torques: &'a [Torque],
    translation: Option<&'a Translation>,
    /// Wheels with motors, whose momentum the steps carry.
    wheels: &'a [Torque],
    least_speed: f64,
    /// Of the step.
    middle: f64,
    failure: Option<SimulateError>,
}

impl<'a> BodyForcing<'a> {
    /// In principal axes.
    pub fn new(
        body: &'a Gyrostat,
        torques: &'a [Torque],
        translation: Option<&'a Translation>,
    ) -> BodyForcing<'a> {
        let least_speed = 0.0;
        BodyForcing { body, torques, translation, wheels: &[], least_speed, middle: f64::NAN, failure: None }
    }

    /// The same with wheels, whose momentum the steps carry, instead of their torque on the body.
    pub fn with_wheels(self, wheels: &'a [Torque]) -> BodyForcing<'a> {
        BodyForcing { wheels, ..self }
    }

    /// The same with a lower bound of the scale of speeds.
    pub fn with_least_speed(self, least_speed: f64) -> BodyForcing<'a> {
        BodyForcing { least_speed, ..self }
    }

    /// The first failure, if there was one.
    pub fn finish(self) -> Result<(), SimulateError> {
        self.failure.map_or(Ok(()), Err)
    }

    fn noted(&mut self, value: Result<[f64; 3], SimulateError>) -> [One; 3] {
        let value = value.unwrap_or_else(|failure| {
            self.failure.get_or_insert(failure);
            [f64::NAN; 3]
        });
        One::each(value)
    }

    fn phase(&self, at: &Place<1, false>) -> Phase {
        let rotor = Rotor::from_unit_components(One::alone(at.rotor));
        let momentum = self.body.momentum(Bivector(One::alone(at.omega)));
        Phase { rotor, momentum, time: at.time.of(0) }
    }
}

impl Forcing<1, false> for BodyForcing<'_> {
    const ACTS: bool = true;

    fn begin(&mut self, middle: One) {
        self.middle = middle.0[0];
    }

    fn torque(&mut self, at: &Place<1, false>, center: &[One; 6]) -> [One; 3] {
        if self.torques.is_empty() || self.failure.is_some() {
            return [One::ZERO; 3];
        }
        let (phase, center) = (&self.phase(at), &Center::from(One::alone(*center)));
        let at = Point { center, ..Point::at_rest(self.body, phase) };
        let torque = total_torque(self.torques, &at, self.middle);
        self.noted(torque.map(|torque| torque.0))
    }

    fn wheel(&self, steady: &[One; 3], time: &One) -> [One; 3] {
        match driven(self.wheels, time.0[0]) {
            Some(driven) => One::each((Bivector(One::alone(*steady)) + driven).0),
            None => *steady,
        }
    }

    fn least_speed(&self) -> One {
        Lanes::all(self.least_speed)
    }

    fn acceleration(&mut self, at: &Place<1, false>, center: &[One; 6]) -> [One; 3] {
        let Some(translation) = self.translation.filter(|_| self.failure.is_none()) else {
            return [One::ZERO; 3];
        };
        let phase = self.phase(at);
        let acceleration = translation.acceleration(self.body, &phase, &Center::from(One::alone(*center)));
        self.noted(acceleration.map(|a| a.0).map_err(|error| error.at(phase.time)))
    }
}
