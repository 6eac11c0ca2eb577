//! The arguments of formulas, functions, forces and events.

use super::center::Center;
use super::phase::{Gyrostat, Phase};
use crate::error::TorqueError;
use polhode_ga::{Bivector, Rotor, Vector};
use std::fmt;
use std::sync::Arc;

/// A point of a motion, in principal axes.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// The body.
    pub body: &'a Gyrostat,
    /// Its mass in kg; NaN where unknown.
    pub mass: f64,
    /// Attitude, momentum and time.
    pub phase: &'a Phase,
    /// The centre of mass.
    pub center: &'a Center,
}

/// A point of the motion in the body axes of the user.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// In s.
    pub time: f64,
    /// Body axes to space.
    pub rotor: Rotor,
    /// In body axes, rad/s.
    pub omega: Bivector,
    /// In m.
    pub position: Vector,
    /// In m/s.
    pub velocity: Vector,
}

impl<'a> Point<'a> {
    /// A body of unknown mass, with the centre of mass at rest at the origin of space.
    pub fn at_rest(body: &'a Gyrostat, phase: &'a Phase) -> Point<'a> {
        const ORIGIN: Center = Center { position: Vector([0.0; 3]), velocity: Vector([0.0; 3]) };
        Point { body, mass: f64::NAN, phase, center: &ORIGIN }
    }

    /// The point in the user's axes, to which `frame` leads from the principal axes.
    pub fn seen(&self, frame: Rotor) -> Seen {
        Seen {
            time: self.phase.time,
            rotor: self.phase.rotor * frame.reverse(),
            omega: frame.apply_bivector(self.body.omega(self.phase.momentum)),
            position: self.center.position,
            velocity: self.center.velocity,
        }
    }
}

type Call<T> = dyn Fn(&Seen) -> Result<T, TorqueError> + Send + Sync;

/// A quantity given by a user's function: a torque, a force in space, or a number.
#[derive(Clone)]
pub struct Function<T> {
    call: Arc<Call<T>>,
    /// From the axes of the motion to those of the function.
    frame: Rotor,
    reads_center: bool,
}

impl<T> Function<T> {
    /// From a function of the point in body axes and in space.
    pub fn new(call: impl Fn(&Seen) -> Result<T, TorqueError> + Send + Sync + 'static) -> Function<T> {
        Function { call: Arc::new(call), frame: Rotor::IDENTITY, reads_center: true }
    }

    /// The same, if it depends on position and velocity or does not.
    pub fn reading_center(self, reads_center: bool) -> Function<T> {
        Function { reads_center, ..self }
    }

    pub(crate) fn in_axes(self, frame: Rotor) -> Function<T> {
        Function { frame: self.frame * frame, ..self }
    }

    pub(crate) fn reads_center(&self) -> bool {
        self.reads_center
    }

    pub(crate) fn frame(&self) -> Rotor {
        self.frame
    }

    pub(crate) fn value(&self, at: &Point) -> Result<T, TorqueError> {
        (self.call)(&at.seen(self.frame))
    }
}

impl<T> fmt::Debug for Function<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Function")
    }
}
