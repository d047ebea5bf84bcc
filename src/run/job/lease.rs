//! Leases of tasks: which process does which, where several share the tasks of a job.
//!
//! A lease is a file beside that of its task, created only where there is none. Its worker writes
//! it again and again; once it has not for the time that the file states, the lease has expired,
//! and another worker may take the task. Two workers that have the same task after all lose time,
//! and nothing else: both write the same file. So leases need neither locks nor clocks that agree.
//! Their ages are measured by the clock of the file system that has them.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter};
use std::fs::File;
use std::hash::{BuildHasher, RandomState};
use std::io::{ErrorKind, Read, Seek, Write};
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use serde::{Deserialize, Serialize};

use super::paths::{lease_path, task_of_lease, tasks_in};
use super::task_file::unfinished_in;
use crate::error::{Error, Result};
use crate::io::Temporary;

/// After how long a lease expires that its process does not renew, unless somebody says.
pub(super) const LEASE: Duration = Duration::from_secs(60);

/// How often a lease is written before it would expire: some of the writes may be late.
const WRITES: u32 = 6;

/// How long the clock of a file system is not asked again.
const CLOCK_KEPT: Duration = Duration::from_secs(10);

/// A file of a lease is short.
const LONGEST: u64 = 1 << 12;

/// A process that does tasks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Worker {
    /// The name of its host.
    pub host: String,
    /// Its number there.
    pub process: u32,
}

impl Display for Worker {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", self.host, self.process)
    }
}

impl Worker {
    /// Returns this process.
    fn here() -> Self {
        Worker {
            host: host(),
            process: std::process::id(),
        }
    }
}

#[cfg(unix)]
fn host() -> String {
    rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned()
}

#[cfg(not(unix))]
fn host() -> String {
    std::env::var("COMPUTERNAME").unwrap_or_default()
}

/// The lease of a task, as it is found.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TaskLease {
    /// The process that has it; `None` if its file cannot be read.
    pub worker: Option<Worker>,
    /// How long ago it was written.
    pub age: Duration,
    /// True if that is longer ago than it states: another worker may take the task.
    pub has_expired: bool,
}

/// What the file of a lease says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Stated {
    worker: Worker,
    /// So that no process is taken for an earlier one.
    id: u64,
    /// In milliseconds.
    expires_after: u64,
}

/// The file of a lease.
#[derive(Debug, PartialEq)]
struct FoundLease {
    /// `None` if it is not complete yet, or damaged.
    stated: Option<Stated>,
    written: SystemTime,
}

impl FoundLease {
    /// Reads a file; `None` if there is none.
    fn read(path: &Path) -> Result<Option<Self>> {
        let read = || {
            let file = File::open(path)?;
            let written = file.metadata()?.modified()?;
            let mut text = Vec::new();
            file.take(LONGEST).read_to_end(&mut text)?;
            Ok(FoundLease {
                stated: serde_json::from_slice(&text).ok(),
                written,
            })
        };
        match read() {
            Ok(found) => Ok(Some(found)),
            Err(error) if is_gone(&error) => Ok(None),
            Err(error) => Err(Error::from(error).in_file(path)),
        }
    }

    /// Returns what it is at some time; `otherwise` is after how long it expires if it does not
    /// state that.
    fn at(&self, now: SystemTime, otherwise: Duration) -> TaskLease {
        let stated = self.stated.as_ref();
        let age = now.duration_since(self.written).unwrap_or_default();
        TaskLease {
            worker: stated.map(|stated| stated.worker.clone()),
            age,
            has_expired: age
                > stated.map_or(otherwise, |stated| {
                    Duration::from_millis(stated.expires_after)
                }),
        }
    }

    /// Removes the file of a lease that has expired. Returns false if another process was faster,
    /// or the lease was written again.
    fn remove(&self, path: &Path) -> Result<bool> {
        let named = |e: std::io::Error| Error::from(e).in_file(path);
        // Only one process can rename the file; it can then see which lease it was.
        let aside = unfinished_in(path.parent().unwrap_or(Path::new(".")))
            .map_err(named)?
            .into_temp_path();
        match std::fs::rename(path, &aside) {
            Err(error) if is_gone(&error) => return Ok(false),
            renamed => renamed.map_err(named)?,
        }
        if Self::read(&aside)?.as_ref() == Some(self) {
            return Ok(true);
        }
        // If another lease is there already, this one is lost: its task may be done twice.
        let _ = aside.persist_noclobber(path);
        Ok(false)
    }
}

/// Returns true if a file is not there; a network file system may have removed it while it was
/// open.
fn is_gone(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::NotFound | ErrorKind::StaleNetworkFileHandle
    )
}

/// The clock by which a file system dates files. Between two looks at it, time is that of this
/// machine.
struct FileClock<'a> {
    folder: &'a Path,
    seen: Mutex<Option<(Instant, SystemTime)>>,
}

impl<'a> FileClock<'a> {
    /// The clock of the file system that a job is in.
    fn of(folder: &'a Path) -> Self {
        FileClock {
            folder,
            seen: Mutex::default(),
        }
    }

    fn now(&self) -> SystemTime {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        match *seen {
            Some((at, time)) if at.elapsed() < CLOCK_KEPT => time + at.elapsed(),
            _ => {
                let time = self.date();
                *seen = Some((Instant::now(), time));
                time
            }
        }
    }

    /// Returns the date of a file that is written now; where none can be written, the time here.
    fn date(&self) -> SystemTime {
        let date = || {
            let mut file = unfinished_in(&tasks_in(self.folder))?;
            file.write_all(b"now")?;
            file.as_file().metadata()?.modified()
        };
        date().unwrap_or_else(|_| SystemTime::now())
    }
}

/// Returns the leases of a job, by the numbers of their tasks.
///
/// # Errors
/// If the files cannot be listed or read.
pub(super) fn leases_in(folder: &Path) -> Result<BTreeMap<usize, TaskLease>> {
    let tasks = tasks_in(folder);
    let named = |e: std::io::Error| Error::from(e).in_file(&tasks);
    let entries = match std::fs::read_dir(&tasks) {
        Err(error) if is_gone(&error) => return Ok(BTreeMap::new()),
        entries => entries.map_err(named)?,
    };
    let clock = FileClock::of(folder);
    let mut leases = BTreeMap::new();
    for entry in entries {
        let path = entry.map_err(named)?.path();
        if let Some(task) = task_of_lease(&path)
            && let Some(found) = FoundLease::read(&path)?
        {
            leases.insert(task, found.at(clock.now(), LEASE));
        }
    }
    Ok(leases)
}

/// Returns a task of the job that a process on another host does, and which process; `None` if that
/// is not known.
pub(super) fn of_other_host(folder: &Path) -> Option<(usize, Worker)> {
    let here = host();
    let leases = leases_in(folder).unwrap_or_default();
    let others = leases.into_iter().filter(|(_, lease)| !lease.has_expired);
    let mut others = others.filter_map(|(task, lease)| Some((task, lease.worker?)));
    others.find(|(_, worker)| worker.host != here)
}

/// The leases of this process.
pub(super) struct Leases<'a> {
    folder: &'a Path,
    stated: Stated,
    text: String,
    clock: FileClock<'a>,
    /// The files of those that it has, by the numbers of their tasks.
    held: Mutex<BTreeMap<usize, Arc<File>>>,
}

impl<'a> Leases<'a> {
    /// Calls a function with the leases of this process, which are written again and again until it
    /// returns. `lease` is the time after which they expire.
    pub(super) fn while_renewed<T>(
        folder: &'a Path,
        lease: Duration,
        work: impl FnOnce(&Leases) -> Result<T>,
    ) -> Result<T> {
        let stated = Stated {
            worker: Worker::here(),
            id: RandomState::new().hash_one(std::process::id()),
            expires_after: u64::try_from(lease.as_millis()).unwrap_or(u64::MAX),
        };
        let text = serde_json::to_string(&stated).map_err(std::io::Error::from)?;
        let leases = Leases {
            folder,
            stated,
            text,
            clock: FileClock::of(folder),
            held: Mutex::default(),
        };
        let (running, ended) = channel::<()>();
        std::thread::scope(|scope| {
            let leases = &leases;
            std::thread::Builder::new()
                .name("breakline-leases".to_owned())
                .spawn_scoped(scope, move || {
                    while ended.recv_timeout(lease / WRITES) == Err(RecvTimeoutError::Timeout) {
                        leases.renew();
                    }
                })?;
            let done = work(leases);
            drop(running);
            done
        })
    }

    fn held(&self) -> std::sync::MutexGuard<'_, BTreeMap<usize, Arc<File>>> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes all leases again. What cannot be written expires, and the task is done twice.
    fn renew(&self) {
        let files: Vec<Arc<File>> = self.held().values().cloned().collect();
        for file in files {
            let _ = self.write(&file);
        }
    }

    fn write(&self, mut file: &File) -> std::io::Result<()> {
        file.rewind()?;
        file.write_all(self.text.as_bytes())?;
        // A network file system may keep to itself what was written, and when.
        file.sync_data()
    }

    /// Returns true if no process has the lease of a task, or it has expired.
    pub(super) fn is_free(&self, task: usize) -> Result<bool> {
        let found = FoundLease::read(&lease_path(self.folder, task))?;
        Ok(found.is_none_or(|found| self.judged(&found).has_expired))
    }

    fn judged(&self, found: &FoundLease) -> TaskLease {
        let own = Duration::from_millis(self.stated.expires_after);
        found.at(self.clock.now(), own)
    }

    /// Takes the lease of a task; `None` if another process has it.
    ///
    /// # Errors
    /// If its file cannot be read or written.
    pub(super) fn take(&self, task: usize) -> Result<Option<Lease<'_>>> {
        let path = lease_path(self.folder, task);
        let mut from = None;
        // The second time after one that has expired, or was given back.
        for _ in 0..2 {
            match Temporary::create_at(&path) {
                Ok((file, own)) => return self.begin(task, file, own, from).map(Some),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(Error::from(error).in_file(path)),
            }
            if let Some(found) = FoundLease::read(&path)? {
                let judged = self.judged(&found);
                if !judged.has_expired || !found.remove(&path)? {
                    return Ok(None);
                }
                from = Some(judged);
            }
        }
        Ok(None)
    }

    fn begin(
        &self,
        task: usize,
        file: File,
        own: Temporary,
        from: Option<TaskLease>,
    ) -> Result<Lease<'_>> {
        self.write(&file)
            .map_err(|e| Error::from(e).in_file(own.path()))?;
        self.held().insert(task, Arc::new(file));
        Ok(Lease {
            leases: self,
            task,
            own,
            from,
        })
    }
}

/// The right of this process to a task; it is given back when this is dropped.
pub(super) struct Lease<'a> {
    leases: &'a Leases<'a>,
    task: usize,
    own: Temporary,
    /// The lease that had expired before.
    pub(super) from: Option<TaskLease>,
}

impl Drop for Lease<'_> {
    fn drop(&mut self) {
        self.leases.held().remove(&self.task);
        // It may have expired, and be that of another process.
        let found = FoundLease::read(self.own.path()).ok().flatten();
        if found.is_some_and(|found| found.stated.as_ref() != Some(&self.leases.stated)) {
            self.own.leave();
        }
    }
}
