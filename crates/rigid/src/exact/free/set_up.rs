//! From bodies to their motions: orbits, series and frames, one body in each lane.

use super::flow::Flow;
use super::orbit::{Orbits, is_steady};
use super::series::{Circular, Hyperbolic, LARGEST_NOME, NEVER, Series};
use super::{FreeMotion, horizon, power_of_two};
use crate::body::inertia::Inertia;
use crate::error::SimulateError;
use crate::exact::flow::{self, Form, either};
use crate::exact::lanes::{
    Coefficients, LEAST_RATE, Phases, SetUp, are_within, by_component, product, reverse, turned,
};
use crate::numerics::double_double::{DoubleDouble, DoubleDoubles};
use crate::numerics::elliptic::mean;
use crate::numerics::lanes::{Phase, decay};
use crate::numerics::precise::Precise;
use crate::numerics::wide::Wides;
use crate::state::checks::check_moments;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::lanes::{Work, with_wide_instructions};
use polhode_ga::{Bivector, Rotor};
use std::f64::consts::PI;

/// A free body at time 0, in principal axes.
#[derive(Clone, Copy, Debug)]
pub struct FreeBody {
    pub(in crate::exact) moments: [f64; 3],
    /// From principal axes to those of the body.
    pub(super) frame: Rotor,
    /// From principal axes to space.
    pub(super) rotor: Rotor,
    pub(in crate::exact) omega: Bivector,
}

impl FreeBody {
    /// At `rotor` (body axes to space) with angular velocity `omega` in body axes. An error if a principal moment is
    /// zero.
    pub fn new(inertia: &Inertia, rotor: Rotor, omega: Bivector) -> Result<FreeBody, SimulateError> {
        let (frame, moments) = (inertia.principal_frame(), inertia.principal_moments());
        check_moments(moments)?;
        Ok(FreeBody { moments, frame, rotor: rotor * frame, omega: frame.reverse().apply_bivector(omega) })
    }

    /// From principal axes to space, and with the frame from principal axes to those of the body; positive moments.
    pub(crate) fn in_frame(frame: Rotor, moments: [f64; 3], rotor: Rotor, omega: Bivector) -> FreeBody {
        FreeBody { moments, frame, rotor, omega }
    }

    /// Its motion.
    pub fn motion(&self) -> FreeMotion {
        let FreeBody { moments, frame, omega, .. } = *self;
        let mut alone = FreeMotions::<1>::default();
        // One lane needs no wide instructions.
        let ([steady], orbits) = alone.filled::<Wides<1, false>, false>(&[*self]);
        let (scale, flow) = if alone.is_circular[0] {
            (alone.circular.scale[0], Form::FreeCircular(alone.circular))
        } else {
            (alone.hyperbolic.scale[0], Form::FreeHyperbolic(alone.hyperbolic))
        };
        let (orbit, horizon) = ((!steady).then(|| orbits.lane(0)), alone.horizons[0]);
        FreeMotion { moments, frame, omega, scale, orbit, flow: flow::Flow(flow), horizon }
    }
}

/// The motions of `W` free bodies, one in each lane.
#[derive(Clone, Debug)]
pub(crate) struct FreeMotions<const W: usize> {
    /// Valid where [`FreeMotions::is_circular`].
    pub circular: Flow<Circular<W>, W>,
    /// Valid elsewhere.
    pub hyperbolic: Flow<Hyperbolic<W>, W>,
    pub is_circular: [bool; W],
    /// [`FreeMotion::horizon`] of each.
    pub horizons: [f64; W],
}

impl<const W: usize> Default for FreeMotions<W> {
    fn default() -> FreeMotions<W> {
        FreeMotions {
            circular: Flow::empty(),
            hyperbolic: Flow::empty(),
            is_circular: [true; W],
            horizons: [0.0; W],
        }
    }
}

impl<const W: usize> FreeMotions<W> {
    /// The lanes of the first `count` motions: the circular and the hyperbolic ones.
    pub fn lanes(&self, count: usize) -> [Vec<usize>; 2] {
        let (circular, hyperbolic) = (0..count).partition(|&l| self.is_circular[l]);
        [circular, hyperbolic]
    }

    /// Replaces the motions by those of other bodies; returns whether each turns steadily, and the orbits of the others.
    #[inline(always)]
    fn filled<N: Precise<W, FMA>, const FMA: bool>(
        &mut self,
        bodies: &[FreeBody; W],
    ) -> ([bool; W], Orbits<N, W, FMA>) {
        let (mut moments, mut rates) = ([[0.0; 3]; W], [[0.0; 3]; W]);
        let (mut size, mut scale, mut steady) = ([0.0; W], [0.0; W], [false; W]);
        for l in 0..W {
            let FreeBody { moments: i, omega: Bivector(w), .. } = bodies[l];
            steady[l] = is_steady(i, w);
            // The orbit of any motion, which is not used.
            (moments[l], rates[l]) = if steady[l] { ([1.0, 2.0, 3.0], [1.0; 3]) } else { (i, w) };
            (size[l], scale[l]) = (power_of_two(moments[l]), power_of_two(rates[l]));
        }
        let orbits = Orbits::<N, W, FMA>::new(&moments, &rates, [&size, &scale]);
        let mut root = [0.0; W];
        for l in 0..W {
            root[l] = orbits.k2[l].sqrt();
        }
        // AGM(1, k) = π/2K'.
        let other = mean(root);
        let Orbits { lambda, mean, on_separatrix, start, .. } = &orbits;
        let (phases, nome) = phases_and_nomes(lambda, mean, on_separatrix, start, &other);
        for l in 0..W {
            self.is_circular[l] = nome[l] <= LARGEST_NOME;
            let fastest = orbits.lambda.hi[l].max(orbits.precession.hi[l].abs());
            self.horizons[l] = horizon(fastest * scale[l]);
        }
        let tumbling = Tumbling { bodies, orbits: &orbits, scale, phases };
        tumbling.circular(&mut self.circular.series, &nome);
        tumbling.fill(&mut self.circular);
        if self.is_circular != [true; W] {
            tumbling.hyperbolic(&mut self.hyperbolic.series, &other);
            tumbling.fill(&mut self.hyperbolic);
        }
        for l in 0..W {
            if steady[l] {
                self.circular.put(l, &bodies[l].steady());
                self.horizons[l] = horizon(bodies[l].omega.norm());
            }
        }
        (steady, orbits)
    }
}

impl SetUp for FreeMotions<TOGETHER> {
    type Body = FreeBody;

    fn is_moderate(FreeBody { moments, omega, .. }: &FreeBody) -> bool {
        // Invariants are products of at most four moments, three differences of moments, each 0 or at least 2⁻⁵² of the
        // moments, and six rates, in units of the largest.
        let (size, scale) = (power_of_two(*moments), power_of_two(omega.0));
        are_within(moments, 1e-6 * size, 4.0 * size) & are_within(&omega.0, LEAST_RATE * scale, 4.0 * scale)
    }

    fn set_up_together(&mut self, bodies: &[FreeBody; TOGETHER]) -> Option<()> {
        with_wide_instructions(Fill { bodies, motions: self })
    }

    fn set_up_alone(&mut self, l: usize, body: &FreeBody) {
        let motion = body.motion();
        self.horizons[l] = motion.horizon;
        self.is_circular[l] = matches!(motion.flow.0, Form::FreeCircular(_));
        match &motion.flow.0 {
            Form::FreeCircular(flow) => self.circular.put(l, flow),
            Form::FreeHyperbolic(flow) => self.hyperbolic.put(l, flow),
            _ => unreachable!("the form of a free body"),
        }
    }
}

impl FreeMotions<TOGETHER> {
    /// States of all at times of their own: rows of four rotor components and of three of the angular velocity.
    pub fn at(
        &self,
        times: &[f64; TOGETHER],
        rotors: &mut [[f64; 4]; TOGETHER],
        omegas: &mut [[f64; 3]; TOGETHER],
    ) {
        either((&self.circular, &self.hyperbolic), &self.is_circular, times, rotors, omegas);
    }
}

/// The motions of bodies whose numbers are in the range of floats.
struct Fill<'a> {
    bodies: &'a [FreeBody; TOGETHER],
    motions: &'a mut FreeMotions<TOGETHER>,
}

impl Work for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        self.motions.filled::<DoubleDoubles<TOGETHER, FMA>, FMA>(self.bodies);
    }
}

/// Bodies that do not turn steadily, in lanes.
struct Tumbling<'a, N, const W: usize, const FMA: bool> {
    bodies: &'a [FreeBody; W],
    orbits: &'a Orbits<N, W, FMA>,
    scale: [f64; W],
    phases: Phases<W>,
}

/// The phases v/2π, and the nomes of the trigonometric series, infinite on the separatrix: from λ, AGM(1, k'), u at time 0, and
/// AGM(1, k). On the separatrix `u = NEVER · turns`.
#[inline(always)]
pub(crate) fn phases_and_nomes<const W: usize, const FMA: bool>(
    lambda: &DoubleDoubles<W, FMA>,
    mean: &DoubleDoubles<W, FMA>,
    on_separatrix: &[bool; W],
    [whole, rest]: &[[f64; W]; 2],
    other: &[f64; W],
) -> (Phases<W>, [f64; W]) {
    // 1/4K.
    let per_u = *mean * DoubleDoubles::all(DoubleDouble::OVER_TWO_PI);
    let per_u = DoubleDoubles::all((1.0 / NEVER).into()).or(on_separatrix, per_u);
    let rate = *lambda * per_u;
    let (mut start, mut nome) = ([[0.0; W]; 2], [0.0; W]);
    for l in 0..W {
        let part = rest[l] * per_u.hi[l];
        (start[0][l], start[1][l]) = if on_separatrix[l] { (part, 0.0) } else { (0.25 * whole[l], part) };
        let decayed = if other[l] > 0.0 { decay(PI * mean.hi[l] / other[l]) } else { 0.0 };
        nome[l] = if on_separatrix[l] { f64::INFINITY } else { decayed };
    }
    (Phases([rate.hi, rate.lo, start[0], start[1]]), nome)
}

impl<N: Precise<W, FMA>, const W: usize, const FMA: bool> Tumbling<'_, N, W, FMA> {
    #[inline(always)]
    fn circular(&self, series: &mut Circular<W>, nome: &[f64; W]) {
        let (rest, mut rho) = (self.orbits.rest_of_eta(), [0.0; W]);
        for l in 0..W {
            rho[l] = decay(rest[l] * self.orbits.mean.hi[l]);
        }
        series.set(nome, &rho, &self.orbits.s);
    }

    /// Arbitrary in the lanes of circular motions.
    #[inline(always)]
    fn hyperbolic(&self, series: &mut Hyperbolic<W>, other: &[f64; W]) {
        let (eta, mean) = (self.orbits.eta(), &self.orbits.mean);
        // πK/4K' and πη/4K'.
        let (mut border, mut gamma) = ([0.0; W], [0.0; W]);
        for l in 0..W {
            border[l] = 0.25 * PI * other[l] / mean.hi[l];
            gamma[l] = 0.5 * eta[l] * other[l];
        }
        series.set::<FMA>(&border, &gamma, &self.orbits.s, &self.orbits.on_separatrix);
    }

    /// Completes flows with the given series by phases and frames.
    #[inline(always)]
    fn fill<S: Series<W>>(&self, flow: &mut Flow<S, W>) {
        let Tumbling { bodies, orbits, scale, phases } = self;
        let half_a_turn = DoubleDoubles::all(DoubleDouble::OVER_TWO_PI * 0.5.into());
        let (rate, still) = (orbits.precession * half_a_turn, [0.0; W]);
        let frames = by_component(|l| bodies[l].frame.components());
        let rotors = by_component(|l| bodies[l].rotor.components());
        let (factors, mut units) = (flow.series.normalizers(), [[[0.0; W]; 4]; 4]);
        units[0][0] = [1.0; W];
        for k in 0..3 {
            let mut column = [[0.0; W]; 3];
            for l in 0..W {
                let axis = orbits.axes[l][k];
                // Quaternion units are the negatives of the planes.
                units[k + 1][axis + 1][l] = -orbits.signs[k][l];
                column[axis][l] = orbits.amplitudes[k][l] * factors[k][l] * scale[l];
            }
            column = turned(&frames, &column);
            for i in 0..3 {
                flow.omega[i][k] = column[i];
            }
        }
        (flow.scale, flow.orbit) = (*scale, *phases);
        flow.precession = Phases([rate.hi, rate.lo, still, still]);
        flow.set_frames::<FMA>(&rotors, &units, &frames);
    }
}

impl<S: Series<W>, const W: usize> Flow<S, W> {
    /// Sets the frames from the rotors at the start and those that stand for the quaternion units of (e1, e2, d).
    #[inline(always)]
    fn set_frames<const FMA: bool>(
        &mut self,
        start: &[[f64; W]; 4],
        units: &[[[f64; W]; 4]; 4],
        frames: &[[f64; W]; 4],
    ) {
        let (z, _) = self.turned::<W, FMA>(&[0.0; W]);
        let mut first = [[0.0; W]; 4];
        for i in 0..4 {
            for l in 0..W {
                for k in 0..4 {
                    first[i][l] += z[k][l] * units[k][i][l];
                }
            }
        }
        for l in 0..W {
            let [a, b, c, d] = [first[0][l], first[1][l], first[2][l], first[3][l]];
            let size = (a * a + b * b + c * c + d * d).sqrt();
            for i in 0..4 {
                first[i][l] /= size;
            }
        }
        let (to_space, to_body) = (product(start, &reverse(&first)), reverse(frames));
        for k in 0..4 {
            let column = product(&product(&to_space, &units[k]), &to_body);
            for i in 0..4 {
                self.rotor[i][k] = column[i];
            }
        }
    }
}

impl FreeBody {
    /// Steady rotation: `exp(−½ Ω t)`, a uniform turn about d along Ω.
    fn steady(&self) -> Flow<Circular> {
        let FreeBody { frame, rotor, omega, .. } = *self;
        let scale = power_of_two(omega.0);
        let square = |x: f64| DoubleDouble::from(x) * x.into();
        let unit = omega / scale;
        let [x, y, z] = unit.0;
        let size = (square(x) + square(y) + square(z)).sqrt();
        let plane = if size.hi > 0.0 { unit / size.value() } else { Bivector::default() };
        let d = [0.0, -plane.0[0], -plane.0[1], -plane.0[2]];
        let mut flow = Flow {
            scale: [scale],
            orbit: Phases::STILL,
            precession: Phase { rate: size * DoubleDouble::OVER_TWO_PI * 0.5.into(), start: [0.0; 2] }.into(),
            series: Circular::steady(),
            rotor: [[[0.0]; 4]; 4],
            omega: frame.apply_bivector(omega).0.map(|w| [[0.0], [0.0], [w]]),
        };
        let in_lane = |c: [f64; 4]| c.map(|x| [x]);
        let units = [Rotor::IDENTITY.components(), d, d, d].map(in_lane);
        flow.set_frames::<false>(&in_lane(rotor.components()), &units, &in_lane(frame.components()));
        flow
    }
}

#[cfg(test)]
mod tests;
