//! A job by its folder: what others need to do its tasks.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use super::folder::{StoredPlan, no_job, remove_job_of};
use super::{Job, JobCommand};
use crate::error::{Error, Result, Setting, wording};
use crate::run::context::Context;

/// The job that was in a folder when it was found there. Whatever comes into its place is not taken
/// for it, unless [`run_job`](crate::run::run_job) has planned it again.
#[derive(Debug, Clone)]
pub struct FoundJob {
    /// The absolute path.
    folder: PathBuf,
    /// The checksum of its plan, which names it. Copies share it: when the job is planned again,
    /// all of them are the new one.
    sum: Arc<AtomicU32>,
}

impl FoundJob {
    /// Finds the job in a folder, which must have one.
    ///
    /// # Errors
    /// If there is no job, or its plan is damaged.
    pub fn read(folder: &Path) -> Result<Self> {
        let stored = StoredPlan::read(folder)?.ok_or_else(|| no_job(folder))?;
        Self::new(folder, stored.sum)
    }

    fn new(folder: &Path, sum: u32) -> Result<Self> {
        Ok(FoundJob {
            folder: std::path::absolute(folder).map_err(|e| Error::from(e).in_file(folder))?,
            sum: Arc::new(AtomicU32::new(sum)),
        })
    }

    /// Returns the folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Reads what the job was planned for.
    ///
    /// # Errors
    /// If the job was removed or replaced meanwhile, with the kind
    /// [`OtherJob`](crate::error::Kind::OtherJob); if its command is damaged, or it has none: then
    /// only the command that planned it goes on with it.
    pub fn stored(&self) -> Result<StoredJob> {
        StoredJob::of(self.clone(), &self.plan()?)
    }

    /// Removes the files of the job, and its folder if nothing else is in it.
    ///
    /// # Errors
    /// If the job was removed or replaced meanwhile, or another process works on it; if it cannot
    /// be removed, or the run is canceled.
    pub fn remove(&self, context: &Context) -> Result<()> {
        remove_job_of(self.sum(), &self.folder, context)
    }

    fn plan(&self) -> Result<StoredPlan> {
        StoredPlan::read_of(self.sum(), &self.folder)
    }

    fn sum(&self) -> u32 {
        self.sum.load(Ordering::Relaxed)
    }
}

/// A job in a folder, and what it was planned for. Its tasks can be done by any process that sees
/// the folder.
#[derive(Debug, Clone)]
pub struct StoredJob {
    /// What it was planned for.
    pub command: JobCommand,
    found: FoundJob,
}

impl StoredJob {
    /// Finds the job in a folder; `None` if the folder has none.
    ///
    /// # Errors
    /// If its plan or its command is damaged; if no command is kept with the job: then only the
    /// call that planned it goes on with it.
    pub fn find(folder: &Path) -> Result<Option<Self>> {
        let Some(stored) = StoredPlan::read(folder)? else {
            return Ok(None);
        };
        Self::of(FoundJob::new(folder, stored.sum)?, &stored).map(Some)
    }

    fn of(found: FoundJob, stored: &StoredPlan) -> Result<Self> {
        let folder = found.folder();
        let command = JobCommand::read(folder, stored)?.ok_or_else(|| {
            Error::usage("the job in this folder is that of a command which goes on itself")
                .in_file(folder)
                .cure(wording![
                    "repeat that command with ",
                    Setting::Resume.on(),
                    " and ",
                    Setting::Job
                ])
        })?;
        Ok(StoredJob { command, found })
    }

    /// Finds the job in a folder, which must have one.
    ///
    /// # Errors
    /// Those of [`find`](Self::find), and if the folder has no job.
    pub fn read(folder: &Path) -> Result<Self> {
        Self::find(folder)?.ok_or_else(|| no_job(folder))
    }

    /// Returns a job that was created for a command.
    pub(crate) fn new(command: JobCommand, job: &Job) -> Result<Self> {
        Ok(StoredJob {
            command,
            found: FoundJob::new(&job.folder, job.sum)?,
        })
    }

    /// Takes a job for this one that was planned again in its place.
    pub(crate) fn follow(&self, job: &Job) {
        self.found.sum.store(job.sum, Ordering::Relaxed);
    }

    /// Returns what takes the place of a job in its folder: the same one, planned again for inputs
    /// that have changed. `None` if that has not happened.
    pub(crate) fn updated(job: &Job) -> Result<Option<Self>> {
        let stored = StoredPlan::read(&job.folder)?;
        let updated = stored.filter(|stored| stored.name == job.name && stored.sum != job.sum);
        let of = |stored: &StoredPlan| Self::of(FoundJob::new(&job.folder, stored.sum)?, stored);
        updated.as_ref().map(of).transpose()
    }

    /// Returns the job without what it was planned for.
    pub fn found(&self) -> &FoundJob {
        &self.found
    }

    /// Returns the folder.
    pub fn folder(&self) -> &Path {
        self.found.folder()
    }

    /// Returns an error unless the job is that of this command: with the same request and outputs,
    /// and the same for files that cannot be read or exist already.
    ///
    /// # Errors
    /// Names what differs, with the kind [`OtherJob`](crate::error::Kind::OtherJob).
    pub fn require_for(&self, asked: &JobCommand) -> Result<()> {
        self.command.require_same(asked, self.folder())
    }

    /// Reads the plan anew. No input is looked at.
    ///
    /// # Errors
    /// If the job was removed or replaced meanwhile, with the kind
    /// [`OtherJob`](crate::error::Kind::OtherJob); if it is damaged.
    pub fn job(&self) -> Result<Job> {
        let JobCommand { request, tiles, .. } = &self.command;
        Job::of_stored(&self.found.plan()?, request, self.folder(), tiles)
    }

    /// Removes the files of the job, and its folder if nothing else is in it.
    ///
    /// # Errors
    /// Those of [`FoundJob::remove`].
    pub fn remove(&self, context: &Context) -> Result<()> {
        self.found.remove(context)
    }
}
