//! The README and the guides: their links lead somewhere.

use std::fs;
use std::path::{Path, PathBuf};

/// All documents, below the project's root.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [".", "docs", "tests/extremes", "tests/faults", "tests/fresh", "tests/golden"]
        .map(|folder| root.join(folder));
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).expect("a folder"));
    let paths = files.map(|file| file.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect()
}

/// The targets of links and pictures, but for those of the web.
fn links(text: &str) -> Vec<&str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    targets.map(|(target, _)| target).filter(|target| !target.starts_with("http")).collect()
}

/// The names by which the headings of a document are linked to.
fn anchors(text: &str) -> Vec<String> {
    let headings =
        text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let name = |c: char| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || c == '-' => Some(c.to_ascii_lowercase()),
        _ => None,
    };
    headings.map(|heading| heading.chars().filter_map(name).collect()).collect()
}

#[test]
fn links_lead_to_files_and_headings() {
    for document in documents() {
        let text = fs::read_to_string(&document).expect("a document");
        for link in links(&text) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target =
                if file.is_empty() { document.clone() } else { document.with_file_name("").join(file) };
            assert!(target.exists(), "{}: {link} leads nowhere", document.display());
            if !anchor.is_empty() {
                let linked = fs::read_to_string(&target).expect("a document");
                assert!(
                    anchors(&linked).iter().any(|name| name == anchor),
                    "{}: no {link}",
                    document.display()
                );
            }
        }
    }
}

#[test]
fn guides_are_linked_from_the_readme() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = fs::read_to_string(root.join("README.md")).expect("README.md");
    for guide in fs::read_dir(root.join("docs")).expect("the guides") {
        let name = guide.expect("an entry").file_name().to_string_lossy().into_owned();
        assert!(
            !name.ends_with(".md") || readme.contains(&format!("docs/{name}")),
            "the README does not link {name}"
        );
    }
}
