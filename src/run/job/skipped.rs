//! Files that are skipped: which they are, and whether they can be read now.

use std::path::Path;

use super::Job;
use super::lock::JobLock;
use super::planned_file::looked_at;
use super::task_file::TaskFile;
use crate::error::{Error, Kind, Result};
use crate::run::context::{Context, Journal};
use crate::run::sources::transforms::FileTransform;

impl Job {
    /// Returns true if a task that is done has skipped its file of points.
    pub(super) fn skips(&self, task: usize) -> bool {
        let file = TaskFile::open(&self.task_file(task)).ok().flatten();
        file.is_some_and(|file| file.facts.skipped().is_some())
    }

    /// Returns true if a file is skipped: the result has a hole.
    ///
    /// # Errors
    /// If the run is canceled.
    pub fn has_holes(&self, context: &Context) -> Result<bool> {
        for task in (0..self.task_count()).filter(|&task| self.file_of(task).is_some()) {
            context.check()?;
            if self.skips(task) {
                return Ok(true);
            }
        }
        Ok(!self.plan.skipped.is_empty())
    }

    /// Returns a file that was skipped and can be read now, but does not fit the plan: the job has
    /// to be planned again.
    ///
    /// # Errors
    /// If a file fails in a way that is not skipped, or the run is canceled.
    ///
    /// # Complexity
    /// Linear in the files that were skipped, which are read.
    pub fn outgrown_by(&self, context: &Context) -> Result<Option<&Path>> {
        let quiet = context.quiet();
        for (input, _) in &self.plan.skipped {
            if looked_at(*input, &self.request, FileTransform::default(), &quiet).is_ok() {
                return Ok(Some(self.request.points[*input].path()));
            }
        }
        for task in (0..self.task_count()).filter(|&task| self.skips(task)) {
            let Some(number) = self.file_of(task) else {
                continue;
            };
            match self.read_file(number, &Journal::new(&quiet), &mut |_| {}) {
                Err(error) if error.kind() == Kind::Usage => {
                    return Ok(Some(&self.plan.files[number].path));
                }
                Err(error) if !self.bad.skips(&error) => return Err(error),
                _ => {}
            }
        }
        Ok(None)
    }

    /// Removes the files of tasks that have skipped a file, so that it is tried again: it may have
    /// been repaired. If it is as before, so is the file of the task, and nothing else is done
    /// again.
    ///
    /// # Errors
    /// If a file cannot be removed.
    pub fn try_again(&self, _lock: &JobLock) -> Result<()> {
        for task in (0..self.task_count()).filter(|&task| self.skips(task)) {
            let path = self.task_file(task).path;
            std::fs::remove_file(&path).map_err(|e| Error::from(e).in_file(&path))?;
        }
        Ok(())
    }
}
