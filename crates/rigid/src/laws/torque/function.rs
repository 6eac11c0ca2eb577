//! Torque laws defined by user functions.

use crate::error::TorqueError;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Rotor};
use std::fmt;
use std::sync::Arc;

/// The torque in body axes at a time, for a rotor from body axes to space and an angular velocity in body
/// axes.
type Call = dyn Fn(f64, Rotor, Bivector) -> Result<Bivector, TorqueError> + Send + Sync;

/// A torque law defined by a user function.
#[derive(Clone)]
pub struct FunctionTorque {
    call: Arc<Call>,
    /// From the axes of the motion to those of the function.
    frame: Rotor,
}

impl FunctionTorque {
    /// A torque in body axes at a time in s, for a rotor from body axes to space and an angular velocity in
    /// body axes.
    pub fn new(
        call: impl Fn(f64, Rotor, Bivector) -> Result<Bivector, TorqueError> + Send + Sync + 'static,
    ) -> FunctionTorque {
        FunctionTorque { call: Arc::new(call), frame: Rotor::IDENTITY }
    }

    pub(super) fn in_axes(self, frame: Rotor) -> FunctionTorque {
        FunctionTorque { call: self.call, frame: self.frame * frame }
    }

    pub(super) fn value(&self, body: &Gyrostat, state: &Phase) -> Result<Bivector, TorqueError> {
        let back = self.frame.reverse();
        let omega = self.frame.apply_bivector(body.omega(state.momentum));
        let torque = (self.call)(state.time, state.rotor * back, omega)?;
        if !torque.0.iter().all(|x| x.is_finite()) {
            let Bivector(torque) = torque;
            return Err(TorqueError(format!(
                "the torque that the function returned is {torque:?}; it must be finite"
            )));
        }
        Ok(back.apply_bivector(torque))
    }
}

impl fmt::Debug for FunctionTorque {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("FunctionTorque")
    }
}
