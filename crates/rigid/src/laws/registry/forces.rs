//! Every force that is made of arguments.

use super::Shape::{Scalar, Vector as Components};
use super::{Entry, Kernel, argument, three};
use crate::laws::force::{Force, Push};
use crate::units::Quantity;
use polhode_ga::Vector;

/// Every force, in the order in which messages name them.
pub static FORCES: [Entry<Push>; 6] = [
    Entry {
        name: "constant",
        label: "Constant",
        formula: "F",
        arguments: &[argument("F", "", Quantity::Force, Components)],
        kernel: Kernel::Native {
            build: |x| Ok(Force::Constant(Vector(three(x, 0))).into()),
            numbers: numbers!(Push { force: Force::Constant(force), .. } => force.0.to_vec()),
        },
    },
    Entry {
        name: "drag",
        label: "Drag",
        formula: "-k v",
        arguments: &[argument("k", "", Quantity::Drag, Scalar)],
        kernel: Kernel::Native {
            build: |x| Ok(Force::Drag(x[0]).into()),
            numbers: numbers!(Push { force: Force::Drag(k), .. } => vec![*k]),
        },
    },
    Entry {
        name: "quadratic_drag",
        label: "Quadratic drag",
        formula: "-k norm(v) v",
        arguments: &[argument("k", "", Quantity::QuadraticDrag, Scalar)],
        kernel: Kernel::Native {
            build: |x| Ok(Force::QuadraticDrag(x[0]).into()),
            numbers: numbers!(Push { force: Force::QuadraticDrag(k), .. } => vec![*k]),
        },
    },
    Entry {
        name: "spring",
        label: "Spring",
        formula: "-k (x - anchor)",
        arguments: &[
            argument("k", "stiffness", Quantity::Stiffness, Scalar),
            argument("anchor", "anchor", Quantity::Length, Components).or(&[0.0; 3]),
        ],
        kernel: Kernel::Native {
            build: |x| Ok(Force::Spring(x[0], Vector([x[1], x[2], x[3]])).into()),
            numbers: numbers!(Push { force: Force::Spring(k, anchor), .. } => [&[*k][..], &anchor.0].concat()),
        },
    },
    Entry {
        name: "central",
        label: "Attracting centre",
        formula: "-mu m x/norm(x)^3",
        arguments: &[argument("mu", "", Quantity::GravitationalParameter, Scalar)],
        kernel: Kernel::Native {
            build: |x| Ok(Force::Central(x[0]).into()),
            numbers: numbers!(Push { force: Force::Central(mu), .. } => vec![*mu]),
        },
    },
    Entry {
        name: "thrust",
        label: "Thrust",
        formula: "R F ~R",
        arguments: &[
            argument("F", "force", Quantity::Force, Components),
            argument("at", "at", Quantity::Length, Components).or(&[]),
        ],
        kernel: Kernel::Native {
            build: |x| {
                let at = (x.len() > 3).then(|| Vector(three(x, 1)));
                Ok(Push { force: Force::Body(Vector(three(x, 0))), at })
            },
            numbers: numbers!(Push { force: Force::Body(force), at } =>
                force.0.into_iter().chain(at.iter().flat_map(|at| at.0)).collect()),
        },
    },
];
