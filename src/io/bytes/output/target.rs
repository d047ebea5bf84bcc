//! What exists at the path of an output.

use std::fs::{File, Metadata};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// The kind of target that a path leads to.
pub(super) enum TargetKind {
    /// A file at this path, which may not exist yet; symbolic links are followed.
    File(PathBuf),
    /// A pipe or a device.
    Stream,
}

/// Longest chain of links that is followed, as in Linux.
const MAX_LINKS: usize = 40;

impl TargetKind {
    pub(super) fn of(path: &Path) -> Result<Self> {
        let mut path = path.to_path_buf();
        for _ in 0..MAX_LINKS {
            if open_file(&path).is_some() {
                return Ok(TargetKind::Stream);
            }
            match std::fs::symlink_metadata(&path) {
                Err(error) if error.kind() == ErrorKind::NotFound => {
                    return Ok(TargetKind::File(path));
                }
                Err(error) => return Err(error.into()),
                Ok(data) if data.is_symlink() => {
                    path = path.with_file_name("").join(std::fs::read_link(&path)?)
                }
                Ok(data) if data.is_dir() => return Err(folder_error()),
                Ok(data) if data.is_file() => return Ok(TargetKind::File(path)),
                Ok(_) => return Ok(TargetKind::Stream),
            }
        }
        Err(Error::usage("symbolic links form a cycle"))
    }
}

/// Returns the folder that a file is in.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// Returns the number in `/proc/self/fd/1` and the like. `/dev/stdout` links to such a path,
/// whatever that links to.
fn open_file(path: &Path) -> Option<u32> {
    let is_listed = path.parent().is_some_and(|folder| {
        folder == Path::new("/dev/fd")
            || folder.starts_with("/proc") && folder.file_name().is_some_and(|n| n == "fd")
    });
    path.file_name()
        .filter(|_| is_listed)?
        .to_str()?
        .parse()
        .ok()
}

/// Returns true if a path leads to the standard output, as `/dev/stdout` does.
pub(super) fn is_standard_output(path: &Path) -> bool {
    let mut path = path.to_path_buf();
    for _ in 0..MAX_LINKS {
        if let Some(number) = open_file(&path) {
            return number == 1;
        }
        match std::fs::read_link(&path) {
            Ok(to) => path = path.with_file_name("").join(to),
            Err(_) => return false,
        }
    }
    false
}

/// Opens a pipe or a device for writing. For the standard output, the program's own descriptor is
/// used.
pub(super) fn open_stream(path: &Path) -> Result<File> {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        let linked = std::fs::read_link(path).ok();
        // If opened anew, a file would be written from its start, and a socket could not be opened.
        if linked.as_deref().or(Some(path)).and_then(open_file) == Some(1) {
            return Ok(std::io::stdout().as_fd().try_clone_to_owned()?.into());
        }
    }
    Ok(File::options().write(true).open(path)?)
}

/// Returns the metadata of the file that a rename would replace, if there is one.
///
/// # Errors
/// If the file must not be replaced: a rename itself only needs permission on the folder.
pub(super) fn replaceable(path: &Path) -> Result<Option<Metadata>> {
    let old = match std::fs::metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        old => old?,
    };
    if old.is_dir() {
        return Err(folder_error());
    }
    if old.permissions().readonly() {
        let error = std::io::Error::new(
            ErrorKind::PermissionDenied,
            "the file is read-only, and is not replaced",
        );
        return Err(
            Error::from(error).cure("give it another name, or allow writing with chmod u+w")
        );
    }
    // Asks the system, because permissions depend on more than the mode.
    File::options().write(true).open(path)?;
    Ok(Some(old))
}

/// Gives a new file the mode of the file that it replaces and, if possible, its owner.
pub(super) fn take_over(new: &File, old: &Metadata) -> Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        // The owner first: changing it clears bits of the mode.
        let _ = fchown(new, Some(old.uid()), Some(old.gid()));
    }
    Ok(new.set_permissions(old.permissions())?)
}

#[cold]
pub(super) fn folder_error() -> Error {
    let error = std::io::Error::new(ErrorKind::IsADirectory, "there is a folder with this name");
    Error::from(error).cure("give the output another name, or move the folder")
}
