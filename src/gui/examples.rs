//! The example scenes that came with the program.

use crate::error::{Error, Result};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::thread;

/// Scenes that need no other files, for a program that was installed without its examples.
const INSIDE: [(&str, &str); 5] = [
    ("bigBalls.yaml", include_str!("../../scenes/bigBalls.yaml")),
    ("cornellBox.yaml", include_str!("../../scenes/cornellBox.yaml")),
    ("glassBalls.yaml", include_str!("../../scenes/glassBalls.yaml")),
    ("legacyBalls.yaml", include_str!("../../scenes/legacyBalls.yaml")),
    ("mirrorRoom.yaml", include_str!("../../scenes/mirrorRoom.yaml")),
];

/// An example.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Example {
    /// A file.
    File(PathBuf),
    /// A name and a text that is within the program.
    Inside(&'static str, &'static str),
}

impl Example {
    /// The name in the window.
    pub fn name(&self) -> String {
        match self {
            Example::File(path) => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            Example::Inside(name, _) => (*name).to_owned(),
        }
    }

    /// The file. That of a scene within the program is in the folder `data`, and written if it is not there.
    ///
    /// # Errors
    /// [`Error::Io`] if it can't be written.
    pub fn file(&self, data: &Path) -> Result<PathBuf> {
        let (name, text) = match self {
            Example::File(path) => return Ok(path.clone()),
            Example::Inside(name, text) => (name, text),
        };
        let folder = data.join("scenes");
        let path = folder.join(name);
        if !path.exists() {
            let failed = |source| Error::Io { action: "write".into(), path: path.clone(), source };
            fs::create_dir_all(&folder).map_err(failed)?;
            fs::write(&path, text).map_err(failed)?;
        }
        Ok(path)
    }
}

/// The examples, looked for on a thread of its own.
pub struct Examples(Arc<OnceLock<Vec<Example>>>);

impl Examples {
    /// Begins to look in the working directory, beside the program, and where packages put examples; `wake` is called when it
    /// is done.
    pub fn look(wake: impl FnOnce() + Send + 'static) -> Examples {
        let found = Arc::new(OnceLock::new());
        let to = Arc::clone(&found);
        thread::spawn(move || {
            let folders = folders(env::current_dir().ok().as_deref(), env::current_exe().ok().as_deref());
            to.get_or_init(|| find(&folders));
            wake();
        });
        Examples(found)
    }

    /// What was found; `None` as long as it is looked for.
    pub fn get(&self) -> Option<&[Example]> {
        self.0.get().map(Vec::as_slice)
    }
}

/// Where scenes may be: `scenes` in the working directory, then beside the program and in all folders above, each followed by
/// where a package of that prefix puts them.
pub fn folders(here: Option<&Path>, program: Option<&Path>) -> Vec<PathBuf> {
    let above = program.into_iter().flat_map(|program| program.ancestors().skip(1));
    let packaged = "share/doc/pathtracer/examples/scenes";
    let beside = above.flat_map(|folder| [folder.join("scenes"), folder.join(packaged)]);
    here.map(|here| here.join("scenes")).into_iter().chain(beside).collect()
}

/// The scenes of the first folder that has any, else those within the program.
pub fn find(folders: &[PathBuf]) -> Vec<Example> {
    let scenes = folders.iter().map(|folder| scenes_in(folder)).find(|scenes| !scenes.is_empty());
    match scenes {
        Some(scenes) => scenes.into_iter().map(Example::File).collect(),
        None => INSIDE.map(|(name, text)| Example::Inside(name, text)).to_vec(),
    }
}

/// The scene files of a folder, by name.
pub fn scenes_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut scenes: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| is_scene(path)).collect();
    scenes.sort();
    scenes
}

/// Whether a file is named like a scene.
pub fn is_scene(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    extension == "yaml" || extension == "yml"
}
