//! A folder of many files that appears whole or not at all.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::target::folder_of;
use super::temporary::{self, Renames, Temporary};
use crate::error::{Error, Result, Setting, wording};

/// By what a folder is known to be one that this program has written.
#[derive(Debug)]
pub(crate) struct FolderKind {
    /// What is in it: "terrain tiles".
    pub(crate) name: &'static str,
    /// One of these files is in it, and names this program as its generator.
    pub(crate) marks: &'static [&'static str],
    /// Returns true if a file may be in it, given its path in the folder.
    pub(crate) has: fn(&Path) -> bool,
}

/// A folder that appears with all its files or not at all: it is filled under a temporary name next
/// to its target and renamed by [`commit`](OutputFolder::commit). If dropped before that, it leaves
/// nothing behind.
#[derive(Debug)]
#[must_use = "nothing appears at the target before `commit`"]
pub(crate) struct OutputFolder {
    staged: Temporary,
    target: PathBuf,
    kind: &'static FolderKind,
    replaces: bool,
}

impl OutputFolder {
    /// Creates a hidden folder next to `target`, where there must be none, or an empty one.
    ///
    /// # Errors
    /// If there is a folder or a file, or the folder around it cannot be written to.
    pub(crate) fn create(target: &Path, kind: &'static FolderKind) -> Result<Self> {
        Self::begin(target, kind, false)
    }

    /// Creates a hidden folder next to `target`. A folder that exists there is replaced if it is
    /// one of the kind, and has no other files.
    ///
    /// # Errors
    /// If there is something else, or the folder around it cannot be written to.
    pub(crate) fn replace(target: &Path, kind: &'static FolderKind) -> Result<Self> {
        Self::begin(target, kind, true)
    }

    fn begin(target: &Path, kind: &'static FolderKind, replaces: bool) -> Result<Self> {
        // Without a dot at its end, which cannot be renamed.
        let path: PathBuf = target.components().collect();
        let stage = || {
            if path.file_name().is_none() {
                return Err(Error::usage("the folder has no name of its own")
                    .cure("name a folder that does not exist"));
            }
            if !folder_of(&path).is_dir() {
                let missing = "the folder around it does not exist";
                let missing = std::io::Error::new(ErrorKind::NotFound, missing);
                let cure = format!("mkdir -p {}", folder_of(&path).display());
                return Err(Error::from(missing).cure(cure));
            }
            require_replaceable(&path, kind, replaces)?;
            Ok(Temporary::folder_beside(&path, &temporary::prefix(None))?)
        };
        let staged = stage().map_err(|e: Error| e.in_file(target))?;
        Ok(OutputFolder {
            staged,
            target: path,
            kind,
            replaces,
        })
    }

    /// Returns the path of the folder while it is filled.
    pub(crate) fn path(&self) -> &Path {
        self.staged.path()
    }

    /// Returns the path that it will have.
    pub(crate) fn target(&self) -> &Path {
        &self.target
    }

    /// Returns the folder around it.
    pub(crate) fn around(&self) -> &Path {
        folder_of(&self.target)
    }

    /// Writes a file, given its path in the folder; folders around it are created.
    ///
    /// # Errors
    /// If it cannot be written; the error names it as it would appear. If outputs are abandoned.
    pub(crate) fn write(&self, name: &Path, bytes: &[u8]) -> Result<()> {
        temporary::refuse_abandoned()?;
        let path = self.path().join(name);
        let write = || {
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder)?;
            }
            std::fs::write(&path, bytes)
        };
        write().map_err(|e| Error::from(e).in_file(self.target.join(name)))
    }

    /// Renames the folder to its target, and removes the one that was there, if that may be
    /// replaced: it is looked at again, since it may have appeared or changed in the meantime.
    ///
    /// # Errors
    /// If what is at the target may not be replaced, or a rename fails. It is then there as before.
    pub(crate) fn commit(self) -> Result<()> {
        let mut renames = Renames::begin();
        let committed = self.rename(&mut renames);
        drop(renames);
        committed.map_err(|e| e.in_file(&self.target))
    }

    fn rename(&self, renames: &mut Renames) -> Result<()> {
        require_replaceable(&self.target, self.kind, self.replaces)?;
        if !self.target.is_dir() {
            // Fails if a folder with files appears right now.
            return Ok(renames.rename(&self.staged, &self.target)?);
        }
        // Under a name that nobody knows, nothing is added to what was there. Its name says that it
        // may be the only copy.
        let aside = self.staged.backup();
        std::fs::rename(&self.target, &aside)?;
        let renamed = require_replaceable(&aside, self.kind, self.replaces)
            .and_then(|()| Ok(renames.rename(&self.staged, &self.target)?));
        match renamed {
            Ok(()) => {
                // A hidden folder of tiles that stays is not an error of what was written.
                let _ = std::fs::remove_dir_all(&aside);
                Ok(())
            }
            Err(error) => match std::fs::rename(&aside, &self.target) {
                Ok(()) => Err(error),
                Err(_) => Err(error.cure(format!("what was there is now {}", aside.display()))),
            },
        }
    }
}

fn require_replaceable(target: &Path, kind: &FolderKind, replaces: bool) -> Result<()> {
    if std::fs::symlink_metadata(target).is_err_and(|e| e.kind() == ErrorKind::NotFound) {
        return Ok(());
    }
    if !target.is_dir() {
        return Err(Error::usage("a file is where a folder is to be written"));
    }
    if std::fs::read_dir(target)?.next().is_none() {
        return Ok(());
    }
    let stays = |why: String| {
        Err(
            Error::usage(format!("the folder exists, and is not replaced: {why}"))
                .cure("name a folder that does not exist"),
        )
    };
    if !kind.marks.iter().any(|mark| is_own(&target.join(mark))) {
        return stays(format!(
            "it has no {} that this program has written",
            kind.marks.join(" or ")
        ));
    }
    if let Some(other) = other_than(target, kind.has)? {
        return stays(format!("{} is not of {}", other.display(), kind.name));
    }
    match replaces {
        true => Ok(()),
        false => Err(Error::usage("the folder exists").cure(wording![
            "pass ",
            Setting::Overwrite.on(),
            " to replace it"
        ])),
    }
}

/// Returns true if a JSON file says that this program has written it.
fn is_own(mark: &Path) -> bool {
    std::fs::read_to_string(mark).is_ok_and(|text| text.contains("\"generator\": \"breakline "))
}

/// Returns a file in a folder, or below it, that is not one of those that it may have.
fn other_than(folder: &Path, has: fn(&Path) -> bool) -> Result<Option<PathBuf>> {
    let mut open = vec![PathBuf::new()];
    while let Some(below) = open.pop() {
        for entry in std::fs::read_dir(folder.join(&below))? {
            let entry = entry?;
            let path = below.join(entry.file_name());
            // A link is neither a folder nor a file here.
            let kind = entry.file_type()?;
            if kind.is_dir() {
                open.push(path);
            } else if !(kind.is_file() && has(&path)) {
                return Ok(Some(path));
            }
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::{FolderKind, OutputFolder};
    use std::path::Path;

    const MARK: &str = "{ \"generator\": \"breakline 0\" }";

    static TILES: FolderKind = FolderKind {
        name: "tiles",
        marks: &["layer.json"],
        has: |path| {
            path == Path::new("layer.json") || path.extension().is_some_and(|e| e == "terrain")
        },
    };

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn refused(folder: crate::Result<OutputFolder>) -> String {
        folder.unwrap_err().to_string()
    }

    #[test]
    fn a_folder_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("tiles");
        let dropped = OutputFolder::create(&target, &TILES).unwrap();
        dropped.write(Path::new("0/0/0.terrain"), b"x").unwrap();
        drop(dropped);
        assert!(names(folder.path()).is_empty());

        let first = OutputFolder::create(&target, &TILES).unwrap();
        first
            .write(Path::new("layer.json"), MARK.as_bytes())
            .unwrap();
        first.write(Path::new("0/0/0.terrain"), b"x").unwrap();
        first.commit().unwrap();
        assert_eq!(names(folder.path()), ["tiles"]);

        let exists = refused(OutputFolder::create(&target, &TILES));
        assert!(exists.contains("the folder exists"), "{exists}");
        let second = OutputFolder::replace(&target, &TILES).unwrap();
        second.write(Path::new("layer.json"), b"[]").unwrap();
        assert_eq!(names(&target), ["0", "layer.json"]);
        second.commit().unwrap();
        assert_eq!(names(folder.path()), ["tiles"]);
        assert_eq!(names(&target), ["layer.json"]);
        // Nothing says who has written it.
        let other = refused(OutputFolder::replace(&target, &TILES));
        assert!(other.contains("has no layer.json"), "{other}");
    }

    #[test]
    fn what_appears_in_the_meantime_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("tiles");
        for begin in [OutputFolder::create, OutputFolder::replace] {
            let staged = begin(&target, &TILES).unwrap();
            staged.write(Path::new("layer.json"), b"{}").unwrap();
            std::fs::create_dir(&target).unwrap();
            std::fs::write(target.join("precious.txt"), "mine").unwrap();
            let error = staged.commit().unwrap_err().to_string();
            assert!(error.contains("not replaced"), "{error}");
            assert_eq!(names(folder.path()), ["tiles"]);
            assert_eq!(names(&target), ["precious.txt"]);
            std::fs::remove_dir_all(&target).unwrap();
        }
        // A folder of tiles that may be replaced, and then has a file of somebody else.
        std::fs::create_dir(&target).unwrap();
        std::fs::write(target.join("layer.json"), MARK).unwrap();
        let staged = OutputFolder::replace(&target, &TILES).unwrap();
        std::fs::write(target.join("index.html"), "mine").unwrap();
        let error = staged.commit().unwrap_err().to_string();
        assert!(error.contains("index.html is not of tiles"), "{error}");
        assert_eq!(names(&target), ["index.html", "layer.json"]);
        std::fs::remove_dir_all(&target).unwrap();
        // An empty one, and a file.
        let staged = OutputFolder::create(&target, &TILES).unwrap();
        std::fs::create_dir(&target).unwrap();
        staged.commit().unwrap();
        std::fs::remove_dir_all(&target).unwrap();
        let staged = OutputFolder::replace(&target, &TILES).unwrap();
        std::fs::write(&target, "mine").unwrap();
        assert!(staged.commit().is_err());
        assert_eq!(std::fs::read(&target).unwrap(), b"mine");
        assert_eq!(names(folder.path()), ["tiles"]);
    }

    #[test]
    fn what_is_something_else_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("photos");
        std::fs::create_dir(&target).unwrap();
        drop(OutputFolder::replace(&target, &TILES).unwrap());
        std::fs::write(target.join("a.jpg"), "x").unwrap();
        let no_mark = refused(OutputFolder::replace(&target, &TILES));
        assert!(no_mark.contains("has no layer.json"), "{no_mark}");
        std::fs::write(target.join("layer.json"), MARK).unwrap();
        let foreign = refused(OutputFolder::replace(&target, &TILES));
        assert!(foreign.contains("a.jpg is not of tiles"), "{foreign}");
        assert!(OutputFolder::replace(&target.join("a.jpg"), &TILES).is_err());
        let missing = refused(OutputFolder::create(&target.join("b/c"), &TILES));
        assert!(missing.contains("around it does not exist"), "{missing}");
        assert!(!missing.contains(".breakline-"), "{missing}");
        for nameless in [".", "..", "/"] {
            let error = refused(OutputFolder::replace(Path::new(nameless), &TILES));
            assert!(error.contains("no name of its own"), "{error}");
        }
    }
}
