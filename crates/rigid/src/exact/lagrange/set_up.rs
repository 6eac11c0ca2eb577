//! From heavy tops to their motions, one top in each lane: the numbers of [`Nutations`] first, then series and frames.

use super::flow::Flow as LagrangeFlow;
use super::nutations::Nutations;
use super::series::{Circular, Hyperbolic};
use super::start::HeavyTop;
use super::{FreeMotion, LagrangeTop};
use crate::error::SimulateError;
use crate::exact::flow::{Flow, Form, either};
use crate::exact::free::series::LARGEST_NOME;
use crate::exact::lanes::{Coefficients, LEAST_RATE, SetUp, are_within};
use crate::numerics::double_double::DoubleDoubles;
use crate::numerics::wide::Wides;
use polhode_ga::Bivector;
use polhode_ga::rows::curve::TOGETHER;
use polhode_ga::simd::lanes::{Work, with_wide_instructions};

impl HeavyTop {
    /// Its motion.
    ///
    /// # Errors
    /// [`SimulateError::Unresolved`] if the roots are not.
    pub fn motion(&self) -> Result<LagrangeTop, SimulateError> {
        // One lane needs no wide instructions.
        let (nutations, starts, orbits) = Nutations::<1>::of::<Wides<1, false>, false>(&[*self]);
        let (axes, start) = (self.axes, starts.lane(0));
        if nutations.steady[0] {
            let moments = [axes.i1, axes.i1, axes.i3];
            let along = Bivector([0.0, 0.0, start.omega3]);
            let motion = FreeMotion::in_frame(axes.frame, moments, self.rotor * axes.frame, along);
            let (flow, horizon) = (motion.flow, motion.horizon());
            return Ok(LagrangeTop { axes, start, orbit: None, flow, horizon });
        }
        let mut tops = LagrangeTops::<1>::default();
        tops.fill::<false>(&nutations);
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
    fn fill<const FMA: bool>(&mut self, of: &Nutations<W>) {
        for l in 0..W {
            self.is_circular[l] = of.nome[l] <= LARGEST_NOME;
        }
        self.steady = of.steady;
        self.circular.series.set(&of.nome, &of.mean, &of.zeros);
        of.complete::<_, FMA>(&mut self.circular);
        self.horizons = of.horizons();
        self.resolved = of.resolved::<_, FMA>(&self.circular);
        if self.is_circular != [true; W] {
            of.set_hyperbolic::<FMA>(&mut self.hyperbolic.series);
            of.complete::<_, FMA>(&mut self.hyperbolic);
            let resolved = of.resolved::<_, FMA>(&self.hyperbolic);
            for l in 0..W {
                self.resolved[l] = if self.is_circular[l] { self.resolved[l] } else { resolved[l] };
            }
        }
        for l in 0..W {
            self.resolved[l] &= of.has_roots[l];
        }
    }
}

impl SetUp for LagrangeTops<TOGETHER> {
    type Body = HeavyTop;

    fn is_moderate(HeavyTop { axes, rotor, omega, scale }: &HeavyTop) -> bool {
        // Invariants are products of up to four squares of tilts, rates in units of the largest, and cancelled differences of
        // them.
        let gravity = axes.c / axes.i1 / scale / scale;
        are_within(&[axes.i1, axes.i3, axes.c], 1e-100, 1e100)
            & (axes.i3 >= 1e-6 * axes.i1)
            & are_within(&[gravity], 1e-15, 4.0)
            & are_within(&omega.0, LEAST_RATE * scale, 4.0 * scale)
            & are_within(&rotor.components(), LEAST_RATE, 4.0)
            & are_within(&axes.frame.components(), LEAST_RATE, 4.0)
    }

    fn set_up_together(&mut self, tops: &[HeavyTop; TOGETHER]) -> Option<()> {
        let nutations = &with_wide_instructions(Solve { tops })?;
        with_wide_instructions(Fill { motions: self, nutations })
    }

    fn set_up_alone(&mut self, l: usize, top: &HeavyTop) {
        let motion = top.motion();
        self.resolved[l] = motion.is_ok();
        let Ok(motion) = motion else { return };
        self.steady[l] = motion.orbit.is_none();
        self.horizons[l] = motion.horizon;
        self.is_circular[l] = !matches!(motion.flow.0, Form::LagrangeHyperbolic(_));
        match &motion.flow.0 {
            Form::LagrangeCircular(flow) => self.circular.put(l, flow),
            Form::LagrangeHyperbolic(flow) => self.hyperbolic.put(l, flow),
            // Steady tops have the motions of free bodies.
            _ => {}
        }
    }
}

impl LagrangeTops<TOGETHER> {
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

/// The orbits of tops whose numbers are in the range of floats.
struct Solve<'a> {
    tops: &'a [HeavyTop; TOGETHER],
}

impl Work for Solve<'_> {
    type Output = Nutations<TOGETHER>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Nutations<TOGETHER> {
        Nutations::of::<DoubleDoubles<TOGETHER, FMA>, FMA>(self.tops).0
    }
}

struct Fill<'a> {
    motions: &'a mut LagrangeTops<TOGETHER>,
    nutations: &'a Nutations<TOGETHER>,
}

impl Work for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        self.motions.fill::<FMA>(self.nutations);
    }
}

#[cfg(test)]
mod tests;
