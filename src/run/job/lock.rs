//! The right to work on a job, for one process or several.

use std::fs::{File, Metadata, TryLockError};
use std::path::Path;
use std::time::{Duration, Instant};

use super::lease;
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
    /// Waits for a folder that this process has alone, for some seconds. What was read of the
    /// folder before may have changed meanwhile.
    pub(super) fn whole(folder: &Path, context: &Context) -> Result<Self> {
        Self::wait(folder, Self::try_whole, context)
    }

    /// Like [`whole`](Self::whole), for a folder that processes have together.
    pub(super) fn shared(folder: &Path, context: &Context) -> Result<Self> {
        let lock = |folder: &Path| Self::try_with(folder, File::try_lock_shared);
        Self::wait(folder, lock, context)
    }

    /// Locks a folder for this process alone; `None` if another one works in it.
    pub(super) fn try_whole(folder: &Path) -> Result<Option<Self>> {
        let lock = Self::try_with(folder, File::try_lock)?;
        // A lock may hold on this host only, or not at all; a lease is seen everywhere.
        Ok(lock.filter(|_| lease::of_other_host(folder).is_none()))
    }

    fn try_with(
        folder: &Path,
        lock: fn(&File) -> std::result::Result<(), TryLockError>,
    ) -> Result<Option<Self>> {
        let path = folder.join(LOCK);
        let named = |e: std::io::Error| Error::from(e).in_file(&path);
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
        Ok(is_taken.then_some(JobLock { _file: file }))
    }

    fn wait(
        folder: &Path,
        lock: impl Fn(&Path) -> Result<Option<Self>>,
        context: &Context,
    ) -> Result<Self> {
        let start = Instant::now();
        loop {
            context.check()?;
            if let Some(lock) = lock(folder)? {
                return Ok(lock);
            }
            if start.elapsed() > PATIENCE {
                let who = lease::of_other_host(folder)
                    .map(|(task, worker)| format!(": {worker} does task {task}"));
                let said = format!(
                    "another process works on this job{}",
                    who.unwrap_or_default()
                );
                return Err(Error::usage(said).in_file(folder).cure(wording![
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
