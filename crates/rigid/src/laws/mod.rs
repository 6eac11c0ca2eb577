//! What acts on a body, what a motion conserves and where it is interrupted.

pub mod conserved;
pub mod event;
pub mod force;
pub(crate) mod forcing;
pub mod formula;
pub mod registry;
pub mod torque;
