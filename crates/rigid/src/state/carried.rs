//! A point of a motion with the data that steps carry.

use super::center::Center;
use super::phase::Phase;
use polhode_ga::Bivector;

/// A point of a motion with the data that steps carry.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// The point.
    pub phase: Phase,
    /// L in space, that of wheels with motors included, kg m²/s.
    pub momentum_space: Bivector,
    /// The momentum h of wheels with motors, in principal axes, which `phase` leaves out; 0 without them.
    pub driven: Bivector,
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
            driven: Bivector::default(),
            center,
            lost: Bivector::default(),
        }
    }

    /// The same with wheels with motors of this momentum.
    pub fn with_wheels(self, driven: Option<Bivector>) -> Carried {
        let Some(driven) = driven else { return self };
        let momentum_space = self.phase.rotor.apply_bivector(self.phase.momentum + driven);
        Carried { driven, momentum_space, ..self }
    }
}
