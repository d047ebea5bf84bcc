//! A job by its folder: what others need to do its tasks.

use std::path::{Path, PathBuf};

use super::folder::{StoredPlan, no_job, remove_job_of};
use super::{Job, JobCommand};
use crate::error::{Error, Result, Setting, wording};
use crate::run::context::Context;

/// A job in a folder, and what it was planned for. Its tasks can be done by any process that sees
/// the folder.
#[derive(Debug, Clone)]
pub struct StoredJob {
    /// What it was planned for.
    pub command: JobCommand,
    folder: PathBuf,
    /// The checksum of its plan, which names it: another one may have come into the folder since.
    sum: u32,
}

impl StoredJob {
    /// Finds the job in a folder; `None` if the folder has none.
    ///
    /// # Errors
    /// If its plan or its command is damaged, or it has none: then only the command that planned it
    /// goes on with it.
    pub fn find(folder: &Path) -> Result<Option<Self>> {
        let Some(stored) = StoredPlan::read(folder)? else {
            return Ok(None);
        };
        let command = JobCommand::read(folder, &stored)?.ok_or_else(|| {
            Error::usage("the job in this folder is that of a command which goes on itself")
                .in_file(folder)
                .cure(wording![
                    "repeat that command with ",
                    Setting::Resume.on(),
                    " and ",
                    Setting::Job
                ])
        })?;
        let folder = std::path::absolute(folder).map_err(|e| Error::from(e).in_file(folder))?;
        Ok(Some(StoredJob {
            command,
            folder,
            sum: stored.sum,
        }))
    }

    /// Finds the job in a folder, which must have one.
    ///
    /// # Errors
    /// Those of [`find`](Self::find); if there is no job.
    pub fn read(folder: &Path) -> Result<Self> {
        Self::find(folder)?.ok_or_else(|| no_job(folder))
    }

    /// Returns a job that was created for a command.
    pub(crate) fn new(command: JobCommand, job: &Job) -> Result<Self> {
        let folder =
            std::path::absolute(&job.folder).map_err(|e| Error::from(e).in_file(&job.folder))?;
        Ok(StoredJob {
            command,
            folder,
            sum: job.sum,
        })
    }

    /// Returns the folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns an error unless the job is that of this command: with the same request and outputs,
    /// and the same for files that cannot be read or exist already.
    ///
    /// # Errors
    /// Names what differs, with the kind [`OtherJob`](crate::error::Kind::OtherJob).
    pub fn require_for(&self, asked: &JobCommand) -> Result<()> {
        self.command.require_same(asked, &self.folder)
    }

    /// Reads the plan anew. No input is looked at.
    ///
    /// # Errors
    /// If the job was removed or replaced meanwhile, with the kind
    /// [`OtherJob`](crate::error::Kind::OtherJob); if it is damaged.
    pub fn job(&self) -> Result<Job> {
        let JobCommand { request, tiles, .. } = &self.command;
        Job::of_stored(
            &StoredPlan::read_of(self.sum, &self.folder)?,
            request,
            &self.folder,
            tiles,
        )
    }

    /// Removes the files of the job, and its folder if nothing else is in it.
    ///
    /// # Errors
    /// If the job was removed or replaced meanwhile, or another process works on it; if it cannot
    /// be removed, or the run is canceled.
    pub fn remove(&self, context: &Context) -> Result<()> {
        remove_job_of(self.sum, &self.folder, context)
    }
}
