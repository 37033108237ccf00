//! What several topics need.

pub(crate) mod build;
pub(crate) mod double_double;
pub(crate) mod stats;
