//! See `fuzz/checks/geometry.rs`.
#![no_main]

#[path = "../checks/geometry.rs"]
mod geometry;
mod support;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| geometry::check(support::folder(), bytes));
