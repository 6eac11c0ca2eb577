//! Members of an ensemble: a body in lanes, how it is stepped, and its outcome.

use crate::error::SimulateError;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::methods::runge_kutta::DOP853;
use crate::methods::splitting::turns::Kind;
use crate::run::certificate::Certificate;
use crate::run::limits::StepBounds;
use crate::run::output::BodyOutput;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Rotor};

/// Bodies side by side: two registers of the widest machines, so that each waits for the other's results.
pub(super) const SIDE_BY_SIDE: usize = 16;

/// The method that the bodies are stepped by.
pub(super) const METHOD: Method = Method::RungeKutta(&DOP853);

/// A body that is stepped in lanes, in principal axes.
#[derive(Debug)]
pub(super) struct Member<'a> {
    pub body: usize,
    /// From principal axes to those of the body.
    pub frame: Rotor,
    pub gyrostat: Gyrostat,
    pub torques: Vec<Torque>,
    /// At the start, rad/s.
    pub omega: Bivector,
    pub start: Phase,
    /// What bounds its own steps.
    pub bounds: StepBounds,
    pub own: BodyOutput<'a>,
}

/// How a body is followed without a step.
pub(super) enum Strategy {
    /// In the lanes.
    Lanes,
    /// It is free: known at all times.
    Free,
    /// As a single one.
    Alone,
}

/// What is told of a body.
pub(super) struct Outcome {
    pub body: usize,
    pub certificate: Certificate,
    pub failure: Option<(f64, SimulateError)>,
}

/// How bodies are stepped side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plan {
    /// In s.
    pub start: f64,
    /// In s.
    pub step: f64,
    pub method: Method,
    /// About which axes a splitting turns them.
    pub kind: Option<Kind>,
}

impl Plan {
    /// Evaluations of the torque in a step.
    pub fn evaluations(&self) -> u64 {
        match self.method {
            Method::Splitting(sequence) => sequence.stages().0.len() as u64 + 1,
            _ => 4,
        }
    }
}
