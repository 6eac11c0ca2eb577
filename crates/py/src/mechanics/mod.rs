//! Bodies, laws and motions.

pub(crate) mod bodies;
pub(crate) mod closed_form;
pub(crate) mod closed_forms;
pub(crate) mod columns;
pub(crate) mod ensemble;
pub(crate) mod flow;
pub(crate) mod forces_and_events;
pub(crate) mod free;
pub(crate) mod law_value;
pub(crate) mod simulation;
pub(crate) mod stepper;
pub(crate) mod surfaces;
pub(crate) mod torque;
