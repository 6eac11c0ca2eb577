//! Conserved quantities of a set of torque laws.
//!
//! With `m = I(Ω) + h` the momentum in principal axes, h that of a wheel, Euler's equations are
//! `m' = m x ω + N` in axial vectors. From them:
//!
//! - `T = ½ ω·I(ω)` changes at the rate `ω·N`, so `E = T + V` is constant where every torque has a
//!   potential. The wheel does no work: `ω·(h x ω) = 0`.
//! - `L = R m ~R` changes at the rate of the torque in space. It is constant without one; its component
//!   along an axis about which no torque acts is; its size is under `N = L x b`.
//! - `m·a`, for an axis a of the body, changes at the rate `(m x ω)·a + N·a`. The first vanishes where the
//!   body is symmetric about a and the wheel lies along a, for then m, ω and a lie in one plane.
//! - In a field that turns about e3 at the rate n, and with other torques that e3 is an axis of,
//!   `∂V/∂t = n N3 = n L3'`: Jacobi's integral `E − n L3` is constant.
//! - Heavy bodies of two shapes have an integral of the fourth and of the third degree: S. Kovalevskaya,
//!   Acta Math. 12 (1889) 177; D. N. Goryachev, Mat. Sb. 21 (1900) 431, and S. A. Chaplygin (1901).

use super::driven_wheels::driven;
use super::torque::{E3, Torque};
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Vector};

/// Moments, directions and components count as equal, parallel and zero within this of their size.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A quantity that the motion conserves exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conserved {
    /// Kinetic plus potential energy, in J.
    Energy,
    /// |L|, that of a wheel included, in kg m²/s.
    AngularMomentum,
    /// The component of L about a unit axis of space, in kg m²/s.
    AxialAngularMomentum(Vector),
    /// The component of L about a unit axis of the body, in principal axes, in kg m²/s.
    SpinAngularMomentum(Vector),
    /// `|(ω1 + iω2)² − (c1 + ic2)(γ1 + iγ2)/i3|²` for moments (2, 2, 1) times i3 and `V = c·γ`, `c3 = 0`,
    /// in (rad/s)⁴.
    Kovalevskaya(Plane),
    /// `ω3 (ω1² + ω2²) − γ3 (c1 ω1 + c2 ω2)/i3` for moments (4, 4, 1) times i3 and `V = c·γ`, `c3 = 0`,
    /// where L·γ = 0, in (rad/s)³.
    GoryachevChaplygin(Plane),
    /// `E − n L·N` of a satellite on a circular orbit at the rate n, N its normal e3, in J.
    Jacobi(f64),
}

/// A heavy body whose centre of mass lies in the plane of two equal moments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The principal axis perpendicular to it, "3"; "1" and "2" follow it in turn.
    normal: usize,
    field: Field,
}

/// A uniform field: `V = c·γ`, `γ = ~R a R` with a unit vector a of space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Field {
    axis: Vector,
    c: Vector,
}

/// The names of all quantities, in the order in which [`Conserved::under`] gives them.
pub const NAMES: [&str; 8] = [
    "energy",
    "angular_momentum",
    "vertical_angular_momentum",
    "axial_angular_momentum",
    "spin_angular_momentum",
    "kovalevskaya_integral",
    "goryachev_chaplygin_integral",
    "jacobi_integral",
];

impl Conserved {
    /// The quantities that a set of laws conserves, for a motion with this start.
    pub fn under(
        body: &Gyrostat,
        torques: &[Torque],
        start: &Phase,
    ) -> impl Iterator<Item = Conserved> + use<> {
        Conserved::all_under(body, torques, start).into_iter().flatten()
    }

    /// The same, without allocating memory for them.
    fn all_under(body: &Gyrostat, torques: &[Torque], start: &Phase) -> [Option<Conserved>; 6] {
        let acting = torques.iter().filter(|t| acts(t));
        let keeps_size = acting.clone().all(|t| matches!(t, Torque::Larmor(_)));
        let mut motors = torques.iter().filter_map(|t| match t {
            Torque::Wheels(wheels) => Some(wheels.is_idle()),
            _ => None,
        });
        let driven = motors.clone().next().is_some();
        let energy = acting.clone().all(|t| is_conservative(t, body)) && motors.all(|idle| idle);
        let energy = energy.then_some(Conserved::Energy);
        let size = keeps_size.then_some(Conserved::AngularMomentum);
        let axis = shared_axis(acting.clone());
        let axial = axis.map(Conserved::AxialAngularMomentum);
        if driven {
            return [energy, size, axial, None, None, None];
        }
        let wheel = body.wheel != Default::default();
        let spins = wheel || acting.clone().next().is_some();
        let spin = || spin_axis(body, acting.clone()).map(Conserved::SpinAngularMomentum);
        let field = axis.filter(|_| !wheel).and_then(|axis| field(acting.clone(), axis));
        let heavy = field.and_then(|field| of_heavy_body(body, field, start));
        [energy, size, axial, if spins { spin() } else { None }, heavy, jacobi(acting)]
    }

    /// Its place in [`NAMES`].
    pub fn number(self) -> usize {
        match self {
            Conserved::Energy => 0,
            Conserved::AngularMomentum => 1,
            Conserved::AxialAngularMomentum(axis) if axis == E3 => 2,
            Conserved::AxialAngularMomentum(_) => 3,
            Conserved::SpinAngularMomentum(_) => 4,
            Conserved::Kovalevskaya(_) => 5,
            Conserved::GoryachevChaplygin(_) => 6,
            Conserved::Jacobi(_) => 7,
        }
    }

    /// Its name in reports and files.
    pub fn name(self) -> &'static str {
        NAMES[self.number()]
    }

    /// Its value, in principal axes.
    pub fn value(self, body: &Gyrostat, torques: &[Torque], state: &Phase) -> f64 {
        let about = |axis: Vector| state.rotor.apply_bivector(momentum(torques, state)).dual().dot(axis);
        match self {
            Conserved::Energy => energy(body, torques, state),
            Conserved::AngularMomentum => momentum(torques, state).norm(),
            Conserved::AxialAngularMomentum(axis) => about(axis),
            Conserved::SpinAngularMomentum(axis) => state.momentum.dual().dot(axis),
            Conserved::Kovalevskaya(plane) => {
                let ([w1, w2, _], [c1, c2], [g1, g2, _]) = plane.components(body, state);
                let real = (w1 - w2) * (w1 + w2) - (c1 * g1 - c2 * g2);
                let imaginary = 2.0 * w1 * w2 - (c1 * g2 + c2 * g1);
                real * real + imaginary * imaginary
            }
            Conserved::GoryachevChaplygin(plane) => {
                let ([w1, w2, w3], [c1, c2], [_, _, g3]) = plane.components(body, state);
                w3 * (w1 * w1 + w2 * w2) - g3 * (c1 * w1 + c2 * w2)
            }
            Conserved::Jacobi(n) => {
                let tide = |torque: &Torque| match torque {
                    Torque::GravityGradient(orbit) => {
                        let u = state.rotor.reverse().apply(orbit.place(state.time).0);
                        1.5 * n * n * u.dot(body.stretched(u))
                    }
                    _ => 0.0,
                };
                energy(body, torques, state) - n * about(E3) + torques.iter().map(tide).sum::<f64>()
            }
        }
    }

    /// The scale of relative changes: the size of its terms, or what the energy allows them to reach for a start at
    /// rest.
    pub fn scale(self, body: &Gyrostat, torques: &[Torque], start: &Phase) -> f64 {
        let kinetic = || body.kinetic(start.momentum);
        let energy = || kinetic() + torques.iter().map(|t| t.size(body)).sum::<f64>();
        let range = || torques.iter().map(|t| t.potential_range()).sum::<f64>();
        let size = || momentum(torques, start).norm();
        // `T <= T0 + range`: `|ω|² i <= 2T` of the slowest turn for an energy, `|I(ω)|² <= 2 i T` of the
        // heaviest.
        let momentum = || {
            let largest = body.moments.iter().fold(0.0, |m: f64, x| m.max(*x));
            size() + (2.0 * largest * range()).sqrt()
        };
        match self {
            Conserved::Energy => energy(),
            Conserved::AngularMomentum => size(),
            Conserved::AxialAngularMomentum(_) | Conserved::SpinAngularMomentum(_) => momentum(),
            Conserved::Kovalevskaya(plane) => plane.square_rate(body, kinetic() + range()).powi(2),
            Conserved::GoryachevChaplygin(plane) => plane.square_rate(body, kinetic() + range()).powf(1.5),
            Conserved::Jacobi(n) => energy() + n.abs() * momentum(),
        }
    }
}

/// The momentum in principal axes, that of all wheels included.
pub(crate) fn momentum(torques: &[Torque], state: &Phase) -> Bivector {
    match driven(torques, state.time) {
        Some(driven) => state.momentum + driven,
        None => state.momentum,
    }
}

/// Kinetic energy, and the potential energy of the laws that have one, in J.
pub fn energy(body: &Gyrostat, torques: &[Torque], state: &Phase) -> f64 {
    body.kinetic(state.momentum) + torques.iter().filter_map(|t| t.potential(body, state)).sum::<f64>()
}

/// Whether a law exerts a torque; a wheel belongs to the body.
fn acts(torque: &Torque) -> bool {
    let nothing = Vector::default();
    match torque {
        Torque::Wheel(_) | Torque::Wheels(_) => false,
        Torque::Heavy(c) | Torque::Larmor(c) => *c != nothing,
        Torque::ConstantBody(torque) | Torque::ConstantSpace(torque) => torque.dual() != nothing,
        Torque::Magnetic { dipole, field } => *dipole != nothing && *field != nothing,
        Torque::GravityGradient(orbit) => orbit.rate() != 0.0,
        Torque::Damping(rate) | Torque::QuadraticDamping(rate) => *rate != 0.0,
        Torque::ViscousDamping(gains) => !gains.is_zero(),
        Torque::TorsionSpring { stiffness, .. } => *stiffness != 0.0,
        Torque::Control { stiffness, damping, .. } => !(stiffness.is_zero() && damping.is_zero()),
        Torque::Registered(law) => law.size != 0.0,
        Torque::Tabulated(_) | Torque::Formula(_) | Torque::Function(_) => true,
    }
}

/// Whether the law does no work beyond its potential. `ω·(L x b)` vanishes where L and ω are parallel.
fn is_conservative(torque: &Torque, body: &Gyrostat) -> bool {
    match torque {
        Torque::Heavy(_) | Torque::Magnetic { .. } | Torque::TorsionSpring { .. } => true,
        Torque::Registered(law) => law.potential.is_some(),
        Torque::Larmor(_) => body.wheel == Default::default() && (0..3).all(|k| is_symmetric(body, k)),
        _ => false,
    }
}

/// The axis of space about which a law has no torque.
fn axis(torque: &Torque) -> Option<Vector> {
    match torque {
        Torque::Heavy(_) => Some(E3),
        Torque::Magnetic { field, .. } => Some(*field),
        Torque::Larmor(b) => Some(*b),
        Torque::Registered(law) => law.axis,
        _ => None,
    }
}

/// The unit axis that all laws share; e3 rather than −e3.
fn shared_axis<'a>(mut acting: impl Iterator<Item = &'a Torque>) -> Option<Vector> {
    let first = axis(acting.next()?)?;
    if !acting.all(|t| axis(t).is_some_and(|other| are_parallel(first, other))) {
        return None;
    }
    if first == E3 {
        return Some(E3);
    }
    let unit = first / first.norm();
    Some(if are_parallel(unit, E3) { E3 } else { unit })
}

fn are_parallel(a: Vector, b: Vector) -> bool {
    a == b || a.cross(b).norm() <= ROUNDING * a.norm() * b.norm()
}

/// Whether the moments about the other two axes are equal.
fn is_symmetric(body: &Gyrostat, axis: usize) -> bool {
    let (a, b) = (body.moments[(axis + 1) % 3], body.moments[(axis + 2) % 3]);
    (a - b).abs() <= ROUNDING * a.max(b)
}

/// The symmetry axis of a body, if no law has a torque about it. For a sphere, the axis of the laws or of the wheel.
fn spin_axis<'a>(body: &Gyrostat, mut acting: impl Iterator<Item = &'a Torque> + Clone) -> Option<Vector> {
    let own = |torque: &Torque| match torque {
        Torque::Heavy(c) => Some(*c),
        Torque::Magnetic { dipole, .. } => Some(*dipole),
        _ => None,
    };
    let wheel = body.wheel.dual();
    let mut symmetric = (0..3).filter(|&k| is_symmetric(body, k));
    let axis = match (symmetric.next(), symmetric.next()) {
        (Some(k), None) => Vector(std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 })),
        (Some(_), Some(_)) => {
            let known = acting.clone().find_map(own).unwrap_or(wheel);
            if known == Vector::default() {
                return None;
            }
            known / known.norm()
        }
        (None, _) => return None,
    };
    let keeps = |torque: &Torque| match torque {
        Torque::Heavy(_) | Torque::Magnetic { .. } => own(torque).is_some_and(|c| are_parallel(c, axis)),
        // u x I(u) is perpendicular to u and to a, for I(u) lies in their plane.
        Torque::GravityGradient(_) => true,
        Torque::ConstantBody(torque) => torque.dual().dot(axis).abs() <= ROUNDING * torque.norm(),
        _ => false,
    };
    (are_parallel(wheel, axis) && acting.all(keeps)).then_some(axis)
}

/// The sum of all laws, which share this axis, if it is one uniform field: gravity, and dipoles in fields.
fn field<'a>(acting: impl Iterator<Item = &'a Torque>, axis: Vector) -> Option<Field> {
    let mut c = Vector::default();
    for torque in acting {
        c += match torque {
            Torque::Heavy(c) => *c,
            Torque::Magnetic { dipole, field } => *dipole * -field.dot(axis),
            _ => return None,
        };
    }
    Some(Field { axis, c })
}

/// The integrals of Kovalevskaya's and of Goryachev's and Chaplygin's tops.
fn of_heavy_body(body: &Gyrostat, field: Field, start: &Phase) -> Option<Conserved> {
    let normal =
        (0..3).find(|&k| is_symmetric(body, k) && body.moments[(k + 1) % 3] > 1.5 * body.moments[k])?;
    let plane = Plane { normal, field };
    if field.c.0[normal].abs() > ROUNDING * field.c.norm() || field.c == Vector::default() {
        return None;
    }
    let ratio = body.moments[(normal + 1) % 3] / body.moments[normal];
    let about = start.rotor.apply_bivector(start.momentum).dual().dot(field.axis);
    if (ratio - 2.0).abs() <= ROUNDING * ratio {
        Some(Conserved::Kovalevskaya(plane))
    } else if (ratio - 4.0).abs() <= ROUNDING * ratio && about.abs() <= ROUNDING * start.momentum.norm() {
        Some(Conserved::GoryachevChaplygin(plane))
    } else {
        None
    }
}

impl Plane {
    /// `(ω1, ω2, ω3)`, `(c1, c2)/i3` and `(γ1, γ2, γ3)`.
    fn components(self, body: &Gyrostat, state: &Phase) -> ([f64; 3], [f64; 2], [f64; 3]) {
        let Plane { normal, field: Field { axis, c } } = self;
        let [i, j] = [(normal + 1) % 3, (normal + 2) % 3];
        let (w, g) = (body.omega(state.momentum).0, state.rotor.reverse().apply(axis).0);
        let weight = [c.0[i], c.0[j]].map(|c| c / body.moments[normal]);
        ([w[i], w[j], w[normal]], weight, [g[i], g[j], g[normal]])
    }

    /// A bound of the squares of rates and of `c/i3`, for the largest kinetic energy.
    fn square_rate(self, body: &Gyrostat, kinetic: f64) -> f64 {
        (2.0 * kinetic + self.field.c.norm()) / body.moments[self.normal]
    }
}

/// Jacobi's integral: one circular orbit, and otherwise only laws with a potential and the axis e3.
fn jacobi<'a>(acting: impl Iterator<Item = &'a Torque>) -> Option<Conserved> {
    let mut rate = None;
    for torque in acting {
        match torque {
            Torque::GravityGradient(orbit) if orbit.is_circular() && rate.is_none() => {
                rate = Some(orbit.rate())
            }
            Torque::Heavy(_) | Torque::Magnetic { .. }
                if axis(torque).is_some_and(|axis| are_parallel(axis, E3)) => {}
            _ => return None,
        }
    }
    rate.map(Conserved::Jacobi)
}
