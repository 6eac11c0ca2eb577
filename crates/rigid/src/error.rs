//! Errors of bodies, torques and simulations.

use polhode_ga::Vector;
use std::fmt;

/// Why a simulation failed.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum SimulateError {
    /// Moments must be positive to turn momentum into rate.
    SingularInertia { moments: [f64; 3] },
    /// All three moments differ, but two must be equal.
    NotSymmetric { moments: [f64; 3] },
    /// The moments differ, but all must be equal.
    NotSpherical { moments: [f64; 3] },
    /// The centre of mass is off the axis of symmetry.
    OffAxis { c: Vector, axis: Vector },
    /// The closed form misses its start or its integrals: the roots of its cubic are too close to each other.
    Unresolved,
    /// A closed form drifts in a conserved quantity, by this relative amount.
    Drifted { quantity: &'static str, drift: f64 },
    /// Output times must be finite and must not decrease.
    BadTime { index: usize, time: f64 },
    /// A step, tolerance, angular velocity or torque that is not usable.
    BadValue { what: &'static str, value: f64 },
    /// The phase of an exact motion is not known this far from its start.
    BeyondHorizon { index: usize, time: f64, start: f64, horizon: f64 },
    /// A time outside the computed motion.
    OutsideMotion { index: usize, time: f64, first: f64, last: f64 },
    /// More steps than the limit allows.
    TooManySteps { steps: f64, step: f64, limit: f64 },
    /// Stability requires steps much shorter than the motion; use a method for stiff laws.
    Stiff { steps: f64 },
    /// Halving the step no longer reduces the difference of two runs.
    NotConverged { rtol: f64, reached: f64, step: f64 },
    /// The method does not support these laws.
    Unfit { method: &'static str, reason: &'static str },
    /// No step is short enough.
    StepTooSmall { time: f64, step: f64 },
    /// A law cannot be evaluated at this time.
    Torque { time: f64, message: String },
    /// A component became NaN or infinite.
    Diverged { time: f64 },
    /// A step of the method turns a body too far.
    StepTurnsTooFar { step: f64, turn: f64 },
    /// The caller stopped the run.
    Interrupted,
}

impl SimulateError {
    /// Time in the motion at which it failed, in s; none for errors found before.
    pub fn time(&self) -> Option<f64> {
        match self {
            SimulateError::StepTooSmall { time, .. }
            | SimulateError::Torque { time, .. }
            | SimulateError::Diverged { time } => Some(*time),
            _ => None,
        }
    }
}

impl fmt::Display for SimulateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SimulateError::SingularInertia { moments: [a, b, c] } => write!(
                f,
                "principal moments {a}, {b}, {c} kg m² include a zero, so the rate about that axis is undefined; \
                 give the body some thickness"
            ),
            SimulateError::NotSymmetric { moments: [a, b, c] } => write!(
                f,
                "the principal moments {a}, {b}, {c} kg m² all differ: not a symmetric top; use simulate"
            ),
            SimulateError::NotSpherical { moments: [a, b, c] } => write!(
                f,
                "the principal moments {a}, {b}, {c} kg m² are not equal: not a sphere; use simulate"
            ),
            SimulateError::OffAxis { c: Vector([x, y, z]), axis: Vector([p, q, r]) } => write!(
                f,
                "c = ({x}, {y}, {z}) N m is not along the axis of symmetry ({p}, {q}, {r}); use simulate"
            ),
            SimulateError::Unresolved => write!(
                f,
                "the closed form of this top is not resolved in floating point: the turning points of its tilt are too \
                 close to each other; use simulate, which integrates numerically"
            ),
            SimulateError::Drifted { quantity, drift } => write!(
                f,
                "the {} of the closed form drifts by {drift:.1e} (relative), but the motion conserves it; use a stepping \
                 method, such as method=\"rkn6\"",
                quantity.replace('_', " ")
            ),
            SimulateError::BadTime { index, time } => {
                write!(
                    f,
                    "times[{index}] = {time}: output times must be finite and must not decrease; sort them"
                )
            }
            SimulateError::BadValue { what, value } => write!(
                f,
                "{what} is {value}; it must be finite{}",
                match *what {
                    "step" | "rtol" | "max_step" => " and positive",
                    "max_steps" => " and at least 1",
                    "the damping g" => " and below 1e150",
                    _ => "",
                }
            ),
            SimulateError::BeyondHorizon { index, time, start, horizon } => {
                let from =
                    if *start == 0.0 { String::new() } else { format!(" from the start at {start} s") };
                let near = if *start == 0.0 { "0" } else { "the start" };
                write!(
                    f,
                    "times[{index}] = {time:e} s is beyond {horizon:.1e} s{from}, where the phase of the rotation is lost to \
                     rounding; use times closer to {near}"
                )
            }
            SimulateError::OutsideMotion { index, time, first, last } => write!(
                f,
                "times[{index}] = {time} is outside the computed motion, {first} s to {last} s; simulate up to this time"
            ),
            SimulateError::TooManySteps { steps, step, limit } => write!(
                f,
                "the run would take {steps:.1e} steps of {step:.3e} s, more than max_steps = {limit:.0e}; simulate a \
                 shorter time, use a longer step or a larger rtol, or raise max_steps"
            ),
            SimulateError::Stiff { steps } => {
                write!(f, "the laws are stiff: {steps:.1e} steps would be needed; use the method midpoint")
            }
            SimulateError::NotConverged { rtol, reached, step } if *reached > 0.1 => write!(
                f,
                "rtol = {rtol:.1e} was not reached: results still differ completely at steps of {step:.3e} s, because the \
                 motion amplifies rounding; simulate a shorter time, or give a step"
            ),
            SimulateError::NotConverged { rtol, reached, step } => write!(
                f,
                "rtol = {rtol:.1e} was not reached: halving the step to {step:.3e} s leaves an error of {reached:.1e}, because \
                 the motion amplifies rounding; use rtol >= {:.0e} or simulate a shorter time",
                2.0 * reached
            ),
            SimulateError::Diverged { time } => {
                write!(f, "the motion became NaN or infinite at t = {time} s; use a shorter step")
            }
            SimulateError::StepTurnsTooFar { step, turn } => write!(
                f,
                "the body turns by {turn:.2} rad in a step of {step} s; at most 1 rad is accurate: use a shorter dt, or step="
            ),
            SimulateError::Unfit { method, reason } => write!(f, "{method} {reason}"),
            SimulateError::StepTooSmall { time, step } => write!(
                f,
                "at t = {time} s no step down to {step:.1e} s meets the tolerance: the motion or a torque is not smooth \
                 or not finite there; check the laws at this time"
            ),
            SimulateError::Torque { time, message } => write!(f, "at t = {time} s: {message}"),
            SimulateError::Interrupted => write!(f, "interrupted"),
        }
    }
}

impl std::error::Error for SimulateError {}

/// Why a body is invalid. Moments are numbered from 1, rows and columns too; points from 0.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum BodyError {
    /// A mass that is zero, negative or not finite.
    Mass(f64),
    /// A density that is zero, negative or not finite.
    Density(f64),
    /// A length of a solid that is zero, negative or not finite.
    Length { name: &'static str, value: f64 },
    /// A hollow sphere whose inner radius is negative or exceeds the outer.
    InnerRadius { inner: f64, outer: f64 },
    /// A torus that intersects itself.
    SpindleTorus { major: f64, minor: f64 },
    /// A density for a solid without volume.
    NoVolume { solid: &'static str },
    /// A number that is NaN or infinite.
    NotFinite { what: String, value: f64 },
    /// A principal moment below zero.
    NegativeMoment { number: usize, moments: [f64; 3] },
    /// A principal moment larger than the sum of the other two.
    ImpossibleMoments { number: usize, moments: [f64; 3] },
    /// An inertia matrix whose halves differ by more than rounding.
    NotSymmetric { row: usize, column: usize, entry: f64, mirrored: f64 },
    /// The inverse of an inertia map with a zero moment.
    Singular { number: usize, axis: Vector },
    /// An extended body whose moments vanish in floating point.
    TooSmall { moment: f64 },
    /// No points.
    NoPoints,
    /// Different numbers of masses and positions.
    PointCount { masses: usize, positions: usize },
    /// A point mass that is negative or not finite.
    PointMass { index: usize, mass: f64 },
    /// A position that is not finite.
    PointPosition { index: usize, position: Vector },
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BodyError::Mass(m) => {
                write!(f, "mass must be positive and finite, got {m:?} kg")
            }
            BodyError::Density(d) => {
                write!(f, "density must be positive and finite, got {d:?} kg/m³")
            }
            BodyError::Length { name, value } => {
                write!(f, "{name} must be positive and finite, got {value:?} m")
            }
            BodyError::InnerRadius { inner, outer } => {
                write!(f, "inner_radius must be between 0 and outer_radius = {outer:?} m, got {inner:?} m")
            }
            BodyError::SpindleTorus { major, minor } => write!(
                f,
                "a torus with minor_radius = {minor:?} m and major_radius = {major:?} m intersects itself; the major radius must be at least the minor radius"
            ),
            BodyError::NoVolume { solid } => {
                write!(f, "a {solid} has no volume, so a density does not determine its mass; give the mass")
            }
            BodyError::NotFinite { what, value } => {
                write!(f, "{what} is {value:?}; give a finite number")
            }
            BodyError::NegativeMoment { number, moments: [a, b, c] } => write!(
                f,
                "no body has the principal moments {a:?}, {b:?}, {c:?}: i{number} is negative; moments are integrals of squares, check the signs"
            ),
            BodyError::ImpossibleMoments { number, moments } => {
                let [a, b, c] = moments;
                let (j, k) = (number % 3, (number + 1) % 3);
                let (j, k) = (j.min(k), j.max(k));
                write!(
                    f,
                    "no body has the principal moments {a:?}, {b:?}, {c:?}: i{number} = {:?} exceeds i{} + i{} = {:?}; check the units and the point they refer to (the centre of mass)",
                    moments[number - 1],
                    j + 1,
                    k + 1,
                    moments[j] + moments[k]
                )
            }
            BodyError::NotSymmetric { row, column, entry, mirrored } => write!(
                f,
                "the inertia matrix is not symmetric: row {row}, column {column} is {entry:?} but row {column}, column {row} is {mirrored:?}; make them equal"
            ),
            BodyError::Singular { number, axis: Vector([x, y, z]) } => write!(
                f,
                "the inertia has no inverse: the moment i{number} about the axis ({x:?}, {y:?}, {z:?}) is zero, as for a thin rod; give the body a thickness"
            ),
            BodyError::TooSmall { moment } => write!(
                f,
                "the largest moment of inertia, {moment:?} kg m², is below the range of floating point; check the units of mass and lengths"
            ),
            BodyError::NoPoints => write!(f, "a body needs at least one point mass, got none"),
            BodyError::PointCount { masses, positions } => {
                write!(f, "{masses} masses for {positions} positions; give one mass for every position")
            }
            BodyError::PointMass { index, mass } => {
                write!(f, "masses[{index}] must be finite and >= 0, got {mass:?} kg")
            }
            BodyError::PointPosition { index, position: Vector([x, y, z]) } => {
                write!(f, "positions[{index}] = ({x:?}, {y:?}, {z:?}) is not finite; remove the point")
            }
        }
    }
}

impl std::error::Error for BodyError {}

/// Why a law is invalid or cannot be evaluated at some point of the motion; the caller adds the time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TorqueError(pub String);

impl fmt::Display for TorqueError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for TorqueError {}
