//! The tasks of a job, listed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::lease::leases_in;
use super::{FileState, Job, TaskLease};
use crate::error::Result;
use crate::run::context::Context;

/// A task of a job.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct JobTask {
    /// Its number, by which [`run_task`](crate::run::run_task) does it. The last one writes the
    /// output.
    pub number: usize,
    /// What it does, such as "tile 17".
    pub name: String,
    /// Its stage: it needs only tasks of earlier ones.
    pub stage: usize,
    /// The tasks that must be done before it.
    pub needs: Vec<usize>,
    /// The file of points that it reads, if it reads one.
    pub input: Option<PathBuf>,
    /// That file as the task has read it, if it is done.
    pub has_read: Option<FileState>,
    /// True if it is done.
    pub is_done: bool,
    /// Which process does it, if several share the job.
    pub lease: Option<TaskLease>,
}

impl Job {
    /// Returns all tasks, each after those that it needs; the last one writes
    /// `outputs`.
    ///
    /// # Complexity
    /// Reads the ends of the files of all tasks; and the outputs, if they are there.
    ///
    /// # Errors
    /// If the run is canceled.
    pub fn tasks(&self, outputs: &[PathBuf], context: &Context) -> Result<Vec<JobTask>> {
        let (done, stages) = (self.done(context)?, self.stages());
        let mut leases = self.leases(&done)?;
        let last = JobTask {
            number: self.task_count(),
            name: "output".to_owned(),
            stage: stages.iter().max().map_or(0, |stage| stage + 1),
            needs: self.last_needs(),
            input: None,
            has_read: None,
            is_done: self.has_written(outputs, context)?,
            lease: leases.remove(&self.task_count()),
        };
        let of_task = |(number, stage)| {
            context.check()?;
            Ok(JobTask {
                number,
                name: self.task_name(number),
                stage,
                needs: self.needs(number),
                input: self.input(number).map(Path::to_path_buf),
                has_read: self.state_of_input(number),
                is_done: done[number],
                lease: leases.remove(&number),
            })
        };
        stages
            .into_iter()
            .enumerate()
            .map(of_task)
            .chain([Ok(last)])
            .collect()
    }

    /// Returns the leases of tasks that are not done, by their numbers.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn leases(&self, done: &[bool]) -> Result<BTreeMap<usize, TaskLease>> {
        let mut leases = leases_in(&self.folder)?;
        // That of a process which was killed once its task was done stays.
        leases.retain(|&task, _| !done.get(task).is_some_and(|is_done| *is_done));
        Ok(leases)
    }
}
