//! Lagrange's heavy top in closed form: two equal moments, the centre of mass on the axis of symmetry.
//!
//! With a moment i1 across the axis, i3 about it, and `V = c u`, `u = cos θ` the axis' (that is γ3), `c >= 0`, the
//! momenta L3 about the axis and Lz about the vertical are constant. A uniform rotation about the axis of symmetry with
//! the rate `ω3 − L3/i1` reduces the top to one with all moments i1, which obeys, with `ℓ = L3/i1`, `b = Lz/i1`,
//! `ĉ = c/i1`, `w = ω1 + iω2` and `g = γ1 + iγ2`,
//!
//! ```text
//! w' = −iĉ g,   g' = −iℓ g + iu w,   w g* = (b − ℓu) + i u',   |w|² = 2ĉ(e − u),   |g|² = 1 − u²,
//! u'² = P(u) = 2ĉ (1 − u²)(e − u) − (b − ℓu)² = 2ĉ (u − r1)(u − r2)(u − r3),   −1 <= r1 <= r2 <= 1 <= r3,
//! u = r1 + (r2 − r1) sn²(λt + u0),   4λ² = 2ĉ(r3 − r1),   k² = (r2 − r1)/(r3 − r1),   k'² = (r3 − r2)/(r3 − r1).
//! ```
//!
//! **The rotor.** Its Cayley–Klein parameters `α = cos ½θ e^{i(φ+ψ)/2}` and `β = sin ½θ e^{i(φ−ψ)/2}` (quaternion
//! `w + iz` and `y − ix`; `g = −2 α* β`) have `|α|² = ½(1 + u)` and `|β|² = ½(1 − u)`, elliptic functions with the double
//! pole of u at iK', and so has |w|². At `u = p` with `p = −1`, 1 or e is `u' = ± i(b − ℓp)`: each has one zero on
//! either side of the real axis, and the phases
//!
//! ```text
//! (arg α)' = ½ (b + ℓ)/(1 + u),   (arg β)' = ½ (b − ℓ)/(1 − u),   (arg w)' = −½ℓ − ½ (b − ℓe)/(e − u)
//! ```
//!
//! have the residue ±½ there: **each of α, β, w is a ratio of theta functions times an exponential of time**. With the
//! nome `q = exp(−πK'/K)`, `v = πu/2K`, `y = πη/2K` and s the sign of `b − ℓp`
//!
//! ```text
//! α = A e^{iμt} θ1(v − i s y)/θ4(v),   β = B e^{iμt} θ2(v − i s y)/θ4(v),   w = C e^{iμt} θ2(v + i s y)/θ4(v),
//! ```
//!
//! with own y and μ: `sc²(η, k') = (1 + r1)/(r2 − r1)` for α, `dn²(η, k') = (r2 − r1)/(p − r1)` for the others.
//! The sizes of A, B, C follow from |α|, |β|, |w| at the bounds. Two of the phases follow from the start, the third from
//! `w ∥ g` where `u = r1`: `C = −i s_α sign(b − ℓr1) A* B` there.
//!
//! **The rates** are the mean rates of the phases less the turns of the theta function, `s πλ/2K`. With S, to which
//! `Π(n) − K` is proportional ([`crate::numerics::elliptic`]), and `Π(n) + Π(k²/n) = K + ½π √(…)`, whose last term is
//! those turns,
//!
//! ```text
//! μ(α) = (b + ℓ) S(n) / 4(1 + r3),                         1 − n = (1 + r3)/(r3 − r1),
//! μ(p) = ½ (b − ℓp) (½ S(n) − 1)/(r3 − p),                 1 − n = (r3 − r2)/(r3 − p),
//!      = ½ (b − ℓp) (1 − ½ (r2 − r1)/(p − r1) S(n))/(p − r2) − s πλ/2K,   1 − n = k'² (p − r1)/(p − r2),
//! μ(β) = μ(1),   μ(w) = −½ℓ − μ(e).
//! ```
//!
//! **Near the separatrix**, where the top leaves the vertical slowly, Jacobi's imaginary transformation gives
//! `q' = exp(−πK/K')` and, with `X = πu/2K'` and `γ = πη/2K'` for u within a half period,
//!
//! ```text
//! θ1(v − i s y) ~ −i e^{2isvγ/π} θ1(s γ + iX | q'),   θ2 ~ e^{2isvγ/π} θ4(s γ + iX | q'),   θ4(v) ~ θ2(iX | q').
//! ```
//!
//! On the separatrix itself `α ~ sinh(X − isγ)/cosh X`, and β and w are proportional to 1/cosh X.
//!
//! **Accuracy.** The start is converted to double-double precision. A pair of roots lies on either side of a known
//! number, r1 and r2 of u(0), r2 and r3 of 1: the distances follow from their product and difference without
//! cancellation (`orbit`), so k', r2 − r1 and the distances of all roots from ±1 are accurate. All phases are reduced in
//! double-double precision: the error does not grow with time.
//!
//! Klein & Sommerfeld, *Theorie des Kreisels* (1897–1910), ch. VI; Whittaker, *Analytical Dynamics* §72.

mod description;
mod energies;
mod factors;
pub(super) mod flow;
mod nutations;
mod orbit;
mod roots;
pub(super) mod series;
mod set_up;
mod start;

use super::free::{FreeMotion, MOST_TURNS};
use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::exact::flow::Flow;
use crate::numerics::wide::Wide;
use crate::state::phase::Gyrostat;
pub use description::{LagrangeDescription, LagrangeRegime};
use orbit::Orbit;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
pub(crate) use set_up::LagrangeTops;
pub use start::HeavyTop;
use start::{Axes, Start};

/// The motion of a heavy symmetric top: rotor and angular velocity at any time up to its
/// [`LagrangeTop::horizon`].
#[derive(Clone, Copy, Debug)]
pub struct LagrangeTop {
    axes: Axes,
    start: Start,
    /// None for rotation about the axis without a torque.
    orbit: Option<Orbit>,
    pub(super) flow: Flow,
    horizon: f64,
}

impl LagrangeTop {
    /// The motion that starts at `rotor` (body axes to space) with angular velocity `omega` in body axes, of a body
    /// that is held at the origin of its axes: `inertia` about that point, and `c = m g (centre of mass)` in N m,
    /// gravity along −e3, as for [`crate::laws::torque::Torque::Heavy`].
    pub fn new(
        inertia: &Inertia,
        rotor: Rotor,
        omega: Bivector,
        c: Vector,
    ) -> Result<LagrangeTop, SimulateError> {
        HeavyTop::new(inertia, rotor, omega, c)?.motion()
    }

    /// Estimated angle in rad at time `t` between the body's motion and this one, which neglects rounding differences
    /// between two moments and between the directions of c and the axis.
    pub fn neglected(&self, t: f64) -> f64 {
        let Start { gravity, spin, below, scale, .. } = self.start;
        if self.axes.apart == 0.0 {
            return 0.0;
        }
        // Near the upright a change grows like the tilt, until the top has fallen.
        let (growth, most) = match &self.orbit {
            Some(orbit) => (orbit.lambda.hi, 1.0 / orbit.kc.value()),
            None if below < Wide::ONE => {
                let square = gravity * 0.5.into() - spin * spin * 0.25.into();
                (square.sqrt().value(), f64::INFINITY)
            }
            None => (0.0, 1.0),
        };
        let turned = scale * t.abs();
        2.0 * self.axes.apart * turned * (growth * turned).exp().min(most)
    }

    /// How far in time, in s, the phases are accurate: 1e17 turns.
    pub fn horizon(&self) -> f64 {
        self.horizon
    }

    /// Rotor and body angular velocity at time `t` in s, the same bits as [`LagrangeTop::at_many`].
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

    /// The angular momentum at the start, in the top's axes.
    fn momentum(&self) -> Bivector {
        let [x, y] = self.start.w.map(|w| w.value() * self.start.scale);
        Gyrostat::rigid([self.axes.i1, self.axes.i1, self.axes.i3]).momentum(Bivector([
            x,
            y,
            self.start.omega3,
        ]))
    }
}
