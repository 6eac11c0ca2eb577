//! The motion of a centre of mass in closed form, where its forces allow one.

use crate::exact::center::CenterLaw;
use crate::laws::force::Force;
use crate::numerics::double_double::DoubleDouble;
use crate::state::center::Center;
use polhode_ga::Vector;

/// The law of motion of a mass in kg under forces, if they are constant forces, drag and springs.
pub(crate) fn center_law<'f>(forces: impl IntoIterator<Item = &'f Force>, mass: f64) -> Option<CenterLaw> {
    let mut forces = forces.into_iter().peekable();
    if forces.peek().is_none() {
        // The mass may be unknown.
        return Some(CenterLaw::default());
    }
    let (mut constant, mut drag) = (Vector::default(), 0.0);
    let mut springs = Vec::new();
    for force in forces {
        match force {
            Force::Constant(force) => constant += *force,
            Force::Drag(k) => drag += k,
            Force::Spring(k, anchor) => springs.push((*k, *anchor)),
            _ => return None,
        }
    }
    // Springs act as one, whose anchor is their mean. That of springs with the same anchor is exact.
    let stiffness: f64 = springs.iter().map(|(k, _)| k).sum();
    let first = springs.first().map_or(Vector::default(), |(_, anchor)| *anchor);
    let pull = springs.iter().fold(Vector::default(), |sum, (k, anchor)| sum + (*anchor - first) * *k);
    let anchor = if stiffness == 0.0 { Vector::default() } else { first + pull / stiffness };
    if stiffness == 0.0 {
        constant += pull;
    }
    Some(CenterLaw::new(constant, drag, (stiffness, anchor), mass))
}

/// A centre of mass that moves by such a law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CenterMotion {
    /// The time of the start, in s.
    pub time: f64,
    /// The centre of mass at the start.
    pub start: Center,
    /// Its law.
    pub law: CenterLaw,
}

impl CenterMotion {
    /// The centre of mass at a time in s.
    pub fn at(&self, time: f64) -> Center {
        self.law.after(&self.start, DoubleDouble::two_sum(time, -self.time))
    }

    /// Whether the centre of mass is finite and its phase known at all times: what grows is largest at the first or the last.
    pub fn is_known_at(&self, times: &[f64]) -> bool {
        let horizon = self.law.horizon();
        times
            .first()
            .into_iter()
            .chain(times.last())
            .all(|&time| (time - self.time).abs() <= horizon && self.at(time).is_finite())
    }
}
