//! Events along a motion: zero crossings of a quantity.

use super::formula::Formula;
use crate::error::TorqueError;
use crate::state::carried::Carried;
use crate::state::point::{Function, Point};
use polhode_ga::{Bivector, Rotor, Vector};

/// The quantity of an event. Vectors and bivectors of the body are in body axes.
#[derive(Clone, Debug)]
pub enum Quantity {
    /// `(R a ~R)·n − level`, with directions a of the body and n of space: an axis of the body crosses a plane or reaches
    /// an angle.
    Axis {
        /// In body axes.
        body: Vector,
        /// In space.
        space: Vector,
        /// The cosine of the angle for unit vectors.
        level: f64,
    },
    /// `Ω_B·B − level`: the spin in a plane of the body, by the dot product of components.
    Spin {
        /// In body axes.
        plane: Bivector,
        /// In rad/s for a unit bivector.
        level: f64,
    },
    /// `x·n − level`: the centre of mass crosses a plane.
    Position {
        /// In space.
        normal: Vector,
        /// In m for a unit vector.
        level: f64,
    },
    /// A formula.
    Formula(Formula),
    /// A function of the caller.
    Function(Function<f64>),
}

/// An event of a motion.
#[derive(Clone, Debug)]
pub struct Event {
    /// The quantity that crosses zero.
    pub quantity: Quantity,
    /// Only rising or only falling crossings, in the direction in which the motion is computed, or both.
    pub direction: Option<Direction>,
    /// Whether the motion ends there.
    pub terminal: bool,
}

/// The direction of a crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
}

/// An occurrence of an event.
#[derive(Clone, Copy, Debug)]
pub struct Occurrence {
    /// Index of the event.
    pub event: usize,
    /// Direction of the crossing.
    pub direction: Direction,
    /// The state at the event.
    pub at: Carried,
}

impl Quantity {
    fn in_axes(self, frame: Rotor) -> Quantity {
        let back = frame.reverse();
        match self {
            Quantity::Axis { body, space, level } => Quantity::Axis { body: back.apply(body), space, level },
            Quantity::Spin { plane, level } => Quantity::Spin { plane: back.apply_bivector(plane), level },
            Quantity::Position { .. } => self,
            Quantity::Formula(formula) => Quantity::Formula(formula.in_axes(frame)),
            Quantity::Function(function) => Quantity::Function(function.in_axes(frame)),
        }
    }

    /// Its value.
    pub fn value(&self, at: &Point) -> Result<f64, TorqueError> {
        let value = match self {
            Quantity::Axis { body, space, level } => at.phase.rotor.apply(*body).dot(*space) - level,
            Quantity::Spin { plane, level } => {
                let (w, b) = (at.body.omega(at.phase.momentum).0, plane.0);
                w[0] * b[0] + w[1] * b[1] + w[2] * b[2] - level
            }
            Quantity::Position { normal, level } => at.center.position.dot(*normal) - level,
            Quantity::Formula(formula) => {
                formula.value(at)?.components().first().copied().unwrap_or(f64::NAN)
            }
            Quantity::Function(function) => function.value(at)?,
        };
        if value.is_nan() {
            return Err(TorqueError("its value is NaN".into()));
        }
        Ok(value)
    }
}

impl Event {
    /// The same event with its body components seen from other body axes: `x' = ~F x F`.
    pub fn in_axes(self, frame: Rotor) -> Event {
        Event { quantity: self.quantity.in_axes(frame), ..self }
    }
}

/// The crossing between two values, if any. A zero at the first value belongs to the interval before.
pub(crate) fn crossing(before: f64, after: f64) -> Option<Direction> {
    match () {
        () if before < 0.0 && after >= 0.0 => Some(Direction::Rising),
        () if before > 0.0 && after <= 0.0 => Some(Direction::Falling),
        () => None,
    }
}

/// Largest height of the first vertex above zero, relative to the depth of the parabola, that is examined further.
const DOUBT: f64 = 0.1;

/// Finds a zero crossing that three samples of equal sign miss: a time at which the sign differs, and the value there.
/// Tries the vertices of parabolas through three values, each narrower than the last.
pub(crate) fn dip<E>(
    mut points: [(f64, f64); 3],
    mut function: impl FnMut(f64) -> Result<f64, E>,
) -> Result<Option<(f64, f64)>, E> {
    let sign = points[1].1.signum();
    if points.iter().any(|p| p.1 * sign <= 0.0) {
        return Ok(None);
    }
    for narrower in 0..40 {
        let [(t0, y0), (t1, y1), (t2, y2)] = points.map(|(t, y)| (t, y * sign));
        // y1 + b (t − t1) + a (t − t1)².
        let (left, right) = ((y1 - y0) / (t1 - t0), (y2 - y1) / (t2 - t1));
        let a = (right - left) / (t2 - t0);
        let b = left + a * (t1 - t0);
        let way = -0.5 * b / a;
        let lowest = y1 + 0.5 * b * way;
        // a > 0 for a parabola that opens upwards, also backwards in time; false for NaN. A minimum just outside is
        // tried too; others are found by the next three samples.
        let near = (t1 + way - 0.5 * (t0 + t2)).abs() <= 0.6 * (t2 - t0).abs();
        if !(a > 0.0 && near) || narrower == 0 && lowest > DOUBT * (y0.max(y2) - lowest) {
            return Ok(None);
        }
        let margin = 1e-3 * (t2 - t0);
        let at = if t2 > t0 {
            (t1 + way).clamp(t0 + margin, t2 - margin)
        } else {
            (t1 + way).clamp(t2 - margin, t0 + margin)
        };
        if at == t1 {
            return Ok(None);
        }
        let value = function(at)?;
        let y = value * sign;
        if y < 0.0 {
            return Ok(Some((at, value)));
        }
        // It has converged above zero.
        if y.is_nan() || (y - y1).abs() <= 0.25 * y {
            return Ok(None);
        }
        let [first, middle, last] = points;
        let beyond = (at - t1) * (t2 - t1) > 0.0;
        points = match (y < y1, beyond) {
            (true, true) => [middle, (at, value), last],
            (true, false) => [first, (at, value), middle],
            (false, true) => [first, middle, (at, value)],
            (false, false) => [(at, value), middle, last],
        };
    }
    Ok(None)
}

/// The root of a function in (low, high) to the spacing `least`, by false position with the Illinois rule, safeguarded by
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
        // Bisect if one end has not moved for several iterations.
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

    /// Two crossings between three samples.
    #[test]
    fn a_dip_below_zero_is_found() {
        let find = |f: &dyn Fn(f64) -> f64, times: [f64; 3]| {
            let mut calls = 0;
            let found = dip::<()>(times.map(|t| (t, f(t))), |t| {
                calls += 1;
                Ok(f(t))
            });
            (found.unwrap(), calls)
        };
        for (times, sign) in [([0.0, 0.2, 0.4], 1.0), ([0.4, 0.2, 0.0], -1.0)] {
            for lowest in [0.05, 0.11, 0.2, 0.3, 0.37] {
                for depth in [1e-3, 1e-6, 1e-9, 1e-12] {
                    let below = |t: f64| sign * (1.0 - (t - lowest).cos() - depth);
                    let (found, calls) = find(&below, times);
                    let seen = times.iter().any(|&t| below(t) * sign < 0.0);
                    assert!(seen || found.is_some_and(|(_, value)| value * sign < 0.0), "{lowest} {depth}");
                    assert!(calls <= 12, "{calls}");
                    let above = |t: f64| sign * (1.0 - (t - lowest).cos() + depth);
                    let (found, calls) = find(&above, times);
                    assert!(found.is_none() && calls <= 12, "{found:?} {calls}");
                }
            }
        }
        // Far from zero the function is not called.
        assert_eq!(find(&|t| 2.0 + t.cos(), [0.0, 0.2, 0.4]), (None, 0));
        assert_eq!(find(&|t| 2.0 - t.cos(), [-0.2, 0.0, 0.2]), (None, 0));
    }

    #[test]
    fn crossings_are_counted_once() {
        assert_eq!(crossing(-1.0, 0.0), Some(Direction::Rising));
        assert_eq!(crossing(0.0, 1.0), None);
        assert_eq!(crossing(1.0, -1.0), Some(Direction::Falling));
        assert_eq!(crossing(f64::NAN, 1.0), None);
    }
}
