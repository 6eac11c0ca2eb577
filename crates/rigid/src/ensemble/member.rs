//! Members of an ensemble: body, plan and outcome.

use crate::error::SimulateError;
use crate::exact::damped::DampedMotions;
use crate::exact::lagrange::LagrangeTops;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::methods::splitting::turns::Kind;
use crate::run::certificate::Certificate;
use crate::run::closed_form::ExactBody;
use crate::run::output::BodyOutput;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::{Bivector, Rotor};
use std::borrow::Cow;

/// Bodies in lanes: two registers of the widest machines, to hide latency.
pub(super) const SIDE_BY_SIDE: usize = 16;

/// Bodies in lanes for steps of the classical method under torques: an evaluation in memory has an overhead, which more
/// bodies share. Under torques computed in registers they go by [`SIDE_BY_SIDE`] again. The same number as without torques
/// in the browser, since code for both would make the page larger.
pub(super) const WIDE: usize = if cfg!(target_family = "wasm") { SIDE_BY_SIDE } else { 2 * SIDE_BY_SIDE };

/// The method of adaptive steps.
pub(super) const METHOD: Method = Method::RungeKutta;

/// A body integrated in lanes, in principal axes.
#[derive(Debug)]
pub(super) struct Member<'a> {
    pub body: usize,
    /// From principal axes to those of the body.
    pub frame: Rotor,
    pub gyrostat: Gyrostat,
    pub torques: Cow<'a, [Torque]>,
    /// At the start, rad/s.
    pub omega: Bivector,
    pub start: Phase,
    pub own: BodyOutput<'a>,
}

/// The member of a lane; lanes without a body hold the first one.
pub(super) fn of<'m, 'a>(members: &'m [Member<'a>], lane: usize) -> &'m Member<'a> {
    members.get(lane).unwrap_or(&members[0])
}

/// Solution strategy of a body without a given step.
pub(super) enum Strategy {
    /// In the lanes.
    Lanes,
    /// In closed form.
    Exact(ExactBody),
    /// As a single body.
    Single,
}

/// Bodies under torques in closed form that wait for others, with what their closed forms need.
#[derive(Default)]
pub(super) struct Waiting<'a> {
    pub members: Vec<(Member<'a>, ExactBody)>,
    pub tops: Option<Box<LagrangeTops<TOGETHER>>>,
    pub damped: Option<Box<DampedMotions>>,
}

/// The outcome of a body.
pub(super) struct Outcome {
    pub body: usize,
    pub certificate: Certificate,
    pub failure: Option<(f64, SimulateError)>,
}

/// Plan of bodies integrated in lanes by equal steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plan {
    /// In s.
    pub start: f64,
    /// In s.
    pub step: f64,
    pub method: Method,
    /// The axes of rotation of a splitting.
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
