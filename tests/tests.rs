//! One test binary; `cargo test TOPIC` runs one topic, named as its module here.

mod accel;
mod support;
