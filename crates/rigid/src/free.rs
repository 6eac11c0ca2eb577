//! The torque-free top, exact at any time.
//!
//! In principal axes `E = ½ Σ i_k ω_k²` and `G² = Σ i_k² ω_k²` are constant, so the angular velocity
//! runs along the intersection of two ellipsoids, the polhode. Name `c` the axis it encircles: that of
//! the largest moment when `G² > 2E i_mid` (short-axis mode), of the smallest otherwise (long-axis
//! mode); `b` the middle one, `a` the other. The combinations
//!
//! ```text
//! P = a(c−a) ω_a² + b(c−b) ω_b² = 2Ec − G²
//! Q = b(b−a) ω_b² + c(c−a) ω_c² = G² − 2Ea
//! D = c(c−b) ω_c² − a(b−a) ω_a² = G² − 2Eb
//! λ² = (c−b)Q / (abc),  k² = (b−a)P / ((c−b)Q),  k'² = (c−a)D / ((c−b)Q)
//! ```
//!
//! are formed in twice the precision, so that k' is known at the separatrix too. Then with `u = u0 + λt`
//!
//! ```text
//! ω = (A_a cn u, τ A_b sn u, σ A_c dn u),   A_a² = P/(a(c−a)),  A_b² = P/(b(c−b)),  A_c² = Q/(c(c−a)),
//! ```
//!
//! σ the sign of ω_c, `τ = σ s ε` with `s = sign(c − a)` and ε the parity of the axes' order (a, b, c). (On the
//! separatrix cn is positive for ever; there A_a and τ take the sign of ω_a.)
//!
//! **The rotor.** Let `d = σ e_c` and `P(t)` the rotor that turns the direction of the body's angular momentum
//! `m` into d the short way; `m·d > 0`, so it is smooth. `R(t) = R(0) ~P(0) exp(−½ I d α) P(t)` carries m to the
//! fixed L for any α. In Euler's angles about L, `α = φ − β`: φ the precession and β the azimuth of m about d.
//! With `φ' = G(2E − m_c²/c)/(G² − m_c²)`, which integrates to a Π, and `β = s χ`, χ the continuous angle of
//! `(a A_a cn u, b A_b sn u)`,
//!
//! ```text
//! α = G t/c + s [κ (Π(n; am u) − Π(n; am u0)) − (χ − χ0)],   κ = G|c−a|/(acλ),  n = −c(b−a)/(a(c−b)) <= 0.
//! ```
//!
//! For |n| < 1, as for a needle, Π is nearly u; then `Π − u` takes its place and `G/a = G/c + sκλ` that of G/c,
//! or two large angles would cancel. Over each period Π gains `4Π(n)` and χ gains 2π. Whole periods and whole
//! turns are split off in twice the precision; what is left is computed from the reduced u, so the error does
//! not grow with time. (On the double cover α counts modulo 4π.)
//!
//! Jacobi 1849; Whittaker, *Analytical Dynamics* §69; Celledoni, Fassò, Säfström, Zanna, SIAM J. Sci. Comput.
//! 30 (2008); the forms without cancellation as in Fukushima 2008.

use crate::double_double::DoubleDouble;
use crate::elliptic::{complete, incomplete_pi, incomplete_pi_excess, jacobi, r_f};
use crate::inertia::Inertia;
use crate::regime::{FreeDescription, Regime};
use crate::simulate::check_moments;
use crate::simulate_error::SimulateError;
use crate::symmetric_top::equal;
use crate::torque::{angular_momentum, kinetic};
use polhode_ga::{Bivector, Rotor, Vector};
use std::f64::consts::PI;

/// Twice the precision knows a phase of this many turns to 1e-14 of a turn.
const MOST_TURNS: f64 = 1e17;

/// A free motion: rotor and angular velocity at any time up to its [`FreeMotion::horizon`].
#[derive(Clone, Copy, Debug)]
pub struct FreeMotion {
    frame: Rotor,
    moments: [f64; 3],
    /// From principal axes to space at time 0.
    rotor: Rotor,
    /// In principal axes at time 0.
    omega: Bivector,
    /// A power of two near the largest component of omega; the tumbling is that of omega/scale in time
    /// t·scale, with moments near 1, so that no square leaves the range of floating point.
    scale: f64,
    /// None for steady rotation.
    tumbling: Option<Tumbling>,
}

impl FreeMotion {
    /// The motion that starts at `rotor` (body axes to space) with angular velocity `omega` in body axes. An
    /// error if a principal moment is zero.
    pub fn new(inertia: &Inertia, rotor: Rotor, omega: Bivector) -> Result<FreeMotion, SimulateError> {
        let (frame, moments) = (inertia.principal_frame(), inertia.principal_moments());
        check_moments(moments)?;
        let (rotor, omega) = (rotor * frame, frame.reverse().apply_bivector(omega));
        Ok(FreeMotion { frame, ..FreeMotion::in_principal_axes(moments, rotor, omega) })
    }

    /// The motion of a body whose axes are its principal axes, with positive moments.
    pub fn in_principal_axes(moments: [f64; 3], rotor: Rotor, omega: Bivector) -> FreeMotion {
        let (size, scale) = (power_of_two(moments), power_of_two(omega.0));
        let tumbling = Tumbling::new(moments.map(|i| i / size), omega.0.map(|w| w / scale));
        FreeMotion { frame: Rotor::IDENTITY, moments, rotor, omega, scale, tumbling }
    }

    /// How far in time, in s, the phase is known: to 1e17 turns.
    pub fn horizon(&self) -> f64 {
        let fastest = match &self.tumbling {
            Some(top) => top.turns_per_second.hi.max(top.lambda / (4.0 * PI)) * self.scale,
            None => self.omega.norm() / (4.0 * PI),
        };
        MOST_TURNS / fastest
    }

    /// Rotor and body angular velocity at time `t` in s.
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        let (turn, omega) = match &self.tumbling {
            Some(tumbling) => {
                let (turn, omega) = tumbling.at(t * self.scale);
                (turn, omega * self.scale)
            }
            None => (steady(self.omega, t), self.omega),
        };
        let rotor = self.rotor * turn * self.frame.reverse();
        (rotor.renormalized(), self.frame.apply_bivector(omega))
    }

    /// What the invariants tell.
    pub fn describe(&self) -> FreeDescription {
        let (i, w) = (self.moments, self.omega.0);
        let momentum = angular_momentum(i, self.omega);
        let largest = |x: &usize, y: &usize| w[*x].abs().total_cmp(&w[*y].abs());
        let still = FreeDescription {
            regime: if w == [0.0; 3] { Regime::Rest } else { Regime::Steady },
            energy: kinetic(i, momentum),
            angular_momentum: momentum.norm(),
            modulus: 0.0,
            axis: (0..3).max_by(largest).unwrap_or(0),
            period: None,
            precession_rate: None,
        };
        let Some(top) = &self.tumbling else { return still };
        let [a, b, c] = top.axes;
        let regime = match top.periods {
            None => Regime::Separatrix,
            Some(_) if equal(i[a], i[b]) => Regime::Symmetric,
            Some(_) if top.s > 0.0 => Regime::ShortAxis,
            Some(_) => Regime::LongAxis,
        };
        let moving = FreeDescription { regime, modulus: top.k2.sqrt(), axis: c, ..still };
        let Some(periods) = &top.periods else { return moving };
        let rate = top.linear_rate + top.s * top.kappa * top.lambda * periods.complete_pi / periods.quarter;
        FreeDescription {
            period: Some(4.0 * periods.quarter / top.lambda / self.scale).filter(|x| x.is_finite()),
            precession_rate: Some(rate * self.scale).filter(|x| x.is_finite()),
            ..moving
        }
    }
}

/// The power of two next below the largest magnitude; 1 for zeros.
fn power_of_two(components: [f64; 3]) -> f64 {
    let largest = components.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 }
}

/// `exp(−½ Ω t)`, with the angle reduced in twice the precision.
fn steady(omega: Bivector, t: f64) -> Rotor {
    let square = |x: f64| DoubleDouble::from(x) * x.into();
    let scale = power_of_two(omega.0);
    let unit = omega / scale;
    let [x, y, z] = unit.0;
    let size = (square(x) + square(y) + square(z)).sqrt();
    if size.hi == 0.0 {
        return Rotor::IDENTITY;
    }
    let (_, turn) = (size * (t * scale).into() / four_pi()).split_integer();
    Rotor::exp(unit / size.value() * (-2.0 * PI * turn))
}

fn four_pi() -> DoubleDouble {
    DoubleDouble::PI * 4.0.into()
}

/// The phases of a motion that is not steady, in principal axes.
#[derive(Clone, Copy, Debug)]
struct Tumbling {
    /// a, b and c.
    axes: [usize; 3],
    /// sign(c − a).
    s: f64,
    /// Amplitudes with their signs: A_a, τ A_b, σ A_c; A_a is negative on half of the separatrix.
    amplitudes: [f64; 3],
    /// Moments of a, b and c.
    moments: [f64; 3],
    /// σ e_c.
    d: Vector,
    lambda: f64,
    k2: f64,
    kc2: f64,
    n: f64,
    kappa: f64,
    /// Whether Π − u stands for Π.
    excess: bool,
    /// G/c, or G/a with the excess, in rad/s.
    linear_rate: f64,
    /// The part of α that is linear in time, in turns of 4π per second.
    turns_per_second: DoubleDouble,
    /// None on the separatrix.
    periods: Option<Periods>,
    u0: f64,
    /// The local part of α, and P, at time 0.
    local0: f64,
    aligned0: Rotor,
}

/// What repeats, off the separatrix.
#[derive(Clone, Copy, Debug)]
struct Periods {
    /// K.
    quarter: f64,
    /// Π(n), or Π(n) − K.
    complete_pi: f64,
    /// λ/4K, in 1/s.
    per_second: DoubleDouble,
    /// α of a period beyond that linear in time, in turns of 4π.
    turns_each: DoubleDouble,
}

impl Tumbling {
    /// None if the rotation is steady: `I(Ω)` parallel to Ω.
    fn new(i: [f64; 3], w: [f64; 3]) -> Option<Tumbling> {
        if (0..3).all(|k| (i[(k + 1) % 3] - i[(k + 2) % 3]) * w[(k + 1) % 3] * w[(k + 2) % 3] == 0.0) {
            return None;
        }
        let dd = DoubleDouble::from;
        let mut order = [0, 1, 2];
        order.sort_by(|&x, &y| i[x].total_cmp(&i[y]));
        let [small, b, large] = order;
        // i_x (i_x − i_b) ω_x²
        let term = |x: usize| dd(i[x]) * (dd(i[x]) - dd(i[b])) * dd(w[x]) * dd(w[x]);
        let (high, low) = (term(large), term(small));
        let d = high + low;
        let (a, c) = if d.hi >= 0.0 { (small, large) } else { (large, small) };
        let s = if c == large { 1.0 } else { -1.0 };
        let (ia, ib, ic) = (dd(i[a]), dd(i[b]), dd(i[c]));
        // Differences of moments, positive.
        let (ab, ac, bc) = ((ib - ia).abs(), (ic - ia).abs(), (ic - ib).abs());
        let square = |k: usize| dd(w[k]) * dd(w[k]);
        let p = ia * ac * square(a) + ib * bc * square(b);
        let q = ib * ab * square(b) + ic * ac * square(c);
        let lambda = (bc * q / (ia * ib * ic)).sqrt();
        let (k2, kc2) = (ab * p / (bc * q), ac * d.abs() / (bc * q));
        let g = (ia * ia * square(a) + ib * ib * square(b) + ic * ic * square(c)).sqrt();
        let kappa = g * ac / (ia * ic * lambda);

        // The order (a, b, c) is even if it is a cyclic one.
        let parity = if (b + 3 - a) % 3 == 1 { 1.0 } else { -1.0 };
        let sigma = 1f64.copysign(w[c]);
        // D is known to a few roundings of its two terms.
        let on_separatrix = d.hi.abs() <= 16.0 * DoubleDouble::EPSILON * (high.hi - low.hi);
        // cn keeps its sign on the separatrix: ω_a < 0 is the half turn about c of a motion with ω_a > 0.
        let half_turn = if on_separatrix { 1f64.copysign(w[a]) } else { 1.0 };
        let tau = sigma * s * parity * half_turn;
        let sizes = [p / (ia * ac), p / (ib * bc), q / (ic * ac)].map(|x| x.sqrt().value());
        let amplitudes = [half_turn * sizes[0], tau * sizes[1], sigma * sizes[2]];
        let mut axis = Vector::default();
        axis.0[c] = sigma;

        let (n, one_minus_n) = (-(ic * ab / (ia * bc)), ib * ac / (ia * bc));
        let excess = n.hi > -1.0;
        let periods = (!on_separatrix).then(|| {
            let kc = kc2.sqrt();
            let (quarter, pi) = (complete(kc, DoubleDouble::ONE), complete(kc, one_minus_n));
            let pi = if excess { pi - quarter } else { pi };
            let gain = kappa * pi * dd(4.0) - DoubleDouble::PI * dd(2.0);
            Periods {
                quarter: quarter.value(),
                complete_pi: pi.value(),
                per_second: lambda / (quarter * dd(4.0)),
                turns_each: gain * dd(s) / four_pi(),
            }
        });
        let linear = match (on_separatrix, excess) {
            // The linear part of Π has joined the other.
            (true, _) => g / ib,
            (false, true) => g / ia,
            (false, false) => g / ic,
        };
        let mut top = Tumbling {
            axes: [a, b, c],
            s,
            amplitudes,
            moments: [i[a], i[b], i[c]],
            d: axis,
            lambda: lambda.value(),
            k2: k2.value().min(1.0),
            kc2: if on_separatrix { 0.0 } else { kc2.value().min(1.0) },
            n: n.value(),
            kappa: kappa.value(),
            excess,
            linear_rate: linear.value(),
            turns_per_second: linear / four_pi(),
            periods,
            u0: 0.0,
            local0: 0.0,
            aligned0: Rotor::IDENTITY,
        };
        top.u0 = top.argument(w[a] / amplitudes[0], w[b] / amplitudes[1]);
        let start = top.reduced(0.0).0;
        top.local0 = top.local_angle(start);
        top.aligned0 = top.aligned(jacobi(start, top.kc2));
        Some(top)
    }

    /// The turn `~P(0) exp(−½ I d α) P(t)` since time 0, and the angular velocity.
    fn at(&self, t: f64) -> (Rotor, Bivector) {
        let (u, whole) = self.reduced(t);
        let functions = jacobi(u, self.kc2);
        let mut turns = self.turns_per_second * t.into();
        if let Some(periods) = &self.periods {
            turns = turns + periods.turns_each * whole.into();
        }
        let (_, turn) = turns.split_integer();
        let angle = 4.0 * PI * turn + (self.local_angle(u) - self.local0);
        let precession = Rotor::exp(self.d.undual() * (-0.5 * angle));
        let rotor = self.aligned0.reverse() * precession * self.aligned(functions);
        (rotor, self.omega(functions))
    }

    /// u at time t less whole periods, and how many these are.
    fn reduced(&self, t: f64) -> (f64, f64) {
        let Some(periods) = &self.periods else { return (self.u0 + self.lambda * t, 0.0) };
        let period = 4.0 * periods.quarter;
        let (whole, rest) = (periods.per_second * t.into() + (self.u0 / period).into()).split_integer();
        (period * rest, whole)
    }

    /// The angular velocity for given sn, cn, dn.
    fn omega(&self, [sn, cn, dn]: [f64; 3]) -> Bivector {
        let mut omega = Bivector::default();
        for (axis, (amplitude, f)) in self.axes.into_iter().zip(self.amplitudes.into_iter().zip([cn, sn, dn]))
        {
            omega.0[axis] = amplitude * f;
        }
        omega
    }

    /// The rotor that turns the direction of the angular momentum into d.
    fn aligned(&self, functions: [f64; 3]) -> Rotor {
        let mut momentum = self.omega(functions).dual();
        for (axis, moment) in self.axes.into_iter().zip(self.moments) {
            momentum.0[axis] *= moment;
        }
        Rotor::from_vectors(momentum, self.d).unwrap_or(Rotor::IDENTITY)
    }

    /// `s [κ Π(n; am u) − χ]`, with Π or its excess, for a reduced u; on the separatrix without the linear
    /// part of Π.
    fn local_angle(&self, u: f64) -> f64 {
        let [sn, cn, dn] = jacobi(u, self.kc2);
        let [a, b, _] = self.moments;
        let chi = f64::atan2(b * self.amplitudes[1].abs() * sn, a * self.amplitudes[0].abs() * cn);
        let pi = match &self.periods {
            // ∫du/(1 + ν² tanh² u) = [u + ν arctan(ν tanh u)]/(1 + ν²), ν² = −n.
            None => {
                let nu = (-self.n).sqrt();
                nu * (nu * sn).atan() / (1.0 - self.n)
            }
            Some(periods) => {
                let (sin, cos) = (sn.abs(), cn.abs());
                let part = if self.excess {
                    incomplete_pi_excess(self.n, sin, cos, dn)
                } else {
                    incomplete_pi(self.n, sin, cos, dn, self.k2, self.kc2)
                };
                let part = if cn < 0.0 { 2.0 * periods.complete_pi - part } else { part };
                // Odd in u; the excess is negative for positive u.
                if sn < 0.0 { -part } else { part }
            }
        };
        self.s * (self.kappa * pi - chi)
    }

    /// The u in [−2K, 2K] with given cn u and sn u.
    fn argument(&self, cn: f64, sn: f64) -> f64 {
        let size = cn.hypot(sn);
        let (cos, sin) = (cn / size, sn / size);
        let Some(periods) = &self.periods else { return (sin / cos).asinh() };
        // Δ² = 1 − k² sin² = cos² + k'² sin².
        let first = sin.abs() * r_f(cos * cos, cos * cos + self.kc2 * sin * sin, 1.0);
        let first = if cos < 0.0 { 2.0 * periods.quarter - first } else { first };
        first.copysign(sin)
    }
}
