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
use crate::kicks::{Kicks, fixed_momentum, restore_momentum};
use crate::phase::{Gyrostat, Phase};
use crate::simulate_error::SimulateError;
use crate::torque::Torque;
use crate::turn::cosine_and_sinc;
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
    kicks: Kicks,
    /// Kicks and drifts in turn, as fractions of the step, and the kick after the last.
    stages: Vec<(f64, f64)>,
    last_kick: f64,
    /// Whether drifts are the exact free motion of any body.
    exact_drift: bool,
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
        let fixed = fixed_momentum(&torques, start);
        let (stages, last_kick) = match sequence {
            Sequence::Composition(composition) => composition.kicks_and_drifts(),
            Sequence::Nystrom(nystrom) => (nystrom.stages().collect(), nystrom.last()),
        };
        Splitting {
            body,
            kicks: Kicks::new(body, torques),
            stages,
            last_kick,
            exact_drift: matches!(sequence, Sequence::Nystrom(_)),
            axes: [a, b],
            kappa: [kappa(a), kappa(b)],
            middle: moments[p],
            wheel: (body.wheel != Bivector::default()).then(|| body.omega(Bivector::default())),
            fixed,
        }
    }

    /// One step of length `h`, which may be negative.
    pub fn step(&self, state: &mut Phase, h: f64) -> Result<(), SimulateError> {
        let start = state.time;
        if self.fixed.is_some() && !self.exact_drift {
            self.turn_about_momentum(state, h);
            for &(_, drift) in &self.stages {
                self.turn_about_axes(state, drift * h);
            }
        } else {
            for &(kick, drift) in &self.stages {
                self.kicks.kick(state, kick * h)?;
                self.drift(state, drift * h);
                state.time += drift * h;
            }
            self.kicks.kick(state, self.last_kick * h)?;
        }
        state.time = start + h;
        state.rotor = state.rotor.renormalized();
        if let Some(fixed) = self.fixed {
            restore_momentum(state, fixed);
        }
        Ok(())
    }

    /// Evaluations of the torque in a step.
    pub fn evaluations(&self) -> u64 {
        self.stages.len() as u64 + 1
    }

    /// The free motion: of a symmetric body without a wheel exactly, of others where asked for.
    fn drift(&self, state: &mut Phase, h: f64) {
        if self.exact_drift && self.kappa[1] != 0.0 {
            let omega = self.body.omega(state.momentum);
            let (rotor, omega) = FreeMotion::in_principal_axes(self.body.moments, state.rotor, omega).at(h);
            (state.rotor, state.momentum) = (rotor, self.body.momentum(omega));
        } else {
            self.turn_about_momentum(state, h);
            self.turn_about_axes(state, h);
        }
    }

    /// It commutes with the other turns: before them m is the one that they turn.
    fn turn_about_momentum(&self, state: &mut Phase, h: f64) {
        let half = 0.5 * h / self.middle;
        let (cos, sinc) = cosine_and_sinc(half * half * state.momentum.norm_squared());
        let [x, y, z] = (state.momentum * (-half * sinc)).0;
        state.rotor = state.rotor * Rotor::from_unit_components([cos, x, y, z]);
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
        // The axes k, i, j are cyclic; a match lets the compiler see them.
        match self.axes[which] {
            0 => turn_about::<0, 1, 2>(state, 0.5 * self.kappa[which] * state.momentum.0[0] * h),
            1 => turn_about::<1, 2, 0>(state, 0.5 * self.kappa[which] * state.momentum.0[1] * h),
            _ => turn_about::<2, 0, 1>(state, 0.5 * self.kappa[which] * state.momentum.0[2] * h),
        }
    }
}

/// `R ← R q`, `m ← ~q m q` with `q = exp(−half I e_k)`, written out.
#[inline]
fn turn_about<const K: usize, const I: usize, const J: usize>(state: &mut Phase, half: f64) {
    let (cos, sinc) = cosine_and_sinc(half * half);
    let sin = half * sinc;
    let [s, b @ ..] = state.rotor.components();
    let mut turned = [0.0; 4];
    turned[0] = s * cos + b[K] * sin;
    turned[K + 1] = b[K] * cos - s * sin;
    turned[I + 1] = b[I] * cos + b[J] * sin;
    turned[J + 1] = b[J] * cos - b[I] * sin;
    state.rotor = Rotor::from_unit_components(turned);
    // ~q m q turns the other two components by −2 half; the one about k is exact. The turn is added to m: rounded
    // cosines and sines would stretch it by the same at every step of a steady motion.
    let (versine, sine) = (2.0 * sin * sin, 2.0 * sin * cos);
    let (x, y) = (state.momentum.0[I], state.momentum.0[J]);
    state.momentum.0[I] = x + (sine * y - versine * x);
    state.momentum.0[J] = y - (sine * x + versine * y);
}
