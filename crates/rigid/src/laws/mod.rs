//! Torque laws, forces, conserved quantities and events.

pub mod conserved;
pub(crate) mod driven_wheels;
pub mod event;
pub mod force;
pub(crate) mod forcing;
pub mod formula;
pub mod registry;
pub mod torque;
