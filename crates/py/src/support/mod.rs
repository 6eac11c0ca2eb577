//! Arrays, texts and facts between Python and the core.

pub(crate) mod arrays;
pub(crate) mod facts;
pub(crate) mod interrupts;
pub(crate) mod pool;
pub(crate) mod python_objects;
pub(crate) mod text;
