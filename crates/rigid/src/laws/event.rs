//! Events along a motion: zero crossings of a quantity.

use super::formula::{Formula, Motion};
use crate::error::TorqueError;
use crate::state::carried::Carried;
use crate::state::phase::Phase;
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

    /// Whether it may depend on the centre of mass.
    pub(crate) fn reads_center(&self) -> bool {
        match self {
            Quantity::Axis { .. } | Quantity::Spin { .. } => false,
            Quantity::Position { .. } | Quantity::Function(_) => true,
            Quantity::Formula(formula) => formula.reads_center(),
        }
    }

    /// The shortest time in s from a turning point to the next as a formula changes with time between two times, at a fixed
    /// point of the motion; infinite for fewer than two turning points, and for functions of the caller, which are called at
    /// points of the motion only.
    pub(crate) fn oscillates_within(&self, at: &Point, [from, to]: [f64; 2]) -> f64 {
        /// Changes below this, relative to the largest value, are rounding.
        const ROUNDING: f64 = 1e-12;
        /// Intervals between samples.
        const COUNT: u32 = 4096;
        let formula = match self {
            Quantity::Formula(formula) if formula.needs(|motion| matches!(motion, Motion::Time)) => formula,
            _ => return f64::INFINITY,
        };
        let part = (to - from) / f64::from(COUNT);
        let times: Vec<f64> = (0..=COUNT).map(|k| from + part * f64::from(k)).collect();
        let value = |&time: &f64| self.value(&Point { phase: &Phase { time, ..*at.phase }, ..*at });
        let one_by_one = || times.iter().map(value).collect::<Result<Vec<f64>, _>>().ok();
        // It may have no value at this point.
        let Some(values) = formula.numbers_at(at, &times).or_else(one_by_one) else {
            return f64::INFINITY;
        };
        let least = ROUNDING * values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let (mut rises, mut last, mut shortest) = (None, None, f64::INFINITY);
        for (k, pair) in (0..COUNT).zip(values.windows(2)) {
            if (pair[1] - pair[0]).abs() <= least {
                continue;
            }
            let now = pair[1] > pair[0];
            if rises.is_some_and(|before| before != now) {
                shortest = last.map_or(shortest, |last: u32| shortest.min(part * f64::from(k - last)));
                last = Some(k);
            }
            rises = Some(now);
        }
        shortest
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
            return Err(TorqueError::new("its value is NaN"));
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
mod tests;
