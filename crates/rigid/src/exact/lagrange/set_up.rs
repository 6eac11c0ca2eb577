//! From heavy tops to their motions: orbits, series and frames, one top in each lane.

use super::flow::Flow as LagrangeFlow;
use super::orbit::Orbits;
use super::series::{Circular, Hyperbolic, Series};
use super::start::{HeavyTop, Starts, square};
use super::{FreeMotion, LagrangeTop, MOST_TURNS};
use crate::error::SimulateError;
use crate::exact::flow::{Flow, Form, either};
use crate::exact::free::series::LARGEST_NOME;
use crate::exact::free::{are_within, phases_and_nomes};
use crate::exact::lanes::{Coefficients, Phases, by_component, product, reverse, turned};
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::elliptic::mean;
use crate::numerics::lanes::hypotenuse;
use crate::numerics::precise::Precise;
use crate::numerics::wide::Wides;
use polhode_ga::Bivector;
use polhode_ga::rows::curve::{Curve, TOGETHER};
use polhode_ga::simd::lanes::{Work, fastest};
use std::f64::consts::PI;

/// The series cannot represent tilts and rates below this.
const LEAST: f64 = 1e-303;

impl HeavyTop {
    /// Its motion.
    ///
    /// # Errors
    /// [`SimulateError::Unresolved`] if the roots are not.
    pub fn motion(&self) -> Result<LagrangeTop, SimulateError> {
        let mut tops = LagrangeTops::<1>::default();
        // One lane needs no wide instructions.
        let (starts, orbits) = tops.filled::<Wides<1, false>, false>(&[*self]);
        let (axes, start) = (self.axes, starts.lane(0));
        if tops.steady[0] {
            let moments = [axes.i1, axes.i1, axes.i3];
            let along = Bivector([0.0, 0.0, start.omega3]);
            let motion = FreeMotion::in_frame(axes.frame, moments, self.rotor * axes.frame, along);
            let (flow, horizon) = (motion.flow, motion.horizon());
            return Ok(LagrangeTop { axes, start, orbit: None, flow, horizon });
        }
        if !tops.resolved[0] {
            return Err(SimulateError::Unresolved);
        }
        let flow = Flow(if tops.is_circular[0] {
            Form::LagrangeCircular(tops.circular)
        } else {
            Form::LagrangeHyperbolic(tops.hyperbolic)
        });
        Ok(LagrangeTop { axes, start, orbit: Some(orbits.lane(0)), flow, horizon: tops.horizons[0] })
    }
}

/// The motions of `W` heavy tops, one in each lane.
#[derive(Clone, Debug)]
pub(crate) struct LagrangeTops<const W: usize> {
    /// Valid where [`LagrangeTops::is_circular`].
    pub circular: LagrangeFlow<Circular<W>, W>,
    /// Valid elsewhere.
    pub hyperbolic: LagrangeFlow<Hyperbolic<W>, W>,
    pub is_circular: [bool; W],
    /// Tops without a torque, whose motions are of free bodies.
    pub steady: [bool; W],
    /// Whether the motion of a top that is not steady is resolved.
    pub resolved: [bool; W],
    /// [`LagrangeTop::horizon`] of each; arbitrary for steady tops.
    pub horizons: [f64; W],
}

impl<const W: usize> Default for LagrangeTops<W> {
    fn default() -> LagrangeTops<W> {
        LagrangeTops {
            circular: LagrangeFlow::empty(),
            hyperbolic: LagrangeFlow::empty(),
            is_circular: [true; W],
            steady: [false; W],
            resolved: [true; W],
            horizons: [0.0; W],
        }
    }
}

impl<const W: usize> LagrangeTops<W> {
    #[inline(always)]
    fn filled<N: Precise<W, FMA>, const FMA: bool>(
        &mut self,
        tops: &[HeavyTop; W],
    ) -> (Starts<N, W, FMA>, Orbits<N, W, FMA>) {
        let frames = by_component(|l| tops[l].axes.frame.components());
        let rotors = by_component(|l| tops[l].rotor.components());
        let omegas = by_component(|l| tops[l].omega.0);
        let starts = Starts::<N, W, FMA>::new(tops, &frames, &rotors, &omegas);
        let orbits = Orbits::new(&starts);
        let mut root = [0.0; W];
        for l in 0..W {
            root[l] = orbits.k2[l].sqrt();
        }
        // AGM(1, k) = π/2K'.
        let other = mean(root);
        let Orbits { lambda, on_separatrix, start, .. } = &orbits;
        let one = DoubleDoubles::all(DoubleDouble::ONE);
        let mean = one.or(on_separatrix, orbits.mean);
        let (phases, nome) = phases_and_nomes(lambda, &mean, on_separatrix, start, &other);
        for l in 0..W {
            self.is_circular[l] = nome[l] <= LARGEST_NOME;
        }
        self.steady = starts.steady;
        let nutating = Nutating { starts: &starts, orbits: &orbits, frames, rotors, omegas, phases };
        self.circular.series.set(&nome, &orbits.mean.hi, &orbits.zeros);
        nutating.fill(&mut self.circular);
        self.horizons = nutating.horizons(&self.circular);
        self.resolved = nutating.resolved(&self.circular);
        if self.is_circular != [true; W] {
            nutating.hyperbolic(&mut self.hyperbolic.series, &other);
            nutating.fill(&mut self.hyperbolic);
            let resolved = nutating.resolved(&self.hyperbolic);
            for l in 0..W {
                self.resolved[l] = if self.is_circular[l] { self.resolved[l] } else { resolved[l] };
            }
        }
        for l in 0..W {
            self.resolved[l] &= orbits.resolved[l];
        }
        (starts, orbits)
    }
}

impl LagrangeTops<TOGETHER> {
    /// Replaces the motions by those of other tops. Each has the bits that it has alone.
    pub fn set_up(&mut self, tops: &[HeavyTop; TOGETHER]) {
        if are_moderate(tops) {
            fastest(SetUp::<false> { tops, motions: self });
        } else {
            fastest(SetUp::<true> { tops, motions: self });
        }
    }

    fn put(&mut self, l: usize, motion: Result<LagrangeTop, SimulateError>) {
        self.resolved[l] = motion.is_ok();
        let Ok(motion) = motion else { return };
        self.steady[l] = motion.orbit.is_none();
        self.horizons[l] = motion.horizon;
        match &motion.flow.0 {
            Form::LagrangeCircular(flow) => self.circular.put(l, flow),
            Form::LagrangeHyperbolic(flow) => self.hyperbolic.put(l, flow),
            // Steady tops have the motions of free bodies.
            _ => {}
        }
        self.is_circular[l] = !matches!(motion.flow.0, Form::LagrangeHyperbolic(_));
    }

    /// Whether the motion of a top is that of its lane.
    pub fn has(&self, l: usize) -> bool {
        self.resolved[l] & !self.steady[l]
    }

    /// [`crate::exact::free::FreeMotions::at`].
    pub fn at(
        &self,
        times: &[f64; TOGETHER],
        rotors: &mut [[f64; 4]; TOGETHER],
        omegas: &mut [[f64; 3]; TOGETHER],
    ) {
        either((&self.circular, &self.hyperbolic), &self.is_circular, times, rotors, omegas);
    }
}

/// With numbers beyond the range of floats where they are `WIDE`.
struct SetUp<'a, const WIDE: bool> {
    tops: &'a [HeavyTop; TOGETHER],
    motions: &'a mut LagrangeTops<TOGETHER>,
}

impl<const WIDE: bool> Work for SetUp<'_, WIDE> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        if WIDE {
            self.motions.filled::<Wides<TOGETHER, FMA>, FMA>(self.tops);
        } else {
            self.motions.filled::<DoubleDoubles<TOGETHER, FMA>, FMA>(self.tops);
        }
    }

    fn run_portably(self) {
        for (l, top) in self.tops.iter().enumerate() {
            self.motions.put(l, top.motion());
        }
    }
}

/// Whether all invariants of the orbits, with their low parts, are in the range of floats.
fn are_moderate(tops: &[HeavyTop; TOGETHER]) -> bool {
    // Invariants are products of up to four squares of tilts, rates in units of the largest, and cancelled differences of them.
    let mut moderate = true;
    for HeavyTop { axes, rotor, omega, scale } in tops {
        let gravity = axes.c / axes.i1 / scale / scale;
        moderate &= are_within(&[axes.i1, axes.i3, axes.c], 1e-100, 1e100) & (axes.i3 >= 1e-6 * axes.i1);
        moderate &= are_within(&[gravity], 1e-15, 4.0) & are_within(&omega.0, 1e-15 * scale, 4.0 * scale);
        moderate &= are_within(&rotor.components(), 1e-15, 4.0);
        moderate &= are_within(&axes.frame.components(), 1e-15, 4.0);
    }
    moderate
}

/// Tops with their orbits, in lanes.
pub(super) struct Nutating<'a, N, const W: usize, const FMA: bool> {
    pub starts: &'a Starts<N, W, FMA>,
    pub orbits: &'a Orbits<N, W, FMA>,
    /// From the tops' axes to those of the body, and from these to space.
    frames: [[f64; W]; 4],
    rotors: [[f64; W]; 4],
    /// At the start, in body axes.
    omegas: [[f64; W]; 3],
    phases: Phases<W>,
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Nutating<'_, N, W, FMA> {
    /// Arbitrary in the lanes of circular motions.
    #[inline(always)]
    fn hyperbolic(&self, series: &mut Hyperbolic<W>, other: &[f64; W]) {
        let Orbits { mean, zeros, on_separatrix, .. } = self.orbits;
        let (mut border, mut gammas) = ([0.0; W], [[0.0; W]; 3]);
        for l in 0..W {
            border[l] = 0.5 * PI * other[l] / mean.hi[l];
            for k in 0..3 {
                gammas[k][l] = zeros[k].eta[l] * other[l];
            }
        }
        let sides = [&zeros[0].side, &zeros[1].side, &zeros[2].side];
        series.set::<FMA>(&border, sides, &gammas, on_separatrix);
    }

    /// Completes flows with the given series by phases and frames.
    #[inline(always)]
    fn fill<S: Series<W>>(&self, flow: &mut LagrangeFlow<S, W>) {
        let Nutating { starts, orbits, frames, phases, .. } = self;
        let (none, one, minus) = ([0.0; W], [1.0; W], [-1.0; W]);
        // The uniform turn about the axis adds to ψ.
        let excess = starts.excess.narrowed();
        let half = excess * DoubleDoubles::all(0.5.into());
        let [alpha, beta, across] = orbits.rates;
        for (phase, rate) in flow.phases.iter_mut().zip([alpha + half, beta - half, across - excess]) {
            let rate = rate * DoubleDoubles::all(DoubleDouble::OVER_TWO_PI);
            *phase = Phases([rate.hi, rate.lo, none, none]);
        }
        // Rotors for the real and imaginary parts of α and β, and axes for w and 1.
        let back = reverse(frames);
        let units = [
            [one, none, none, none],
            [none, none, none, minus],
            [none, none, minus, none],
            [none, one, none, none],
        ];
        for k in 0..4 {
            let column = product(&units[k], &back);
            for i in 0..4 {
                flow.rotor[i][k] = column[i];
            }
        }
        for (k, size) in [starts.scale, starts.scale, starts.omega3].into_iter().enumerate() {
            let mut axis = [none; 3];
            axis[k] = size;
            let column = turned(frames, &axis);
            for i in 0..3 {
                flow.omega[i][k] = column[i];
            }
        }
        (flow.scale, flow.orbit) = (starts.scale, *phases);
        flow.factors = self.factors(flow);
    }

    /// The times of 1e17 turns of the fastest phases.
    #[inline(always)]
    fn horizons<S>(&self, flow: &LagrangeFlow<S, W>) -> [f64; W] {
        let mut horizons = [0.0; W];
        for l in 0..W {
            let mut fastest = self.orbits.lambda.hi[l] / PI;
            for phase in &flow.phases {
                fastest = fastest.max(phase.0[0][l].abs());
            }
            horizons[l] = MOST_TURNS / (fastest * self.starts.scale[l]);
        }
        horizons
    }

    /// Whether each solution reproduces the start, and keeps the energy.
    #[inline(always)]
    fn resolved<S: Series<W>>(&self, flow: &LagrangeFlow<S, W>) -> [bool; W] {
        let mut resolved = self.starts_at(flow);
        for part in [0.3, 1.0, 2.2] {
            let kept = self.keeps_energy(flow, part);
            for l in 0..W {
                resolved[l] &= kept[l];
            }
        }
        resolved
    }

    /// Whether the solution reproduces the start. The rate across the axis is compared with its own largest size.
    #[inline(always)]
    fn starts_at<S: Series<W>>(&self, flow: &LagrangeFlow<S, W>) -> [bool; W] {
        /// The roundings of a start add up to less.
        const MOST: f64 = 1e-12;
        let (starts, mut right) = (self.starts, [true; W]);
        let (rotors, omegas) = flow.values::<W, FMA>(&[0.0; W]);
        for l in 0..W {
            for k in 0..4 {
                right[l] &= (rotors[k][l] - self.rotors[k][l]).abs() <= MOST;
            }
            let across = self.orbits.sizes[2][l] * starts.scale[l];
            let spin = 64.0 * f64::EPSILON * starts.omega3[l].abs();
            let most = MOST * across + spin + LEAST * starts.scale[l];
            let mut change = [0.0; 3];
            for k in 0..3 {
                change[k] = omegas[k][l] - self.omegas[k][l];
            }
            let [x, y, z] = change;
            right[l] &= hypotenuse(hypotenuse(x, y), z) <= most;
        }
        right
    }

    /// Whether `|w|² + 2ĉu` is that of the start after a part of a quarter of a nutation, compared with the largest |w|².
    #[inline(always)]
    fn keeps_energy<S: Series<W>>(&self, flow: &LagrangeFlow<S, W>, part: f64) -> [bool; W] {
        /// The rounding of a tilt of 1e-300 is 1e-13 of it.
        const MOST: f64 = 1e-10;
        let (starts, orbits) = (self.starts, self.orbits);
        let (mut times, mut rounding) = ([0.0; W], [0.0; W]);
        for l in 0..W {
            let quarter = if orbits.on_separatrix[l] { 1.0 } else { 0.5 * PI / orbits.mean.hi[l] };
            times[l] = part * (quarter / orbits.lambda.hi[l] / starts.scale[l]);
            // That of the rate about the axis, in body axes.
            rounding[l] = starts.omega3[l].abs() / starts.scale[l] * f64::EPSILON * 8.0 + LEAST;
        }
        let (rotors, omegas) = flow.values::<W, FMA>(&times);
        let [x, y, _] = turned(&reverse(&self.frames), &omegas);
        let (x, y) = (N::from(x).in_units(&starts.scale), N::from(y).in_units(&starts.scale));
        let [a, b, c, d] = product(&rotors, &self.frames);
        let [a, b, c, d] = [N::from(a), N::from(b), N::from(c), N::from(d)];
        // u relative to that of the start, from the nearer pole.
        let (two, upper) = (N::all(2.0), N::all(1.0).exceeds(starts.below));
        let rise = (starts.below - (b * b + c * c) * two).or(&upper, (a * a + d * d) * two - starts.above);
        let change = x * x + y * y - square(starts.w) + starts.gravity * rise;
        let (largest, spin) = (N::from(orbits.sizes[2]), N::from(rounding));
        change.abs().at_most((largest * largest) * N::all(MOST) + (largest + spin) * spin)
    }
}
