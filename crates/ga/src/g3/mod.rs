//! The typed values of 3-d space and their functions.

pub mod attitude;
pub(crate) mod complex;
pub mod functions;
pub mod pauli;
pub mod rotor;
pub mod values;
