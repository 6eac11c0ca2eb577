//! The centre of mass.

use polhode_ga::Vector;

/// Position and velocity of the centre of mass in space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Center {
    /// In m.
    pub position: Vector,
    /// In m/s.
    pub velocity: Vector,
}

impl Center {
    /// Whether all numbers are.
    pub(crate) fn is_finite(&self) -> bool {
        self.position.0.iter().chain(&self.velocity.0).all(|x| x.is_finite())
    }
}
