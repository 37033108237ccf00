//! See `fuzz/checks/film.rs`.
#![no_main]

#[path = "../checks/film.rs"]
mod film;
mod support;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| film::check(support::folder(), bytes));
