//! Registry of forces.

use super::Shape::{Scalar, Vector as Components};
use super::{Entry, Kernel, argument, three};
use crate::laws::force::{Force, Push};
use crate::units::Quantity;
use polhode_ga::Vector;

/// Every force, in the order in which messages name them.
pub static FORCES: [Entry<Push>; 6] = [
    native!("constant", "Constant", "F", [argument("F", "", Quantity::Force, Components)],
        |x| Ok(Force::Constant(Vector(three(x, 0))).into()),
        Push { force: Force::Constant(force), .. } => force.0.to_vec()),
    native!("drag", "Drag", "-k v", [argument("k", "", Quantity::Drag, Scalar)],
        |x| Ok(Force::Drag(x[0]).into()), Push { force: Force::Drag(k), .. } => vec![*k]),
    native!("quadratic_drag", "Quadratic drag", "-k norm(v) v",
        [argument("k", "", Quantity::QuadraticDrag, Scalar).not_negative()],
        |x| Ok(Force::QuadraticDrag(x[0]).into()), Push { force: Force::QuadraticDrag(k), .. } => vec![*k]),
    native!("spring", "Spring", "-k (x - anchor)",
        [argument("k", "stiffness", Quantity::Stiffness, Scalar),
            argument("anchor", "anchor", Quantity::Length, Components).or(&[0.0; 3])],
        |x| Ok(Force::Spring(x[0], Vector([x[1], x[2], x[3]])).into()),
        Push { force: Force::Spring(k, anchor), .. } => [&[*k][..], &anchor.0].concat()),
    native!("central", "Attracting centre", "-mu m x/norm(x)^3",
        [argument("mu", "", Quantity::GravitationalParameter, Scalar)],
        |x| Ok(Force::Central(x[0]).into()), Push { force: Force::Central(mu), .. } => vec![*mu]),
    native!("thrust", "Thrust", "R F ~R",
        [argument("F", "force", Quantity::Force, Components),
            argument("at", "at", Quantity::Length, Components).or(&[])],
        |x| {
            let at = (x.len() > 3).then(|| Vector(three(x, 1)));
            Ok(Push { force: Force::Body(Vector(three(x, 0))), at })
        },
        Push { force: Force::Body(force), at } => force.0.into_iter().chain(at.iter().flat_map(|at| at.0)).collect()),
];
