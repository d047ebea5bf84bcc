//! Hidden files that become outputs, folders of files that are needed for a while, and the list of
//! all of them.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::target::folder_of;
use crate::error::{Error, Result};

/// How the names of all temporary files begin.
const PREFIX: &str = ".breakline-";

/// What the names of files that are set aside contain.
const BACKUP: &str = ".old";

/// How often a folder is removed again into which other threads still write.
const ATTEMPTS: usize = 1000;

/// All temporary files of the process. Locked while one is created and while a set is renamed.
static ALL: Mutex<Vec<Listed>> = Mutex::new(Vec::new());

/// True while a guard says that no output appears anymore.
static ABANDONED: AtomicBool = AtomicBool::new(false);

/// How long a thread may take for the file that it is just writing.
const LAST_FILE: Duration = Duration::from_millis(20);

/// A temporary file or folder of the process.
#[derive(Debug)]
struct Listed {
    path: PathBuf,
    what: What,
}

/// What is temporary.
#[derive(Debug)]
enum What {
    /// A file that no other process knows.
    File,
    /// A file in whose place other processes may put files of their own, with what it contains once
    /// it is written.
    Shared(String),
    /// A folder, with all that is in it.
    Folder,
}

impl Listed {
    /// Removes the file, unless it is that of another process now, or the folder.
    fn remove(&self) {
        let path = &self.path;
        // It may not be complete.
        let is_own = |text: &String| {
            std::fs::read(path).is_ok_and(|found| text.as_bytes().starts_with(&found))
        };
        match &self.what {
            What::Shared(text) if !is_own(text) => {}
            What::File | What::Shared(_) => drop(std::fs::remove_file(path)),
            // Not empty at its removal while other threads write into it.
            What::Folder => {
                for _ in 0..ATTEMPTS {
                    match std::fs::remove_dir_all(path) {
                        Err(error) if error.kind() == io::ErrorKind::DirectoryNotEmpty => {}
                        _ => break,
                    }
                }
            }
        }
    }
}

/// Returns an error if all outputs are abandoned, but only after the guard is dropped: a program
/// that ends early never sees it.
pub(super) fn refuse_abandoned() -> Result<()> {
    match ABANDONED.load(Ordering::Relaxed) {
        true => {
            drop(all());
            Err(Error::canceled())
        }
        false => Ok(()),
    }
}

fn all() -> MutexGuard<'static, Vec<Listed>> {
    ALL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The right to rename temporary files.
pub(super) struct Renames(MutexGuard<'static, Vec<Listed>>);

impl Renames {
    /// Waits until no other set is being renamed.
    pub(super) fn begin() -> Self {
        Renames(all())
    }

    pub(super) fn rename(&mut self, temporary: &Temporary, target: &Path) -> io::Result<()> {
        std::fs::rename(&temporary.path, target)?;
        self.0.retain(|listed| listed.path != temporary.path);
        Ok(())
    }
}

/// A file that is removed when dropped, or when the program ends early, unless it was renamed: a
/// hidden one that becomes an output, or one that is there only as long as something is done. Or a
/// folder of such files.
#[derive(Debug)]
pub(crate) struct Temporary {
    path: PathBuf,
}

impl Temporary {
    /// Creates a hidden file in the folder of `target`, whose name begins with `prefix`.
    pub(super) fn create(target: &Path, prefix: &str) -> io::Result<(File, Self)> {
        let folder = folder_of(target);
        let mut builder = tempfile::Builder::new();
        builder.prefix(prefix);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The mode that an ordinary new file would get; the umask still applies.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let mut all = all();
        let (file, path) = builder.tempfile_in(folder)?.into_parts();
        let path = path.keep().map_err(|e| e.error)?;
        all.push(Listed {
            path: path.clone(),
            what: What::File,
        });
        Ok((file, Temporary { path }))
    }

    /// Creates a file at this path, where there must be none. The caller will write `text` to it.
    /// Other processes may put files of their own in its place, so what is there is removed only if
    /// it contains `text`, or the begin of it.
    ///
    /// # Errors
    /// With the kind `AlreadyExists` if there is one: of several processes that try, one succeeds.
    pub(crate) fn create_at(path: &Path, text: &str) -> io::Result<(File, Self)> {
        let mut all = all();
        let file = File::options().write(true).create_new(true).open(path)?;
        let path = path.to_path_buf();
        all.push(Listed {
            path: path.clone(),
            what: What::Shared(text.to_owned()),
        });
        Ok((file, Temporary { path }))
    }

    /// Creates a folder in another one, for files that are needed for a while. Only this user can
    /// read it.
    pub(crate) fn folder_in(folder: &Path) -> io::Result<Self> {
        let mut all = all();
        let path = tempfile::Builder::new()
            .prefix(PREFIX.trim_start_matches('.'))
            .tempdir_in(folder)?
            .keep();
        all.push(Listed {
            path: path.clone(),
            what: What::Folder,
        });
        Ok(Temporary { path })
    }

    /// Creates a hidden folder next to `target`, which can become it; its name begins with
    /// `prefix`.
    pub(super) fn folder_beside(target: &Path, prefix: &str) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(prefix);
        // Others may read what it becomes: only the umask limits who.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let mut all = all();
        let path = builder.tempdir_in(folder_of(target))?.keep();
        all.push(Listed {
            path: path.clone(),
            what: What::Folder,
        });
        Ok(Temporary { path })
    }

    /// Returns the path of the file or the folder.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns a name next to this file that is equally unlikely to be taken.
    pub(super) fn backup(&self) -> PathBuf {
        self.path.with_extension(BACKUP.trim_start_matches('.'))
    }

    /// Returns another such name, for each number.
    pub(super) fn other_backup(&self, number: usize) -> PathBuf {
        let mut name = self.backup().into_os_string();
        name.push(format!(".{number}"));
        PathBuf::from(name)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let mut all = all();
        if let Some(i) = all.iter().position(|listed| listed.path == self.path) {
            all.swap_remove(i).remove();
        }
    }
}

/// Returns how the names of temporary files begin, with the mark of their set.
pub(super) fn prefix(mark: Option<&str>) -> String {
    match mark {
        Some(mark) => format!("{PREFIX}{mark}-"),
        None => PREFIX.to_owned(),
    }
}

/// Removes temporary files and folders from a folder by the begin of their names. What a commit had
/// set aside stays: it may be the only copy of a file.
pub(super) fn remove_all(folder: &Path, prefix: &str) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(prefix) && !name.contains(BACKUP) {
            if entry.file_type()?.is_dir() {
                std::fs::remove_dir_all(entry.path())?;
            } else {
                std::fs::remove_file(entry.path())?;
            }
        }
    }
    Ok(())
}

/// A guard: while it exists, no output can be created or renamed.
#[derive(Debug)]
#[must_use = "outputs that are still being written may appear once it is dropped"]
pub struct Abandoned {
    _all: MutexGuard<'static, Vec<Listed>>,
}

impl Drop for Abandoned {
    fn drop(&mut self) {
        ABANDONED.store(false, Ordering::Relaxed);
    }
}

/// Removes the temporary files of all outputs, for a program that is about to end early; those
/// that other processes have put in their places stay.
///
/// Keep the returned guard until the program has ended. A set that is being renamed is completed
/// first.
pub fn abandon_outputs() -> Abandoned {
    let mut all = all();
    ABANDONED.store(true, Ordering::Relaxed);
    all.iter().for_each(Listed::remove);
    if all.iter().any(|listed| matches!(listed.what, What::Folder)) {
        std::thread::sleep(LAST_FILE);
        all.iter().for_each(Listed::remove);
    }
    all.clear();
    Abandoned { _all: all }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After a kill within a commit, what it had set aside may be the only copy.
    #[test]
    fn what_a_commit_sets_aside_is_not_abandoned() {
        let folder = tempfile::tempdir().unwrap();
        let prefix = prefix(Some("mark"));
        let (_, temporary) = Temporary::create(&folder.path().join("a.shp"), &prefix).unwrap();
        let kept = [
            temporary.backup(),
            temporary.other_backup(0),
            temporary.other_backup(1),
        ];
        kept.iter()
            .for_each(|path| std::fs::write(path, "old").unwrap());
        remove_all(folder.path(), &prefix).unwrap();
        assert!(kept.iter().all(|path| path.exists()) && !temporary.path.exists());
        assert!(kept[0] != kept[1] && kept[1] != kept[2]);
    }
}
