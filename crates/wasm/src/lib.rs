//! The core in the browser: the same motion and the same algebra as in Python, behind plain exports.
//!
//! [`opened`] runs a scene, [`about`] describes its motion, [`acting`] what acts on the body, [`opened::crowd`] runs an ensemble for display, [`recorded`]
//! holds a motion that was computed elsewhere, `merged` replaces tables of a scene, and [`formulas`] evaluates lines.
//! `viewer/src/core/wasm.ts` calls the exports.

pub mod about;
pub mod acting;
mod exports;
pub mod formulas;
pub mod laws;
mod merged;
pub mod opened;
pub mod recorded;
mod rows;
#[cfg(test)]
mod tests;
