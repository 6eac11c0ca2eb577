//! How a motion is to be solved.

use crate::error::SimulateError;
use crate::laws::event::Event;
use crate::methods::Method;

/// How to solve it.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `None` is the closed form where there is one and no step is given, and else the best method for the laws.
    pub method: Option<Method>,
    /// A fixed step in s; `None` lets the tolerance choose it.
    pub step: Option<f64>,
    /// The relative error to reach where it chooses the step; `None` aims at 1e-10 and takes what rounding
    /// leaves of it.
    pub rtol: Option<f64>,
    /// Whether nothing but the closed form will do.
    pub exact: bool,
    /// The longest step in s.
    pub max_step: Option<f64>,
    /// How many steps a sweep may take; `None` is [`MAX_STEPS`], or a hundred times that where a step is given.
    pub max_steps: Option<f64>,
    /// Times at which steps end, in any order: where the laws are not smooth, or push shortly.
    pub breaks: Vec<f64>,
    /// What to look for on the way, with body components in body axes.
    pub events: Vec<Event>,
}

/// The default limit of the steps in a sweep: minutes of work.
pub const MAX_STEPS: f64 = 1e8;

impl Options {
    /// How many steps a sweep may take.
    pub(crate) fn most_steps(&self) -> f64 {
        self.max_steps.unwrap_or(if self.step.is_some() { 100.0 * MAX_STEPS } else { MAX_STEPS })
    }

    /// Whether another method may take over where the laws are stiff: none is asked for, nor how long steps are.
    pub(crate) fn may_change_method(&self) -> bool {
        self.method.is_none() && self.step.is_none() && self.max_step.is_none()
    }

    /// What is wrong with them, or with the times, for any body.
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
