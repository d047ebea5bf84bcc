//! The file that a reader reads.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// A file with random access.
#[derive(Debug)]
pub(super) struct Input {
    pub(super) file: File,
    /// Length of the file in bytes: the only size that is trusted.
    pub(super) length: u64,
    /// The name of the file in messages.
    pub(super) name: PathBuf,
}

impl Input {
    /// Opens a file. Input without random access (a pipe; `-`, which is the standard input) is
    /// first copied to a temporary file.
    pub(super) fn open(path: &Path) -> Result<Self> {
        if path.as_os_str() == "-" {
            return Self::spool(io::stdin().lock(), Path::new("standard input"));
        }
        let named = |error: io::Error| Error::from(error).in_file(path);
        let file = File::open(path).map_err(named)?;
        let about = file.metadata().map_err(named)?;
        if about.is_file() {
            return Ok(Input {
                file,
                length: about.len(),
                name: path.to_path_buf(),
            });
        }
        Self::spool(file, path)
    }

    /// Copies a stream to a temporary file, which the system deletes with the reader.
    pub(super) fn spool(mut source: impl Read, name: &Path) -> Result<Self> {
        let named = |error: io::Error| Error::from(error).in_file(name);
        let mut file = tempfile::tempfile().map_err(named)?;
        let length = io::copy(&mut source, &mut file).map_err(named)?;
        Ok(Input {
            file,
            length,
            name: name.to_path_buf(),
        })
    }

    /// Reads up to `count` bytes from `start` on; fewer at the end of the file.
    pub(super) fn bytes(&mut self, start: u64, count: usize) -> io::Result<Vec<u8>> {
        let count = self.length.saturating_sub(start).min(count as u64);
        self.file.seek(SeekFrom::Start(start))?;
        let mut bytes = Vec::with_capacity(count as usize);
        (&self.file).take(count).read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}
