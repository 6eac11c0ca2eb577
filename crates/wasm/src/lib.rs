//! The core in the browser.

pub mod json;
