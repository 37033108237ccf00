//! `pathtracer man` and `pathtracer completions SHELL`: what packages carry beside the program, made of the definition of the
//! command line itself.

use super::arguments;
use clap::builder::PossibleValue;
use clap::{Arg, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};
use std::io::{self, Write};

const DESCRIPTION: &str = "Renders scenes of balls, boxes, rectangles and OBJ meshes, written in YAML, by path tracing on all cores. \
    Embree and an accelerator of its own give the same picture, byte by byte; so do all numbers of threads. Without \
    arguments, or with a scene alone, a window opens that renders while the scene is changed.";

const EXAMPLES: [(&str, &str); 4] = [
    (
        "A picture of 1280 x 720 pixels with 10 samples each and paths of at most 20 segments:",
        "pathtracer /usr/share/doc/pathtracer/examples/scenes/bigBalls.yaml 1280 720 10 20 bigBalls.png",
    ),
    (
        "As many samples as a relative error of 5 % takes:",
        "pathtracer scene.yaml 800 800 0 8 box.exr --noise 0.05",
    ),
    ("As good as it gets within two minutes:", "pathtracer scene.yaml 800 800 0 8 box.exr --time 2m"),
    ("Everything that is wrong with a scene:", "pathtracer check scene.yaml"),
];

const ENVIRONMENT: [(&str, &str); 3] = [
    ("OIDN_DIR, VIRTUAL_ENV", "Where Open Image Denoise is looked for, for --denoise."),
    ("NO_COLOR", "No colours in the progress."),
    ("DISPLAY, WAYLAND_DISPLAY", "Where the window opens."),
];

const FILES: [(&str, &str); 2] = [
    ("/usr/share/doc/pathtracer/examples", "Sample scenes with their meshes and pictures, of the package."),
    ("~/.config/pathtracer/window.json", "What the window keeps between runs."),
];

/// Prints the page of the manual; returns the exit code.
pub(super) fn page() -> anyhow::Result<u8> {
    io::stdout().lock().write_all(&roff_page()?)?;
    Ok(0)
}

/// Prints the completions of a shell; returns the exit code.
pub(super) fn completions(shell: Shell) -> anyhow::Result<u8> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut arguments::command(), "pathtracer", &mut text);
    io::stdout().lock().write_all(&text)?;
    Ok(0)
}

/// One page for all commands.
fn roff_page() -> io::Result<Vec<u8>> {
    let mut command = in_lines(arguments::command());
    command.build();
    let source = concat!("pathtracer ", env!("CARGO_PKG_VERSION"));
    // An empty date would be left out, and what follows would take its place.
    let man = Man::new(command.clone()).title("PATHTRACER").date(" ").source(source).manual("User Commands");
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    section(&mut page, "DESCRIPTION", &[DESCRIPTION])?;
    man.render_options_section(&mut page)?;
    section(&mut page, "COMMANDS", &[])?;
    for subcommand in command.get_subcommands() {
        describe(&mut page, subcommand, &command)?;
    }
    section(&mut page, "EXIT STATUS", &arguments::EXIT_CODES.lines().collect::<Vec<_>>())?;
    list(&mut page, "ENVIRONMENT", &ENVIRONMENT)?;
    list(&mut page, "FILES", &FILES)?;
    list(&mut page, "EXAMPLES", &EXAMPLES)?;
    Ok(page)
}

/// A command with the names that its options take in one line, not in a list, and so all commands below.
fn in_lines(command: Command) -> Command {
    let with_names = |argument: Arg| {
        let names = argument.get_possible_values();
        if names.is_empty() || !argument.get_action().takes_values() {
            return argument;
        }
        let names: Vec<&str> = names.iter().map(PossibleValue::get_name).collect();
        let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
        argument.help(format!("{help} ({})", names.join(", "))).hide_possible_values(true)
    };
    command.mut_args(with_names).mut_subcommands(in_lines)
}

fn section(page: &mut Vec<u8>, heading: &str, lines: &[&str]) -> io::Result<()> {
    let mut roff = Roff::new();
    roff.control("SH", [heading]);
    for &line in lines {
        roff.text([roman(line)]);
    }
    roff.to_writer(page)
}

fn list(page: &mut Vec<u8>, heading: &str, entries: &[(&str, &str)]) -> io::Result<()> {
    let mut roff = Roff::new();
    roff.control("SH", [heading]);
    for &(term, text) in entries {
        roff.control("TP", []).text([bold(term)]).text([roman(text)]);
    }
    roff.to_writer(page)
}

/// A command with its options, and the commands below it. What is the same as an option of `program` is not told again.
fn describe(page: &mut Vec<u8>, command: &Command, program: &Command) -> io::Result<()> {
    let is_known = |argument: &Arg| program.get_arguments().any(|other| is_same(other, argument));
    let shares = command.get_arguments().any(|argument| argument.is_positional() && is_known(argument));
    let mut roff = Roff::new();
    roff.control("SS", [command.get_bin_name().unwrap_or_else(|| command.get_name())]);
    let also = shares.then_some("Takes the arguments and options of a render too.");
    let texts = [command.get_about(), command.get_after_help()].map(|text| text.map(ToString::to_string));
    for text in texts.into_iter().flatten().chain(also.map(str::to_owned)) {
        for line in text.lines() {
            roff.text([roman(line)]);
        }
        roff.control("PP", []);
    }
    roff.to_writer(page)?;
    let own = command.clone().mut_args(|argument| {
        let is_hidden = argument.is_hide_set() || is_known(&argument);
        argument.hide(is_hidden)
    });
    let mut options = Vec::new();
    Man::new(own).render_options_section(&mut options)?;
    let options = String::from_utf8_lossy(&options);
    // The heading of a section, and what stands before it, is not wanted below the heading of a command.
    let entries = options.split_once(".SH OPTIONS\n").map_or("", |(_, entries)| entries);
    page.write_all(entries.as_bytes())?;
    command.get_subcommands().try_for_each(|below| describe(page, below, program))
}

/// Whether two options have the same name and do the same.
fn is_same(a: &Arg, b: &Arg) -> bool {
    let text = |argument: &Arg| argument.get_help().map(ToString::to_string);
    a.get_id() == b.get_id() && text(a) == text(b)
}
