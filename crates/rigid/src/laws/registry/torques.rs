//! Every torque law that is made of arguments.

use super::Shape::{Bivectors, Gains as Factors, Numbers, Scalar, Vector as Components, Word};
use super::{Argument, Entry, Kernel, Limit, Shape, TABLE, argument, direction, three};
use crate::error::TorqueError;
use crate::laws::torque::{Gains, Orbit, Torque};
use crate::units::Quantity;
use polhode_ga::{Bivector, Rotor, Vector};

/// An attitude, the identity by default.
const fn attitude(name: &'static str) -> Argument {
    Argument { quantity: None, ..argument(name, name, Quantity::Angle, Shape::Rotor) }
        .or(&[1.0, 0.0, 0.0, 0.0])
}

fn rotor(numbers: &[f64]) -> Result<Rotor, TorqueError> {
    let components = numbers.try_into().unwrap_or_default();
    Rotor::from_components(components).map_err(|error| TorqueError(error.to_string()))
}

/// Every torque law, in the order in which messages name them.
pub static TORQUES: [Entry<Torque>; 14] = [
    Entry {
        name: "damping",
        label: "Damping",
        formula: "-g I(Ω)",
        arguments: &[argument("g", "", Quantity::DecayRate, Scalar)],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::Damping(x[0])),
            numbers: numbers!(Torque::Damping(g) => vec![*g]),
        },
    },
    Entry {
        name: "quadratic_damping",
        label: "Quadratic damping",
        formula: "-k norm(Ω) Ω",
        arguments: &[argument("k", "", Quantity::QuadraticRotaryDamping, Scalar).not_negative()],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::QuadraticDamping(x[0])),
            numbers: numbers!(Torque::QuadraticDamping(k) => vec![*k]),
        },
    },
    Entry {
        name: "viscous_damping",
        label: "Viscous damping",
        formula: "-d(Ω)",
        arguments: &[argument("d", "", Quantity::RotaryDamping, Factors).not_negative()],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::ViscousDamping(Gains::new(three(x, 0)))),
            numbers: numbers!(Torque::ViscousDamping(d) => d.along().to_vec()),
        },
    },
    Entry {
        name: "gravity_gradient",
        label: "Gravity gradient",
        formula: "3 n^2 (a/r)^3 u × I(u)",
        arguments: &[
            Argument { period: "period", ..argument("n", "rate", Quantity::AngularRate, Scalar) },
            Argument {
                quantity: None,
                limit: Limit::Eccentricity,
                ..argument("eccentricity", "eccentricity", Quantity::Angle, Scalar).or(&[0.0])
            },
            argument("mean_anomaly", "mean_anomaly", Quantity::Angle, Scalar).or(&[0.0]),
        ],
        kernel: Kernel::Native {
            build: |x| Orbit::new(x[0], x[1], x[2]).map(Torque::GravityGradient),
            numbers: numbers!(Torque::GravityGradient(orbit) =>
                vec![orbit.rate(), orbit.eccentricity(), orbit.anomaly()]),
        },
    },
    Entry {
        name: "constant_body",
        label: "Constant in the body",
        formula: "N",
        arguments: &[argument("N", "", Quantity::Torque, Shape::Bivector)],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::ConstantBody(Bivector(three(x, 0)))),
            numbers: numbers!(Torque::ConstantBody(torque) => torque.0.to_vec()),
        },
    },
    Entry {
        name: "constant_space",
        label: "Constant in space",
        formula: "~R N R",
        arguments: &[argument("N", "", Quantity::Torque, Shape::Bivector)],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::ConstantSpace(Bivector(three(x, 0)))),
            numbers: numbers!(Torque::ConstantSpace(torque) => torque.0.to_vec()),
        },
    },
    Entry {
        name: "magnetic",
        label: "Magnetic dipole",
        formula: "dipole∧(~R field R)",
        arguments: &[
            argument("dipole", "dipole", Quantity::MagneticDipole, Components),
            argument("field", "field", Quantity::MagneticField, Components),
        ],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::Magnetic { dipole: Vector(three(x, 0)), field: Vector(three(x, 1)) }),
            numbers: numbers!(Torque::Magnetic { dipole, field } => [dipole.0, field.0].concat()),
        },
    },
    Entry {
        name: "torsion_spring",
        label: "Torsion spring",
        formula: "k ⟨log((~rest R)^2)⟩_2",
        arguments: &[argument("k", "stiffness", Quantity::TorsionalStiffness, Scalar), attitude("rest")],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::TorsionSpring { stiffness: x[0], rest: rotor(&x[1..])? }),
            numbers: numbers!(Torque::TorsionSpring { stiffness, rest } =>
                [&[*stiffness][..], &rest.components()].concat()),
        },
    },
    Entry {
        name: "gyrostat",
        label: "Wheel",
        formula: "Ω×h",
        arguments: &[argument("h", "", Quantity::AngularMomentum, Shape::Bivector)],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::Wheel(Bivector(three(x, 0)))),
            numbers: numbers!(Torque::Wheel(h) => h.0.to_vec()),
        },
    },
    Entry {
        name: "pd_control",
        label: "PD control",
        formula: "kp(⟨log((~target R)^2)⟩_2) - kd(Ω)",
        arguments: &[
            argument("kp", "kp", Quantity::TorsionalStiffness, Factors).not_negative(),
            argument("kd", "kd", Quantity::RotaryDamping, Factors).not_negative(),
            attitude("target"),
        ],
        kernel: Kernel::Native {
            build: |x| {
                let (stiffness, damping) = (Gains::new(three(x, 0)), Gains::new(three(x, 1)));
                Ok(Torque::Control { stiffness, damping, target: rotor(&x[6..])? })
            },
            numbers: numbers!(Torque::Control { stiffness, damping, target } =>
                [&stiffness.along()[..], &damping.along(), &target.components()].concat()),
        },
    },
    Entry {
        name: "larmor",
        label: "Larmor",
        formula: "dual(L_B)∧(~R b R)",
        arguments: &[argument("b", "", Quantity::AngularRate, Components)],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::Larmor(Vector(three(x, 0)))),
            numbers: numbers!(Torque::Larmor(b) => b.0.to_vec()),
        },
    },
    // The "cannonball": a sphere of this cross-section takes up the momentum of sunlight, whatever its attitude, at the
    // centre of its surface (O. Montenbruck and E. Gill, Satellite Orbits, Springer 2000, sec. 3.4).
    Entry {
        name: "radiation_pressure",
        label: "Radiation pressure",
        formula: "-(coefficient pressure area) offset∧(~R sun R)/norm(sun)",
        arguments: &[
            argument("area", "area", Quantity::Area, Scalar).not_negative(),
            argument("offset", "offset", Quantity::Length, Components),
            direction("sun"),
            Argument {
                quantity: None,
                ..argument("coefficient", "coefficient", Quantity::Area, Scalar).not_negative().or(&[1.0])
            },
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
            argument("kind", "kind", Quantity::Torque, Word(&["linear", "cubic"])).or(&[]),
        ],
        kernel: Kernel::Table,
    },
    Entry {
        name: "heavy",
        label: "Gravity",
        formula: "(~R e3 R)∧c",
        arguments: &[argument("c", "", Quantity::Torque, Components)],
        kernel: Kernel::Native {
            build: |x| Ok(Torque::Heavy(Vector(three(x, 0)))),
            numbers: numbers!(Torque::Heavy(c) => c.0.to_vec()),
        },
    },
];
