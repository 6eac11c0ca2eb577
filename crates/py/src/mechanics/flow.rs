//! Free flow over rows, each a body with its own times, for JAX.
//!
//! A row without a motion is NaN and not an error, because derivatives may be evaluated there.

use super::closed_form::pieces;
use super::free::flat;
use crate::support::arrays::{Array, Rows, bad, numbers, table};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::exact::free::{FlowDerivatives, FreeMotion};
use pyo3::prelude::*;

/// Number of times from which lanes are faster.
const IN_LANES: usize = 8;

/// Bodies in principal axes, each with its times.
struct Bodies<'a> {
    moments: &'a [[f64; 3]],
    rotors: &'a [[f64; 4]],
    omegas: &'a [[f64; 3]],
    times: &'a [f64],
    /// Number of times of each body.
    count: usize,
}

impl<'a> Bodies<'a> {
    fn new(
        moments: &'a Rows<'_>,
        rotors: &'a Rows<'_>,
        omegas: &'a Rows<'_>,
        times: &'a Rows<'_>,
    ) -> PyResult<Bodies<'a>> {
        let (moments, rotors) = (numbers(moments)?.as_chunks().0, numbers(rotors)?.as_chunks().0);
        let (omegas, times) = (numbers(omegas)?.as_chunks().0, numbers(times)?);
        let bodies = moments.len();
        if rotors.len() != bodies || omegas.len() != bodies || !times.len().is_multiple_of(bodies.max(1)) {
            return Err(bad("numbers of bodies, rotors, angular velocities and times differ"));
        }
        Ok(Bodies { moments, rotors, omegas, times, count: times.len() / bodies.max(1) })
    }

    fn times(&self, body: usize) -> &[f64] {
        &self.times[body * self.count..][..self.count]
    }

    fn motion(&self, body: usize) -> Option<FreeMotion> {
        let moments = self.moments[body];
        let omega = self.omegas[body];
        let known = moments.iter().all(|i| *i > 0.0 && i.is_finite()) && omega.iter().all(|w| w.is_finite());
        let rotor = Rotor::from_components(self.rotors[body]).ok().filter(|_| known)?;
        Some(FreeMotion::in_principal_axes(moments, rotor, Bivector(omega)))
    }

    /// The states of a body, a row of seven numbers for each time.
    fn states(&self, body: usize) -> Vec<[f64; 7]> {
        let mut rows = vec![[f64::NAN; 7]; self.count];
        let Some(motion) = self.motion(body) else { return rows };
        let (times, horizon) = (self.times(body), motion.horizon());
        let known = |t: f64| t.is_finite() && t.abs() <= horizon;
        if self.count < IN_LANES || !times.iter().all(|&t| known(t)) {
            for (row, &t) in rows.iter_mut().zip(times).filter(|(_, t)| known(**t)) {
                let (rotor, omega) = motion.at(t);
                *row = joined(rotor.components(), omega.0);
            }
            return rows;
        }
        let (mut rotors, mut omegas) = (vec![0.0; 4 * self.count], vec![0.0; 3 * self.count]);
        motion.at_many(Threads::ONE, times, &mut rotors, &mut omegas);
        for (row, (r, w)) in rows.iter_mut().zip(rotors.as_chunks().0.iter().zip(omegas.as_chunks().0)) {
            *row = joined(*r, *w);
        }
        rows
    }

    /// The derivatives of a body's states; None if it has none.
    fn derivatives(&self, body: usize) -> Vec<Option<FlowDerivatives>> {
        let Some(motion) = self.motion(body) else { return vec![None; self.count] };
        let (common, horizon) = (motion.differentiated(), motion.horizon());
        self.times(body)
            .iter()
            .map(|&t| (t.is_finite() && t.abs() <= horizon).then(|| common.at(t)))
            .collect()
    }
}

fn joined([s, x, y, z]: [f64; 4], [p, q, r]: [f64; 3]) -> [f64; 7] {
    [s, x, y, z, p, q, r]
}

/// Rows of the rotor (4) and of the angular velocity (3) of bodies in principal axes: from moments (n, 3), rotors
/// (n, 4), angular velocities (n, 3) and times (n, m), body by body.
#[pyfunction]
pub(crate) fn free_flow<'py>(
    py: Python<'py>,
    moments: Rows<'py>,
    rotors: Rows<'py>,
    omegas: Rows<'py>,
    times: Rows<'py>,
) -> PyResult<Array<'py>> {
    let bodies = Bodies::new(&moments, &rotors, &omegas, &times)?;
    let found = pieces(py, bodies.moments.len(), 1, |body| bodies.states(body))?;
    table(py, found.concat().into_iter())
}

/// Their derivatives, rows of 49 numbers: of the rotor by angular velocity and moments (12 each) and by time (4), of
/// the angular velocity by itself and by the moments (9 each) and by time (3) — see [`FlowDerivatives`] — without
/// the derivative by the attitude, which is a product of rotors.
#[pyfunction]
pub(crate) fn free_flow_derivatives<'py>(
    py: Python<'py>,
    moments: Rows<'py>,
    rotors: Rows<'py>,
    omegas: Rows<'py>,
    times: Rows<'py>,
) -> PyResult<Array<'py>> {
    let bodies = Bodies::new(&moments, &rotors, &omegas, &times)?;
    let found = pieces(py, bodies.moments.len(), 1, |body| bodies.derivatives(body))?;
    let rows = found.concat().into_iter().map(|one| one.map_or([f64::NAN; 49], |one| row(&one)));
    table(py, rows)
}

fn row(one: &FlowDerivatives) -> [f64; 49] {
    let by_omega: [f64; 12] = flat(&one.rotor_by_omega);
    let by_moments: [f64; 12] = flat(&one.rotor_by_moments);
    let (omega, moments): ([f64; 9], [f64; 9]) = (flat(&one.omega_by_omega), flat(&one.omega_by_moments));
    let parts = [&by_omega[..], &by_moments, &one.rotor_by_time, &omega, &moments, &one.omega_by_time];
    let mut numbers = parts.into_iter().flatten();
    std::array::from_fn(|_| numbers.next().copied().unwrap_or(f64::NAN))
}
