//! One output file.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result, Setting, wording};

use super::target::{self, TargetKind};
use super::temporary::{self, Temporary};

/// A file that appears complete or not at all: it is written under a temporary name next to its
/// target and renamed by [`commit`](Output::commit). If dropped before that, it leaves nothing
/// behind.
///
/// A file that exists at the target is replaced; its mode is kept, and a symbolic link is followed.
/// A pipe or a device cannot be renamed to, so bytes are written to it directly.
#[derive(Debug)]
#[must_use = "nothing appears at the target before `commit`"]
pub struct Output {
    file: BufWriter<File>,
    target: PathBuf,
    sink: Sink,
}

/// Where the bytes of an [`Output`] end up.
#[derive(Debug)]
enum Sink {
    /// A temporary file, to be renamed to this path.
    Renamed(Temporary, PathBuf),
    /// The stream that they are written to directly.
    Stream,
    /// A temporary file, to be copied to this stream, which cannot be written out of order.
    Copied(File),
}

/// In which order the bytes of an [`Output`] are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Writing {
    InOrder,
    AnyOrder,
}

/// An output whose bytes are on the disk or in their stream.
#[derive(Debug)]
pub(super) struct Flushed {
    pub(super) renamed: Option<(Temporary, PathBuf)>,
    pub(super) target: PathBuf,
}

impl Output {
    /// Opens a hidden file in the folder of `target`. A pipe or a device is opened itself, which
    /// waits for a reader.
    ///
    /// # Errors
    /// If the folder does not exist or is not writable, if `target` is a folder, or if a file
    /// exists there that is read-only.
    pub fn create(target: impl AsRef<Path>) -> Result<Self> {
        Self::open(target.as_ref(), None, Writing::InOrder)
    }

    /// Like [`create`](Output::create), but for formats whose first bytes are known last. Output to
    /// a pipe or a device is collected in a temporary file, which `commit` copies.
    ///
    /// # Errors
    /// As [`create`](Output::create).
    pub fn create_seekable(target: impl AsRef<Path>) -> Result<Self> {
        Self::open(target.as_ref(), None, Writing::AnyOrder)
    }

    /// Opens a hidden file whose name has the mark of its set, if there is one.
    pub(super) fn open(target: &Path, mark: Option<&str>, writing: Writing) -> Result<Self> {
        let open = || -> Result<(File, Sink)> {
            Ok(match (TargetKind::of(target)?, writing) {
                (TargetKind::File(path), _) => {
                    let (file, temporary) = temporary_for(&path, mark)?;
                    (file, Sink::Renamed(temporary, path))
                }
                (TargetKind::Stream, Writing::AnyOrder) => (
                    tempfile::tempfile()?,
                    Sink::Copied(target::open_stream(target)?),
                ),
                (TargetKind::Stream, Writing::InOrder) => {
                    (target::open_stream(target)?, Sink::Stream)
                }
            })
        };
        let (file, sink) = open().map_err(|e| e.in_file(target))?;
        Ok(Output {
            file: BufWriter::with_capacity(1 << 18, file),
            target: target.to_path_buf(),
            sink,
        })
    }

    /// Takes a complete file, which is on the disk of `target`, as the output. Its bytes are copied
    /// to a pipe or a device.
    #[cfg(feature = "gdal")]
    pub(super) fn adopt(file: &Path, target: &Path, mark: Option<&str>) -> Result<Self> {
        let adopt = || -> Result<Self> {
            let TargetKind::File(path) = TargetKind::of(target)? else {
                let mut output = Self::open(target, mark, Writing::InOrder)?;
                io::copy(&mut File::open(file)?, &mut output)?;
                return Ok(output);
            };
            let replaced = target::replaceable(&path)?;
            let (hidden, temporary) = Temporary::create(&path, &temporary::prefix(mark))?;
            let usual = hidden.metadata()?.permissions();
            std::fs::rename(file, temporary.path())?;
            let file = File::options()
                .read(true)
                .write(true)
                .open(temporary.path())?;
            match replaced {
                Some(old) => target::take_over(&file, &old)?,
                None => file.set_permissions(usual)?,
            }
            Ok(Output {
                file: BufWriter::new(file),
                target: target.to_path_buf(),
                sink: Sink::Renamed(temporary, path),
            })
        };
        adopt().map_err(|e| e.in_file(target))
    }

    /// Returns the file with all bytes that were written, from its beginning; `None` if they go to
    /// a pipe or a device.
    pub(super) fn read_back(&mut self) -> io::Result<Option<&mut File>> {
        match self.sink {
            Sink::Renamed(..) => {
                self.file.flush()?;
                let file = self.file.get_mut();
                file.rewind()?;
                Ok(Some(file))
            }
            Sink::Stream | Sink::Copied(_) => Ok(None),
        }
    }

    /// Returns the path of the hidden file, for formats that a library writes by path, and that of
    /// the file which it replaces, behind all links; `None` if the output is a pipe or a device.
    #[cfg(feature = "gpkg")]
    pub(crate) fn paths(&self) -> Option<(&Path, &Path)> {
        match &self.sink {
            Sink::Renamed(temporary, path) => Some((temporary.path(), path)),
            Sink::Stream | Sink::Copied(_) => None,
        }
    }

    /// Returns the file's final name.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Writes all bytes to the disk, so that a full disk is noticed before anything is replaced.
    pub(super) fn flush_to_disk(self) -> Result<Flushed> {
        let Output { file, target, sink } = self;
        let flush = || -> Result<Option<(Temporary, PathBuf)>> {
            let mut file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
            match sink {
                Sink::Renamed(temporary, path) => {
                    file.sync_all()?;
                    Ok(Some((temporary, path)))
                }
                Sink::Stream => Ok(None),
                Sink::Copied(mut stream) => {
                    file.rewind()?;
                    io::copy(&mut file, &mut stream)?;
                    Ok(None)
                }
            }
        };
        match flush() {
            Ok(renamed) => Ok(Flushed { renamed, target }),
            Err(error) => Err(error.in_file(&target)),
        }
    }
}

/// Checks that an output could be written, without leaving a trace, even if the program is killed.
/// A pipe or a device is not opened.
///
/// # Errors
/// As [`Output::create`].
pub fn probe(target: &Path) -> Result<()> {
    let probe = || match TargetKind::of(target)? {
        TargetKind::File(path) => {
            let replaced = target::replaceable(&path)?;
            let nameless = tempfile::tempfile_in(target::folder_of(&path))?;
            match replaced {
                Some(old) => Ok(target::take_over(&nameless, &old)?),
                None => Ok(()),
            }
        }
        TargetKind::Stream => Ok(()),
    };
    probe().map_err(|e: Error| e.in_file(target))
}

/// Returns the path of the file that is written for a target. Symbolic links are followed, even if
/// the file they name does not exist yet.
pub(crate) fn followed(target: &Path) -> std::path::PathBuf {
    match TargetKind::of(target) {
        Ok(TargetKind::File(path)) => path,
        _ => target.to_path_buf(),
    }
}

/// Returns true if a target is a pipe or a device, which is never replaced.
pub fn is_stream(target: &Path) -> bool {
    matches!(TargetKind::of(target), Ok(TargetKind::Stream))
}

/// Returns true if a target is the standard output, by a name such as `/dev/stdout`.
pub fn is_standard_output(target: &Path) -> bool {
    target::is_standard_output(target)
}

/// Returns an error if a file exists at the path of an output that must not replace it. Pipes and
/// devices are not replaced.
///
/// # Errors
/// If a file, a folder or a link exists there.
pub fn require_absent(target: &Path) -> Result<()> {
    if is_stream(target) || target.symlink_metadata().is_err() {
        return Ok(());
    }
    let exists = io::Error::new(io::ErrorKind::AlreadyExists, "the file exists");
    Err(Error::from(exists).in_file(target).cure(wording![
        "give it another name, or add ",
        Setting::Overwrite.on()
    ]))
}

/// Returns an empty file without a name on the disk of a target; for a pipe or a device, in the
/// system's folder for such files.
pub(super) fn scratch_for(target: &Path) -> Result<File> {
    Ok(match TargetKind::of(target)? {
        TargetKind::File(path) => tempfile::tempfile_in(target::folder_of(&path))?,
        TargetKind::Stream => tempfile::tempfile()?,
    })
}

/// Removes the temporary files that a program left next to an output when it was killed, of sets
/// with this [mark](super::OutputSet::mark). No program may be writing such a set.
///
/// # Errors
/// If one cannot be removed.
pub fn remove_abandoned(target: &Path, mark: &str) -> Result<()> {
    match TargetKind::of(target)? {
        TargetKind::File(path) => Ok(temporary::remove_all(
            target::folder_of(&path),
            &temporary::prefix(Some(mark)),
        )?),
        TargetKind::Stream => Ok(()),
    }
}

fn temporary_for(path: &Path, mark: Option<&str>) -> Result<(File, Temporary)> {
    let replaced = target::replaceable(path)?;
    let (file, temporary) = Temporary::create(path, &temporary::prefix(mark))?;
    if let Some(old) = replaced {
        target::take_over(&file, &old)?;
    }
    Ok((file, temporary))
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    /// `PERF:` meshes are written in rows of a few bytes: with the trait's default loop, each takes
    /// three times as long.
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
