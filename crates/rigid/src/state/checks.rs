//! Checks of inertia, times and horizons.

use crate::error::SimulateError;

/// Checks times against the horizons, backwards and forwards, of an exact motion from its start.
pub fn check_horizons(start: f64, times: &[f64], horizons: [f64; 2]) -> Result<(), SimulateError> {
    let horizon = |elapsed: f64| horizons[usize::from(elapsed > 0.0)];
    match times.iter().position(|&t| (t - start).abs() > horizon(t - start)) {
        Some(index) => {
            let elapsed = times[index] - start;
            Err(SimulateError::BeyondHorizon { index, time: times[index], start, horizon: horizon(elapsed) })
        }
        None => Ok(()),
    }
}

/// Checks that the moments are positive, so that the momentum determines the rate.
pub(crate) fn check_moments(moments: [f64; 3]) -> Result<(), SimulateError> {
    if moments.iter().all(|i| *i > 0.0 && i.is_finite()) {
        return Ok(());
    }
    Err(SimulateError::SingularInertia { moments })
}
