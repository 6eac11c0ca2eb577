//! Torque laws of bodies in SIMD lanes.
//!
//! Shared orbits and tables are evaluated once per time.

mod gain;
mod merged;
mod orbits;
mod table;

use crate::laws::forcing::{Forcing, Place};
use crate::laws::formula::Formulas;
use crate::laws::torque::Torque;
use crate::laws::torque::lanes::{Three, add, part, turn_from};
use crate::state::phase::{Gyrostat, vertical};
use gain::Gain;
use merged::Law;
pub(crate) use merged::Laws;
use orbits::Orbits;
use polhode_ga::Bivector;
use polhode_ga::simd::lanes::{Lanes, cross};

/// A torque whose parameters are so few that it is computed in registers, with the steps of some of the bodies.
pub(super) trait Divisible<const W: usize, const F: bool> {
    /// The same for `P` of the bodies, from `first` on.
    fn part<const P: usize>(&self, first: usize) -> impl Forcing<P, F>;
}

/// Free bodies without wheels.
pub(crate) struct NoForcing;

impl<const W: usize, const F: bool> Divisible<W, F> for NoForcing {
    #[inline(always)]
    fn part<const P: usize>(&self, _: usize) -> impl Forcing<P, F> {
        NoForcing
    }
}

impl<const W: usize, const F: bool> Forcing<W, F> for NoForcing {
    const ACTS: bool = false;

    #[inline(always)]
    fn torque(&mut self, _: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        [Lanes::ZERO; 3]
    }
}

/// Weights and damping only, without wheels: their parameters stay in registers.
pub(super) struct Weight<const W: usize, const F: bool>(Three<W, F>);

impl<const W: usize, const F: bool> Forcing<W, F> for Weight<W, F> {
    const ACTS: bool = true;
    const WHEELS: bool = false;

    /// γ∧c: its axial vector is γ x c.
    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        cross(&vertical(&at.rotor), &self.0)
    }
}

impl<const W: usize, const F: bool> Divisible<W, F> for Weight<W, F> {
    #[inline(always)]
    fn part<const P: usize>(&self, first: usize) -> impl Forcing<P, F> {
        Weight::<P, F>(part(&self.0, first))
    }
}

/// One gravity gradient and damping only, without wheels.
pub(super) struct Gradient<const W: usize, const F: bool> {
    moments: Three<W, F>,
    orbits: Orbits<W>,
}

impl<const W: usize, const F: bool> Forcing<W, F> for Gradient<W, F> {
    const ACTS: bool = true;
    const WHEELS: bool = false;

    fn ahead(&mut self, times: impl Iterator<Item = f64> + Clone) {
        self.orbits.foresee(times);
    }

    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        self.orbits.torque(&self.moments, at)
    }
}

/// One controller or torsion spring and damping only, without wheels.
pub(super) struct Controller<const W: usize, const F: bool> {
    stiffness: Gain<W, F>,
    target: [Lanes<W, F>; 4],
    damping: Gain<W, F>,
}

impl<const W: usize, const F: bool> Forcing<W, F> for Controller<W, F> {
    const ACTS: bool = true;
    const WHEELS: bool = false;

    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        let mut torque = self.stiffness.against(&turn_from(&self.target, &at.rotor));
        add(&mut torque, &self.damping.against(&at.omega));
        torque
    }
}

impl<const W: usize, const F: bool> Divisible<W, F> for Controller<W, F> {
    #[inline(always)]
    fn part<const P: usize>(&self, first: usize) -> impl Forcing<P, F> {
        Controller::<P, F> {
            stiffness: self.stiffness.part(first),
            target: part(&self.target, first),
            damping: self.damping.part(first),
        }
    }
}

/// One formula and damping only, without wheels: a call less for each torque.
pub(super) struct OneFormula<'t, const W: usize, const F: bool>(Box<Formulas<'t, W, F>>);

impl<const W: usize, const F: bool> Forcing<W, F> for OneFormula<'_, W, F> {
    const ACTS: bool = true;
    const WHEELS: bool = false;

    fn ahead(&mut self, times: impl Iterator<Item = f64> + Clone) {
        self.0.foresee(times);
    }

    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        self.0.torque(at)
    }
}

/// The forcing of bodies in lanes, specialised for the simple cases.
pub(super) enum LaneForcing<'t, const W: usize, const F: bool> {
    NoForcing(NoForcing),
    Weight(Weight<W, F>),
    Gradient(Gradient<W, F>),
    Controller(Controller<W, F>),
    Formula(OneFormula<'t, W, F>),
    Laws(Laws<'t, W, F>),
}

impl<'t, const W: usize, const F: bool> LaneForcing<'t, W, F> {
    /// Every body has laws of the same kinds in the same order.
    pub fn new(gyrostats: [Gyrostat; W], torques: [&'t [Torque]; W]) -> LaneForcing<'t, W, F> {
        if torques[0].is_empty() {
            return LaneForcing::NoForcing(NoForcing);
        }
        let mut laws = Laws::new(gyrostats, torques);
        if gyrostats.iter().any(|body| body.wheel != Bivector::default()) {
            return LaneForcing::Laws(laws);
        }
        let (last, before) = (laws.laws.pop(), laws.laws.pop());
        match (before, last) {
            (None, Some(Law::Heavy(c))) => LaneForcing::Weight(Weight(c)),
            (None, Some(Law::GravityGradient(orbits))) => {
                LaneForcing::Gradient(Gradient { moments: laws.moments, orbits })
            }
            (None, Some(Law::Spring { stiffness, rest: target })) => {
                LaneForcing::Controller(Controller { stiffness, target, damping: Gain::NONE })
            }
            (None, Some(Law::Formula(formulas))) => LaneForcing::Formula(OneFormula(formulas)),
            (Some(Law::Spring { stiffness, rest: target }), Some(Law::ViscousDamping(damping)))
                if laws.laws.is_empty() =>
            {
                LaneForcing::Controller(Controller { stiffness, target, damping })
            }
            others => {
                laws.laws.extend(others.0.into_iter().chain(others.1));
                LaneForcing::Laws(laws)
            }
        }
    }
}
