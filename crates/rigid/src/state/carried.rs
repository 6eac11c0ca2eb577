//! A point of a motion as steps carry it on.

use super::center::Center;
use super::phase::Phase;
use polhode_ga::Bivector;

/// A point of the motion as the steps carry it.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// The point.
    pub phase: Phase,
    /// L in space, kg m²/s.
    pub momentum_space: Bivector,
    /// The centre of mass, where forces move it.
    pub center: Center,
    /// What rounding has left out of the momentum, a sum over all steps: that of the body or in space, as steps carry it.
    pub lost: Bivector,
}

impl Carried {
    /// From a point of the motion.
    pub fn new(phase: Phase, center: Center) -> Carried {
        Carried {
            phase,
            momentum_space: phase.rotor.apply_bivector(phase.momentum),
            center,
            lost: Bivector::default(),
        }
    }
}
