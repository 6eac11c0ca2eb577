//! Bodies, laws and motions.

pub(crate) mod bodies;
pub(crate) mod closed_forms;
pub(crate) mod columns;
pub(crate) mod ensemble;
pub(crate) mod flow;
pub(crate) mod free;
pub(crate) mod laws;
pub(crate) mod made;
pub(crate) mod motion;
pub(crate) mod simulation;
pub(crate) mod torque;
