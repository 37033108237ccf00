//! The order of the modules: each uses only those above it in `lib.rs`.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules that see fewer than all above them, beside those of `COMMON`.
const NARROW: [(&str, &[&str]); 3] =
    [("accel", &["geometry"]), ("material", &["sampling"]), ("geometry", &[])];

/// What every module may use.
const COMMON: [&str; 5] = ["error", "math", "memory", "whole_file", "words"];

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

/// The modules of the crate that a file names, but in comments.
fn used(path: &Path) -> Vec<String> {
    named(&fs::read_to_string(path).expect("a source file"), depth(path))
}

/// How many `super::` lead from a file to the crate's root.
fn depth(path: &Path) -> usize {
    let below = path.strip_prefix(source()).expect("a file of the source");
    let is_folder = below.file_stem().is_some_and(|stem| stem == "mod");
    below.components().count() - usize::from(is_folder)
}

/// The modules that stand behind `crate::`, or behind as many `super::` as lead to the root, also in groups in braces.
fn named(text: &str, depth: usize) -> Vec<String> {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    let code: String = code.collect::<Vec<_>>().join(" ");
    let root = "super::".repeat(depth);
    let behind = |prefix: &str| code.split(prefix).skip(1).flat_map(first_names).collect::<Vec<_>>();
    [behind("crate::"), behind(&root)].concat()
}

/// The first name of a path, or of every path of a group in braces.
fn first_names(path: &str) -> Vec<String> {
    let name = |path: &str| -> String {
        path.trim_start().chars().take_while(|&c| c.is_alphanumeric() || c == '_').collect()
    };
    let Some(group) = path.strip_prefix('{') else { return vec![name(path)] };
    let (mut names, mut open) = (vec![name(group)], 1);
    for (at, c) in group.char_indices() {
        match c {
            '{' => open += 1,
            '}' => open -= 1,
            ',' if open == 1 => names.push(name(&group[at + 1..])),
            _ => {}
        }
        if open == 0 {
            break;
        }
    }
    names
}

#[test]
fn grouped_imports_and_paths_from_the_root_are_seen() {
    let text = "use crate::{film::{Film, Sums}, world::World,\n    render};\nuse super::super::cli;\nuse super::near; // crate::gui";
    assert_eq!(named(text, 2), ["film", "world", "render", "cli"]);
    assert_eq!(named("crate::error::Result<crate::math::Rgb>", 1), ["error", "math"]);
    assert_eq!(depth(&source().join("world/light/mod.rs")), 2);
    assert_eq!(depth(&source().join("world/sky.rs")), 2);
    assert_eq!(depth(&source().join("render.rs")), 1);
}

#[test]
fn modules_use_only_those_above_them() {
    let order = modules();
    assert!(order.len() > 10, "{order:?}");
    let mut wrong = Vec::new();
    for (place, module) in order.iter().enumerate() {
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

/// Where `unsafe` may be, below `src/`; the README lists the same.
const UNSAFE: [&str; 5] =
    ["accel/embree/", "accel/bvh/simd/", "picture/oiio.rs", "picture/denoise.rs", "memory.rs"];

#[test]
fn unsafe_code_is_only_where_the_readme_says() {
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let readme = fs::read_to_string(readme).expect("README.md");
    for place in UNSAFE {
        assert!(readme.contains(&format!("`src/{place}`")), "the README does not list {place}");
    }
    for path in modules().iter().flat_map(|module| files(module)) {
        let below = path.strip_prefix(source()).expect("a file of the source").display().to_string();
        // The lint denies it elsewhere.
        let allows = fs::read_to_string(&path).expect("a source file").contains("allow(unsafe_code)");
        assert!(!allows || UNSAFE.iter().any(|place| below.starts_with(place)), "unsafe code in {below}");
    }
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
