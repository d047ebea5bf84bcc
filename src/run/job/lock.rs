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
        Self::wait(folder, take_whole, context)
    }

    /// Like [`whole`](Self::whole), for a folder that processes have together.
    pub(super) fn shared(folder: &Path, context: &Context) -> Result<Self> {
        Self::wait(folder, take_shared, context)
    }

    /// Locks a folder for this process alone; `None` if another one works in it.
    pub(super) fn try_whole(folder: &Path) -> Result<Option<Self>> {
        let file = open(folder)?;
        let is_taken = take_whole(&file, folder)?;
        Ok(is_taken.then_some(JobLock { _file: file }))
    }

    fn wait(
        folder: &Path,
        take: fn(&File, &Path) -> Result<bool>,
        context: &Context,
    ) -> Result<Self> {
        let start = Instant::now();
        loop {
            context.check()?;
            let file = open(folder)?;
            if take(&file, folder)? {
                return Ok(JobLock { _file: file });
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

/// Opens the file that is locked. It stays empty: a folder without a job may have such a file, too.
/// NFS gives a shared lock only to a file that is open for reading.
fn open(folder: &Path) -> Result<File> {
    let path = folder.join(LOCK);
    let file = File::options()
        .read(true)
        .write(true)
        .create(true)
        .truncate(false)
        .open(&path);
    file.map_err(|e| Error::from(e).in_file(path))
}

/// Locks a file for this process alone. Returns false if another one works in the folder.
fn take_whole(file: &File, folder: &Path) -> Result<bool> {
    if !is_taken(file.try_lock(), file, folder)? {
        return Ok(false);
    }
    // A lock may hold on this host only, or not at all; a lease is seen everywhere.
    let is_free = lease::of_other_host(folder).is_none();
    if !is_free {
        // Others on this host need not wait; where there are no locks, this fails.
        let _ = file.unlock();
    }
    Ok(is_free)
}

/// Locks a file together with others. Returns false if another process has the folder alone.
fn take_shared(file: &File, folder: &Path) -> Result<bool> {
    is_taken(file.try_lock_shared(), file, folder)
}

fn is_taken(
    locked: std::result::Result<(), TryLockError>,
    file: &File,
    folder: &Path,
) -> Result<bool> {
    match locked {
        // The job may have been removed, and planned again, while this one waited.
        Ok(()) => {
            let path = folder.join(LOCK);
            let about = file.metadata().map_err(|e| Error::from(e).in_file(&path))?;
            Ok(is_at(&about, &path))
        }
        Err(TryLockError::WouldBlock) => Ok(false),
        // Some shared file systems have no locks.
        Err(TryLockError::Error(_)) => Ok(true),
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
