use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::run::memory_of;

/// Plan a run in tiles, and do its tasks one by one, as batch queues do
///
/// A job is a folder: the plan, the command, and a file for each task that is done. Tasks may run
/// on all machines that see the folder and the inputs, in any order in which each comes after those
/// that it needs, and may be repeated. The last one writes the output.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline job plan ground.job -- dem tiles/*.laz -o dem.tif
  breakline job run ground.job --task 17
  breakline job status ground.job
  breakline job run ground.job
  breakline job work ground.job       # on each of some hosts, instead of numbers of tasks
  breakline job clean ground.job")]
pub(crate) struct JobArgs {
    #[command(subcommand)]
    pub(crate) action: JobAction,
}

/// What is done with a job.
#[derive(Debug, Clone, Subcommand)]
pub(crate) enum JobAction {
    /// Create a job for a command: `dem`, `contour`, `hillshade` or `tin`, with its options
    Plan {
        /// Folder to create
        #[arg(value_name = "JOB")]
        job: PathBuf,
        /// Read only headers to plan, where they state number and extent (LAS, LAZ): points are
        /// taken to be spread evenly over their files. Classes have to be stated
        #[arg(long)]
        headers_only: bool,
        /// The command, after `--`
        #[arg(required = true, last = true, value_name = "COMMAND")]
        command: Vec<String>,
    },
    /// Do one task, or all that are left
    Run {
        /// Folder of the job
        #[arg(value_name = "JOB")]
        job: PathBuf,
        /// Number of the task, from 0; the last one writes the output. The exit code is 4 while
        /// tasks that it needs are not done
        #[arg(long, value_name = "N")]
        task: Option<usize>,
        /// Do only the tasks again that changed inputs affect, and replace the output, if it is
        /// still as the job wrote it
        #[arg(long, conflicts_with = "task")]
        update: bool,
    },
    /// Do tasks together with others: the same command on any number of hosts, as often as you like
    ///
    /// Each process takes tasks that are free, until all are done, here or elsewhere; one of them
    /// writes the output. It does one task on each thread (--threads). Nothing else is needed than
    /// the folder, which all see, and the inputs, under the same names. A process may begin, end or
    /// be killed at any time: its tasks are done by the others
    Work {
        /// Folder of the job
        #[arg(value_name = "JOB")]
        job: PathBuf,
        /// Memory to use, such as `16GB`: as many tasks are done at a time as have room in it, at
        /// least one [default: what is free]
        #[arg(long, value_name = "SIZE", value_parser = memory_of)]
        memory: Option<u64>,
        /// A process that gives no sign of life for so long loses its tasks to others
        #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = clap::value_parser!(u32).range(1..))]
        lease: u32,
    },
    /// Show which tasks are done, and which process does which
    Status {
        /// Folder of the job
        #[arg(value_name = "JOB")]
        job: PathBuf,
        /// Print a JSON object, with what each task needs, and its stage: tasks of one stage need
        /// only those of earlier ones
        #[arg(long)]
        json: bool,
        /// Read the files of the tasks, and remove those that are damaged
        #[arg(long)]
        verify: bool,
    },
    /// Remove the files that the job has written, except the output
    Clean {
        /// Folder of the job
        #[arg(value_name = "JOB")]
        job: PathBuf,
    },
}
