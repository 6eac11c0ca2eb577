//! Arithmetic and functions of numbers.

pub(crate) mod double_double;
pub mod elliptic;
pub(crate) mod exact_sum;
pub(crate) mod lanes;
pub(crate) mod precise;
pub(crate) mod quaternion;
pub(crate) mod sinc;
pub(crate) mod sum;
pub(crate) mod wide;
