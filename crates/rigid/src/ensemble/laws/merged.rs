//! Any laws of bodies in SIMD lanes: those of one kind are merged where their parameters add up.

use super::gain::Gain;
use super::orbits::Orbits;
use super::table::CachedTable;
use crate::laws::forcing::{Forcing, Place};
use crate::laws::formula::Formulas;
use crate::laws::torque::lanes::{Three, add, in_lanes, quadratic, seen, turn_from};
use crate::laws::torque::{Axes, Gains, Torque};
use crate::state::phase::vertical;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::simd::lanes::{Lanes, Work, cross, fastest};
use polhode_ga::{Bivector, Rotor};
use std::array;
use std::sync::Arc;

/// The laws of bodies in lanes, in principal axes.
pub(crate) struct Laws<'t, const W: usize, const F: bool> {
    gyrostats: [Gyrostat; W],
    pub(super) moments: Three<W, F>,
    wheel: Three<W, F>,
    pub(super) laws: Vec<Law<'t, W, F>>,
    /// Of the step, in s.
    middle: Lanes<W, F>,
}

/// A law, or the sum of several of one kind, with the parameters of each body.
pub(super) enum Law<'t, const W: usize, const F: bool> {
    /// `c` of all weights.
    Heavy(Three<W, F>),
    GravityGradient(Orbits<W>),
    ConstantBody(Three<W, F>),
    ConstantSpace(Three<W, F>),
    QuadraticDamping(Lanes<W, F>),
    ViscousDamping(Gain<W, F>),
    Magnetic {
        dipole: Three<W, F>,
        field: Three<W, F>,
    },
    Spring {
        stiffness: Gain<W, F>,
        rest: [Lanes<W, F>; 4],
    },
    Larmor(Three<W, F>),
    /// A table shared by all, in its axes.
    Tabulated(CachedTable<'t>),
    Formula(Box<Formulas<'t, W, F>>),
    /// Lane by lane.
    Other([&'t Torque; W]),
}

/// The numbers of a law computed in lanes; empty for others.
fn numbers(law: &Torque) -> Vec<f64> {
    match law {
        Torque::Heavy(v) | Torque::Larmor(v) => v.0.to_vec(),
        Torque::ConstantBody(b) | Torque::ConstantSpace(b) => b.0.to_vec(),
        Torque::QuadraticDamping(k) => vec![*k],
        Torque::ViscousDamping(d) => d.entries().to_vec(),
        Torque::Magnetic { dipole, field } => [dipole.0, field.0].concat(),
        Torque::TorsionSpring { stiffness, rest } => {
            [&Gains::new([*stiffness; 3]).entries()[..], &rest.components()].concat()
        }
        Torque::Control { stiffness, damping, target } => {
            [&stiffness.entries()[..], &target.components(), &damping.entries()].concat()
        }
        _ => Vec::new(),
    }
}

/// The lanes of N numbers, from the first on. A body without this law has it with zeros.
fn lanes<const N: usize, const W: usize, const F: bool>(
    each: &[Vec<f64>; W],
    first: usize,
) -> [Lanes<W, F>; N] {
    in_lanes(|l| array::from_fn(|k| each[l].get(first + k).copied().unwrap_or_default()))
}

fn gain<const W: usize, const F: bool>(each: &[Vec<f64>; W], first: usize) -> Gain<W, F> {
    Gain::new(array::from_fn(|row| lanes(each, first + 3 * row)))
}

impl<'t, const W: usize, const F: bool> Law<'t, W, F> {
    /// Combines the same law of each body into one in lanes; a controller is a spring and a damper. Damping and wheels
    /// are stored with the bodies.
    fn new(each: [&'t Torque; W], gyrostats: &[Gyrostat; W]) -> Vec<Law<'t, W, F>> {
        let own: [Vec<f64>; W] = each.map(numbers);
        let law = match each[0] {
            Torque::Damping(_) | Torque::Wheel(_) => return Vec::new(),
            Torque::Heavy(_) => Law::Heavy(lanes(&own, 0)),
            Torque::GravityGradient(_) => Orbits::new(each).map_or(Law::Other(each), Law::GravityGradient),
            Torque::ConstantBody(_) => Law::ConstantBody(lanes(&own, 0)),
            Torque::ConstantSpace(_) => Law::ConstantSpace(lanes(&own, 0)),
            Torque::QuadraticDamping(_) => Law::QuadraticDamping(lanes::<1, W, F>(&own, 0)[0]),
            Torque::ViscousDamping(_) => Law::ViscousDamping(gain(&own, 0)),
            Torque::Magnetic { .. } => Law::Magnetic { dipole: lanes(&own, 0), field: lanes(&own, 3) },
            Torque::TorsionSpring { .. } => Law::Spring { stiffness: gain(&own, 0), rest: lanes(&own, 9) },
            Torque::Control { .. } => {
                let spring = Law::Spring { stiffness: gain(&own, 0), rest: lanes(&own, 9) };
                return vec![spring, Law::ViscousDamping(gain(&own, 13))];
            }
            Torque::Larmor(_) => Law::Larmor(lanes(&own, 0)),
            Torque::Tabulated(table) => {
                let same =
                    |law: &&Torque| matches!(law, Torque::Tabulated(other) if Arc::ptr_eq(table, other));
                if each.iter().all(same) { Law::Tabulated(CachedTable::new(table)) } else { Law::Other(each) }
            }
            Torque::Formula(_) | Torque::Registered(_) => {
                let known = each.map(Torque::formula);
                let formulas = known[0].filter(|_| known.iter().all(Option::is_some)).and_then(|first| {
                    Formulas::new(known.map(|formula| formula.unwrap_or(first)), gyrostats)
                });
                formulas.map_or(Law::Other(each), |formulas| Law::Formula(Box::new(formulas)))
            }
            Torque::Function(_) | Torque::Wheels(_) => Law::Other(each),
        };
        vec![law]
    }

    /// The same, unless it borrows.
    fn kept(self) -> Option<Law<'static, W, F>> {
        Some(match self {
            Law::Heavy(c) => Law::Heavy(c),
            Law::GravityGradient(orbits) => Law::GravityGradient(orbits),
            Law::ConstantBody(torque) => Law::ConstantBody(torque),
            Law::ConstantSpace(torque) => Law::ConstantSpace(torque),
            Law::QuadraticDamping(k) => Law::QuadraticDamping(k),
            Law::ViscousDamping(d) => Law::ViscousDamping(d),
            Law::Magnetic { dipole, field } => Law::Magnetic { dipole, field },
            Law::Spring { stiffness, rest } => Law::Spring { stiffness, rest },
            Law::Larmor(b) => Law::Larmor(b),
            Law::Tabulated(_) | Law::Formula(_) | Law::Other(_) => return None,
        })
    }

    /// Adds the parameters of a law of the same kind; false where they do not add up.
    fn join(&mut self, other: &Law<'t, W, F>) -> bool {
        match (self, other) {
            (Law::Heavy(a), Law::Heavy(b))
            | (Law::ConstantBody(a), Law::ConstantBody(b))
            | (Law::ConstantSpace(a), Law::ConstantSpace(b))
            | (Law::Larmor(a), Law::Larmor(b)) => add(a, b),
            (Law::QuadraticDamping(a), Law::QuadraticDamping(b)) => *a += *b,
            (Law::ViscousDamping(a), Law::ViscousDamping(b)) => a.join(b),
            _ => return false,
        }
        true
    }
}

impl<'t, const W: usize, const F: bool> Laws<'t, W, F> {
    /// Every body has laws of the same kinds in the same order.
    pub fn new(gyrostats: [Gyrostat; W], torques: [&'t [Torque]; W]) -> Laws<'t, W, F> {
        let mut laws: Vec<Law<'t, W, F>> = Vec::new();
        for law in 0..torques[0].len() {
            for law in Law::new(array::from_fn(|l| &torques[l][law]), &gyrostats) {
                if !laws.iter_mut().any(|known| known.join(&law)) {
                    laws.push(law);
                }
            }
        }
        let (moments, wheel) = (in_lanes(|l| gyrostats[l].moments), in_lanes(|l| gyrostats[l].wheel.0));
        Laws { gyrostats, moments, wheel, laws, middle: Lanes::ZERO }
    }

    /// The same without borrowed laws; none if a law borrows a table, formula or function.
    pub fn kept(self) -> Option<Laws<'static, W, F>> {
        let Laws { gyrostats, moments, wheel, laws, middle } = self;
        let laws = laws.into_iter().map(Law::kept).collect::<Option<_>>()?;
        Some(Laws { gyrostats, moments, wheel, laws, middle })
    }
}

/// Evaluates the law of each body; NaN where it fails.
#[inline(never)]
fn lane_by_lane<const W: usize, const F: bool>(
    gyrostats: &[Gyrostat; W],
    each: &[&Torque; W],
    at: &Place<W, F>,
    middle: &Lanes<W, F>,
) -> Three<W, F> {
    in_lanes(|l| {
        let (body, rotor) = (&gyrostats[l], at.rotor.map(|lanes| lanes.0[l]));
        // Laws are not evaluated for a failed body.
        if !rotor[0].is_finite() {
            return [f64::NAN; 3];
        }
        let momentum = body.momentum(Bivector(at.omega.map(|lanes| lanes.0[l])));
        let phase = Phase { rotor: Rotor::from_unit_components(rotor), momentum, time: at.time.of(l) };
        each[l]
            .value_within(&Point::at_rest(body, &phase), middle.0[l])
            .map_or([f64::NAN; 3], |torque| torque.0)
    })
}

/// The torque of a law, compiled outside the stages of the steps, which would repeat its code, and apart from a loop over
/// laws, out of which the compiler would take work for laws that are not there.
struct Term<'a, 't, const W: usize, const F: bool> {
    law: &'a mut Law<'t, W, F>,
    gyrostats: &'a [Gyrostat; W],
    moments: &'a Three<W, F>,
    wheel: &'a Three<W, F>,
    at: &'a Place<W, F>,
    middle: &'a Lanes<W, F>,
}

impl<const W: usize, const F: bool> Work for Term<'_, '_, W, F> {
    type Output = Three<W, F>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Three<W, F> {
        // The caller is on the same path; other paths are not compiled.
        if FUSED != F {
            return [Lanes::ZERO; 3];
        }
        let Term { law, gyrostats, moments, wheel, at, middle } = self;
        match law {
            // γ∧c: its axial vector is γ x c.
            Law::Heavy(c) => cross(&vertical(&at.rotor), c),
            Law::GravityGradient(orbits) => orbits.torque(moments, at),
            Law::ConstantBody(torque) => *torque,
            Law::ConstantSpace(torque) => seen(&at.rotor, torque),
            Law::QuadraticDamping(k) => quadratic(*k, &at.omega),
            Law::ViscousDamping(d) => d.against(&at.omega),
            Law::Magnetic { dipole, field } => cross(dipole, &seen(&at.rotor, field)),
            Law::Spring { stiffness, rest } => stiffness.against(&turn_from(rest, &at.rotor)),
            Law::Larmor(b) => {
                let mut momentum = *wheel;
                for k in 0..3 {
                    momentum[k] = moments[k].times_plus(at.omega[k], wheel[k]);
                }
                cross(&momentum, &seen(&at.rotor, b))
            }
            Law::Tabulated(cached) => {
                let torque = cached.at(at, middle);
                if cached.table.axes == Axes::Body { torque } else { seen(&at.rotor, &torque) }
            }
            Law::Formula(formulas) => formulas.torque(at),
            Law::Other(each) => lane_by_lane(gyrostats, each, at, middle),
        }
    }
}

impl<const W: usize, const F: bool> Forcing<W, F> for Laws<'_, W, F> {
    const ACTS: bool = true;

    #[inline(always)]
    fn begin(&mut self, middle: Lanes<W, F>) {
        self.middle = middle;
    }

    fn ahead(&mut self, times: impl Iterator<Item = f64> + Clone) {
        for law in &mut self.laws {
            match law {
                Law::GravityGradient(orbits) => orbits.foresee(times.clone()),
                Law::Formula(formulas) => formulas.foresee(times.clone()),
                _ => {}
            }
        }
    }

    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        let Laws { gyrostats, moments, wheel, laws, middle } = self;
        let mut sum = [Lanes::ZERO; 3];
        for law in laws {
            add(&mut sum, &fastest(Term { law, gyrostats, moments, wheel, at, middle }));
        }
        sum
    }
}
