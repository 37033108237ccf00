//! Whether two names are of one file, which may not be there yet.

use std::fs;
use std::path::{Path, PathBuf};

/// Whether two paths lead to one file.
pub fn same_file(a: &Path, b: &Path) -> bool {
    a == b || whole_path(a) == whole_path(b)
}

/// A path from the root on and without links; of what is not there, that of the folder with its name; else as it is.
pub fn whole_path(path: &Path) -> PathBuf {
    let of_folder = || {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(fs::canonicalize(folder).ok()?.join(path.file_name()?))
    };
    fs::canonicalize(path).ok().or_else(of_folder).unwrap_or_else(|| path.to_path_buf())
}
