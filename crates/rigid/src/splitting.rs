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
//! Without a torque L is constant in space. Rounding would let `R m ~R` wander from it, so after each
//! step |m| is scaled back and R is turned by the tiny angle that carries `R m ~R` to L. The direction
//! of m is left alone: on an unstable axis a component that is zero stays zero.

use crate::phase::{Gyrostat, Phase};
use crate::torque::{Torque, TorqueError};
use polhode_ga::{Bivector, Rotor};

/// A symmetric composition of the second-order step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// The name it is asked for by.
    pub name: &'static str,
    /// Its order of convergence.
    pub order: i32,
    /// γ_1 … up to the middle one; the rest mirrors them.
    half: &'static [f64],
}

/// Every method, by rising order.
///
/// Coefficients: H. Yoshida, Phys. Lett. A 150 (1990) 262; W. Kahan & R.-C. Li, Math. Comp. 66 (1997)
/// 1089, as printed in Hairer, Lubich & Wanner, *Geometric Numerical Integration*, V.3.
pub const METHODS: [Method; 4] = [
    Method { name: "strang", order: 2, half: &[1.0] },
    Method { name: "yoshida4", order: 4, half: &[1.351_207_191_959_657_6, -1.702_414_383_919_315_3] },
    Method {
        name: "kahan_li6",
        order: 6,
        half: &[
            0.392_161_444_007_314_1,
            0.332_599_136_789_359_44,
            -0.706_246_172_557_639_4,
            0.082_213_596_293_550_8,
            0.798_543_990_934_829_9,
        ],
    },
    Method {
        name: "kahan_li8",
        order: 8,
        half: &[
            0.130_202_483_088_890_08,
            0.561_162_981_775_108_4,
            -0.389_474_962_644_847_3,
            0.158_841_906_555_155_6,
            -0.395_903_894_133_237_6,
            0.184_539_640_978_315_7,
            0.258_374_387_686_322_04,
            0.295_011_723_609_310_3,
            -0.605_508_533_830_034_5,
        ],
    },
];

impl Method {
    /// The method of this name.
    pub fn from_name(name: &str) -> Option<Method> {
        METHODS.into_iter().find(|m| m.name == name)
    }

    /// The method of the highest order.
    pub fn best() -> Method {
        METHODS[METHODS.len() - 1]
    }

    /// γ_1 … γ_s.
    fn stages(&self) -> impl Iterator<Item = f64> + '_ {
        let mirrored = self.half.iter().rev().skip(1);
        self.half.iter().chain(mirrored).copied()
    }
}

/// A body in its principal axes, with what turns it and how it is stepped.
#[derive(Clone, Debug)]
pub struct Stepper {
    body: Gyrostat,
    torques: Vec<Torque>,
    damping: f64,
    method: Method,
    /// Axes a and b, and κ_a, κ_b; i_p.
    axes: [usize; 2],
    kappa: [f64; 2],
    middle: f64,
    /// L in space, constant without torques.
    fixed: Bivector,
}

impl Stepper {
    /// Moments must be positive; torques in principal axes.
    pub fn new(body: Gyrostat, torques: Vec<Torque>, method: Method, start: &Phase) -> Stepper {
        let moments = body.moments;
        let mut order = [0, 1, 2];
        order.sort_by(|&x, &y| moments[x].total_cmp(&moments[y]));
        let [a, p, b] = order;
        // 1/i_k − 1/i_p, without subtracting nearly equal quotients.
        let kappa = |k: usize| (moments[p] - moments[k]) / (moments[p] * moments[k]);
        let damping = torques.iter().map(|t| t.damping_rate()).sum();
        Stepper {
            body,
            torques,
            damping,
            method,
            axes: [a, b],
            kappa: [kappa(a), kappa(b)],
            middle: moments[p],
            fixed: start.rotor.apply_bivector(start.momentum),
        }
    }

    /// One step of length `h`, which may be negative.
    pub fn step(&self, state: &mut Phase, h: f64) -> Result<(), TorqueError> {
        let start = state.time;
        if self.torques.is_empty() {
            for gamma in self.method.stages() {
                self.turn_about_axes(state, gamma * h);
            }
            self.turn_about_momentum(state, h);
            self.restore_momentum(state);
        } else {
            let mut kick = 0.0;
            for gamma in self.method.stages() {
                self.kick(state, (kick + 0.5 * gamma) * h)?;
                self.turn_about_axes(state, gamma * h);
                self.turn_about_momentum(state, gamma * h);
                state.time += gamma * h;
                kick = 0.5 * gamma;
            }
            self.kick(state, kick * h)?;
        }
        state.rotor = state.rotor.renormalized();
        state.time = start + h;
        Ok(())
    }

    /// Takes the rounding of one free step out of |m| and the direction of `R m ~R`, to first order.
    fn restore_momentum(&self, state: &mut Phase) {
        let size = self.fixed.norm_squared();
        if size > 0.0 {
            // Added, not multiplied by 1 + x, which would round shrinking and growing differently.
            let missing = 0.5 * (size - state.momentum.norm_squared()) / size;
            state.momentum += state.momentum * missing;
            let wandered = state.rotor.apply_bivector(state.momentum);
            // exp(−½ a∧b/|a||b|) turns the axial vector a into b.
            let back = wandered.dual().wedge(self.fixed.dual()) * (-0.5 / size);
            state.rotor = Rotor::exp(back) * state.rotor;
        }
    }

    /// The method's order of convergence.
    pub fn order(&self) -> i32 {
        self.method.order
    }

    /// The rate of the fastest turn, in rad/s, a scale for steps: each turn's for the largest momentum
    /// that the energy allows, `m_k² <= 2E i_k`, and the swing in the torque.
    pub fn fastest_rate(&self, start: &Phase) -> f64 {
        let torque: f64 = self.torques.iter().map(|t| t.size(&self.body)).sum();
        let energy = self.body.kinetic(start.momentum) + 2.0 * torque;
        let largest = |i: f64| (2.0 * energy * i).sqrt();
        let axes = (0..2).map(|w| self.kappa[w].abs() * largest(self.body.moments[self.axes[w]]));
        let smallest = self.body.moments.iter().fold(f64::INFINITY, |m: f64, x| m.min(*x));
        let about_momentum = start.momentum.norm().max(largest(self.middle)) / self.middle;
        axes.sum::<f64>() + about_momentum + (torque / smallest).sqrt() + self.damping.abs()
    }

    fn turn_about_momentum(&self, state: &mut Phase, h: f64) {
        state.rotor = state.rotor * Rotor::exp_fast(state.momentum * (-0.5 * h / self.middle));
    }

    fn turn_about_axes(&self, state: &mut Phase, h: f64) {
        self.turn_about_axis(state, 0, 0.5 * h);
        self.turn_about_axis(state, 1, h);
        self.turn_about_axis(state, 0, 0.5 * h);
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

    /// `m' = N − g m` for a time h: `m e^(−gh) + N (1 − e^(−gh))/g`.
    fn kick(&self, state: &mut Phase, h: f64) -> Result<(), TorqueError> {
        let mut torque = Bivector::default();
        for law in &self.torques {
            torque += law.value(&self.body, state)?;
        }
        let decay = -self.damping * h;
        let impulse = if decay == 0.0 { h } else { h * decay.exp_m1() / decay };
        state.momentum = state.momentum * decay.exp() + torque * impulse;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compositions_are_consistent() {
        for method in METHODS {
            let sum: f64 = method.stages().sum();
            assert!((sum - 1.0).abs() < 4e-16, "{} {sum}", method.name);
            // Order > 2 needs Σγ³ = 0.
            let cubes: f64 = method.stages().map(|g| g * g * g).sum();
            assert!(method.order == 2 || cubes.abs() < 4e-15, "{} {cubes}", method.name);
        }
    }
}
