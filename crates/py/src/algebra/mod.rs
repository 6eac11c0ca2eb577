//! Multivectors, rotors and their arrays.

pub(crate) mod attitude;
pub(crate) mod batch;
pub(crate) mod multivector;
pub(crate) mod operators;
pub(crate) mod rows;
pub(crate) mod signature;
pub(crate) mod single;
pub(crate) mod slots;
pub(crate) mod types;
pub(crate) mod value;
