//! How much light arrives, and what is seen?

mod caustic;
mod counters;
mod features;
mod numbers;
mod path;

pub use counters::{Counters, FixedSum};
pub use features::{FeatureTracer, Features};
pub use path::PathTracer;
