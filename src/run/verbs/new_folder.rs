//! Folders of outputs.

use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// A folder of outputs. One that did not exist is removed with this value, if it is empty, unless
/// it is [kept](Self::keep).
pub(super) struct NewFolder {
    path: PathBuf,
    is_new: bool,
}

impl NewFolder {
    /// Creates the folder if it does not exist.
    ///
    /// # Errors
    /// If it cannot be created.
    pub(super) fn at(path: &Path) -> Result<Self> {
        let is_new = !path.exists();
        if is_new {
            std::fs::create_dir(path).map_err(|e| Error::from(e).in_file(path))?;
        }
        Ok(NewFolder {
            path: path.to_path_buf(),
            is_new,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Keeps the folder: the outputs are in it.
    pub(super) fn keep(mut self) {
        self.is_new = false;
    }
}

impl Drop for NewFolder {
    fn drop(&mut self) {
        if self.is_new {
            // Fails if something else is in it.
            let _ = std::fs::remove_dir(&self.path);
        }
    }
}
