//! Structure-preserving steps for a rigid body: products of exact turns.
//!
//! In principal axes the kinetic energy `½ Σ m_k²/i_k` of the angular momentum `m` splits, with `p` the
//! middle axis, into
//!
//! ```text
//! |m|²/(2 i_p)  +  ½ κ_a m_a²  +  ½ κ_b m_b²,     κ_k = 1/i_k − 1/i_p.
//! ```
//!
//! Each part alone is solved exactly by turns. The first commutes with everything and turns the body
//! about the fixed L: `R ← R exp(−½ h m/i_p)`, m unchanged. The others turn about a body axis by the
//! angle `α = κ_k m_k h`: `R ← R q`, `m ← ~q m q`, `q = exp(−½ α I e_k)`. Turns keep |m|, |R| and
//! `R m ~R` whatever the step. With the middle axis left out, the product `κ_a κ_b` that rules the error
//! is smallest; it vanishes for a symmetric top, which is then solved exactly.
//!
//! A torque kicks the momentum at fixed attitude: `m ← m + h N`; with damping, `m' = N − g m` solved
//! exactly. The symmetric product kick–a–b–a–kick is of order 2, and symmetric compositions
//! `S(γ_1 h) … S(γ_s h)` of it reach orders 4, 6 and 8.
//!
//! A wheel with the relative momentum `h` ([`Gyrostat`]) adds `−h·I⁻¹m` to the energy: a turn about the fixed body axis of
//! `I⁻¹h`, put in the middle.
//!
//! Runge–Kutta–Nyström splittings ([`Nystrom`]) need the free motion whole between kicks: one turn for a symmetric
//! body, the exact solution of [`FreeMotion`] for any other.
//!
//! Without a torque L is constant in space. Rounding would let `R m ~R` wander from it, so after each
//! step |m| is scaled back and R is turned by the tiny angle that carries `R m ~R` to L. The direction
//! of m is left alone: on an unstable axis a component that is zero stays zero.

mod sequences;

use crate::free::FreeMotion;
use crate::phase::{Gyrostat, Phase};
use crate::simulate_error::SimulateError;
use crate::torque::{Torque, exerted};
use polhode_ga::{Bivector, Rotor};
pub use sequences::{COMPOSITIONS, Composition, Nystrom, RKN6};

/// How kicks and free motion follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sequence {
    /// Second-order steps, composed.
    Composition(&'static Composition),
    /// Kicks between exact free motions.
    Nystrom(&'static Nystrom),
}

/// A body in its principal axes, with what turns it and how it is stepped.
#[derive(Clone, Debug)]
pub struct Splitting {
    body: Gyrostat,
    torques: Vec<Torque>,
    damping: f64,
    sequence: Sequence,
    /// Axes a and b, and κ_a, κ_b; i_p.
    axes: [usize; 2],
    kappa: [f64; 2],
    middle: f64,
    /// `−I⁻¹h` of a wheel.
    wheel: Option<Bivector>,
    /// L in space, where it is constant.
    fixed: Option<Bivector>,
}

impl Splitting {
    /// Moments must be positive; torques in principal axes, each dependent on attitude and time at most.
    pub fn new(body: Gyrostat, torques: Vec<Torque>, sequence: Sequence, start: &Phase) -> Splitting {
        let moments = body.moments;
        let mut order = [0, 1, 2];
        order.sort_by(|&x, &y| moments[x].total_cmp(&moments[y]));
        let [a, p, b] = order;
        // 1/i_k − 1/i_p, without subtracting nearly equal quotients.
        let kappa = |k: usize| (moments[p] - moments[k]) / (moments[p] * moments[k]);
        // Of a symmetric body one turn is none: that of the second axis.
        let [a, b] = if kappa(a) == 0.0 { [b, a] } else { [a, b] };
        let damping = torques.iter().map(|t| t.damping_rate()).sum();
        let free = torques.iter().all(|t| matches!(t, Torque::Wheel(_)));
        Splitting {
            body,
            torques,
            damping,
            sequence,
            axes: [a, b],
            kappa: [kappa(a), kappa(b)],
            middle: moments[p],
            wheel: (body.wheel != Bivector::default()).then(|| body.omega(Bivector::default())),
            fixed: free.then(|| start.rotor.apply_bivector(start.momentum)),
        }
    }

    /// One step of length `h`, which may be negative.
    pub fn step(&self, state: &mut Phase, h: f64) -> Result<(), SimulateError> {
        let start = state.time;
        match (self.fixed, self.sequence) {
            (Some(fixed), Sequence::Composition(composition)) => {
                for gamma in composition.stages() {
                    self.turn_about_axes(state, gamma * h);
                }
                self.turn_about_momentum(state, h);
                restore_momentum(state, fixed);
            }
            (None, Sequence::Composition(composition)) => {
                let mut kick = 0.0;
                for gamma in composition.stages() {
                    self.kick(state, (kick + 0.5 * gamma) * h)?;
                    self.turn_about_axes(state, gamma * h);
                    self.turn_about_momentum(state, gamma * h);
                    state.time += gamma * h;
                    kick = 0.5 * gamma;
                }
                self.kick(state, kick * h)?;
            }
            (_, Sequence::Nystrom(nystrom)) => {
                for (kick, drift) in nystrom.stages() {
                    self.kick(state, kick * h)?;
                    self.drift(state, drift * h);
                    state.time += drift * h;
                }
                self.kick(state, nystrom.last() * h)?;
            }
        }
        state.rotor = state.rotor.renormalized();
        state.time = start + h;
        Ok(())
    }

    /// Evaluations of the torque in a step.
    pub fn evaluations(&self) -> u64 {
        let kicks = match self.sequence {
            Sequence::Composition(composition) => composition.stages().count(),
            Sequence::Nystrom(nystrom) => nystrom.stages().count(),
        };
        kicks as u64 + 1
    }

    /// The free motion, exactly.
    fn drift(&self, state: &mut Phase, h: f64) {
        if self.kappa[1] == 0.0 {
            self.turn_about_axes(state, h);
            self.turn_about_momentum(state, h);
        } else {
            let omega = self.body.omega(state.momentum);
            let (rotor, omega) = FreeMotion::in_principal_axes(self.body.moments, state.rotor, omega).at(h);
            (state.rotor, state.momentum) = (rotor, self.body.momentum(omega));
        }
    }

    fn turn_about_momentum(&self, state: &mut Phase, h: f64) {
        state.rotor = state.rotor * Rotor::exp_fast(state.momentum * (-0.5 * h / self.middle));
    }

    fn turn_about_axes(&self, state: &mut Phase, h: f64) {
        match (self.kappa[1] == 0.0, self.wheel) {
            (true, None) => self.turn_about_axis(state, 0, h),
            (false, None) => {
                self.turn_about_axis(state, 0, 0.5 * h);
                self.turn_about_axis(state, 1, h);
                self.turn_about_axis(state, 0, 0.5 * h);
            }
            (_, Some(wheel)) => {
                self.turn_about_axis(state, 0, 0.5 * h);
                self.turn_about_axis(state, 1, 0.5 * h);
                let turn = Rotor::exp_fast(wheel * (-0.5 * h));
                state.rotor = state.rotor * turn;
                state.momentum = turn.reverse().apply_bivector(state.momentum);
                self.turn_about_axis(state, 1, 0.5 * h);
                self.turn_about_axis(state, 0, 0.5 * h);
            }
        }
    }

    fn turn_about_axis(&self, state: &mut Phase, which: usize, h: f64) {
        let k = self.axes[which];
        let half = 0.5 * self.kappa[which] * state.momentum.0[k] * h;
        let mut plane = Bivector::default();
        plane.0[k] = -half;
        state.rotor = state.rotor * Rotor::exp_fast(plane);
        // ~q m q turns the other two components by −2 half; written out, the one about k is exact. The turn is
        // added to m: rounded cosines and sines would stretch it by the same at every step of a steady motion.
        let (sin, cos) = half.sin_cos();
        let (versine, sine) = (2.0 * sin * sin, 2.0 * sin * cos);
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (x, y) = (state.momentum.0[i], state.momentum.0[j]);
        state.momentum.0[i] = x + (sine * y - versine * x);
        state.momentum.0[j] = y - (sine * x + versine * y);
    }

    /// `m' = N − g (m − h)` for a time t, `m − h` being what the body carries: `(m − h) e^(−gt) + N (1 − e^(−gt))/g`.
    fn kick(&self, state: &mut Phase, h: f64) -> Result<(), SimulateError> {
        let torque = exerted(&self.torques, &self.body, state)?;
        let decay = -self.damping * h;
        let impulse = if decay == 0.0 { h } else { h * decay.exp_m1() / decay };
        if decay != 0.0 {
            let wheel = self.body.wheel;
            state.momentum = (state.momentum - wheel) * decay.exp() + wheel;
        }
        state.momentum += torque * impulse;
        Ok(())
    }
}

/// Takes the rounding of one free step out of |m| and the direction of `R m ~R`, to first order.
fn restore_momentum(state: &mut Phase, fixed: Bivector) {
    let size = fixed.norm_squared();
    if size > 0.0 {
        // Added, not multiplied by 1 + x, which would round shrinking and growing differently.
        let missing = 0.5 * (size - state.momentum.norm_squared()) / size;
        state.momentum += state.momentum * missing;
        let wandered = state.rotor.apply_bivector(state.momentum);
        // exp(−½ a∧b/|a||b|) turns the axial vector a into b.
        let back = wandered.dual().wedge(fixed.dual()) * (-0.5 / size);
        state.rotor = Rotor::exp(back) * state.rotor;
    }
}
