//! The implicit midpoint rule on the group of rotors.
//!
//! With `m̄ = ½(m + m')`, `Ω̄ = I⁻¹(m̄ − h_w)` (`h_w` the momentum of a wheel) and the unit rotor `q ∝ 1 − ½hΩ̄`, which turns by
//! `2 arctan ½h|Ω̄|` (Cayley's transform), a step is
//!
//! ```text
//! R' = R q,    L' = L + h N_S(R̄, m̄, t + ½h),    R̄ = R √q = R' ~√q,
//! ```
//!
//! N in space taken at the attitude half-way. It is symmetric and of order 2. Seen from the body the second equation is
//! `√q m' ~√q = ~√q m √q + hN`; with the axial vectors and `x = ½h|ω̄|`, half the sum and the difference give
//!
//! ```text
//! F(m̄) = m̄ + ½h ω̄ x m̄ − m − ½h (N_∥ + √(1 + x²) N_⊥) = 0,    m' = 2m̄ − m,
//! ```
//!
//! with `N_∥` along ω̄. Without a torque `m' − m = h m̄ x ω̄`: its products with m̄ and ω̄, the changes of `½|m|²` and of the
//! energy, vanish. So these two and L are conserved exactly, and under a torque the linear invariants of L. Damping
//! `N = −g I(Ω̄)` shrinks `m − h_w` for any step: the rule is A-stable.

use super::momentum::{fixed_momentum, restore_momentum};
use crate::error::SimulateError;
use crate::laws::torque::{Dependence, Torque, damping_rate, total_torque};
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::{Bivector, Rotor, Vector};

/// Newton's method converges in four or five iterations, with an inexact Jacobian in a few times as many.
const MOST_ITERATIONS: u32 = 60;

/// A correction this small relative to the momentum is the last: the next would be its square.
const CONVERGED: f64 = 4.0 * f64::EPSILON;

/// Below this, iteration ends when corrections no longer decrease.
const ROUNDING: f64 = 1e-12;

/// A smaller momentum, in kg m²/s, counts as rest.
const LEAST: f64 = 1e-290;

/// The midpoint rule for a body and its torques.
#[derive(Clone, Debug)]
pub struct Midpoint {
    body: Gyrostat,
    torques: Vec<Torque>,
    damping: f64,
    /// Whether a torque other than damping depends on the angular velocity.
    rates: bool,
    /// L in space, if it is constant.
    fixed: Option<Bivector>,
}

impl Midpoint {
    /// Moments must be positive; torques in principal axes.
    pub fn new(body: Gyrostat, torques: Vec<Torque>, start: &Phase) -> Midpoint {
        Midpoint {
            body,
            damping: damping_rate(&torques),
            rates: torques.iter().any(|t| t.dependence() == Dependence::Rate),
            fixed: fixed_momentum(&torques, start),
            torques,
        }
    }

    /// One step of length `h`, which may be negative. An error where Newton's method finds no solution.
    pub fn step(&self, state: &mut Phase, h: f64) -> Result<(), SimulateError> {
        let mean = self.mean_momentum(state, h)?;
        let turn = cayley(self.body.omega(mean) * (0.5 * h));
        state.rotor = (state.rotor * turn).renormalized();
        state.momentum = mean * 2.0 - state.momentum;
        state.time += h;
        if let Some(fixed) = self.fixed {
            restore_momentum(state, fixed);
        }
        Ok(())
    }

    /// m̄ with `F(m̄) = 0`.
    fn mean_momentum(&self, state: &Phase, h: f64) -> Result<Bivector, SimulateError> {
        let mut frozen = None;
        let correction = |mean: Bivector| {
            let residual = self.residual(state, mean, h)?;
            let jacobian = match frozen {
                Some(jacobian) => jacobian,
                None if self.rates => *frozen.insert(self.measured_jacobian(state, mean, residual, h)?),
                None => self.jacobian(mean, h),
            };
            Ok(solved(&jacobian, residual))
        };
        let relative = |correction: f64, mean: Bivector| {
            let size = state.momentum.norm().max(mean.norm());
            if size > LEAST { correction / size } else { correction }
        };
        newton(state.momentum, MOST_ITERATIONS, correction, relative)?.ok_or_else(|| {
            let message = format!(
                "Newton's method did not converge for a midpoint step of {h:e} s; use a shorter step"
            );
            SimulateError::Torque { time: state.time, message }
        })
    }

    /// `F(m̄)`.
    fn residual(&self, state: &Phase, mean: Bivector, h: f64) -> Result<Bivector, SimulateError> {
        let omega = self.body.omega(mean);
        let half = omega * (0.5 * h);
        let turned = cross(half, mean);
        let mut residual = (mean - state.momentum) + turned;
        if !self.torques.is_empty() {
            let secant = (1.0 + half.norm_squared()).sqrt();
            // √q ∝ 1 + q, of the size √(2 sec (1 + sec)).
            let size = (2.0 * secant * (1.0 + secant)).sqrt();
            let [x, y, z] = (half / -size).0;
            let root = Rotor::from_unit_components([(1.0 + secant) / size, x, y, z]);
            let middle = Phase { rotor: state.rotor * root, momentum: mean, time: state.time + 0.5 * h };
            let damping = self.body.carried(omega) * -self.damping;
            let torque =
                total_torque(&self.torques, &Point::at_rest(&self.body, &middle), middle.time)? + damping;
            // N_∥ + sec N_⊥ with (1 − sec)/x² = −1/(1 + sec).
            let along = half * (half.dual().dot(torque.dual()) / (1.0 + secant));
            residual = residual - (torque * secant - along) * (0.5 * h);
        }
        Ok(residual)
    }

    /// `dF/dm̄` of the free motion and of damping: `1 + ½hg + ½h(ω̂ − m̂ I⁻¹)`.
    fn jacobian(&self, mean: Bivector, h: f64) -> [[f64; 3]; 3] {
        let ([x, y, z], [u, v, w], [a, b, c]) = (self.body.omega(mean).0, mean.0, self.body.moments);
        let (half, diagonal) = (0.5 * h, 1.0 + 0.5 * h * self.damping);
        [
            [diagonal, half * (w / b - z), half * (y - v / c)],
            [half * (z - w / a), diagonal, half * (u / c - x)],
            [half * (v / a - y), half * (x - u / b), diagonal],
        ]
    }

    /// `dF/dm̄` by differences.
    fn measured_jacobian(
        &self,
        state: &Phase,
        mean: Bivector,
        residual: Bivector,
        h: f64,
    ) -> Result<[[f64; 3]; 3], SimulateError> {
        let mut jacobian = [[0.0; 3]; 3];
        let size = mean.norm();
        let change = 1e-7 * if size > LEAST { size } else { 1.0 };
        for k in 0..3 {
            let mut moved = mean;
            moved.0[k] += change;
            let slope = (self.residual(state, moved, h)? - residual) / change;
            for i in 0..3 {
                jacobian[i][k] = slope.0[i];
            }
        }
        Ok(jacobian)
    }
}

/// Newton's method from x with the given correction at a point, and its relative size after it was subtracted; None if
/// it does not converge.
pub(crate) fn newton(
    mut x: Bivector,
    most_iterations: u32,
    mut correction: impl FnMut(Bivector) -> Result<Bivector, SimulateError>,
    relative: impl Fn(f64, Bivector) -> f64,
) -> Result<Option<Bivector>, SimulateError> {
    let mut last = f64::INFINITY;
    for _ in 0..most_iterations {
        let change = correction(x)?;
        x = x - change;
        let relative = relative(change.norm(), x);
        if relative <= CONVERGED || relative < ROUNDING && relative >= 0.5 * last {
            return Ok(Some(x));
        }
        if !relative.is_finite() {
            break;
        }
        last = relative;
    }
    Ok(None)
}

/// The axial vector's cross product.
pub(crate) fn cross(a: Bivector, b: Bivector) -> Bivector {
    Bivector(Vector(a.0).cross(Vector(b.0)).0)
}

/// `J⁻¹ r` by Cramer's rule, whose zeros stay zeros.
pub(crate) fn solved(jacobian: &[[f64; 3]; 3], r: Bivector) -> Bivector {
    let column = |k: usize| Vector([jacobian[0][k], jacobian[1][k], jacobian[2][k]]);
    let (a, b, c, r) = (column(0), column(1), column(2), Vector(r.0));
    Bivector([r.dot(b.cross(c)), a.dot(r.cross(c)), a.dot(b.cross(r))]) / a.dot(b.cross(c))
}

/// The unit rotor `∝ 1 − B`.
pub(crate) fn cayley(b: Bivector) -> Rotor {
    let secant = (1.0 + b.norm_squared()).sqrt();
    let [x, y, z] = (b / -secant).0;
    Rotor::from_unit_components([1.0 / secant, x, y, z])
}
