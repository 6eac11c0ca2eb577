//! Splitting methods: structure-preserving products of exact rotations.
//!
//! In principal axes the kinetic energy `½ Σ m_k²/i_k` of the angular momentum `m` splits, with `p` the
//! middle axis, into
//!
//! ```text
//! |m|²/(2 i_p)  +  ½ κ_a m_a²  +  ½ κ_b m_b²,     κ_k = 1/i_k − 1/i_p.
//! ```
//!
//! Rotations solve each part exactly. The first commutes with the others and turns the body about the fixed L:
//! `R ← R exp(−½ h m/i_p)`, m unchanged. The others turn about a body axis by the angle `α = κ_k m_k h`: `R ← R q`,
//! `m ← ~q m q`, `q = exp(−½ α I e_k)`. They conserve |m|, |R| and `R m ~R` for any step. The choice of p minimises the
//! product `κ_a κ_b` in the error, which vanishes for a symmetric top.
//!
//! A torque kicks the momentum at fixed attitude: `m ← m + h N`; with damping, `m' = N − g m` solved
//! exactly. The symmetric product kick–a–b–a–kick is of order 2, and symmetric compositions
//! `S(γ_1 h) … S(γ_s h)` of it reach orders 4, 6 and 8.
//!
//! A wheel with the relative momentum `h` ([`Gyrostat`]) adds `−h·I⁻¹m` to the energy: a turn about the fixed body axis
//! of `I⁻¹h`, put in the middle.
//!
//! Runge–Kutta–Nyström splittings ([`RKN6`]) need the exact free motion between kicks: one turn for a symmetric body,
//! [`FreeMotion`] for any other.
//!
//! Without a torque L is constant in space. Against rounding each step rescales |m| and turns R so that `R m ~R` is L.
//! The direction of m is unchanged, so a zero component on an unstable axis stays zero.

mod sequences;
pub(crate) mod turns;

use super::momentum::fixed_momentum;
use crate::error::SimulateError;
use crate::exact::free::FreeMotion;
use crate::laws::forcing::{BodyForcing, Forcing};
use crate::laws::torque::{Torque, damping_rate};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::Bivector;
use polhode_ga::simd::lanes::One;
pub use sequences::{COMPOSITIONS, RKN6, Sequence};
use turns::{Spin, Turns};

/// A body in its principal axes and its torques, stepped by a splitting.
#[derive(Clone, Debug)]
pub struct Splitting {
    body: Gyrostat,
    torques: Vec<Torque>,
    stages: (Vec<(f64, f64)>, f64),
    /// Whether drifts are the exact free motion instead of a few turns.
    exact_drift: bool,
    turns: Turns<1, false>,
}

impl Splitting {
    /// Moments must be positive; torques in principal axes, each dependent on attitude and time at most.
    pub fn new(body: Gyrostat, torques: Vec<Torque>, sequence: &Sequence, start: &Phase) -> Splitting {
        let fixed = fixed_momentum(&torques, start).map(|momentum| momentum.0);
        let turns = Turns::new([(body, damping_rate(&torques), fixed)]);
        let exact_drift = sequence.is_nystrom() && !turns.kind().is_symmetric();
        Splitting { body, torques, stages: sequence.stages(), exact_drift, turns }
    }

    /// One step of length `h`, which may be negative, with the accumulated rounding of the kicks.
    pub fn step(&self, state: &mut Phase, lost: &mut Bivector, h: f64) -> Result<(), SimulateError> {
        let mut acting = BodyForcing::new(&self.body, &self.torques, None);
        let mut spin = Spin::alone(state, *lost);
        let (stages, last) = &self.stages;
        if self.exact_drift {
            let mut time = state.time;
            acting.begin(One::all(time + 0.5 * h));
            for &(kick, drift) in stages {
                self.turns.kick(&mut acting, &mut spin, time, kick * h);
                self.drift(&mut spin, drift * h);
                time += drift * h;
            }
            self.turns.kick(&mut acting, &mut spin, time, last * h);
            self.turns.finish(&mut spin);
        } else {
            self.turns.step((stages, *last), &mut acting, &mut spin, state.time, h);
        }
        acting.finish()?;
        state.time += h;
        (state.rotor, state.momentum) = (spin.one_rotor(), spin.one_momentum());
        *lost = Bivector(One::alone(spin.lost));
        Ok(())
    }

    /// Turns in a step; an exact free motion rounds like 60 of them.
    pub fn turns_per_step(&self) -> f64 {
        let stages = self.stages.0.len() as f64;
        if self.exact_drift { 60.0 * stages } else { 3.0 * stages }
    }

    /// Evaluations of the torque in a step.
    pub fn evaluations(&self) -> u64 {
        self.stages.0.len() as u64 + 1
    }

    /// The exact free motion.
    fn drift(&self, spin: &mut Spin<1, false>, h: f64) {
        let omega = self.body.omega(spin.one_momentum());
        let motion = FreeMotion::in_principal_axes(self.body.moments, spin.one_rotor(), omega);
        let (rotor, omega) = motion.at(h);
        spin.rotor = One::each(rotor.components());
        spin.momentum = One::each(self.body.momentum(omega).0);
    }
}
