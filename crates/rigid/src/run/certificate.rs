//! Certificate of a run: its method, its error and the drift of conserved quantities.

use crate::laws::conserved::Conserved;
use crate::laws::torque::Torque;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::Rotor;

/// Method, error estimate and drifts of conserved quantities of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Certificate {
    /// The method's name, `exact` for the exact solution.
    pub method: &'static str,
    /// Longest step taken, in s; 0 for the exact solution.
    pub step: f64,
    /// Steps taken, in all passes.
    pub steps: u64,
    /// Evaluations of the torque, in all passes.
    pub evaluations: u64,
    /// Conservative estimate of the error, from the difference of the last two passes, or the error that an exact
    /// solution neglects.
    pub error_estimate: Option<f64>,
    /// Each conserved quantity: its initial value, and its largest change over the run relative to the
    /// terms that make it up.
    pub drifts: Vec<(Conserved, f64, f64)>,
    /// Largest `abs(|R| − 1)` at the output times.
    pub norm_drift: f64,
    /// Warnings, such as of a law for which fixed steps are too long.
    pub warnings: Vec<String>,
}

/// `abs(|R| − 1)`.
pub(crate) fn off_unit(rotor: Rotor) -> f64 {
    (rotor.components().iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs()
}

/// The size to which changes are relative; 1 for 0, because drift from zero without other terms is absolute.
pub(crate) fn nonzero(scale: f64) -> f64 {
    if scale == 0.0 { 1.0 } else { scale }
}

/// The larger of two drifts; NaN if one is, which `f64::max` would lose.
#[inline(always)]
pub(crate) fn larger(known: f64, drift: f64) -> f64 {
    if drift <= known || known.is_nan() { known } else { drift }
}

/// Tracks the conserved quantities along a run.
pub(crate) struct DriftMonitor<'a> {
    body: Gyrostat,
    torques: &'a [Torque],
    quantities: Vec<Tracked>,
}

/// A quantity with its value at the start, the size of its terms, and its largest change so far.
struct Tracked {
    quantity: Conserved,
    start: f64,
    scale: f64,
    drift: f64,
}

impl<'a> DriftMonitor<'a> {
    pub fn new(body: Gyrostat, torques: &'a [Torque], start: Phase) -> DriftMonitor<'a> {
        let follow = |quantity: Conserved| {
            let scale = nonzero(quantity.scale(&body, torques, &start));
            Tracked { quantity, start: quantity.value(&body, torques, &start), scale, drift: 0.0 }
        };
        DriftMonitor {
            body,
            torques,
            quantities: Conserved::under(&body, torques, &start).map(follow).collect(),
        }
    }

    /// Each quantity with its relative changes at these points.
    pub fn changes<'s>(&self, states: impl Iterator<Item = &'s Phase> + Clone) -> Vec<(Conserved, Vec<f64>)> {
        let change = |tracked: &Tracked, state: &Phase| {
            (tracked.quantity.value(&self.body, self.torques, state) - tracked.start) / tracked.scale
        };
        let series = |f: &Tracked| (f.quantity, states.clone().map(|state| change(f, state)).collect());
        self.quantities.iter().map(series).collect()
    }

    pub fn record(&mut self, state: &Phase) {
        for tracked in &mut self.quantities {
            let value = tracked.quantity.value(&self.body, self.torques, state);
            tracked.drift = larger(tracked.drift, (value - tracked.start).abs() / tracked.scale);
        }
    }

    /// Each quantity with its value at the start and its largest relative change.
    pub fn finish(self) -> Vec<(Conserved, f64, f64)> {
        self.quantities.into_iter().map(|f| (f.quantity, f.start, f.drift)).collect()
    }
}
