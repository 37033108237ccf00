//! How much light arrives?

pub mod caustic;
mod counters;
mod numbers;
mod path;

pub use counters::{Counters, FixedSum};
pub use path::PathTracer;
