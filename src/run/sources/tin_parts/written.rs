//! A surface in parts whose files are written.

use std::path::PathBuf;

use crate::error::{Error, Result};
use crate::terrain::TinIndex;

/// A surface in parts whose files were written. Its folder is removed again, unless it is
/// [kept](Self::keep).
#[derive(Debug)]
pub struct WrittenParts {
    /// What the index says.
    pub index: TinIndex,
    /// The folder of the parts, unless it was there before.
    folder: Option<PathBuf>,
    /// The files of the surface that the new one replaces, and their folder.
    superseded: Option<(PathBuf, Vec<PathBuf>)>,
}

impl WrittenParts {
    /// The parts that an index names. `folder` is theirs, unless it was there before; `superseded`
    /// are the folder and the files of the surface that they replace.
    pub(crate) fn new(
        index: TinIndex,
        folder: Option<PathBuf>,
        superseded: Option<(PathBuf, Vec<PathBuf>)>,
    ) -> Self {
        WrittenParts {
            index,
            folder,
            superseded,
        }
    }

    /// Keeps the parts, once the index has appeared, and removes those of the surface that this one
    /// replaces.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub fn keep(&mut self) -> Result<()> {
        self.folder = None;
        let Some((folder, files)) = self.superseded.take() else {
            return Ok(());
        };
        for file in files.iter().filter(|file| file.exists()) {
            std::fs::remove_file(file).map_err(|e| Error::from(e).in_file(file))?;
        }
        // It stays if somebody has put something else there.
        let _ = std::fs::remove_dir(&folder);
        Ok(())
    }
}

impl Drop for WrittenParts {
    fn drop(&mut self) {
        if let Some(folder) = &self.folder {
            let _ = std::fs::remove_dir_all(folder);
        }
    }
}
