//! Files that are used where they are: mapped to memory.

// The exception of decision 31: a map cannot be made without `unsafe`, and it is made here only.
#![allow(unsafe_code)]

use std::fs::File;
use std::path::Path;

use crate::error::{Error, Result};

/// The bytes of a file, read by the operating system when they are first used.
///
/// The file must not change as long as this exists. If another program writes to it, results are
/// undefined; if it becomes shorter, the operating system ends this program. Programs that replace
/// the file by another one, as breakline does with all its outputs, do no harm.
#[derive(Debug)]
pub struct Mapped(memmap2::Mmap);

impl AsRef<[u8]> for Mapped {
    #[inline]
    fn as_ref(&self) -> &[u8] {
        &self.0
    }
}

/// Copies bytes to memory of their own, so that they can be used like those of a file.
///
/// # Errors
/// If the system has no memory for them.
pub fn of_bytes(bytes: &[u8]) -> Result<Mapped> {
    // A map of no bytes is refused by some systems; one byte more is not a TIN, either.
    let mut map = memmap2::MmapMut::map_anon(bytes.len().max(1))?;
    map[..bytes.len()].copy_from_slice(bytes);
    Ok(Mapped(map.make_read_only()?))
}

/// Maps a file to memory. See [`Mapped`] for what must not happen to it meanwhile.
///
/// # Errors
/// If it cannot be opened, or is not a file on a disk: a pipe, a device, a folder.
pub fn open(path: impl AsRef<Path>) -> Result<Mapped> {
    let path = path.as_ref();
    map(path).map_err(|e| e.in_file(path))
}

fn map(path: &Path) -> Result<Mapped> {
    // Before it is opened: that of a pipe waits for a writer, and takes it.
    if !std::fs::metadata(path)?.is_file() {
        return Err(Error::usage(
            "not a file on a disk, which could be used without reading all of it",
        ));
    }
    let file = File::open(path)?;
    // SAFETY: the map is only read, and lives as long as the bytes that are borrowed from it. That
    // the file does not change meanwhile is asked of the caller, in the documentation above and in
    // docs/formats.md: no system that we support can promise it. The bytes are plain numbers, each
    // checked after it was copied out, so that no value of them is invalid.
    let map = unsafe { memmap2::Mmap::map(&file) }?;
    Ok(Mapped(map))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bytes_are_those_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        for length in [0, 1, 5000] {
            let bytes: Vec<u8> = (0..length).map(|i: u32| i as u8).collect();
            std::fs::write(&path, &bytes).unwrap();
            assert_eq!(open(&path).unwrap().as_ref(), bytes);
        }
        assert!(open(folder.path()).is_err());
        let error = open(folder.path().join("b")).unwrap_err();
        assert_eq!(error.path(), Some(&*folder.path().join("b")));
    }
}
