//! See `fuzz/checks/yaml.rs`.
#![no_main]

#[path = "../checks/yaml.rs"]
mod yaml;
mod support;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| yaml::check(support::folder(), bytes));
