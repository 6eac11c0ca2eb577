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

impl Point<'_> {
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

/// A quantity given by a user's function: a force in space, or a number.
#[derive(Clone)]
pub struct Function<T> {
    call: Arc<Call<T>>,
    /// From the axes of the motion to those of the function.
    frame: Rotor,
}

impl<T> Function<T> {
    /// From a function of the point in body axes and in space.
    pub fn new(call: impl Fn(&Seen) -> Result<T, TorqueError> + Send + Sync + 'static) -> Function<T> {
        Function { call: Arc::new(call), frame: Rotor::IDENTITY }
    }

    pub(crate) fn in_axes(self, frame: Rotor) -> Function<T> {
        Function { call: self.call, frame: self.frame * frame }
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
