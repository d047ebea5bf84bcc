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
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError, Weak};
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

/// Returns the id that Linux chose when it started; `None` elsewhere. The names of hosts do not
/// suffice: many are called `localhost`.
fn boot() -> Option<String> {
    let id = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").ok()?;
    Some(id.trim().to_owned()).filter(|id| !id.is_empty())
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
    /// The time until it expires unless it is written again.
    pub left: Duration,
}

/// What the file of a lease says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Stated {
    worker: Worker,
    /// The id that its host chose when it started, because another one may have the same name;
    /// `None` where the system has none.
    #[serde(default)]
    boot: Option<String>,
    /// So that no process is taken for an earlier one.
    id: u64,
    /// In milliseconds.
    expires_after: u64,
    /// True if the process has the lock of the job, or shares it.
    #[serde(default)]
    has_lock: bool,
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
        let lasts = stated.map_or(otherwise, |stated| {
            Duration::from_millis(stated.expires_after)
        });
        let age = now.duration_since(self.written);
        // A date far ahead is that of another clock: who has the lease soon writes it again.
        let distance = age.clone().unwrap_or_else(|ahead| ahead.duration());
        TaskLease {
            worker: stated.map(|stated| stated.worker.clone()),
            age: age.unwrap_or_default(),
            has_expired: distance > lasts,
            left: lasts.saturating_sub(distance),
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
#[derive(Debug)]
struct FileClock {
    folder: PathBuf,
    seen: Mutex<Option<(Instant, SystemTime)>>,
}

impl FileClock {
    /// The clock of the file system that a job is in.
    fn of(folder: &Path) -> Self {
        FileClock {
            folder: folder.to_path_buf(),
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
            let mut file = unfinished_in(&tasks_in(&self.folder))?;
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
    let clock = FileClock::of(folder);
    let found = found_in(folder)?.into_iter();
    Ok(found
        .map(|(task, found)| (task, found.at(clock.now(), LEASE)))
        .collect())
}

/// Reads the files of the leases of a job.
fn found_in(folder: &Path) -> Result<BTreeMap<usize, FoundLease>> {
    let tasks = tasks_in(folder);
    let named = |e: std::io::Error| Error::from(e).in_file(&tasks);
    let entries = match std::fs::read_dir(&tasks) {
        Err(error) if is_gone(&error) => return Ok(BTreeMap::new()),
        entries => entries.map_err(named)?,
    };
    let mut all = BTreeMap::new();
    for entry in entries {
        let path = entry.map_err(named)?.path();
        if let Some(task) = task_of_lease(&path)
            && let Some(found) = FoundLease::read(&path)?
        {
            all.insert(task, found);
        }
    }
    Ok(all)
}

/// What a process has of the lock of a job, which holds on its host at least.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HostLock {
    /// All of it. Other leases of this host that state the lock are then left over from processes
    /// that were killed.
    Whole,
    /// A part, together with others.
    Shared,
    /// None: the file system has no locks, or the process that has it gives no sign of life.
    Lacking,
}

/// The leases of this process, which are written again and again as long as this or one of them
/// lives.
#[derive(Debug, Clone)]
pub(super) struct Leases(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    folder: PathBuf,
    stated: Stated,
    text: String,
    clock: FileClock,
    lock: HostLock,
    /// The files of those that it has, by the numbers of their tasks.
    held: Mutex<BTreeMap<usize, Arc<File>>>,
    /// Ends the thread that writes them when it is dropped.
    _running: Sender<()>,
}

impl Leases {
    /// Begins to have leases. `lease` is the time after which they expire.
    ///
    /// # Errors
    /// If no thread can be started that writes them.
    pub(super) fn begin(folder: &Path, lease: Duration, lock: HostLock) -> Result<Self> {
        let stated = Stated {
            worker: Worker::here(),
            boot: boot(),
            id: RandomState::new().hash_one(std::process::id()),
            expires_after: u64::try_from(lease.as_millis()).unwrap_or(u64::MAX),
            has_lock: lock != HostLock::Lacking,
        };
        let text = serde_json::to_string(&stated).map_err(std::io::Error::from)?;
        let (running, ended) = channel::<()>();
        let shared = Arc::new(Shared {
            folder: folder.to_path_buf(),
            stated,
            text,
            clock: FileClock::of(folder),
            lock,
            held: Mutex::default(),
            _running: running,
        });
        let weak: Weak<Shared> = Arc::downgrade(&shared);
        let renew = move || {
            while ended.recv_timeout(lease / WRITES) == Err(RecvTimeoutError::Timeout) {
                if let Some(shared) = weak.upgrade() {
                    shared.renew();
                }
            }
        };
        std::thread::Builder::new()
            .name("breakline-leases".to_owned())
            .spawn(renew)?;
        Ok(Leases(shared))
    }

    /// Returns true if no process has the lease of a task, or it has expired.
    pub(super) fn is_free(&self, task: usize) -> Result<bool> {
        let found = FoundLease::read(&lease_path(&self.0.folder, task))?;
        Ok(found.is_none_or(|found| self.0.judged(&found).has_expired))
    }

    /// Like [`is_free`](Self::is_free), but heeds no process on this host that had the lock.
    pub(super) fn is_free_elsewhere(&self, task: usize) -> Result<bool> {
        let found = FoundLease::read(&lease_path(&self.0.folder, task))?;
        Ok(found
            .is_none_or(|found| self.0.had_lock_here(&found) || self.0.judged(&found).has_expired))
    }

    /// Returns true if another process has a lease that has not expired. Those that are not
    /// complete do not count: their processes look for other leases once they are.
    ///
    /// # Errors
    /// If the files cannot be listed or read.
    pub(super) fn has_others(&self) -> Result<bool> {
        let is_other = |found: &FoundLease| {
            let stated = found.stated.as_ref();
            stated.is_some_and(|stated| *stated != self.0.stated)
                && !self.0.judged(found).has_expired
        };
        Ok(found_in(&self.0.folder)?.values().any(is_other))
    }

    /// Takes the lease of a task; `None` if another process has it.
    ///
    /// # Errors
    /// If its file cannot be read or written.
    pub(super) fn take(&self, task: usize) -> Result<Option<Lease>> {
        let path = lease_path(&self.0.folder, task);
        let mut from = None;
        // The second time after one that has expired, or was given back.
        for _ in 0..2 {
            match Temporary::create_at(&path, &self.0.text) {
                Ok((file, own)) => return self.have(task, file, own, from).map(Some),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(Error::from(error).in_file(path)),
            }
            if let Some(found) = FoundLease::read(&path)? {
                let judged = self.0.judged(&found);
                if !judged.has_expired || !found.remove(&path)? {
                    return Ok(None);
                }
                from = Some(judged);
            }
        }
        Ok(None)
    }

    fn have(
        &self,
        task: usize,
        file: File,
        own: Temporary,
        from: Option<TaskLease>,
    ) -> Result<Lease> {
        self.0
            .write(&file)
            .map_err(|e| Error::from(e).in_file(own.path()))?;
        self.0.held().insert(task, Arc::new(file));
        Ok(Lease {
            leases: self.clone(),
            task,
            own,
            from,
        })
    }
}

impl Shared {
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

    fn judged(&self, found: &FoundLease) -> TaskLease {
        let own = Duration::from_millis(self.stated.expires_after);
        let mut lease = found.at(self.clock.now(), own);
        lease.has_expired |= self.lock == HostLock::Whole && self.had_lock_here(found);
        lease
    }

    /// Returns true if a lease is that of a process on this host which had the lock of the job.
    fn had_lock_here(&self, found: &FoundLease) -> bool {
        found.stated.as_ref().is_some_and(|stated| {
            let is_here =
                stated.boot == self.stated.boot && stated.worker.host == self.stated.worker.host;
            is_here && stated.has_lock
        })
    }
}

/// The right of this process to a task; it is given back when this is dropped.
#[derive(Debug)]
pub(super) struct Lease {
    leases: Leases,
    task: usize,
    own: Temporary,
    /// The lease that had expired before.
    pub(super) from: Option<TaskLease>,
}

impl Lease {
    /// Returns the leases of this process.
    pub(super) fn leases(&self) -> &Leases {
        &self.leases
    }

    /// Returns an error if another process may have the task now: this one was stopped for longer
    /// than the lease lasts.
    pub(super) fn confirm(&self) -> Result<()> {
        match FoundLease::read(self.own.path())? {
            Some(found) if found.stated.as_ref() == Some(&self.leases.0.stated) => Ok(()),
            _ => Err(lost().in_file(self.own.path())),
        }
    }
}

#[cold]
fn lost() -> Error {
    Error::not_yet("this process gave no sign of life for so long that another one does its task")
        .cure("do it again")
}

impl Drop for Lease {
    fn drop(&mut self) {
        // Its file goes with `own`, unless it is that of another process now.
        self.leases.0.held().remove(&self.task);
    }
}
