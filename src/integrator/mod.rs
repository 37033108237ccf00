//! How much light arrives?

mod counters;
mod numbers;
mod path;

pub use counters::{Counters, FixedSum};
pub use path::PathTracer;
