//! Torque laws, forces, conserved quantities and events.

pub mod conserved;
pub mod event;
pub mod force;
pub(crate) mod forcing;
pub mod formula;
pub(crate) mod motors;
pub mod registry;
pub mod torque;
