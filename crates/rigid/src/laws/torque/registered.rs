//! Laws of the registry computed by formulas.

use super::FormulaTorque;
use crate::laws::formula::Formula;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::{Rotor, Vector};

/// A law with the formulas of its torque and potential.
#[derive(Clone, Debug)]
pub struct FormulaLaw {
    /// Its name in the registry.
    pub(crate) name: &'static str,
    /// The numbers of its arguments, in the axes in which they were given.
    pub(crate) numbers: Vec<f64>,
    pub(crate) torque: FormulaTorque,
    /// The potential energy in J.
    pub(crate) potential: Option<Formula>,
    /// The largest torque in N m, and the largest size of the potential in J.
    pub(crate) size: f64,
    /// The axis of space about which there is no torque.
    pub(crate) axis: Option<Vector>,
}

impl FormulaLaw {
    pub(super) fn in_axes(self, frame: Rotor) -> FormulaLaw {
        let potential = self.potential.map(|potential| potential.in_axes(frame));
        FormulaLaw { torque: self.torque.in_axes(frame), potential, ..self }
    }

    pub(super) fn potential(&self, body: &Gyrostat, state: &Phase) -> Option<f64> {
        let at = Point { body, mass: f64::NAN, phase: state, center: &Center::default() };
        self.potential.as_ref()?.value(&at).ok()?.components().first().copied()
    }
}
