//! See `fuzz/checks/mtl.rs`.
#![no_main]

#[path = "../checks/mtl.rs"]
mod mtl;
mod support;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| mtl::check(support::folder(), bytes));
