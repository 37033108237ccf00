//! The order of the modules: each uses only those above it in `lib.rs`.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules that see everything.
const FREE: [&str; 4] = ["render", "study", "cli", "gui"];

/// Modules that see fewer than all above them, beside `error`, `math` and `memory`.
const NARROW: [(&str, &[&str]); 3] =
    [("accel", &["geometry"]), ("material", &["sampling"]), ("geometry", &[])];

/// What every module may use.
const COMMON: [&str; 3] = ["error", "math", "memory"];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The modules in the order of `lib.rs`.
fn modules() -> Vec<String> {
    let text = fs::read_to_string(source().join("lib.rs")).expect("lib.rs");
    let names = text.lines().filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod "));
    names.map(|name| name.trim_end_matches(';').to_owned()).collect()
}

/// All files of a module.
fn files(module: &str) -> Vec<PathBuf> {
    let mut found = vec![source().join(format!("{module}.rs"))];
    let mut folders = vec![source().join(module)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found.retain(|path| path.extension().is_some_and(|extension| extension == "rs") && path.exists());
    found
}

/// The modules that a file names after `crate::`, but in comments.
fn used(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).expect("a source file");
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    let names = code.flat_map(|line| line.split("crate::").skip(1).map(str::to_owned).collect::<Vec<_>>());
    let end = |name: &str| name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
    names.map(|name| name[..end(&name)].to_owned()).collect()
}

#[test]
fn modules_use_only_those_above_them() {
    let order = modules();
    assert!(order.len() > 10, "{order:?}");
    let mut wrong = Vec::new();
    for (place, module) in order.iter().enumerate() {
        if FREE.contains(&module.as_str()) {
            continue;
        }
        let narrow = NARROW.iter().find(|(name, _)| name == module).map(|(_, may)| *may);
        for path in files(module) {
            for name in used(&path) {
                let Some(other) = order.iter().position(|other| *other == name) else { continue };
                let fits = match narrow {
                    Some(may) => may.contains(&name.as_str()) || COMMON.contains(&name.as_str()),
                    None => other < place,
                };
                if !fits && other != place {
                    wrong.push(format!("{} uses {name}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_file_is_longer_than_500_lines() {
    let mut folders = vec![source(), Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")];
    let mut long = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let lines = fs::read_to_string(&path).expect("a source file").lines().count();
                if lines > 500 {
                    long.push(format!("{}: {lines}", path.display()));
                }
            }
        }
    }
    assert!(long.is_empty(), "{long:#?}");
}
