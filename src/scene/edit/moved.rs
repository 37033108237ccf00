//! A scene in another folder: the files that it names keep to be the same.

use super::text::{lost, quoted};
use crate::error::{Error, Result};
use crate::scene::files;
use crate::scene::source::Source;
use crate::scene::yaml;
use crate::scene::yaml::node::{Kind, Node};
use crate::scene::yaml::position::{self, Part, Target};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

/// The keys whose values are names of files.
const KEYS: [&str; 2] = ["Filepath", "Image"];

/// The text of a scene that was at `from` and goes to `to`: where it names files relative to its folder, it names the same
/// files from the other folder. In the same folder, and where no file is found, names stay.
///
/// # Errors
/// [`Error::Usage`] where a name can't be replaced in the text, or a folder's name is no UTF-8; [`Error::Io`] where a folder
/// is not there; [`Error::Scene`] where the text is no YAML.
pub fn moved(text: &str, from: &Path, to: &Path) -> Result<String> {
    let (here, there) = (folder_of(from)?, folder_of(to)?);
    if here == there {
        return Ok(text.to_owned());
    }
    let source = Source::new(from, text);
    let root = yaml::parse(&source).map_err(|diagnostic| Error::Scene(vec![*diagnostic]))?;
    let mut names = Names::default();
    names.collect(&root, &mut Vec::new());
    let offsets = position::find(text, &names.targets);
    // An anchor's value is one place, however many aliases it has.
    let mut changes = BTreeMap::new();
    for (name, offset) in names.names.iter().zip(offsets) {
        if let Some(new) = renamed(name, &here, &there)? {
            let span = offset.and_then(|offset| written(text, offset, name)).ok_or_else(|| lost(name))?;
            changes.insert(span.start, (span.end, new));
        }
    }
    let mut text = text.to_owned();
    for (start, (end, new)) in changes.into_iter().rev() {
        let is_plain = !text[start..].starts_with(['"', '\'']) && can_be_plain(&new);
        text.replace_range(start..end, &if is_plain { new } else { quoted(&new) });
    }
    Ok(text)
}

/// The names of files in a document, and where they are.
#[derive(Default)]
struct Names<'n> {
    names: Vec<&'n str>,
    targets: Vec<Target>,
}

impl<'n> Names<'n> {
    fn collect(&mut self, node: &'n Node<'_>, path: &mut Vec<u32>) {
        match &node.kind {
            Kind::List(items) => {
                for (item, index) in items.iter().zip(0..) {
                    self.descend(item, index, false, path);
                }
            }
            Kind::Map(entries) => {
                for ((key, value), index) in entries.iter().zip(0..) {
                    let is_name = key.text().is_some_and(|key| KEYS.contains(&key));
                    self.descend(value, index, is_name, path);
                }
            }
            _ => {}
        }
    }

    /// Into a child of the node at `path`.
    fn descend(&mut self, node: &'n Node<'_>, index: u32, is_name: bool, path: &mut Vec<u32>) {
        path.push(index);
        match node.text() {
            Some(name) if is_name => {
                self.names.push(name);
                self.targets.push(Target { path: path.clone(), part: Part::Scalar });
            }
            _ => self.collect(node, path),
        }
        path.pop();
    }
}

/// The folder of a file, from the root on and without links.
fn folder_of(file: &Path) -> Result<PathBuf> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = |source| Error::Io { action: "find the folder".into(), path: folder.into(), source };
    folder.canonicalize().map_err(failed)
}

/// What the file called `name` in the scene's folder `here` is called in the folder `there`; `None` where its name stays.
fn renamed(name: &str, here: &Path, there: &Path) -> Result<Option<String>> {
    let found = files::places(here, name).into_iter().find(|path| path.is_file());
    let Some(found) = found.filter(|_| Path::new(name).is_relative()) else { return Ok(None) };
    let Some(file) = found.file_name() else { return Ok(None) };
    let path = relative(&folder_of(&found)?.join(file), there);
    let no_text = || Error::Usage(format!("the scene can't be saved: {} is no UTF-8", path.display()));
    path.to_str().map(|path| Some(path.to_owned())).ok_or_else(no_text)
}

/// A file as seen from a folder; both are from the root on. Where they share no folder but the root, the file's whole path
/// lives longer.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let shared = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    if shared < 2 {
        return file.to_path_buf();
    }
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(file.components().skip(shared)).collect()
}

/// The bytes of the text that stands at `offset`, with its quotes; `None` where it goes over several lines.
fn written(text: &str, offset: usize, content: &str) -> Option<Range<usize>> {
    let rest = text.get(offset..)?;
    let length = match rest.chars().next()? {
        quote @ ('"' | '\'') => {
            let mut chars = rest.char_indices().skip(1).peekable();
            loop {
                match chars.next()? {
                    (_, '\n') => return None,
                    (_, '\\') if quote == '"' => _ = chars.next(),
                    // In single quotes two of them are one of the text.
                    (_, '\'') if quote == '\'' && chars.peek().is_some_and(|next| next.1 == '\'') => {
                        _ = chars.next()
                    }
                    (end, found) if found == quote => break end + 1,
                    _ => {}
                }
            }
        }
        _ => rest.starts_with(content).then_some(content.len())?,
    };
    Some(offset..offset + length)
}

/// Whether a name needs no quotes. With a slash it is neither a number nor a word of YAML's own.
fn can_be_plain(name: &str) -> bool {
    let starts_well = name.starts_with(|c: char| c.is_alphanumeric() || "./_".contains(c));
    starts_well && name.contains('/') && name.chars().all(|c| c.is_alphanumeric() || "./_-".contains(c))
}
