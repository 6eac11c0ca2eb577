//! Motions in closed form.

pub(crate) mod center;
pub mod damped;
pub mod flow;
pub mod free;
pub mod lagrange;
pub(crate) mod lanes;
pub mod larmor;
pub mod many;
pub mod motion;
pub mod regime;
pub mod symmetric;
