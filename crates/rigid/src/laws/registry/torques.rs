//! Registry of torque laws.

use super::Shape::{Bivectors, Gains as Factors, Numbers, Scalar, Vector as Components, Word};
use super::{Argument, Entry, Kernel, Limit, Shape, TABLE, argument, pure, three};
use crate::error::TorqueError;
use crate::laws::torque::{Gains, Kind, Orbit, Torque};
use crate::units::Quantity;
use polhode_ga::{Bivector, Rotor, Vector};

/// An attitude, the identity by default.
const fn attitude(name: &'static str) -> Argument {
    pure(name, Shape::Rotor).or(&[1.0, 0.0, 0.0, 0.0])
}

fn rotor(numbers: &[f64]) -> Result<Rotor, TorqueError> {
    let components = numbers.try_into().unwrap_or_default();
    Rotor::from_components(components).map_err(|error| TorqueError::new(error.to_string()))
}

/// Every torque law, in the order in which messages name them.
pub static TORQUES: [Entry<Torque>; 14] = [
    native!("damping", "Damping", "-g I(Ω)", [argument("g", "", Quantity::DecayRate, Scalar)],
        |x| Ok(Torque::Damping(x[0])), Torque::Damping(g) => vec![*g]),
    native!("quadratic_damping", "Quadratic damping", "-k norm(Ω) Ω",
        [argument("k", "", Quantity::QuadraticRotaryDamping, Scalar).not_negative()],
        |x| Ok(Torque::QuadraticDamping(x[0])), Torque::QuadraticDamping(k) => vec![*k]),
    native!("viscous_damping", "Viscous damping", "-d(Ω)",
        [argument("d", "", Quantity::RotaryDamping, Factors).not_negative()],
        |x| Ok(Torque::ViscousDamping(Gains::new(three(x, 0)))), Torque::ViscousDamping(d) => d.along().to_vec()),
    native!("gravity_gradient", "Gravity gradient", "3 n^2 (a/r)^3 u × I(u)",
        [Argument { period: "period", ..argument("n", "rate", Quantity::AngularRate, Scalar) },
            Argument { limit: Limit::Eccentricity, ..pure("eccentricity", Scalar).or(&[0.0]) },
            argument("mean_anomaly", "mean_anomaly", Quantity::Angle, Scalar).or(&[0.0])],
        |x| Orbit::new(x[0], x[1], x[2]).map(Torque::GravityGradient),
        Torque::GravityGradient(orbit) => vec![orbit.rate(), orbit.eccentricity(), orbit.anomaly()]),
    native!("constant_body", "Constant in the body", "N", [argument("N", "", Quantity::Torque, Shape::Bivector)],
        |x| Ok(Torque::ConstantBody(Bivector(three(x, 0)))), Torque::ConstantBody(torque) => torque.0.to_vec()),
    native!("constant_space", "Constant in space", "~R N R", [argument("N", "", Quantity::Torque, Shape::Bivector)],
        |x| Ok(Torque::ConstantSpace(Bivector(three(x, 0)))), Torque::ConstantSpace(torque) => torque.0.to_vec()),
    native!("magnetic", "Magnetic dipole", "dipole∧(~R field R)",
        [argument("dipole", "dipole", Quantity::MagneticDipole, Components),
            argument("field", "field", Quantity::MagneticField, Components)],
        |x| Ok(Torque::Magnetic { dipole: Vector(three(x, 0)), field: Vector(three(x, 1)) }),
        Torque::Magnetic { dipole, field } => [dipole.0, field.0].concat()),
    native!("torsion_spring", "Torsion spring", "k ⟨log((~rest R)^2)⟩_2",
        [argument("k", "stiffness", Quantity::TorsionalStiffness, Scalar), attitude("rest")],
        |x| Ok(Torque::TorsionSpring { stiffness: x[0], rest: rotor(&x[1..])? }),
        Torque::TorsionSpring { stiffness, rest } => [&[*stiffness][..], &rest.components()].concat()),
    native!("gyrostat", "Wheel", "Ω×h", [argument("h", "", Quantity::AngularMomentum, Shape::Bivector)],
        |x| Ok(Torque::Wheel(Bivector(three(x, 0)))), Torque::Wheel(h) => h.0.to_vec()),
    native!("pd_control", "PD control", "kp(⟨log((~target R)^2)⟩_2) - kd(Ω)",
        [argument("kp", "kp", Quantity::TorsionalStiffness, Factors).not_negative(),
            argument("kd", "kd", Quantity::RotaryDamping, Factors).not_negative(), attitude("target")],
        |x| {
            let (stiffness, damping) = (Gains::new(three(x, 0)), Gains::new(three(x, 1)));
            Ok(Torque::Control { stiffness, damping, target: rotor(&x[6..])? })
        },
        Torque::Control { stiffness, damping, target } =>
            [&stiffness.along()[..], &damping.along(), &target.components()].concat()),
    native!("larmor", "Larmor", "dual(L_B)∧(~R b R)", [argument("b", "", Quantity::AngularRate, Components)],
        |x| Ok(Torque::Larmor(Vector(three(x, 0)))), Torque::Larmor(b) => b.0.to_vec()),
    // The "cannonball": a sphere of this cross-section takes up the momentum of sunlight, whatever its attitude, at the
    // centre of its surface (O. Montenbruck and E. Gill, Satellite Orbits, Springer 2000, sec. 3.4).
    Entry {
        name: "radiation_pressure",
        label: "Radiation pressure",
        formula: "-(coefficient pressure area) offset∧(~R sun R)/norm(sun)",
        arguments: &[
            argument("area", "area", Quantity::Area, Scalar).not_negative(),
            argument("offset", "offset", Quantity::Length, Components),
            Argument { limit: Limit::NotZero, ..pure("sun", Components) },
            pure("coefficient", Scalar).not_negative().or(&[1.0]),
            argument("pressure", "pressure", Quantity::Pressure, Scalar).not_negative().or(&[4.56e-6]),
        ],
        kernel: Kernel::Formula {
            size: "coefficient pressure area norm(offset)",
            potential: "(coefficient pressure area) offset·(~R sun R)/norm(sun)",
            axis: "sun",
        },
    },
    Entry {
        name: TABLE,
        label: "Table",
        formula: "",
        arguments: &[
            argument("times", "times", Quantity::Time, Numbers),
            argument("torques", "torques", Quantity::Torque, Bivectors),
            argument("frame", "frame", Quantity::Torque, Word(&["body", "space"])).or(&[]),
            argument("kind", "kind", Quantity::Torque, Word(Kind::NAMES)).or(&[]),
        ],
        kernel: Kernel::Table,
    },
    native!("heavy", "Gravity", "(~R e3 R)∧c", [argument("c", "", Quantity::Torque, Components)],
        |x| Ok(Torque::Heavy(Vector(three(x, 0)))), Torque::Heavy(c) => c.0.to_vec()),
];
