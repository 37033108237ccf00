//! One test binary; `cargo test TOPIC` runs one topic, named as its module here.

/// Light transport against closed forms: furnaces, lights of every shape, the sky.
mod transport;
