//! What packages carry: the page of the manual and the completions of shells.

use super::Folder;
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Commands whose help names all options that there are.
const COMMANDS: [&str; 8] =
    ["", "compare", "bench", "tradeoff", "diff", "merge", "farm export", "farm slurm"];

/// All long options that a help text explains.
fn options(help: &str) -> BTreeSet<String> {
    let starts = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let words = starts.flat_map(|line| line.split([' ', ',']).filter(|word| word.starts_with("--")).take(1));
    words.map(str::to_owned).collect()
}

fn all_options() -> BTreeSet<String> {
    let folder = Folder::new();
    let help = |command: &&str| folder.run(&format!("{command} --help")).stdout;
    COMMANDS.iter().map(help).flat_map(|help| options(&help)).collect()
}

#[test]
fn the_manual_has_all_options_and_commands() {
    let ended = Folder::new().run("man");
    ended.succeeds();
    // A minus sign is escaped, so that it can be copied out of the page.
    let page = ended.stdout.replace("\\-", "-");
    let expected = all_options();
    assert!(expected.len() > 50, "{expected:?}");
    for option in expected {
        assert!(page.contains(&format!("\\fB{option}\\fR")), "{option} is not in the manual");
    }
    for command in ["gui", "check", "compare", "bench", "tradeoff", "diff", "merge", "farm slurm", "info"] {
        assert!(page.contains(&format!(".SS \"pathtracer {command}\"")), "{command} is not in the manual");
    }
    for heading in ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "EXAMPLES"] {
        assert_eq!(page.lines().filter(|line| *line == format!(".SH {heading}")).count(), 1, "{heading}");
    }
}

/// The README and the guides beside it.
#[test]
fn the_documents_name_all_options() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text: String = ["README.md", "docs/settings.md", "docs/measuring.md"]
        .map(|name| std::fs::read_to_string(root.join(name)).expect(name))
        .concat();
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '-').collect();
    for option in all_options() {
        // Those of clap itself need no words.
        let is_known = ["--help", "--version"].contains(&option.as_str());
        assert!(is_known || words.contains(&option.as_str()), "{option} is in no document");
    }
}

#[test]
fn completions_have_all_options_of_a_render() {
    let folder = Folder::new();
    let expected = options(&folder.run("--help").stdout);
    for shell in ["bash", "zsh", "fish"] {
        let ended = folder.run(&format!("completions {shell}"));
        ended.succeeds();
        for option in &expected {
            let name = option.trim_start_matches('-');
            assert!(ended.stdout.contains(name), "{option} is not completed by {shell}");
        }
    }
}

#[test]
fn completions_of_bash_are_a_script_that_it_reads() {
    let script = Folder::new().run("completions bash").stdout;
    let mut bash = Command::new("bash").arg("-n").stdin(Stdio::piped()).spawn().expect("bash");
    bash.stdin.take().expect("a pipe").write_all(script.as_bytes()).expect("bash reads");
    assert!(bash.wait().expect("bash ends").success());
}

#[test]
fn completions_of_an_unknown_shell_are_answered_by_the_known_ones() {
    Folder::new().run("completions csh").fails(2, "[possible values: bash, zsh, fish]");
}
