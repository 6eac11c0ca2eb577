//! What the flows of heavy tops are made of, as floats, one top in each lane.
//!
//! Orbits are solved in double-double numbers, within the range of floats or beyond it; the code of all that follows from them
//! is the same for both.

use super::MOST_TURNS;
use super::energies::Energies;
use super::flow::Flow;
use super::orbit::Orbits;
use super::series::{Hyperbolic, Series, Zeros};
use super::start::{HeavyTop, LEAST, Starts};
use crate::exact::free::phases_and_nomes;
use crate::exact::lanes::{Phases, by_component, product, reverse, turned};
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::lanes::{hypotenuse, sin_cos_turns};
use crate::numerics::precise::Precise;
use polhode_ga::rows::curve::Curve;
use std::f64::consts::PI;

/// Orbits and starts, in units of the scales.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nutations<const W: usize> {
    /// From the tops' axes to those of the body, and from these to space.
    pub frames: [[f64; W]; 4],
    pub rotors: [[f64; W]; 4],
    /// At the start, in body axes.
    omegas: [[f64; W]; 3],
    pub scale: [f64; W],
    pub omega3: [f64; W],
    /// α, β and w at the start.
    pub state: [[[f64; W]; 2]; 3],
    /// v, and the phases of α, β and w.
    pub orbit: Phases<W>,
    phases: [Phases<W>; 3],
    /// Infinite on the separatrix.
    pub nome: [f64; W],
    pub lambda: [f64; W],
    /// AGM(1, k') and AGM(1, k).
    pub mean: [f64; W],
    other: [f64; W],
    pub on_separatrix: [bool; W],
    pub zeros: [Zeros<W>; 3],
    /// |α| at the upper bound, |β| and |w| at the lower one.
    pub sizes: [[f64; W]; 3],
    /// `C/(A* B)` of the complex factors of α, β and w.
    pub relations: [[f64; W]; 2],
    pub energies: Energies<W>,
    /// Whether the cubic has the roots of an orbit; without them nothing else is valid.
    pub has_roots: [bool; W],
    /// Whether a top turns about its axis without a torque; then nothing else is valid.
    pub steady: [bool; W],
}

impl<const W: usize> Nutations<W> {
    /// Those of tops, with their starts and orbits.
    #[inline(always)]
    pub fn of<N: Precise<W, FMA>, const FMA: bool>(
        tops: &[HeavyTop; W],
    ) -> (Nutations<W>, Starts<N, W, FMA>, Orbits<N, W, FMA>) {
        let frames = by_component(|l| tops[l].axes.frame.components());
        let rotors = by_component(|l| tops[l].rotor.components());
        let omegas = by_component(|l| tops[l].omega.0);
        let starts = Starts::<N, W, FMA>::new(tops, &frames, &rotors, &omegas);
        let orbits = Orbits::new(&starts);
        let Orbits { lambda, on_separatrix, start, other, zeros, sizes, .. } = orbits;
        let one = DoubleDoubles::all(DoubleDouble::ONE);
        let mean = one.or(&on_separatrix, orbits.mean);
        let (orbit, nome) = phases_and_nomes(&lambda, &mean, &on_separatrix, &start, &other);
        let mut state = [[[0.0; W]; 2]; 3];
        for (parts, z) in state.iter_mut().zip([starts.alpha, starts.beta, starts.w]) {
            *parts = [z[0].values(), z[1].values()];
        }
        // The uniform turn about the axis adds to ψ.
        let excess = starts.excess.narrowed();
        let half = excess.half();
        let [alpha, beta, across] = orbits.rates;
        let mut phases = [Phases::STILL; 3];
        for (phase, rate) in phases.iter_mut().zip([alpha + half, beta - half, across - excess]) {
            let rate = rate * DoubleDoubles::all(DoubleDouble::OVER_TWO_PI);
            (phase.0[0], phase.0[1]) = (rate.hi, rate.lo);
        }
        let nutations = Nutations {
            frames,
            rotors,
            omegas,
            scale: starts.scale,
            omega3: starts.omega3,
            state,
            orbit,
            phases,
            nome,
            lambda: lambda.hi,
            mean: orbits.mean.hi,
            other,
            on_separatrix,
            zeros,
            sizes,
            relations: relations(&orbits),
            energies: Energies::new(&starts, &sizes),
            has_roots: orbits.resolved,
            steady: starts.steady,
        };
        (nutations, starts, orbits)
    }

    /// Arbitrary in the lanes of circular motions.
    #[inline(always)]
    pub fn set_hyperbolic<const FMA: bool>(&self, series: &mut Hyperbolic<W>) {
        let Nutations { mean, other, zeros, on_separatrix, .. } = self;
        let (mut border, mut gammas) = ([0.0; W], [[0.0; W]; 3]);
        for l in 0..W {
            border[l] = 0.5 * PI * other[l] / mean[l];
            for k in 0..3 {
                gammas[k][l] = zeros[k].eta[l] * other[l];
            }
        }
        let sides = [&zeros[0].side, &zeros[1].side, &zeros[2].side];
        series.set::<FMA>(&border, sides, &gammas, on_separatrix);
    }

    /// Completes a flow with the given series by phases, frames and factors.
    #[inline(always)]
    pub fn complete<S: Series<W>, const FMA: bool>(&self, flow: &mut Flow<S, W>) {
        let Nutations { frames, scale, omega3, .. } = self;
        let (none, one, minus) = ([0.0; W], [1.0; W], [-1.0; W]);
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
        for (k, size) in [scale, scale, omega3].into_iter().enumerate() {
            let mut axis = [none; 3];
            axis[k] = *size;
            let column = turned(frames, &axis);
            for i in 0..3 {
                flow.omega[i][k] = column[i];
            }
        }
        (flow.scale, flow.orbit, flow.phases) = (*scale, self.orbit, self.phases);
        flow.factors = self.factors::<S, FMA>(flow);
    }

    /// The times of 1e17 turns of the fastest phases.
    #[inline(always)]
    pub fn horizons(&self) -> [f64; W] {
        let mut horizons = [0.0; W];
        for l in 0..W {
            let mut fastest = self.lambda[l] / PI;
            for phase in &self.phases {
                fastest = fastest.max(phase.0[0][l].abs());
            }
            horizons[l] = MOST_TURNS / (fastest * self.scale[l]);
        }
        horizons
    }

    /// Whether each flow reproduces the start, and keeps the energy.
    #[inline(always)]
    pub fn resolved<S: Series<W>, const FMA: bool>(&self, flow: &Flow<S, W>) -> [bool; W] {
        let mut resolved = self.starts_at::<S, FMA>(flow);
        let (mut quarters, to_axes) = ([0.0; W], reverse(&self.frames));
        for l in 0..W {
            let quarter = if self.on_separatrix[l] { 1.0 } else { 0.5 * PI / self.mean[l] };
            quarters[l] = quarter / self.lambda[l] / self.scale[l];
        }
        for part in [0.3, 1.0, 2.2] {
            let mut times = [0.0; W];
            for l in 0..W {
                times[l] = part * quarters[l];
            }
            let (rotors, omegas) = flow.values::<W, FMA>(&times);
            let (rotors, omegas) = (product(&rotors, &self.frames), turned(&to_axes, &omegas));
            let kept = self.energies.are_kept::<FMA>(&rotors, &omegas, &self.scale);
            for l in 0..W {
                resolved[l] &= kept[l];
            }
        }
        resolved
    }

    /// Whether the solution reproduces the start. The rate across the axis is compared with its own largest size.
    #[inline(always)]
    fn starts_at<S: Series<W>, const FMA: bool>(&self, flow: &Flow<S, W>) -> [bool; W] {
        /// The roundings of a start add up to less.
        const MOST: f64 = 1e-12;
        let (rotors, omegas) = flow.values::<W, FMA>(&[0.0; W]);
        let mut right = [true; W];
        for l in 0..W {
            for k in 0..4 {
                right[l] &= (rotors[k][l] - self.rotors[k][l]).abs() <= MOST;
            }
            let across = self.sizes[2][l] * self.scale[l];
            let spin = 64.0 * f64::EPSILON * self.omega3[l].abs();
            let most = MOST * across + spin + LEAST * self.scale[l];
            let mut change = [0.0; 3];
            for k in 0..3 {
                change[k] = omegas[k][l] - self.omegas[k][l];
            }
            let [x, y, z] = change;
            right[l] &= hypotenuse(hypotenuse(x, y), z) <= most;
        }
        right
    }
}

/// `C/(A* B)` at the start: −iκ, turned by the phase `μ_β − μ_α − μ_w` since v = 0, an odd number of turns of the theta
/// functions in each period.
#[inline(always)]
fn relations<N: Precise<W, FMA>, const W: usize, const FMA: bool>(
    orbits: &Orbits<N, W, FMA>,
) -> [[f64; W]; 2] {
    let Orbits { lambda, mean, on_separatrix, start, kappa, rates, .. } = orbits;
    let [alpha, beta, across] = *rates;
    let turns = (across - beta + alpha) / (*lambda * *mean);
    let mut relations = [[0.0; W]; 2];
    for l in 0..W {
        let odd = 2.0 * (0.5 * (turns.hi[l] + turns.lo[l] - 1.0)).round() + 1.0;
        // v/2π at the start.
        let part = 0.25 * start[0][l] + start[1][l] * mean.hi[l] / (2.0 * PI);
        let (sin, cos) = sin_cos_turns::<FMA>(odd * part - (odd * part).round(), 0.0);
        let (sin, cos) = if on_separatrix[l] { (0.0, 1.0) } else { (sin, cos) };
        (relations[0][l], relations[1][l]) = (kappa[l] * sin, -kappa[l] * cos);
    }
    relations
}
