//! A point of a motion with the data that steps carry.

use super::center::Center;
use super::phase::Phase;
use polhode_ga::Bivector;

/// A point of a motion with the data that steps carry.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// The point.
    pub phase: Phase,
    /// L in space, kg m²/s.
    pub momentum_space: Bivector,
    /// The centre of mass, where forces move it.
    pub center: Center,
    /// Accumulated rounding of the momentum (Kahan), of the body or in space, as steps carry it.
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
