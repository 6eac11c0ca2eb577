//! A point of a motion: body, attitude, momentum and centre of mass.

pub mod carried;
pub mod center;
pub mod checks;
pub mod phase;
pub mod point;
