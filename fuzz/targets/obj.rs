//! See `fuzz/checks/obj.rs`.
#![no_main]

#[path = "../checks/obj.rs"]
mod obj;
mod support;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| obj::check(support::folder(), bytes));
