use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Kind, Result};

/// A file that appears whole or not at all: it is written beside its target and renamed by
/// [`commit`](Output::commit). Dropped before that, it leaves nothing behind.
#[derive(Debug)]
#[must_use = "nothing is at the target before `commit`"]
pub struct Output {
    file: BufWriter<NamedTempFile>,
    target: PathBuf,
}

impl Output {
    /// Opens a hidden file in the folder of `target`.
    ///
    /// # Errors
    /// If the folder does not exist or cannot be written to.
    pub fn create(target: impl AsRef<Path>) -> Result<Self> {
        let target = target.as_ref().to_path_buf();
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".breakline-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // What an ordinary new file would get; the umask still applies.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = builder.tempfile_in(folder).map_err(|e| Error::from(e).in_file(&target))?;
        Ok(Output { file: BufWriter::with_capacity(1 << 18, file), target })
    }

    /// Flushes and renames to the target, replacing what was there.
    ///
    /// # Errors
    /// If the last bytes cannot be written or the rename fails.
    pub fn commit(self) -> Result<()> {
        let Output { file, target } = self;
        let file = file.into_inner().map_err(|e| Error::from(e.into_error()).in_file(&target))?;
        file.persist(&target).map_err(|e| Error::caused_by(Kind::Io, e.error).in_file(&target))?;
        Ok(())
    }

    /// The file's final name.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// The unbuffered file, for libraries that want one; flushed first.
    ///
    /// # Errors
    /// If the buffered bytes cannot be written.
    pub fn file(&mut self) -> io::Result<&mut File> {
        self.file.flush()?;
        Ok(self.file.get_mut().as_file_mut())
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    /// `PERF:` meshes are written in rows of some bytes: with the loop that comes with the trait each takes three times as long.
    #[inline]
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Output {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}
