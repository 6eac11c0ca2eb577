//! Arrays, texts and facts between Python and the core.

pub(crate) mod arrays;
pub(crate) mod face;
pub(crate) mod facts;
pub(crate) mod interrupts;
pub(crate) mod pool;
pub(crate) mod text;
