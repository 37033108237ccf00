//! What the scene file says.

pub mod desc;
