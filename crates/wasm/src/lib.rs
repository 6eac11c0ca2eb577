//! The core in the browser.

pub mod formulas;
pub mod json;
