//! Torque laws. A torque is a bivector; its components are those of the axial vector.

use polhode_ga::{Bivector, Rotor, Vector};

const E1: Vector = Vector([1.0, 0.0, 0.0]);
const E2: Vector = Vector([0.0, 1.0, 0.0]);
const E3: Vector = Vector([0.0, 0.0, 1.0]);

/// What turns the body. Vectors and bivectors of the body are in body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Torque {
    /// Uniform gravity along −e3 on a body held at the origin of its axes: `V = c·γ`, `γ = ~R e3 R`, where
    /// `c = m g (centre of mass)`, in N m. The torque is `γ∧c`.
    Heavy(Vector),
    /// The gradient of a central field on a circular orbit of rate `n` (rad/s) in the plane e1e2: with
    /// `u = cos(nt) e1 + sin(nt) e2` from planet to body, axial torque `3n² u x I(u)`.
    GravityGradient(f64),
    /// Constant in body axes, in N m.
    ConstantBody(Bivector),
    /// Constant in space, in N m.
    ConstantSpace(Bivector),
    /// `−g L`, with g in 1/s.
    Damping(f64),
}

impl Torque {
    /// The same law with its body components seen from other body axes: `x' = ~F x F`.
    pub fn in_axes(self, frame: Rotor) -> Torque {
        let back = frame.reverse();
        match self {
            Torque::Heavy(c) => Torque::Heavy(back.apply(c)),
            Torque::ConstantBody(n) => Torque::ConstantBody(back.apply_bivector(n)),
            other => other,
        }
    }

    /// The torque in principal axes, without the part proportional to L ([`Torque::damping_rate`]).
    pub fn in_body(self, moments: [f64; 3], rotor: Rotor, time: f64) -> Bivector {
        match self {
            Torque::Heavy(c) => rotor.reverse().apply(E3).wedge(c),
            Torque::GravityGradient(n) => {
                let u = rotor.reverse().apply(radial(n, time));
                u.wedge(stretched(moments, u)) * (3.0 * n * n)
            }
            Torque::ConstantBody(torque) => torque,
            Torque::ConstantSpace(torque) => rotor.reverse().apply_bivector(torque),
            Torque::Damping(_) => Bivector::default(),
        }
    }

    /// The g of the part `−g L`, in 1/s.
    pub fn damping_rate(self) -> f64 {
        if let Torque::Damping(g) = self { g } else { 0.0 }
    }

    /// Largest torque it can exert, in N m: a scale for steps.
    pub fn size(self, moments: [f64; 3]) -> f64 {
        match self {
            Torque::Heavy(c) => c.norm(),
            Torque::GravityGradient(n) => 3.0 * n * n * moments.iter().fold(0.0, |m: f64, x| m.max(*x)),
            Torque::ConstantBody(torque) | Torque::ConstantSpace(torque) => torque.norm(),
            Torque::Damping(_) => 0.0,
        }
    }
}

/// The direction from planet to body.
fn radial(n: f64, time: f64) -> Vector {
    let (sin, cos) = (n * time).sin_cos();
    E1 * cos + E2 * sin
}

/// The inertia matrix on a vector in principal axes.
fn stretched(moments: [f64; 3], u: Vector) -> Vector {
    Vector([0, 1, 2].map(|k| moments[k] * u.0[k]))
}

/// A quantity that the motion conserves exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conserved {
    /// Kinetic plus potential energy, in J.
    Energy,
    /// |L|, in kg m²/s.
    AngularMomentum,
    /// The component of L in the plane e1e2 of space (about e3), in kg m²/s.
    VerticalAngularMomentum,
    /// `½ω·Iω − n L·N + (3/2) n² u·I(u)` of a satellite on a circular orbit, N the orbit normal, in J.
    Jacobi,
}

impl Conserved {
    /// What a set of laws leaves constant.
    pub fn under(torques: &[Torque]) -> Vec<Conserved> {
        match torques {
            [] => vec![Conserved::Energy, Conserved::AngularMomentum],
            [Torque::GravityGradient(_)] => vec![Conserved::Jacobi],
            _ if torques.iter().all(|t| matches!(t, Torque::Heavy(_))) => {
                vec![Conserved::Energy, Conserved::VerticalAngularMomentum]
            }
            _ => Vec::new(),
        }
    }

    /// Its name in reports and files.
    pub fn name(self) -> &'static str {
        match self {
            Conserved::Energy => "energy",
            Conserved::AngularMomentum => "angular_momentum",
            Conserved::VerticalAngularMomentum => "vertical_angular_momentum",
            Conserved::Jacobi => "jacobi_integral",
        }
    }

    /// Its value, in principal axes.
    pub fn value(self, moments: [f64; 3], torques: &[Torque], state: &Phase) -> f64 {
        match self {
            Conserved::Energy => energy(moments, torques, state),
            Conserved::AngularMomentum => state.momentum.norm(),
            Conserved::VerticalAngularMomentum => state.rotor.apply_bivector(state.momentum).0[2],
            Conserved::Jacobi => {
                let n = torques.iter().find_map(|t| match t {
                    Torque::GravityGradient(n) => Some(*n),
                    _ => None,
                });
                let n = n.unwrap_or(0.0);
                let u = state.rotor.reverse().apply(radial(n, state.time));
                let vertical = state.rotor.apply_bivector(state.momentum).0[2];
                kinetic(moments, state.momentum) - n * vertical + 1.5 * n * n * u.dot(stretched(moments, u))
            }
        }
    }

    /// The size against which a change counts: that of the terms that make it up, at the start.
    pub fn scale(self, moments: [f64; 3], torques: &[Torque], start: &Phase) -> f64 {
        let kinetic = kinetic(moments, start.momentum);
        match self {
            Conserved::Energy | Conserved::Jacobi => {
                kinetic + torques.iter().map(|t| t.size(moments)).sum::<f64>()
            }
            Conserved::AngularMomentum | Conserved::VerticalAngularMomentum => start.momentum.norm(),
        }
    }
}

/// A point of the motion in principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// From principal axes to space.
    pub rotor: Rotor,
    /// Angular momentum in principal axes, kg m²/s.
    pub momentum: Bivector,
    /// Time in s.
    pub time: f64,
}

/// `I(Ω)` in principal axes.
pub fn angular_momentum(moments: [f64; 3], omega: Bivector) -> Bivector {
    Bivector([0, 1, 2].map(|k| moments[k] * omega.0[k]))
}

/// `I⁻¹(L)` in principal axes, for positive moments.
pub fn angular_velocity(moments: [f64; 3], momentum: Bivector) -> Bivector {
    Bivector([0, 1, 2].map(|k| momentum.0[k] / moments[k]))
}

/// `½ L·I⁻¹(L)`.
pub fn kinetic(moments: [f64; 3], momentum: Bivector) -> f64 {
    let term = |k: usize| if momentum.0[k] == 0.0 { 0.0 } else { momentum.0[k] * momentum.0[k] / moments[k] };
    0.5 * (term(0) + term(1) + term(2))
}

/// Kinetic energy and the potential energy of gravity, in J.
pub fn energy(moments: [f64; 3], torques: &[Torque], state: &Phase) -> f64 {
    let potential = torques.iter().map(|t| match t {
        Torque::Heavy(c) => state.rotor.reverse().apply(E3).dot(*c),
        _ => 0.0,
    });
    kinetic(moments, state.momentum) + potential.sum::<f64>()
}
