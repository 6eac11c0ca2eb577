//! A law as the call that would make it.

use super::Torque;

/// An argument of a law.
#[derive(Clone, Debug, PartialEq)]
pub enum Argument {
    /// A number.
    One(f64),
    /// Several, the components of a vector, a bivector or a rotor among them.
    Row(Vec<f64>),
}

impl Torque {
    /// The function of Python's `polhode.torque` that makes this law, if it is one of numbers alone, and its arguments.
    pub fn call(&self) -> Option<(&'static str, Vec<Argument>)> {
        use Argument::One;
        let row = |numbers: &[f64]| Argument::Row(numbers.to_vec());
        Some(match self {
            Torque::Heavy(c) => ("heavy", vec![row(&c.0)]),
            Torque::GravityGradient(orbit) => {
                let (rate, eccentricity, anomaly) = (orbit.rate(), orbit.eccentricity(), orbit.anomaly());
                ("gravity_gradient", vec![One(rate), One(eccentricity), One(anomaly)])
            }
            Torque::ConstantBody(torque) => ("constant_body", vec![row(&torque.0)]),
            Torque::ConstantSpace(torque) => ("constant_space", vec![row(&torque.0)]),
            Torque::Damping(g) => ("damping", vec![One(*g)]),
            Torque::QuadraticDamping(k) => ("quadratic_damping", vec![One(*k)]),
            Torque::ViscousDamping(d) => ("viscous_damping", vec![row(&d.along())]),
            Torque::Magnetic { dipole, field } => ("magnetic", vec![row(&dipole.0), row(&field.0)]),
            Torque::TorsionSpring { stiffness, rest } => {
                ("torsion_spring", vec![One(*stiffness), row(&rest.components())])
            }
            Torque::Wheel(h) => ("gyrostat", vec![row(&h.0)]),
            Torque::Control { stiffness, damping, target } => (
                "pd_control",
                vec![row(&stiffness.along()), row(&damping.along()), row(&target.components())],
            ),
            Torque::Larmor(b) => ("larmor", vec![row(&b.0)]),
            Torque::Tabulated(_) | Torque::Formula(_) | Torque::Function(_) => return None,
        })
    }
}
