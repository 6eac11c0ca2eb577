//! Torque laws that are formulas: `-c ∧ (~R e3 R)`.

use super::lanes::seen;
use super::{Axes, Dependence};
use crate::error::TorqueError;
use crate::laws::formula::{Formula, Motion, Purpose, given};
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::formula::{Error, Given, Input, Names};
use polhode_ga::simd::lanes::One;
use polhode_ga::{Bivector, Rotor};

/// A law that is a formula.
#[derive(Clone, Debug)]
pub struct FormulaTorque(Formula);

/// The names that the motion defines in a formula.
pub fn given_names() -> impl Iterator<Item = &'static str> {
    given(Purpose::Torque(Axes::Body)).into_iter().map(|(name, _)| name)
}

impl FormulaTorque {
    /// Reads a formula whose value is the torque in these axes: see [`Formula::new`].
    pub fn new(
        text: &str,
        axes: Axes,
        names: Names,
        value: impl FnMut(&Input) -> Option<Given>,
    ) -> Result<FormulaTorque, Error> {
        Formula::new(text, Purpose::Torque(axes), names, value).map(FormulaTorque)
    }

    /// The same formula with other values: see [`Formula::with_values`].
    pub fn with_values(&self, value: impl FnMut(&Input) -> Option<Given>) -> FormulaTorque {
        FormulaTorque(self.0.with_values(value))
    }

    /// The text of the formula.
    pub fn text(&self) -> &str {
        self.0.text()
    }

    /// The axes of its value.
    pub fn axes(&self) -> Axes {
        if self.0.purpose() == Purpose::Torque(Axes::Space) { Axes::Space } else { Axes::Body }
    }

    /// The names that the motion does not define, with their values.
    pub fn known(&self) -> impl Iterator<Item = (&str, Given)> {
        self.0.known()
    }

    pub(crate) fn formula(&self) -> &Formula {
        &self.0
    }

    pub(super) fn in_axes(self, frame: Rotor) -> FormulaTorque {
        FormulaTorque(self.0.in_axes(frame))
    }

    pub(super) fn needs_time(&self) -> bool {
        self.0.needs(|motion| motion == Motion::Time)
    }

    pub(super) fn dependence(&self) -> Dependence {
        if self.0.needs(Motion::is_rate) { Dependence::Rate } else { Dependence::Attitude }
    }

    pub(super) fn value(&self, body: &Gyrostat, state: &Phase) -> Result<Bivector, TorqueError> {
        let at = Point { body, mass: f64::NAN, phase: state, center: &Center::default() };
        let value = self.0.value(&at)?;
        let torque = One::each(value.components().try_into().unwrap_or_default());
        let by = |r: Rotor| Bivector(One::alone(seen(&One::each(r.components()), &torque)));
        Ok(match (self.0.purpose(), self.0.frame()) {
            (Purpose::Torque(Axes::Space), _) => by(state.rotor),
            (_, Rotor::IDENTITY) => Bivector(One::alone(torque)),
            (_, frame) => by(frame),
        })
    }
}
