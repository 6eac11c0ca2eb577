//! Motions in closed form.

pub mod damped;
pub mod free;
pub mod lagrange;
pub mod larmor;
pub mod regime;
pub mod symmetric;
