//! The discrete Moser–Veselov algorithm, in rotors, with half kicks before and after.
//!
//! A free step turns by the unit rotor `q ∝ 1 − P`, where
//!
//! ```text
//! F(P) = I(P) + P x I(P) − ½h (1 + |P|²) m = 0,    m' = ~q m q,    R' = R q
//! ```
//!
//! (crosses of axial vectors). With `h̃ = h (1 + |P|²)` and `m̄ = ½(m + m')` this says `I(P) = ½h̃ m̄` and `m' − m = h̃ m̄ x I⁻¹m̄`:
//! the implicit midpoint rule ([`super::midpoint`]) with another step, so that the energy, |m| and `R m ~R` are conserved
//! exactly (R. I. McLachlan & A. Zanna, Found. Comput. Math. 5 (2005) 87). Since `½h|Ω̄| = |P|/(1 + |P|²)`, only steps of
//! `h|Ω̄| <= 1` have a solution.
//!
//! The order is 4 with the moments `Ĩ_k` of
//!
//! ```text
//! 1/Ĩ_k = (1 + h²s)/I_k + h²d,    s = −(Σ 1/I_k) H/3 + (Σ I_k) C/6Π,    d = (Σ I_k) H/6Π − C/3Π,
//! ```
//!
//! `H = ½ m·I⁻¹m`, `C = ½|m|²`, `Π = I_1 I_2 I_3` (E. Hairer & G. Vilmart, J. Phys. A 39 (2006) 13225): H and C are
//! constant, so s and d are, and conserving `(1 + h²s) H + h²d C` conserves H. With kicks the order is 2.

use super::midpoint::{cayley, cross, newton, solved};
use super::momentum::{fixed_momentum, restore_momentum};
use super::splitting::turns::{Spin, Turns};
use crate::error::SimulateError;
use crate::laws::forcing::{BodyForcing, Forcing};
use crate::laws::torque::{Torque, damping_rate};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::Bivector;
use polhode_ga::simd::lanes::Lanes;

/// Newton's method converges in four or five iterations, near the longest step in a few times as many.
const MOST_ITERATIONS: u32 = 40;

/// The method for a body without a wheel, and its torques.
#[derive(Clone, Debug)]
pub struct MoserVeselov {
    body: Gyrostat,
    torques: Vec<Torque>,
    kicks: Turns<1, false>,
    /// L in space, where it is constant.
    fixed: Option<Bivector>,
}

impl MoserVeselov {
    /// Moments must be positive; torques in principal axes, each dependent on attitude and time at most.
    pub fn new(body: Gyrostat, torques: Vec<Torque>, start: &Phase) -> MoserVeselov {
        let fixed = fixed_momentum(&torques, start);
        MoserVeselov { body, kicks: Turns::new([(body, damping_rate(&torques), None)]), torques, fixed }
    }

    /// One step of length `h`, which may be negative. An error where `h|Ω|` is too large.
    pub fn step(&self, state: &mut Phase, h: f64) -> Result<(), SimulateError> {
        let end = state.time + h;
        self.kick(state, state.time + 0.5 * h, 0.5 * h)?;
        self.drift(state, h)?;
        state.time = end;
        self.kick(state, end - 0.5 * h, 0.5 * h)?;
        if let Some(fixed) = self.fixed {
            restore_momentum(state, fixed);
        }
        Ok(())
    }

    /// A kick in a step with this middle.
    fn kick(&self, state: &mut Phase, middle: f64, h: f64) -> Result<(), SimulateError> {
        if self.torques.is_empty() {
            return Ok(());
        }
        let mut acting = BodyForcing::new(&self.body, &self.torques, None);
        acting.begin(Lanes::all(middle));
        let mut spin = Spin::alone(state, Bivector::default());
        self.kicks.kick(&mut acting, &mut spin, state.time, h);
        state.momentum = spin.one_momentum();
        acting.finish()
    }

    fn drift(&self, state: &mut Phase, h: f64) -> Result<(), SimulateError> {
        let m = state.momentum;
        let moments = self.modified_moments(m, h);
        let turn = half_turn(moments, m, h).ok_or_else(|| self.too_long(state, h))?;
        let carried = Gyrostat::rigid(moments).carried(turn);
        state.momentum += cross(carried, turn) * (4.0 / (h * (1.0 + turn.norm_squared())));
        state.rotor = (state.rotor * cayley(turn)).renormalized();
        Ok(())
    }

    fn too_long(&self, state: &Phase, h: f64) -> SimulateError {
        let omega = Gyrostat::rigid(self.body.moments).omega(state.momentum).norm();
        let message = format!(
            "the discrete Moser-Veselov equation has no solution for a step of {h:e} s, which turns the body by {:.2} rad; \
             use steps of at most about 1 rad",
            (h * omega).abs()
        );
        SimulateError::Torque { time: state.time, message }
    }

    /// `Ĩ_k`.
    fn modified_moments(&self, m: Bivector, h: f64) -> [f64; 3] {
        let [a, b, c] = self.body.moments;
        let [x, y, z] = m.0;
        let (energy, casimir) = (0.5 * (x * x / a + y * y / b + z * z / c), 0.5 * m.norm_squared());
        let (sum, product) = ((a + b + c) / 6.0, a * b * c);
        let s = h * h * (sum * casimir / product - (1.0 / a + 1.0 / b + 1.0 / c) * energy / 3.0);
        let d = h * h * (sum * energy - casimir / 3.0) / product;
        self.body.moments.map(|i| i / (1.0 + s + d * i))
    }
}

/// P with `F(P) = 0` by Newton's method; None if it does not converge.
fn half_turn(moments: [f64; 3], m: Bivector, h: f64) -> Option<Bivector> {
    if !moments.iter().all(|i| *i > 0.0) {
        return None;
    }
    let body = Gyrostat::rigid(moments);
    let correction = |turn: Bivector| {
        let carried = body.carried(turn);
        let residual = carried + cross(turn, carried) - m * (0.5 * h * (1.0 + turn.norm_squared()));
        // I + P̂ I − (I(P))^ − h m P.
        let ([a, b, c], [x, y, z], [u, v, w]) = (moments, turn.0, carried.0);
        let hm = m * h;
        let entry = |i: usize, j: usize| -hm.0[i] * turn.0[j];
        let jacobian = [
            [a + entry(0, 0), w - z * b + entry(0, 1), y * c - v + entry(0, 2)],
            [z * a - w + entry(1, 0), b + entry(1, 1), u - x * c + entry(1, 2)],
            [v - y * a + entry(2, 0), x * b - u + entry(2, 1), c + entry(2, 2)],
        ];
        Ok(solved(&jacobian, residual))
    };
    let relative =
        |size: f64, turn: Bivector| if m == Bivector::default() { 0.0 } else { size / turn.norm() };
    let start = Bivector([0, 1, 2].map(|k| 0.5 * h * m.0[k] / moments[k]));
    newton(start, MOST_ITERATIONS, correction, relative).ok().flatten()
}
