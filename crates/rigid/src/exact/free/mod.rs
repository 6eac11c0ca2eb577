//! Torque-free motion in closed form.
//!
//! In principal axes `E = ½ Σ i_k ω_k²` and `G² = Σ i_k² ω_k²` are constant, so the angular velocity
//! follows the intersection of two ellipsoids, the polhode. Let `c` be the axis it encircles: that of the largest moment
//! if `G² > 2E i_mid` (short-axis mode), of the smallest otherwise (long-axis mode); `b` the middle axis, `a` the other.
//! The combinations
//!
//! ```text
//! P = a(c−a) ω_a² + b(c−b) ω_b² = 2Ec − G²
//! Q = b(b−a) ω_b² + c(c−a) ω_c² = G² − 2Ea
//! D = c(c−b) ω_c² − a(b−a) ω_a² = G² − 2Eb
//! λ² = (c−b)Q / (abc),  k² = (b−a)P / ((c−b)Q),  k'² = (c−a)D / ((c−b)Q)
//! ```
//!
//! are computed in double-double precision, so that k' is accurate near the separatrix. With `u = u0 + λt`
//!
//! ```text
//! ω = (A_a cn u, τ A_b sn u, σ A_c dn u),   A_a² = P/(a(c−a)),  A_b² = P/(b(c−b)),  A_c² = Q/(c(c−a)),
//! ```
//!
//! σ the sign of ω_c, `τ = σ s ε` with `s = sign(c − a)` and ε the parity of the order (a, b, c). (On the separatrix cn
//! is positive; there A_a and τ take the sign of ω_a.)
//!
//! **The rotor.** In the frame of `e1 = e_a`, `d = σ e_c` and `e2 = d x e1`, the momentum is
//! `m = (a A_a cn, s b A_b sn, c A_c dn)`. Let the rotor `W(t)` carry m to `G d`, which stands for the fixed L:
//! `R(t) = R(0) ~W(0) W(t)`. As a quaternion `W = (w0, w1, w2, w3)` it has the Cayley–Klein parameters
//! `α = w0 + i w3` and `β = w1 + i w2`, and `m = ~W G d W` reads
//!
//! ```text
//! |α|² − |β|² = m3/G,   2 α β* = (m2 + i m1)/G,   |α|² + |β|² = 1.
//! ```
//!
//! So `|α|² = (G + m3)/2G` is an elliptic function of u with the periods 2K and 4iK', its poles at ±iK' and its
//! zeros where `dn = −G/cA_c`: at ±i(2K' − η) for `dn iη = G/cA_c`, that is `η = F(φ, k')` with
//! `tan²φ = a(c−b)/(c(b−a))`; the zeros of `|β|²` are ±iη. Zeros and poles determine a function up to a factor: with the
//! theta functions of nome q², `q = exp(−πK'/K)`, `v = πu/2K` and `y = πη/2K`
//!
//! ```text
//! α = C(t) θ4(v − i s y | q²),   β = s C(t) θ1(v − i s y | q²),
//! ```
//!
//! with the signs of m. `C C*` is a constant times 1/θ4(v | q), so normalising suffices. The phase of C is linear in
//! time, ½νt, since α has no other zeros and poles: ν is the mean rate of precession without the turns of m about d.
//! **The rotor is four theta series, and one uniform turn about L**:
//!
//! ```text
//! W = exp(½ν t d) (Re θ4 + d Im θ4 + e1 s Re θ1 + e2 s Im θ1)/|…|   in quaternion units.
//! ```
//!
//! This form (Jacobi 1849) needs an integral of the third kind only in ν: with Euler's
//! `φ' = G(2E − m3²/c)/(G² − m3²)` and the 2π by which m turns about d in each period,
//!
//! ```text
//! ν = G/c + s (κ Π(n) − π/2) λ/K,   κ = G|c−a|/(acλ),   n = −c(b−a)/(a(c−b)) <= 0
//!   = G/a − s G|b−a| S(n)/2ab − s π λ/2K   = G/c + s P S(k²/n)/2cG,
//! ```
//!
//! where `Π − K` is proportional to the sum S ([`crate::numerics::elliptic`]), and the second form follows from
//! `Π(n) + Π(k²/n) = K + ½π √(…)`, whose last term times κ is π/2. The form with the smaller parameter is used.
//!
//! **Near the separatrix** K grows and q tends to 1. Jacobi's imaginary transformation gives the nome
//! `q' = exp(−πK/K')` and, with `x = πu/4K'` and `γ = πη/4K'` for u within a half period,
//!
//! ```text
//! θ4(v − i s y | q²) ~ exp(2i s v γ/π) θ2(s γ + i x | √q'),   θ1 ~ −i exp(…) θ1(s γ + i x | √q'):
//! ```
//!
//! circular functions of γ times hyperbolic ones of x; the exponential joins the precession. On the separatrix
//! itself one term remains, and ν is G/b.
//!
//! **Accuracy.** v and νt/2 are reduced in double-double precision, so the error does not grow with time. All series are
//! factors (sin v, sinh x, …) times rapidly converging sums, so each component of ω is accurate relative to itself. No
//! limit is special: equal moments give q = 0, steady rotation β = 0.
//!
//! Jacobi 1849; Whittaker, *Analytical Dynamics* §69; Celledoni, Fassò, Säfström, Zanna, SIAM J. Sci. Comput.
//! 30 (2008); DLMF 20.7 (theta functions), 19.7 and 19.8 (integrals).

mod derivatives;
mod description;
pub(super) mod flow;
pub(crate) mod orbit;
pub(crate) mod series;
mod set_up;
mod variation;

use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::exact::flow::Flow;
pub use derivatives::{Differentiated, FlowDerivatives};
use orbit::Orbit;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};
pub use set_up::FreeBody;
pub(crate) use set_up::{FreeMotions, phases_and_nomes};
use std::f64::consts::PI;

/// Number of turns up to which double-double precision gives a phase to 1e-14 turns.
pub(crate) const MOST_TURNS: f64 = 1e17;

/// A free motion: rotor and angular velocity at any time up to its [`FreeMotion::horizon`].
#[derive(Clone, Copy, Debug)]
pub struct FreeMotion {
    moments: [f64; 3],
    /// From principal axes to those of the body.
    frame: Rotor,
    /// In principal axes at time 0.
    omega: Bivector,
    /// A power of two near the largest component of omega; the orbit is that of omega/scale in time t·scale, with
    /// moments near 1, so that squares do not overflow.
    scale: f64,
    /// None for steady rotation.
    orbit: Option<Orbit>,
    pub(super) flow: Flow,
    /// In s.
    horizon: f64,
}

impl FreeMotion {
    /// The motion that starts at `rotor` (body axes to space) with angular velocity `omega` in body axes. An
    /// error if a principal moment is zero.
    pub fn new(inertia: &Inertia, rotor: Rotor, omega: Bivector) -> Result<FreeMotion, SimulateError> {
        Ok(FreeBody::new(inertia, rotor, omega)?.motion())
    }

    /// The motion of a body whose axes are its principal axes, with positive moments.
    pub fn in_principal_axes(moments: [f64; 3], rotor: Rotor, omega: Bivector) -> FreeMotion {
        FreeMotion::in_frame(Rotor::IDENTITY, moments, rotor, omega)
    }

    /// From principal axes to space, and with the frame from principal axes to those of the body.
    pub(crate) fn in_frame(frame: Rotor, moments: [f64; 3], rotor: Rotor, omega: Bivector) -> FreeMotion {
        FreeBody::in_frame(frame, moments, rotor, omega).motion()
    }

    /// How far in time, in s, the phase is accurate: 1e17 turns.
    pub fn horizon(&self) -> f64 {
        self.horizon
    }

    /// Rotor and body angular velocity at time `t` in s, the same bits as [`FreeMotion::at_many`].
    pub fn at(&self, t: f64) -> (Rotor, Bivector) {
        self.flow.at(t)
    }

    /// The same at many times: rows of four rotor components and of three components of the angular velocity.
    ///
    /// # Panics
    /// If the numbers of rows and times differ.
    pub fn at_many(&self, threads: Threads, times: &[f64], rotors: &mut [f64], omegas: &mut [f64]) {
        self.flow.at_many(threads, times, rotors, omegas);
    }
}

/// The time, in s, of [`MOST_TURNS`] turns by the fastest angular velocity of a rotor.
fn horizon(fastest: f64) -> f64 {
    MOST_TURNS * 4.0 * PI / fastest
}

/// The power of two next below the largest magnitude, within 2^±1000; 1 for zeros.
#[inline]
pub(crate) fn power_of_two([x, y, z]: [f64; 3]) -> f64 {
    let largest = x.abs().max(y.abs()).max(z.abs());
    // The bits of the exponent.
    let power = f64::from_bits(largest.to_bits() & (0x7ff << 52));
    if largest > 0.0 { power.clamp(1000f64.exp2().recip(), 1000f64.exp2()) } else { 1.0 }
}
