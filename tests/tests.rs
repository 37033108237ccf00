//! One test binary; `cargo test TOPIC` runs one topic, named as its module here.

/// Embree: the oracle's hits at exact, the promises of robust and fast, refusals.
#[cfg(feature = "embree")]
mod embree;

/// Every light against its density.
mod lights;
/// Light transport against closed forms: furnaces, lights of every shape, the sky.
mod transport;
