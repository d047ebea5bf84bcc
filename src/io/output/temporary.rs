//! Hidden files that become outputs, and the list of all of them.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::target::folder_of;

/// All temporary files of the process. Locked while one is created and while a set is renamed.
static ALL: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn all() -> MutexGuard<'static, Vec<PathBuf>> {
    ALL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The right to rename temporary files.
pub(super) struct Renames(MutexGuard<'static, Vec<PathBuf>>);

impl Renames {
    /// Waits until no other set is being renamed.
    pub(super) fn begin() -> Self {
        Renames(all())
    }

    pub(super) fn rename(&mut self, temporary: &Temporary, target: &Path) -> io::Result<()> {
        std::fs::rename(&temporary.path, target)?;
        self.0.retain(|path| *path != temporary.path);
        Ok(())
    }
}

/// A hidden file, removed when dropped unless it was renamed.
#[derive(Debug)]
pub(super) struct Temporary {
    path: PathBuf,
}

impl Temporary {
    /// Creates a hidden file in the folder of `target`.
    pub(super) fn create(target: &Path) -> io::Result<(File, Self)> {
        let folder = folder_of(target);
        let mut builder = tempfile::Builder::new();
        builder.prefix(".breakline-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The mode that an ordinary new file would get; the umask still applies.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let mut all = all();
        let (file, path) = builder.tempfile_in(folder)?.into_parts();
        let path = path.keep().map_err(|e| e.error)?;
        all.push(path.clone());
        Ok((file, Temporary { path }))
    }

    /// Returns a name next to this file that is equally unlikely to be taken.
    pub(super) fn backup(&self) -> PathBuf {
        self.path.with_extension("old")
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let mut all = all();
        if let Some(i) = all.iter().position(|path| *path == self.path) {
            all.swap_remove(i);
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

/// A guard: while it exists, no output can be created or renamed.
#[derive(Debug)]
#[must_use = "outputs that are still being written may appear once it is dropped"]
pub struct Abandoned {
    _all: MutexGuard<'static, Vec<PathBuf>>,
}

/// Removes the temporary files of all outputs, for a program that is about to end early.
///
/// Keep the returned guard until the program has ended. A set that is being renamed is completed
/// first.
pub fn abandon_outputs() -> Abandoned {
    let mut all = all();
    for path in all.drain(..) {
        let _ = std::fs::remove_file(path);
    }
    Abandoned { _all: all }
}
