//! The tasks of a job, listed.

use std::path::{Path, PathBuf};

use super::{FileState, Job};
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
}

impl Job {
    /// Returns all tasks, each after those that it needs; the last one writes `output`.
    ///
    /// # Complexity
    /// Reads the ends of the files of all tasks; and the output, if it is there.
    ///
    /// # Errors
    /// If the run is canceled.
    pub fn tasks(&self, output: &Path, context: &Context) -> Result<Vec<JobTask>> {
        let (done, stages) = (self.done(context)?, self.stages());
        let last = JobTask {
            number: self.task_count(),
            name: "output".to_owned(),
            stage: stages.iter().max().map_or(0, |stage| stage + 1),
            needs: self.last_needs(),
            input: None,
            has_read: None,
            is_done: self.has_written(output, context)?,
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
            })
        };
        stages
            .into_iter()
            .enumerate()
            .map(of_task)
            .chain([Ok(last)])
            .collect()
    }
}
