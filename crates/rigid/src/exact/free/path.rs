//! Curves of the angular velocity: polhode in the body, herpolhode in space.

use super::FreeMotion;
use crate::error::SimulateError;
use crate::state::checks::check_horizons;
use polhode_ga::Bivector;

/// Half the range of u drawn on the separatrix: sech 20 = 4e-9 of the way from pole to pole is missing.
const NEARLY_ALL: f64 = 20.0;

impl FreeMotion {
    /// Start and duration in s that cover the polhode: one period; on the separatrix from one end of the middle axis to
    /// the other; 0 if the rotation is steady.
    fn once_round(&self) -> (f64, f64) {
        let Some(orbit) = &self.orbit else { return (0.0, 0.0) };
        match orbit.mean {
            Some(_) => (0.0, self.period().unwrap_or(0.0)),
            None => {
                let rate = orbit.lambda.hi * self.scale;
                ((-NEARLY_ALL - orbit.start.1) / rate, 2.0 * NEARLY_ALL / rate)
            }
        }
    }

    /// `count` angular velocities in body axes along the polhode, at equal time steps from the start; the last equals
    /// the first, except on the separatrix, where the curve goes from pole to pole.
    pub fn polhode(&self, count: usize) -> Vec<Bivector> {
        let (start, length) = self.once_round();
        let step = length / count.saturating_sub(1).max(1) as f64;
        let mut curve: Vec<_> = (0..count).map(|k| self.at(start + step * k as f64).1).collect();
        if self.period().is_some()
            && let [first, .., last] = &mut curve[..]
        {
            *last = *first;
        }
        curve
    }

    /// `count` angular velocities in space axes over `periods` times the duration of the polhode.
    pub fn herpolhode(&self, count: usize, periods: f64) -> Result<Vec<Bivector>, SimulateError> {
        let (start, length) = self.once_round();
        let step = periods * length / count.saturating_sub(1).max(1) as f64;
        let times: Vec<f64> = (0..count).map(|k| start + step * k as f64).collect();
        check_horizons(0.0, &times, [self.horizon(); 2])?;
        let in_space = |&t: &f64| {
            let (rotor, omega) = self.at(t);
            rotor.apply_bivector(omega)
        };
        Ok(times.iter().map(in_space).collect())
    }
}
