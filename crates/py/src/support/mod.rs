//! Arrays and texts between Python and the core.

pub(crate) mod arrays;
pub(crate) mod face;
pub(crate) mod pool;
pub(crate) mod text;
