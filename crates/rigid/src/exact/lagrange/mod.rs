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
pub(super) mod flow;
mod orbit;
pub(super) mod series;
mod start;

use super::free::series::LARGEST_NOME;
use super::free::{FreeMotion, MOST_TURNS, phases_and_nomes};
use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::exact::flow::{Flow, Form};
use crate::exact::lanes::Phases;
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::elliptic::mean;
use crate::numerics::lanes::Phase;
use crate::numerics::wide::Wide;
use crate::state::phase::Gyrostat;
pub use description::{LagrangeDescription, LagrangeRegime};
use flow::Flow as LagrangeFlow;
use orbit::Orbit;
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use series::{Circular, Hyperbolic, Series};
use start::{Axes, Start};
use std::f64::consts::PI;

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

/// The series cannot represent tilts and rates below this.
const LEAST: f64 = 1e-303;

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
        let axes = Axes::new(inertia, c)?;
        let start = Start::new(&axes, rotor, omega)?;
        if start.is_steady() {
            let moments = [axes.i1, axes.i1, axes.i3];
            let along = Bivector([0.0, 0.0, start.omega3]);
            let motion = FreeMotion::in_frame(axes.frame, moments, rotor * axes.frame, along);
            let (flow, horizon) = (motion.flow, motion.horizon());
            return Ok(LagrangeTop { axes, start, orbit: None, flow, horizon });
        }
        let orbit = Orbit::new(&start).ok_or(SimulateError::Unresolved)?;
        let (flow, horizon) = flow_and_horizon(&axes, &start, &orbit);
        let top = LagrangeTop { axes, start, orbit: Some(orbit), flow, horizon };
        if top.starts_at(rotor, omega, &orbit) && top.keeps_energy(&orbit) {
            Ok(top)
        } else {
            Err(SimulateError::Unresolved)
        }
    }

    /// Whether the solution reproduces the start. The rate across the axis is compared with its own largest size.
    fn starts_at(&self, rotor: Rotor, omega: Bivector, orbit: &Orbit) -> bool {
        /// The roundings of a start add up to less.
        const MOST: f64 = 1e-12;
        let (found, rate) = self.at(0.0);
        let turned = (0..4).all(|k| (found.components()[k] - rotor.components()[k]).abs() <= MOST);
        let across = orbit.sizes[2] * self.start.scale;
        let spin = 64.0 * f64::EPSILON * self.start.omega3.abs();
        turned && (rate - omega).norm() <= MOST * across + spin + LEAST * self.start.scale
    }

    /// Whether `|w|² + 2ĉu` is that of the start at some times of a nutation, compared with the largest |w|².
    fn keeps_energy(&self, orbit: &Orbit) -> bool {
        /// The rounding of a tilt of 1e-300 is 1e-13 of it.
        const MOST: f64 = 1e-10;
        let Start { gravity, below, above, w, scale, .. } = self.start;
        let largest = Wide::from(orbit.sizes[2]);
        let quarter = orbit.mean.map_or(1.0, |mean| 0.5 * PI / mean.hi) / orbit.lambda.hi / scale;
        [0.3, 1.0, 2.2].iter().all(|part| {
            let (rotor, omega) = self.at(part * quarter);
            let [x, y, _] = self.axes.frame.reverse().apply_bivector(omega).0.map(|x| Wide::from(x / scale));
            let [a, b, c, d] = (rotor * self.axes.frame).components().map(Wide::from);
            // u relative to that of the start, from the nearer pole.
            let two = Wide::from(2.0);
            let rise =
                if below < Wide::ONE { below - (b * b + c * c) * two } else { (a * a + d * d) * two - above };
            let change = x * x + y * y - start::square(w) + gravity * rise;
            // The rounding of the rate about the axis, in body axes.
            let spin = Wide::from(self.start.omega3.abs() / scale * f64::EPSILON * 8.0 + LEAST);
            change.abs() <= (largest * largest) * MOST.into() + (largest + spin) * spin
        })
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

/// The states by the rapidly converging series, and how far in time, in s, their phases are accurate.
fn flow_and_horizon(axes: &Axes, start: &Start, orbit: &Orbit) -> (Flow, f64) {
    // AGM(1, k) = π/2K'.
    let [other] = mean([orbit.k2.sqrt()]);
    let [lambda, mean] = [orbit.lambda, orbit.mean.unwrap_or(DoubleDouble::ONE)].map(Alone::all);
    let start_of_u = [[orbit.start.0], [orbit.start.1]];
    let (phase, [nome]) = phases_and_nomes(&lambda, &mean, &[orbit.mean.is_none()], &start_of_u, &[other]);
    match orbit.mean {
        Some(mean) if nome <= LARGEST_NOME => {
            let series = Circular::new(nome, mean.hi, orbit.zeros);
            let flow = flow(axes, start, orbit, phase, series);
            (Flow(Form::LagrangeCircular(flow)), horizon(start, orbit, &flow))
        }
        mean => {
            let gammas = orbit.zeros.map(|zero| (zero.side, zero.eta * other));
            let series = match mean {
                Some(mean) => Hyperbolic::new(0.5 * PI * other / mean.hi, gammas),
                None => Hyperbolic::separatrix(gammas[0].1, gammas[0].0),
            };
            let flow = flow(axes, start, orbit, phase, series);
            (Flow(Form::LagrangeHyperbolic(flow)), horizon(start, orbit, &flow))
        }
    }
}

/// A number in a lane of its own.
type Alone = DoubleDoubles<1, false>;

/// The time of 1e17 turns of the fastest phase.
fn horizon<S>(start: &Start, orbit: &Orbit, flow: &LagrangeFlow<S>) -> f64 {
    let rates = flow.phases.iter().map(|phase| phase.of(0).rate.hi.abs());
    MOST_TURNS / (rates.fold(orbit.lambda.hi / PI, f64::max) * start.scale)
}

/// Phases, series and frames together.
fn flow<S: Series<1>>(
    axes: &Axes,
    start: &Start,
    orbit: &Orbit,
    phase: Phases<1>,
    series: S,
) -> LagrangeFlow<S> {
    // The uniform turn about the axis adds to ψ.
    let excess = start.excess.narrow();
    let half = excess * 0.5.into();
    let [alpha, beta, across] = orbit.rates;
    let uniform = |rate: DoubleDouble| Phase { rate: rate * DoubleDouble::OVER_TWO_PI, start: [0.0; 2] };
    let phases = [alpha + half, beta - half, across - excess].map(uniform);
    let back = axes.frame.reverse();
    let unit = |c: [f64; 4]| (Rotor::from_unit_components(c) * back).components();
    let columns =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0]].map(unit);
    let axis = |k: usize, size: f64| {
        let mut e = [0.0; 3];
        e[k] = size;
        axes.frame.apply_bivector(Bivector(e)).0
    };
    let rates = [axis(0, start.scale), axis(1, start.scale), axis(2, start.omega3)];
    let mut flow = LagrangeFlow {
        scale: [start.scale],
        orbit: phase,
        phases: phases.map(Phases::from),
        series,
        factors: [[[1.0], [0.0]]; 3],
        rotor: std::array::from_fn(|i| columns.map(|c| [c[i]])),
        omega: std::array::from_fn(|i| rates.map(|c| [c[i]])),
    };
    flow.factors = factors(start, orbit, &flow).map(|factor| factor.map(|x| [x]));
    flow
}

/// The product of complex numbers.
fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// The constants A, B and C: their sizes from the bounds, their phases from the two of α, β and w that are relatively
/// largest at the start.
fn factors<S: Series<1>>(start: &Start, orbit: &Orbit, flow: &LagrangeFlow<S>) -> [[f64; 2]; 3] {
    let at = |turns: f64, k: usize| {
        let state = flow.series.state::<1, false>(&[turns], &[0.0]);
        let [re, im] = state.z[k].map(|z| z[0]);
        (re.hypot(im), state.denominator[0])
    };
    let bounds = [at(0.25, 0), at(0.0, 1), at(0.0, 2)];
    let now = flow.turned::<1, false>(&[0.0]);
    let state = [start.alpha, start.beta, start.w].map(|z| z.map(|x| x.value()));
    let mut unit: [[f64; 2]; 3] = std::array::from_fn(|k| {
        let [re, im] = now.z[k].map(|z| z[0]);
        normalized(times(state[k], normalized([re, -im])))
    });
    let part = |k: usize| state[k][0].hypot(state[k][1]) / orbit.sizes[k];
    let smallest = (0..3).min_by(|&j, &k| part(j).total_cmp(&part(k))).unwrap_or(2);
    // C = −iκ A* B at v = 0.
    let conjugate = |[x, y]: [f64; 2]| [x, -y];
    let relation = times([0.0, -orbit.kappa], turn_since_bound(orbit));
    match smallest {
        0 => unit[0] = conjugate(times(times(unit[2], conjugate(unit[1])), conjugate(relation))),
        1 => unit[1] = times(times(unit[2], unit[0]), conjugate(relation)),
        _ => unit[2] = times(times(conjugate(unit[0]), unit[1]), relation),
    }
    std::array::from_fn(|k| {
        let (size, denominator) = bounds[k];
        unit[k].map(|x| x * (orbit.sizes[k] * denominator / size))
    })
}

/// The phase by `μ_β − μ_α − μ_w` since v = 0: an odd number of turns of the theta functions in each period.
fn turn_since_bound(orbit: &Orbit) -> [f64; 2] {
    let Some(mean) = orbit.mean else { return [1.0, 0.0] };
    let [alpha, beta, across] = orbit.rates;
    let turns = ((across - beta + alpha) / (orbit.lambda * mean)).value();
    let odd = 2.0 * (0.5 * (turns - 1.0)).round() + 1.0;
    // v/π at the start.
    let (whole, rest) = orbit.start;
    let part = 0.5 * whole + rest * mean.hi / PI;
    let (sin, cos) = (PI * odd * part).sin_cos();
    [cos, sin]
}

fn normalized([x, y]: [f64; 2]) -> [f64; 2] {
    let size = x.hypot(y);
    if size > 0.0 { [x / size, y / size] } else { [1.0, 0.0] }
}
