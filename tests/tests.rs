//! One test binary; `cargo test TOPIC` runs one topic, named as its module here.

mod support;

mod material;
mod sampling;
