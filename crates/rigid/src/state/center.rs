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

/// From the components of the position, then those of the velocity.
impl From<[f64; 6]> for Center {
    fn from([x, y, z, u, v, w]: [f64; 6]) -> Center {
        Center { position: Vector([x, y, z]), velocity: Vector([u, v, w]) }
    }
}

impl Center {
    /// The components of the position, then those of the velocity.
    pub fn components(&self) -> [f64; 6] {
        let (Vector([x, y, z]), Vector([u, v, w])) = (self.position, self.velocity);
        [x, y, z, u, v, w]
    }

    /// Whether all numbers are.
    pub(crate) fn is_finite(&self) -> bool {
        self.position.0.iter().chain(&self.velocity.0).all(|x| x.is_finite())
    }
}
