//! Syntax: from the text of a formula to its tree.

pub(crate) mod commands;
pub(crate) mod grades;
pub(crate) mod indices;
pub(crate) mod letters;
pub(crate) mod names;
pub(crate) mod number;
pub(crate) mod parser;
pub(crate) mod reading;
pub(crate) mod token;
pub(crate) mod tree;
