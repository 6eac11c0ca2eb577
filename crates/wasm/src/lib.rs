//! The core in the browser: the same motion and the same algebra as in Python, behind plain exports.
//!
//! [`opened`] follows a scene, [`about`] tells what is known of the motion, [`opened::crowd`] follows an ensemble for
//! looking, [`recorded`] holds a motion that was followed elsewhere, [`merged`] changes tables of a scene, [`formulas`] evaluates
//! lines; [`json`] is the text in which the page gets what is not an array. `viewer/src/core/wasm.ts` is the other side
//! of the exports.

pub mod about;
mod exports;
pub mod formulas;
pub mod json;
pub mod laws;
mod merged;
pub mod opened;
pub mod recorded;
mod rows;
#[cfg(test)]
mod tests;
