use std::path::PathBuf;

use clap::{Args, Subcommand};

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
    },
    /// Show which tasks are done
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
