//! The program: parse, run, print one error, exit code.

use std::env;
use std::ffi::OsString;
use std::process::ExitCode;

use pathtracer::{cli, gui};

fn main() -> ExitCode {
    let arguments: Vec<OsString> = env::args_os().collect();
    let code = cli::run(&arguments, &gui::open).unwrap_or_else(|error| cli::report(&error, &arguments));
    ExitCode::from(code)
}
