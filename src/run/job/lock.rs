//! The right to work on a job, for one process or several.

use std::fs::{File, Metadata, TryLockError};
use std::path::Path;
use std::time::{Duration, Instant};

use super::awaited;
use super::lease::{HostLock, LEASE, Lease, Leases};
use super::paths::{LOCK, tasks_in};
use super::pause::Pause;
use crate::error::{Error, Result, Setting, wording};
use crate::run::context::Context;
use crate::run::context::event::{Event, listed};

/// A job that this process has alone: by the lock, which may hold on this host only or not at all,
/// and by the lease of the last task, the output, which is seen everywhere.
#[derive(Debug)]
pub struct JobLock {
    /// Given back before the lock.
    lease: Lease,
    _file: File,
}

/// A job that this process has together with others that do its tasks.
#[derive(Debug)]
pub(super) struct SharedLock {
    _file: File,
    locked: Locked,
}

/// How a file is locked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Locked {
    Yes,
    /// Another process has locked it.
    No,
    /// The file system has no locks.
    Unknown,
}

impl JobLock {
    /// Waits for a folder that this process has alone, for some seconds. What was read of the
    /// folder before may have changed meanwhile. `last` is the number of the last task.
    pub(super) fn whole(folder: &Path, last: usize, context: &Context) -> Result<Self> {
        patiently(folder, last, || take_whole(folder, last), context)
    }

    /// Locks a folder for this process, which has the lease of the last task; returns that if
    /// others work in it.
    pub(super) fn of_output(
        lease: Lease,
        folder: &Path,
    ) -> Result<std::result::Result<Self, Lease>> {
        let file = open(folder)?;
        Ok(match judged(file.try_lock(), &file, folder)? {
            Locked::No => Err(lease),
            Locked::Yes | Locked::Unknown => Ok(JobLock { lease, _file: file }),
        })
    }

    /// Takes a folder by the lease of the last task alone, because the process that has the lock
    /// gives no sign of life.
    pub(super) fn without_lock(lease: Lease, folder: &Path) -> Result<Self> {
        let file = open(folder)?;
        Ok(JobLock { lease, _file: file })
    }

    /// Returns the lease of the last task.
    pub(super) fn lease(&self) -> &Lease {
        &self.lease
    }

    /// Takes the lease of another task, which is the last one once the job is planned again.
    pub(super) fn take_next(&self, last: usize, folder: &Path) -> Result<Lease> {
        let taken = self.lease.leases().take(last)?;
        taken.ok_or_else(|| busy(folder, last))
    }

    /// Keeps the job by the lease of the task that is now the last one.
    pub(super) fn moved_to(self, lease: Lease) -> Self {
        JobLock { lease, ..self }
    }

    /// Returns an error if another process may have the job now: this one was stopped for longer
    /// than its lease lasts. Asked before files get their names.
    ///
    /// # Errors
    /// Also if that cannot be found out.
    pub fn confirm(&self) -> Result<()> {
        self.lease.confirm()
    }
}

impl SharedLock {
    /// Waits for a folder that no process has alone, for some seconds. `last` is the number of the
    /// last task.
    pub(super) fn wait(folder: &Path, last: usize, context: &Context) -> Result<Self> {
        patiently(folder, last, || Self::try_take(folder), context)
    }

    /// Locks a folder together with others.
    pub(super) fn try_take(folder: &Path) -> Result<Taken<Self>> {
        let file = open(folder)?;
        Ok(match judged(file.try_lock_shared(), &file, folder)? {
            Locked::No => Taken::Locked(file),
            locked => Taken::Yes(SharedLock {
                _file: file,
                locked,
            }),
        })
    }

    /// Works in a folder without the lock, because the process that has it gives no sign of life.
    pub(super) fn without(file: File) -> Self {
        SharedLock {
            _file: file,
            locked: Locked::No,
        }
    }

    /// Returns what this process has of the lock.
    pub(super) fn of_host(&self) -> HostLock {
        match self.locked {
            Locked::Yes => HostLock::Shared,
            Locked::No | Locked::Unknown => HostLock::Lacking,
        }
    }

    /// Returns true unless a process that does not see this lock has the whole job, and so the
    /// lease of the last task. With locks, such a lease of a process on this host that had the lock
    /// was left when that was killed.
    pub(super) fn permits(&self, leases: &Leases, last: usize) -> Result<bool> {
        match self.locked {
            Locked::Yes => leases.is_free_elsewhere(last),
            Locked::No | Locked::Unknown => leases.is_free(last),
        }
    }
}

/// What became of an attempt to take a folder.
pub(super) enum Taken<T> {
    Yes(T),
    /// Another process has locked this file. It stays open while it is waited for, so that it can
    /// be seen who waits.
    Locked(File),
    /// It can be locked, but other processes have leases.
    Leased,
}

/// Tries again and again to take a folder, for some seconds. After that, only leases are waited for
/// that expire soon: their processes have given no sign of life meanwhile.
fn patiently<T>(
    folder: &Path,
    last: usize,
    take: impl Fn() -> Result<Taken<T>>,
    context: &Context,
) -> Result<T> {
    let start = Instant::now();
    let mut reported = None;
    loop {
        context.check()?;
        let waits = take()?;
        if let Taken::Yes(lock) = waits {
            return Ok(lock);
        }
        let waited = start.elapsed();
        if waited > PATIENCE {
            let is_leased = matches!(waits, Taken::Leased);
            if !is_leased || !awaited::leases_expire(folder, waited, LEASE) {
                return Err(busy(folder, last));
            }
            if Pause::is_time_to_say(&mut reported) {
                let on = &awaited::of_job(folder, last)[..];
                context.monitor.event(&Event::WaitsForJob { on });
            }
        }
        std::thread::sleep(PATIENCE / 50);
    }
}

#[cold]
fn busy(folder: &Path, last: usize) -> Error {
    let who = listed(&awaited::of_job(folder, last));
    Error::usage(format!("another process works on this job{who}"))
        .in_file(folder)
        .cure(wording![
            "wait for it, or name another folder (",
            Setting::Job,
            ")"
        ])
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

/// Takes a folder for this process alone.
fn take_whole(folder: &Path, last: usize) -> Result<Taken<JobLock>> {
    let file = open(folder)?;
    let lock = match judged(file.try_lock(), &file, folder)? {
        Locked::No => return Ok(Taken::Locked(file)),
        Locked::Yes => HostLock::Whole,
        Locked::Unknown => HostLock::Lacking,
    };
    let tasks = tasks_in(folder);
    std::fs::create_dir_all(&tasks).map_err(|e| Error::from(e).in_file(&tasks))?;
    let leases = Leases::begin(folder, LEASE, lock)?;
    // Asked first, so that this one keeps nobody from a task while it waits.
    if !leases.has_others()?
        && let Some(lease) = leases.take(last)?
        // Processes that take a task from now on see that lease. Those that took one before are
        // seen now.
        && !leases.has_others()?
    {
        return Ok(Taken::Yes(JobLock { lease, _file: file }));
    }
    // Others on this host need not wait; where there are no locks, this fails.
    let _ = file.unlock();
    Ok(Taken::Leased)
}

fn judged(
    locked: std::result::Result<(), TryLockError>,
    file: &File,
    folder: &Path,
) -> Result<Locked> {
    match locked {
        // The job may have been removed, and planned again, while this one waited.
        Ok(()) => {
            let path = folder.join(LOCK);
            let about = file.metadata().map_err(|e| Error::from(e).in_file(&path))?;
            Ok(if is_at(&about, &path) {
                Locked::Yes
            } else {
                Locked::No
            })
        }
        Err(TryLockError::WouldBlock) => Ok(Locked::No),
        Err(TryLockError::Error(_)) => Ok(Locked::Unknown),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::job::paths::lease_path;

    /// The number of the last task changes with the plan.
    #[test]
    fn a_job_that_is_planned_again_has_the_lease_of_an_output_all_the_time() {
        let folder = tempfile::tempdir().unwrap();
        let lock = JobLock::whole(folder.path(), 3, &Context::default()).unwrap();
        let leased = || [3, 5].map(|task| lease_path(folder.path(), task).exists());
        assert_eq!(leased(), [true, false]);
        let next = lock.take_next(5, folder.path()).unwrap();
        assert_eq!(leased(), [true, true]);
        let lock = lock.moved_to(next);
        assert_eq!(leased(), [false, true]);
        lock.confirm().unwrap();
        drop(lock);
        assert_eq!(leased(), [false, false]);
    }
}
