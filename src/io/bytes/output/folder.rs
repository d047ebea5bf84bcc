//! A folder of many files that appears whole or not at all.

use std::path::{Path, PathBuf};

use super::temporary::{Renames, Temporary};
use crate::error::{Error, Result, Setting, wording};

/// A folder that appears with all its files or not at all: it is filled under a temporary name next
/// to its target and renamed by [`commit`](OutputFolder::commit). If dropped before that, it leaves
/// nothing behind.
#[derive(Debug)]
#[must_use = "nothing appears at the target before `commit`"]
pub(crate) struct OutputFolder {
    staged: Temporary,
    target: PathBuf,
}

impl OutputFolder {
    /// Creates a hidden folder next to `target`. A folder that exists there is replaced if
    /// `may_replace`, and if it has one of the files `marks`, by which it is known to be what a
    /// program has written; an empty one is.
    ///
    /// # Errors
    /// If there is a folder that may not be replaced or a file, or the folder around it cannot be
    /// written to.
    pub(crate) fn create(target: &Path, may_replace: bool, marks: &[&str]) -> Result<Self> {
        let create = || {
            require_replaceable(target, may_replace, marks)?;
            Ok(Temporary::folder_beside(target)?)
        };
        let staged = create().map_err(|e: Error| e.in_file(target))?;
        Ok(OutputFolder {
            staged,
            target: target.to_path_buf(),
        })
    }

    /// Returns the path of the folder while it is filled.
    pub(crate) fn path(&self) -> &Path {
        self.staged.path()
    }

    /// Writes a file, given its path in the folder; folders around it are created.
    ///
    /// # Errors
    /// If it cannot be written; the error names it as it would appear.
    pub(crate) fn write(&self, name: &Path, bytes: &[u8]) -> Result<()> {
        let path = self.path().join(name);
        let write = || {
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder)?;
            }
            std::fs::write(&path, bytes)
        };
        write().map_err(|e| Error::from(e).in_file(self.target.join(name)))
    }

    /// Renames the folder to its target, and removes the one that was there.
    ///
    /// # Errors
    /// If a rename fails. What was at the target is then there again.
    pub(crate) fn commit(self) -> Result<()> {
        let named = |e: std::io::Error| Error::from(e).in_file(&self.target);
        // Removed at the end, with what is replaced in it.
        let aside = match self.target.is_dir() {
            true => Some(Temporary::folder_beside(&self.target).map_err(named)?),
            false => None,
        };
        let mut renames = Renames::begin();
        let before = aside.as_ref().map(|aside| aside.path().join("replaced"));
        if let Some(before) = &before {
            std::fs::rename(&self.target, before).map_err(named)?;
        }
        let renamed = renames.rename(&self.staged, &self.target);
        if let (Err(_), Some(before)) = (&renamed, &before) {
            let _ = std::fs::rename(before, &self.target);
        }
        drop(renames);
        renamed.map_err(named)
    }
}

fn require_replaceable(target: &Path, may_replace: bool, marks: &[&str]) -> Result<()> {
    if !target.exists() {
        return Ok(());
    }
    if !target.is_dir() {
        return Err(Error::usage("a file is where a folder is to be written"));
    }
    if std::fs::read_dir(target)?.next().is_none() {
        return Ok(());
    }
    if !marks.iter().any(|mark| target.join(mark).is_file()) {
        return Err(Error::usage(format!(
            "the folder exists, and is not replaced: it has no {}",
            marks.join(" or ")
        ))
        .cure("name a folder that does not exist"));
    }
    match may_replace {
        true => Ok(()),
        false => Err(Error::usage("the folder exists").cure(wording![
            "pass ",
            Setting::Overwrite.on(),
            " to replace it"
        ])),
    }
}

#[cfg(test)]
mod tests {
    use super::OutputFolder;
    use std::path::Path;

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("tiles");
        let marks = ["layer.json"];
        let dropped = OutputFolder::create(&target, false, &marks).unwrap();
        dropped.write(Path::new("0/0/0.terrain"), b"x").unwrap();
        drop(dropped);
        assert!(names(folder.path()).is_empty());

        let first = OutputFolder::create(&target, false, &marks).unwrap();
        first.write(Path::new("layer.json"), b"{}").unwrap();
        first.write(Path::new("0/0/0.terrain"), b"x").unwrap();
        first.commit().unwrap();
        assert_eq!(names(folder.path()), ["tiles"]);

        let refused = OutputFolder::create(&target, false, &marks).unwrap_err();
        assert!(
            refused.to_string().contains("the folder exists"),
            "{refused}"
        );
        let second = OutputFolder::create(&target, true, &marks).unwrap();
        second.write(Path::new("layer.json"), b"[]").unwrap();
        assert_eq!(names(&target), ["0", "layer.json"]);
        second.commit().unwrap();
        assert_eq!(names(folder.path()), ["tiles"]);
        assert_eq!(names(&target), ["layer.json"]);
    }

    #[test]
    fn what_is_something_else_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("photos");
        std::fs::create_dir(&target).unwrap();
        drop(OutputFolder::create(&target, true, &["layer.json"]).unwrap());
        std::fs::write(target.join("a.jpg"), "x").unwrap();
        let refused = OutputFolder::create(&target, true, &["layer.json"]).unwrap_err();
        assert!(
            refused.to_string().contains("has no layer.json"),
            "{refused}"
        );
        let file = target.join("a.jpg");
        assert!(OutputFolder::create(&file, true, &["layer.json"]).is_err());
    }
}
