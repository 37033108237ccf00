//! Finding the pictures that a scene names, and reading each of them once.

use super::desc::PictureDesc;
use super::diagnostic::{Report, quote};
use super::digest::Digest;
use super::files;
use super::yaml::value::Value;
use crate::picture::{self, Decoded};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The pictures of one scene.
pub(crate) struct Pictures {
    folder: PathBuf,
    /// By canonical path; `None` for a file that could not be read, which was reported.
    read: HashMap<PathBuf, Option<Arc<Decoded>>>,
    /// Of every file that was read, in the order in which the scene names them first.
    digests: Vec<Digest>,
    /// The files that were read.
    files: Vec<PathBuf>,
}

impl Pictures {
    /// The pictures named in the scene file `file`.
    pub(crate) fn beside(file: &Path) -> Pictures {
        let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
        Pictures { folder, read: HashMap::new(), digests: Vec::new(), files: Vec::new() }
    }

    /// Of all files that were read.
    pub(crate) fn digests(&self) -> &[Digest] {
        &self.digests
    }

    /// All files that were read.
    pub(crate) fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The picture that `value` names. `encoded` says whether its values are sRGB-encoded; `None`: as its type tells.
    pub(crate) fn get(
        &mut self,
        value: Value<'_>,
        encoded: Option<bool>,
        report: &mut Report,
    ) -> Option<PictureDesc> {
        let name = value.text("the name of a picture", report)?;
        let path = files::find(&self.folder, name, &files::PICTURE, value, report)?;
        self.open(&path, encoded).unwrap_or_else(|error| {
            value.error(
                &format!("names {}, which can't be used: {error}", quote(&path.display().to_string())),
                None,
                report,
            );
            None
        })
    }

    /// The picture in a file; `Ok(None)` if it was found to be unreadable before.
    pub(crate) fn open(&mut self, path: &Path, encoded: Option<bool>) -> Result<Option<PictureDesc>, String> {
        let key = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let mut failure = None;
        let picture = self.read.entry(key).or_insert_with(|| match read(path) {
            Ok((picture, digest)) => {
                self.digests.push(digest);
                self.files.push(path.to_path_buf());
                Some(Arc::new(picture))
            }
            Err(error) => {
                failure = Some(error);
                None
            }
        });
        let picture = picture.clone();
        match failure {
            Some(error) => Err(error),
            None => Ok(picture.map(|picture| {
                let is_encoded = encoded.unwrap_or(picture.is_encoded);
                PictureDesc { file: path.to_path_buf(), picture, is_encoded }
            })),
        }
    }
}

fn read(path: &Path) -> Result<(Decoded, Digest), String> {
    // First, since what is no picture may be a file of any size.
    let picture = picture::read(path).map_err(|error| error.to_string())?;
    let digest = Digest::of(&fs::read(path).map_err(|error| error.to_string())?);
    if !picture.is_sound() {
        return Err("it holds values that are negative or no numbers".to_owned());
    }
    Ok((picture, digest))
}
