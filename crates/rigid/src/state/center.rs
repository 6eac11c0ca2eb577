//! The centre of mass.

use polhode_ga::Vector;

/// The centre of mass in space: m and m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Center {
    /// In m.
    pub position: Vector,
    /// In m/s.
    pub velocity: Vector,
}
