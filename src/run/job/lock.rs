//! The right to work on a job, for one process or several.

use std::fs::{File, Metadata, TryLockError};
use std::path::Path;
use std::time::{Duration, Instant};

use crate::error::{Error, Result, Setting, wording};
use crate::run::context::Context;

/// The file that is locked while a process works on the job; it is empty.
pub(super) const LOCK: &str = "lock";

/// A job that a process works on.
#[derive(Debug)]
pub struct JobLock {
    _file: File,
}

impl JobLock {
    /// Waits for the lock of a folder, for some seconds. What was read of the folder before may
    /// have changed meanwhile.
    pub(super) fn take(
        folder: &Path,
        lock: impl Fn(&File) -> std::result::Result<(), TryLockError>,
        context: &Context,
    ) -> Result<Self> {
        let path = folder.join(LOCK);
        let named = |e: std::io::Error| Error::from(e).in_file(&path);
        let start = Instant::now();
        loop {
            context.check()?;
            // Nothing is written to it: a folder that is no job yet may have such a file.
            let file = File::options()
                .write(true)
                .create(true)
                .truncate(false)
                .open(&path)
                .map_err(named)?;
            let is_taken = match lock(&file) {
                // The job may have been removed, and planned again, while this one waited.
                Ok(()) => is_at(&file.metadata().map_err(named)?, &path),
                Err(TryLockError::WouldBlock) => false,
                // Some shared file systems have no locks.
                Err(TryLockError::Error(_)) => true,
            };
            if is_taken {
                return Ok(JobLock { _file: file });
            }
            if start.elapsed() > PATIENCE {
                return Err(Error::usage("another process works on this job")
                    .in_file(folder)
                    .cure(wording![
                        "wait for it, or name another folder (",
                        Setting::Job,
                        ")"
                    ]));
            }
            std::thread::sleep(PATIENCE / 50);
        }
    }
}

/// How long a lock is waited for: a worker that was killed may leave a process that ends its task.
const PATIENCE: Duration = Duration::from_secs(10);

/// Returns true if an open file is the one at this path.
#[cfg(unix)]
fn is_at(open: &Metadata, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata(path)
        .is_ok_and(|there| (there.dev(), there.ino()) == (open.dev(), open.ino()))
}

/// Returns true: an open file cannot be removed here.
#[cfg(not(unix))]
fn is_at(_open: &Metadata, _path: &Path) -> bool {
    true
}
