//! The coordinate system in a `.prj` next to a file.

use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::crs::Crs;
use crate::error::{Error, Result};

/// Limit for the bytes of a `.prj`; a larger file is something else.
const MAX_PRJ: u64 = 1 << 20;

/// What a `.prj` states.
pub(crate) enum Prj {
    /// A system; `None` if there is no file, or one that states none.
    Stated(Option<Crs>),
    /// The text, which is not understood, and why.
    Unread(String, Error),
}

/// Reads the `.prj` next to a file.
///
/// # Errors
/// If it exists and cannot be read.
pub(crate) fn read_beside(path: &Path) -> Result<Prj> {
    match sibling(path, "prj") {
        Some(path) => read(&path),
        None => Ok(Prj::Stated(None)),
    }
}

/// Reads a file of WKT.
///
/// # Errors
/// If it cannot be read.
pub(crate) fn read(path: &Path) -> Result<Prj> {
    let mut bytes = Vec::new();
    File::open(path)?
        .take(MAX_PRJ)
        .read_to_end(&mut bytes)
        .map_err(|e| Error::from(e).in_file(path))?;
    let text = String::from_utf8_lossy(&bytes);
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.is_empty() {
        return Ok(Prj::Stated(None));
    }
    Ok(match Crs::from_wkt(text) {
        Ok(crs) => Prj::Stated(crs.unless_undefined()),
        Err(error) => Prj::Unread(text.to_owned(), error),
    })
}

/// Returns the file next to `path` with this extension, in lower, upper or mixed case.
pub(crate) fn sibling(path: &Path, extension: &str) -> Option<PathBuf> {
    let lower = path.with_extension(extension);
    if lower.exists() {
        return Some(lower);
    }
    let wanted = lower.file_name()?.to_str()?.to_owned();
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    // Sorted, so that the choice does not depend on the file system.
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| {
            path.file_name()
                .and_then(OsStr::to_str)
                .is_some_and(|name| name.eq_ignore_ascii_case(&wanted))
        })
        .collect();
    found.sort();
    found.into_iter().next()
}
