//! The algebra over rows of numbers.

pub mod compose;
pub mod curve;
pub mod product;
pub mod rotor_functions;
pub(crate) mod tiles;
pub(crate) mod written;
