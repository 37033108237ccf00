//! The command line: what was typed, what it means, what is printed, exit codes.
//!
//! Results go to stdout, everything for humans to stderr. Exit codes: 0 done, 1 failure, 2 usage, 3 bad scene,
//! 4 hits or pictures differ, 5 a noise target missed because the time was up, 130 and 143 interrupted.

mod arguments;
mod bench;
mod check;
mod compare;
pub(crate) mod console;
mod describe;
mod diff;
mod event;
mod farm;
mod findings;
mod info;
mod interrupt;
mod keeper;
mod manual;
mod merge;
mod plot_file;
mod progress;
mod render;
mod saving;
mod scaling;
mod studied;
mod tradeoff;

use crate::error::{Error, Result};
use arguments::{Arguments, Command};
use event::Event;
use std::ffi::OsString;
use std::path::Path;

/// Opens the window, maybe with a scene, and comes back when it is closed. [`Error::Unavailable`] says why it can't be opened.
pub type Window = dyn Fn(Option<&Path>) -> Result<()>;

/// Runs the command that the arguments ask for, the program's name first, and returns the exit code.
///
/// # Errors
/// Whatever the command fails with; `main` prints it and chooses the exit code.
pub fn run(arguments: &[OsString], window: &Window) -> anyhow::Result<u8> {
    let Arguments { command, render } = Arguments::parse(arguments)?;
    match command {
        Some(Command::Gui { scene }) => open(window, scene.as_deref()),
        Some(Command::Check { scenes }) => Ok(check::run(&scenes)),
        Some(Command::Compare(arguments)) => compare::run(&arguments.resolve()?),
        Some(Command::Bench(arguments)) => bench::run(&arguments.resolve()?),
        Some(Command::Tradeoff(arguments)) => tradeoff::run(&arguments.resolve()?),
        Some(Command::Diff(arguments)) => diff::run(&arguments),
        Some(Command::Merge(arguments)) => merge::run(&arguments),
        Some(Command::Farm(command)) => farm::run(command),
        Some(Command::Info { file }) => info::run(&file),
        Some(Command::Completions { shell }) => manual::completions(shell),
        Some(Command::Man) => manual::page(),
        None if arguments.len() == 1 => open(window, None),
        None => match (arguments, render.only_scene()) {
            ([_, _], Some(scene)) => open(window, Some(scene)),
            _ => render::run(&render.resolve()?),
        },
    }
}

fn open(window: &Window, scene: Option<&Path>) -> anyhow::Result<u8> {
    match window(scene) {
        Ok(()) => Ok(0),
        Err(Error::Unavailable(why)) => Err(arguments::usage(&why).into()),
        Err(error) => Err(error.into()),
    }
}

/// Prints the error of [`run`], with `--json` among the arguments also as an event, and returns the exit code.
pub fn report(error: &anyhow::Error, arguments: &[OsString]) -> u8 {
    if let Some(error) = error.downcast_ref::<clap::Error>()
        && !error.use_stderr()
    {
        // Help or version was asked for. A reader that has gone away is no failure.
        let _ = error.print();
        return 0;
    }
    let code = exit_code(error);
    if arguments.iter().any(|argument| argument == "--json") {
        event::emit(&Event::error(code, error));
    }
    let is_openjd = |words: &[OsString]| words[0] == "--progress" && words[1] == "openjd";
    if arguments.windows(2).any(is_openjd) || arguments.iter().any(|word| word == "--progress=openjd") {
        progress::openjd("fail", &error.to_string());
    }
    match (error.downcast_ref::<clap::Error>(), error.downcast_ref::<Error>()) {
        (Some(error), _) => drop(error.print()),
        // Each mistake of a scene comes with its own "error:".
        (_, Some(Error::Scene(_))) => console::say(error),
        _ => console::say(format_args!("error: {error}")),
    }
    code
}

fn exit_code(error: &anyhow::Error) -> u8 {
    if error.is::<clap::Error>() {
        return Error::Usage(String::new()).exit_code();
    }
    match error.downcast_ref::<Error>() {
        Some(error @ Error::Interrupted) => interrupt::exit_code().unwrap_or(error.exit_code()),
        Some(error) => error.exit_code(),
        None => 1,
    }
}
