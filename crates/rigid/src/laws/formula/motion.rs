//! The names that a motion defines in formulas, and their values.

use super::{Axes, Purpose, VECTOR};
use crate::state::phase::Gyrostat;
use crate::state::point::Point;
use polhode_ga::formula::{Given, Meaning, Type};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor, Vector};
use std::array::from_fn;

/// The names that the motion defines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Rotor,
    Time,
    OmegaBody,
    OmegaSpace,
    MomentumBody,
    MomentumSpace,
    Inertia,
    Position,
    Velocity,
    Mass,
}

/// The names that the motion defines in the formula of a torque with units. After a number, `m` is the metre.
pub(crate) fn given_names() -> impl Iterator<Item = &'static str> {
    let names = given(Purpose::Torque(Axes::Body)).into_iter();
    names.filter(|(_, motion)| *motion != Motion::Mass).map(|(name, _)| name)
}

/// The names that the motion defines. `Ω` is the angular velocity in the axes of the torque.
pub(super) fn given(purpose: Purpose) -> Vec<(&'static str, Motion)> {
    let mut names = vec![
        ("x", Motion::Position),
        ("v", Motion::Velocity),
        ("m", Motion::Mass),
        ("R", Motion::Rotor),
        ("t", Motion::Time),
        ("Ω_B", Motion::OmegaBody),
        ("Ω_S", Motion::OmegaSpace),
        ("Omega_B", Motion::OmegaBody),
        ("Omega_S", Motion::OmegaSpace),
        ("L", Motion::MomentumSpace),
        ("L_B", Motion::MomentumBody),
        ("I", Motion::Inertia),
    ];
    match purpose {
        Purpose::Torque(Axes::Body) => names.extend([("Ω", Motion::OmegaBody), ("Omega", Motion::OmegaBody)]),
        Purpose::Torque(Axes::Space) => {
            names.extend([("Ω", Motion::OmegaSpace), ("Omega", Motion::OmegaSpace)]);
        }
        Purpose::Force | Purpose::Event => {}
    }
    names
}

impl Motion {
    pub(super) fn meaning(self) -> Meaning {
        match self {
            Motion::Rotor => Meaning::Value(Type::ROTOR),
            Motion::Time | Motion::Mass => Meaning::Value(Type::SCALAR),
            Motion::Position | Motion::Velocity => Meaning::Value(Type::of(VECTOR)),
            Motion::Inertia => Meaning::Map { grade: 2 },
            _ => Meaning::Value(Type::of(Grades::BIVECTOR)),
        }
    }

    /// Whether it changes faster than the attitude: the angular velocity, the momentum and the velocity of the centre of
    /// mass, or its position, which steps for attitudes do not know.
    pub fn is_rate(self) -> bool {
        !matches!(self, Motion::Rotor | Motion::Time | Motion::Inertia | Motion::Mass)
    }

    /// Whether it is that of the centre of mass.
    pub fn is_of_center(self) -> bool {
        matches!(self, Motion::Position | Motion::Velocity)
    }

    /// Its value at a point of the motion, with `frame` from principal axes to those of the body.
    pub(super) fn at(self, point: &Point, frame: Rotor) -> Given {
        let Point { body, phase: state, center, mass } = *point;
        let vector = |v: Vector| Given::Value(Graded::new(&v.0, VECTOR).unwrap_or_default());
        let bivector = |b: Bivector| Given::Value(Graded::new(&b.0, Grades::BIVECTOR).unwrap_or_default());
        match self {
            Motion::Rotor => {
                let rotor =
                    if frame == Rotor::IDENTITY { state.rotor } else { state.rotor * frame.reverse() };
                Given::Value(Graded::new(&rotor.components(), Grades::EVEN).unwrap_or_default())
            }
            Motion::Time => Given::Value(Graded::default().map(|_| state.time)),
            Motion::OmegaBody => bivector(frame.apply_bivector(body.omega(state.momentum))),
            Motion::OmegaSpace => bivector(state.rotor.apply_bivector(body.omega(state.momentum))),
            Motion::MomentumBody => bivector(frame.apply_bivector(state.momentum)),
            Motion::MomentumSpace => bivector(state.rotor.apply_bivector(state.momentum)),
            Motion::Inertia => inertia(body, frame),
            Motion::Position => vector(center.position),
            Motion::Velocity => vector(center.velocity),
            Motion::Mass => Given::Value(Graded::default().map(|_| mass)),
        }
    }
}

/// The matrix of `I(…)`, with `frame` from principal axes to those of the body.
pub(super) fn inertia(body: &Gyrostat, frame: Rotor) -> Given {
    let (f, i) = (frame.to_matrix(), body.moments);
    let entry = |j: usize, k: usize| (0..3).map(|a| f[j][a] * i[a] * f[k][a]).sum();
    Given::Matrix(from_fn(|n| entry(n / 3, n % 3)))
}
