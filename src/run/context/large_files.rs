//! Where files go that do not fit into memory.

use std::path::{Path, PathBuf};

/// Returns the folder for large files that are needed for a while. `/tmp` may be in memory.
pub(crate) fn folder_of_large_files() -> PathBuf {
    let is_named = std::env::var_os("TMPDIR").is_some_and(|name| !name.is_empty());
    let on_disk = Path::new("/var/tmp");
    match !is_named && on_disk.is_dir() {
        true => on_disk.to_path_buf(),
        false => std::env::temp_dir(),
    }
}
