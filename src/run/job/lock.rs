//! The folder of a job, for one process or several, and its removal.

use std::fs::{File, TryLockError};
use std::path::Path;
use std::time::{Duration, Instant};

use super::{COMMAND, PLAN};
use crate::error::{Error, Result};

/// The file that is locked while a process works on the job.
const LOCK: &str = "lock";

/// A job that a process works on.
#[derive(Debug)]
pub struct JobLock {
    _file: File,
}

impl JobLock {
    pub(super) fn take(folder: &Path, lock: impl Fn(&File) -> std::result::Result<(), TryLockError>) -> Result<Self> {
        let path = folder.join(LOCK);
        let file = File::create(&path).map_err(|e| Error::from(e).in_file(&path))?;
        let start = Instant::now();
        loop {
            match lock(&file) {
                Err(TryLockError::WouldBlock) if start.elapsed() < PATIENCE => std::thread::sleep(PATIENCE / 50),
                Err(TryLockError::WouldBlock) => {
                    return Err(Error::usage("another process works on this job")
                        .in_file(folder)
                        .cure("wait for it, or name another folder (--job)"));
                }
                // Some shared file systems have no locks.
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(JobLock { _file: file }),
            }
        }
    }
}

/// How long a lock is waited for: a worker that was killed may leave a process that ends its task.
const PATIENCE: Duration = Duration::from_secs(10);

/// Removes the files of a job and its folder, if nothing else is in it.
///
/// # Errors
/// If the folder has no job, or the job cannot be removed.
pub fn remove_job(folder: &Path) -> Result<()> {
    if !folder.join(PLAN).is_file() {
        return Err(Error::usage("there is no job in this folder").in_file(folder));
    }
    let _lock = JobLock::take(folder, File::try_lock)?;
    remove_files(folder)
}

/// Removes the files of a job and its folder, if nothing else is in it.
pub(super) fn remove_files(folder: &Path) -> Result<()> {
    let named = |e: std::io::Error| Error::from(e).in_file(folder);
    // The plan last: a removal that was interrupted can be repeated.
    let tasks = folder.join("tasks");
    if tasks.exists() {
        std::fs::remove_dir_all(&tasks).map_err(named)?;
    }
    std::fs::remove_file(folder.join(PLAN)).map_err(named)?;
    for name in [LOCK, COMMAND] {
        let _ = std::fs::remove_file(folder.join(name));
    }
    let is_empty = std::fs::read_dir(folder).map_err(named)?.next().is_none();
    if is_empty { std::fs::remove_dir(folder).map_err(named) } else { Ok(()) }
}
