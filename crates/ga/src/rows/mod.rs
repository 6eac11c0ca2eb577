//! The algebra over rows of numbers.

pub mod compose;
pub mod curve;
pub(crate) mod fixed_terms;
pub mod motors;
pub mod product;
pub mod rotor_functions;
pub mod signs;
pub(crate) mod tiles;
pub mod versors;
