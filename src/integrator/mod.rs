//! How much light arrives?

mod counters;
mod path;

pub use counters::Counters;
pub use path::PathTracer;
