//! Errors of bodies, torques and simulations.

use polhode_ga::Vector;
use thiserror::Error;

/// A time without a long row of zeros.
fn seconds(time: f64) -> String {
    if time.abs() < 1e16 { format!("{time}") } else { format!("{time:e}") }
}

/// Three numbers, without and with the zeros of whole ones.
fn short([a, b, c]: &[f64; 3]) -> String {
    format!("{a}, {b}, {c}")
}

fn full([a, b, c]: &[f64; 3]) -> String {
    format!("{a:?}, {b:?}, {c:?}")
}

/// Why a simulation failed.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)]
pub enum SimulateError {
    /// Moments must be positive to turn momentum into rate.
    #[error(
        "principal moments {} kg m² include a zero, so the rate about that axis is undefined; \
         give the body some thickness",
        short(moments)
    )]
    SingularInertia { moments: [f64; 3] },
    #[error("the principal moments {} kg m² all differ: not a symmetric top; use simulate", short(moments))]
    NotSymmetric { moments: [f64; 3] },
    #[error("the principal moments {} kg m² are not equal: not a sphere; use simulate", short(moments))]
    NotSpherical { moments: [f64; 3] },
    #[error("c = ({}) N m is not along the axis of symmetry ({}); use simulate", short(&c.0), short(&axis.0))]
    OffAxis { c: Vector, axis: Vector },
    /// The closed form misses its start or its integrals: the roots of its cubic are too close to each other.
    #[error(
        "the closed form of this top is not resolved in floating point: the turning points of its tilt are too \
         close to each other; use simulate, which integrates numerically"
    )]
    Unresolved,
    #[error(
        "the {} of the closed form drifts by {drift:.1e} (relative), but the motion conserves it; use a stepping \
         method, such as method=\"rkn6\"",
        quantity.replace('_', " ")
    )]
    Drifted { quantity: &'static str, drift: f64 },
    #[error("times[{index}] = {time}: output times must be finite and must not decrease; sort them")]
    BadTime { index: usize, time: f64 },
    /// A step, tolerance, angular velocity or torque that is not usable.
    #[error("{what} is {value}; it must be finite{}", bound(what))]
    BadValue { what: &'static str, value: f64 },
    /// The phase of an exact motion is not known this far from its start.
    #[error(
        "times[{index}] = {time:e} s is beyond {horizon:.1e} s{}, where the phase of the motion is lost to \
         rounding; use times closer to {}",
        if *start == 0.0 { String::new() } else { format!(" from the start at {start} s") },
        if *start == 0.0 { "0" } else { "the start" }
    )]
    BeyondHorizon { index: usize, time: f64, start: f64, horizon: f64 },
    #[error(
        "times[{index}] = {time} is outside the computed motion, {first} s to {last} s; simulate up to this time"
    )]
    OutsideMotion { index: usize, time: f64, first: f64, last: f64 },
    #[error(
        "the run would take {steps:.1e} steps of {step:.3e} s, more than max_steps = {limit:.0e}; simulate a \
         shorter time, use a longer step or a larger rtol, or raise max_steps"
    )]
    TooManySteps { steps: f64, step: f64, limit: f64 },
    /// Stability requires steps much shorter than the motion.
    #[error("the laws are stiff: {steps:.1e} steps would be needed; use the method midpoint")]
    Stiff { steps: f64 },
    /// Halving the step no longer reduces the difference of two runs.
    #[error("rtol = {rtol:.1e} was not reached: {}", unreached(*reached, *step, *agreed))]
    NotConverged {
        rtol: f64,
        reached: f64,
        step: f64,
        /// The last output time up to which the results agreed, in s.
        agreed: Option<f64>,
    },
    /// The method does not support these laws.
    #[error("{method} {reason}")]
    Unfit { method: &'static str, reason: &'static str },
    #[error(
        "at t = {} s no step down to {step:.1e} s meets the tolerance: the motion or a torque is not smooth \
         or not finite there; check the laws at this time",
        seconds(*time)
    )]
    StepTooSmall { time: f64, step: f64 },
    /// A law cannot be evaluated at this time.
    #[error("at t = {} s: {message}", seconds(*time))]
    Torque { time: f64, message: String },
    /// A law has no finite value at this time.
    #[error("at t = {} s: {message}", seconds(*time))]
    Undefined { time: f64, message: String },
    #[error("the motion became NaN or infinite at t = {} s; use a shorter time, or a shorter step where one is given", seconds(*time))]
    Diverged { time: f64 },
    #[error(
        "the body turns by {turn:.2} rad in a step of {step} s; more than 1 rad is not accurate: use a shorter dt, \
         or shorter steps with step="
    )]
    StepTurnsTooFar { step: f64, turn: f64 },
    /// The caller stopped the run.
    #[error("interrupted")]
    Interrupted,
}

impl SimulateError {
    /// Time in the motion at which it failed, in s; none for errors found before.
    pub fn time(&self) -> Option<f64> {
        match self {
            SimulateError::StepTooSmall { time, .. }
            | SimulateError::Torque { time, .. }
            | SimulateError::Undefined { time, .. }
            | SimulateError::Diverged { time } => Some(*time),
            _ => None,
        }
    }
}

/// The bound of a value besides that it is finite.
fn bound(what: &str) -> &'static str {
    match what {
        "step" | "rtol" | "max_step" => " and positive",
        "max_steps" => " and at least 1",
        "the damping g" => " and below 1e150",
        _ => "",
    }
}

fn unreached(reached: f64, step: f64, agreed: Option<f64>) -> String {
    let agree = agreed.map_or(String::new(), |time| format!("results agree up to t = {} s; ", seconds(time)));
    if reached > 0.1 {
        return format!(
            "results still differ completely at steps of {step:.3e} s, because the motion amplifies rounding; \
             {agree}simulate a shorter time, or give a step"
        );
    }
    format!(
        "halving the step to {step:.3e} s leaves an error of {reached:.1e}, because the motion amplifies \
         rounding; {agree}use rtol >= {:.0e} or simulate a shorter time",
        2.0 * reached
    )
}

/// Why a body is invalid. Moments are numbered from 1, rows and columns too; points from 0.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)]
pub enum BodyError {
    #[error("mass must be positive and finite, got {0:?} kg")]
    Mass(f64),
    #[error("density must be positive and finite, got {0:?} kg/m³")]
    Density(f64),
    /// A length of a solid.
    #[error("{name} must be positive and finite, got {value:?} m")]
    Length { name: &'static str, value: f64 },
    #[error("inner_radius must be between 0 and outer_radius = {outer:?} m, got {inner:?} m")]
    InnerRadius { inner: f64, outer: f64 },
    #[error(
        "a torus with minor_radius = {minor:?} m and major_radius = {major:?} m intersects itself; the major radius must be at least the minor radius"
    )]
    SpindleTorus { major: f64, minor: f64 },
    #[error("a {solid} has no volume, so a density does not determine its mass; give the mass")]
    NoVolume { solid: &'static str },
    #[error("{what} is {value:?}; give a finite number")]
    NotFinite { what: String, value: f64 },
    #[error(
        "no body has the principal moments {}: i{number} is negative; moments are integrals of squares, check the signs",
        full(moments)
    )]
    NegativeMoment { number: usize, moments: [f64; 3] },
    /// A principal moment larger than the sum of the other two.
    #[error(
        "no body has the principal moments {}: i{number} = {:?} exceeds {}; check the units and the point they refer to (the centre of mass)",
        full(moments),
        moments[number - 1],
        others(*number, moments)
    )]
    ImpossibleMoments { number: usize, moments: [f64; 3] },
    /// An inertia matrix whose halves differ by more than rounding.
    #[error(
        "the inertia matrix is not symmetric: row {row}, column {column} is {entry:?} but row {column}, column {row} is {mirrored:?}; make them equal"
    )]
    NotSymmetric { row: usize, column: usize, entry: f64, mirrored: f64 },
    #[error(
        "the inertia has no inverse: the moment i{number} about the axis ({}) is zero, as for a thin rod; give the body a thickness",
        full(&axis.0)
    )]
    Singular { number: usize, axis: Vector },
    /// An extended body whose moments vanish in floating point.
    #[error(
        "the largest moment of inertia, {moment:?} kg m², is below the range of floating point; check the units of mass and lengths"
    )]
    TooSmall { moment: f64 },
    #[error("a body needs at least one point mass, got none")]
    NoPoints,
    #[error("{masses} masses for {positions} positions; give one mass for every position")]
    PointCount { masses: usize, positions: usize },
    #[error("masses[{index}] must be finite and >= 0, got {mass:?} kg")]
    PointMass { index: usize, mass: f64 },
    #[error("positions[{index}] = ({}) is not finite; remove the point", full(&position.0))]
    PointPosition { index: usize, position: Vector },
}

/// The sum of the other two moments: `i1 + i2 = 3.0`.
fn others(number: usize, moments: &[f64; 3]) -> String {
    let (j, k) = (number % 3, (number + 1) % 3);
    let (j, k) = (j.min(k), j.max(k));
    format!("i{} + i{} = {:?}", j + 1, k + 1, moments[j] + moments[k])
}

/// Why a law is invalid or cannot be evaluated at some point of the motion; the caller adds the time.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct TorqueError {
    /// What is wrong, and the remedy.
    pub message: String,
    /// Whether the law just has no finite value at this point: a step that is too long may lead there.
    pub is_undefined: bool,
}

impl TorqueError {
    /// That of a law that is invalid, or whose evaluation fails.
    pub fn new(message: impl Into<String>) -> TorqueError {
        TorqueError { message: message.into(), is_undefined: false }
    }

    /// That of a law without a finite value at a point.
    pub fn undefined(message: impl Into<String>) -> TorqueError {
        TorqueError { message: message.into(), is_undefined: true }
    }

    /// The error of a motion at a time.
    pub fn at(self, time: f64) -> SimulateError {
        let message = self.message;
        if self.is_undefined {
            SimulateError::Undefined { time, message }
        } else {
            SimulateError::Torque { time, message }
        }
    }
}
