//! Options of a run: method, step, tolerances and limits.

use crate::error::SimulateError;
use crate::laws::event::Event;
use crate::methods::Method;

/// Options of a run.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `None` selects the closed form if there is one and no step is given, else the best method for the laws.
    pub method: Option<Method>,
    /// A fixed step in s; `None` lets the tolerance determine it.
    pub step: Option<f64>,
    /// The relative tolerance without a step; `None` is 1e-10, or what rounding allows.
    pub rtol: Option<f64>,
    /// Whether to require the closed form.
    pub exact: bool,
    /// The longest step in s.
    pub max_step: Option<f64>,
    /// Maximum number of steps of a sweep; `None` is [`MAX_STEPS`], or a hundred times that with a step.
    pub max_steps: Option<f64>,
    /// Times at which steps end, in any order: where the laws are not smooth, or have short pulses.
    pub breaks: Vec<f64>,
    /// Events to detect, with body components in body axes.
    pub events: Vec<Event>,
}

/// The default maximum number of steps of a sweep: minutes of work.
pub const MAX_STEPS: f64 = 1e8;

impl Options {
    /// The maximum number of steps of a sweep.
    pub(crate) fn most_steps(&self) -> f64 {
        self.max_steps.unwrap_or(if self.step.is_some() { 100.0 * MAX_STEPS } else { MAX_STEPS })
    }

    /// Whether another method may take over for stiff laws: neither method nor steps are given.
    pub(crate) fn may_change_method(&self) -> bool {
        self.method.is_none() && self.step.is_none() && self.max_step.is_none()
    }

    /// Checks the options and the times.
    pub(crate) fn check(&self, times: &[f64]) -> Result<(), SimulateError> {
        for (index, &time) in times.iter().enumerate() {
            if !time.is_finite() || index > 0 && time < times[index - 1] {
                return Err(SimulateError::BadTime { index, time });
            }
        }
        let given = [
            ("step", self.step),
            ("rtol", self.rtol),
            ("max_step", self.max_step),
            ("max_steps", self.max_steps),
        ];
        for (what, value) in given.into_iter().filter_map(|(what, value)| Some((what, value?))) {
            if !(value > 0.0 && value.is_finite()) || what == "max_steps" && value < 1.0 {
                return Err(SimulateError::BadValue { what, value });
            }
        }
        if let Some(&value) = self.breaks.iter().find(|time| !time.is_finite()) {
            return Err(SimulateError::BadValue { what: "a time in breaks", value });
        }
        Ok(())
    }
}
