//! Names of files that belong to another one.

use std::path::{Path, PathBuf};

/// Returns a path with a text behind its whole name: `relief.png` has `relief.png.aux.xml`.
pub(crate) fn appended(path: &Path, end: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(end);
    name.into()
}
