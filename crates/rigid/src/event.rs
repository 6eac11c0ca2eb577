//! Events along a motion: when a quantity passes zero.

use crate::runge_kutta::Carried;
use crate::torque::TorqueError;
use polhode_ga::{Bivector, Rotor, Vector};
use std::fmt;
use std::sync::Arc;

/// A quantity of a point of the motion by a function: of time, rotor (body axes to space), angular velocity in body
/// axes, position and velocity.
pub type Function = dyn Fn(&Seen) -> Result<f64, TorqueError> + Send + Sync;

/// A point of the motion as an event sees it, in the body axes of the user.
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

/// What passes zero.
#[derive(Clone)]
pub enum Quantity {
    /// `(R a ~R)·n − level`, with a direction a of the body and n of space: an axis of the body crosses a plane or
    /// reaches an angle.
    Axis {
        /// Of the body.
        body: Vector,
        /// Of space.
        space: Vector,
        /// The cosine of the angle for unit vectors.
        level: f64,
    },
    /// `Ω_B·B − level`: the spin in a plane of the body, by the dot product of components.
    Spin {
        /// Of the body.
        plane: Bivector,
        /// In rad/s for a unit bivector.
        level: f64,
    },
    /// `x·n − level`: the centre of mass crosses a plane.
    Position {
        /// Of space.
        normal: Vector,
        /// In m for a unit vector.
        level: f64,
    },
    /// Any other.
    Function(Arc<Function>),
}

impl fmt::Debug for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Quantity::Axis { body, space, level } => write!(f, "Axis({body:?}, {space:?}, {level})"),
            Quantity::Spin { plane, level } => write!(f, "Spin({plane:?}, {level})"),
            Quantity::Position { normal, level } => write!(f, "Position({normal:?}, {level})"),
            Quantity::Function(_) => f.write_str("Function"),
        }
    }
}

/// What to look for along a motion.
#[derive(Clone, Debug)]
pub struct Event {
    /// What passes zero.
    pub quantity: Quantity,
    /// Only upwards in the direction of time in which the motion is followed, only downwards, or both.
    pub direction: Option<Direction>,
    /// Whether the motion ends there.
    pub terminal: bool,
}

/// Which way a quantity passes zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
}

/// An event that happened.
#[derive(Clone, Copy, Debug)]
pub struct Happened {
    /// Which event.
    pub event: usize,
    /// Which way.
    pub direction: Direction,
    /// Where.
    pub at: Carried,
}

impl Quantity {
    /// Its value.
    pub fn value(&self, seen: &Seen) -> Result<f64, TorqueError> {
        Ok(match self {
            Quantity::Axis { body, space, level } => seen.rotor.apply(*body).dot(*space) - level,
            Quantity::Spin { plane, level } => {
                let (w, b) = (seen.omega.0, plane.0);
                w[0] * b[0] + w[1] * b[1] + w[2] * b[2] - level
            }
            Quantity::Position { normal, level } => seen.position.dot(*normal) - level,
            Quantity::Function(function) => function(seen)?,
        })
    }
}

/// The crossing between two values, if there is one. A value that is zero at the start has been counted before.
pub(crate) fn crossing(before: f64, after: f64) -> Option<Direction> {
    if before < 0.0 && after >= 0.0 {
        Some(Direction::Rising)
    } else if before > 0.0 && after <= 0.0 {
        Some(Direction::Falling)
    } else {
        None
    }
}

/// Where in (low, high) a function passes zero, to the spacing `least`: false position with the Illinois rule, guarded by
/// bisection. `at_low` and `at_high` differ in sign.
pub(crate) fn root<E>(
    (mut low, mut high): (f64, f64),
    (mut at_low, mut at_high): (f64, f64),
    least: f64,
    mut function: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let mut side: i32 = 0;
    for _ in 0..200 {
        if (high - low).abs() <= least || at_high == 0.0 {
            break;
        }
        let secant = high - at_high * (high - low) / (at_high - at_low);
        let inside = (secant - low) * (secant - high) < 0.0;
        // One end that has not moved for long calls for bisection.
        let middle = if inside && side.abs() < 4 { secant } else { 0.5 * (low + high) };
        let value = function(middle)?;
        if value == 0.0 {
            return Ok(middle);
        }
        if (value < 0.0) == (at_low < 0.0) {
            (low, at_low) = (middle, value);
            side = if side < 0 { side - 1 } else { -1 };
            if side < -1 {
                at_high *= 0.5;
            }
        } else {
            (high, at_high) = (middle, value);
            side = if side > 0 { side + 1 } else { 1 };
            if side > 1 {
                at_low *= 0.5;
            }
        }
    }
    Ok(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_to_the_spacing() {
        let find = |f: &dyn Fn(f64) -> f64, low: f64, high: f64| {
            let mut calls = 0;
            let root = root::<()>((low, high), (f(low), f(high)), 1e-15, |x| {
                calls += 1;
                Ok(f(x))
            });
            (root.unwrap(), calls)
        };
        let (x, calls) = find(&|x| x.cos() - x, 0.0, 1.0);
        assert!((x - 0.739_085_133_215_160_6).abs() < 2e-15 && calls < 20, "{x} {calls}");
        // A triple root, and a jump.
        let (x, _) = find(&|x| (x - 0.3).powi(3), 0.0, 1.0);
        assert!((x - 0.3).abs() < 1e-5);
        let (x, _) = find(&|x| if x < 0.7 { -1e-9 } else { 1e3 }, 0.0, 1.0);
        assert!((x - 0.7).abs() < 1e-14);
    }

    #[test]
    fn crossings_are_counted_once() {
        assert_eq!(crossing(-1.0, 0.0), Some(Direction::Rising));
        assert_eq!(crossing(0.0, 1.0), None);
        assert_eq!(crossing(1.0, -1.0), Some(Direction::Falling));
        assert_eq!(crossing(f64::NAN, 1.0), None);
    }
}
