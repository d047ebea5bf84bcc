//! What happens while files are written.

use std::fmt::{Display, Formatter};
use std::path::Path;
use std::time::Duration;

use crate::crs::Crs;
use crate::data::Frame;

/// Something that happens while a request is worked on, for callers that show it: neither a choice
/// nor a doubt, as a [`Notice`](super::Notice) is.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Event<'a> {
    /// A job was planned, or is there.
    Planned(&'a JobSize),
    /// A job goes on, so many of whose tasks are done.
    Resumed {
        /// The tasks that are done.
        done: usize,
        /// All tasks.
        tasks: usize,
    },
    /// A file that was skipped can be read now, and does not fit the plan: the job is planned
    /// again.
    PlannedAgain(&'a Path),
    /// The files are no longer like those that the tiles of a job were chosen for: all of it is
    /// planned again.
    TilesChosenAgain,
    /// The tasks of the job in a folder begin.
    TasksBegin(&'a Path),
    /// A task was that of another process, which gave no sign of life, and is done here now.
    TakenOver {
        /// Its number.
        task: usize,
        /// Whose it was, such as "node7:4711"; `None` if that is not known.
        worker: Option<&'a str>,
        /// How long ago that process gave the last sign of life.
        age: Duration,
    },
    /// Nothing can be done but to wait for so many tasks of other processes.
    Waits {
        /// Their number.
        tasks: usize,
        /// The processes that do them, as far as they are known.
        on: &'a [Awaited],
    },
    /// Nothing can be done but to wait for processes that have the job.
    WaitsForJob {
        /// These processes, as far as they are known.
        on: &'a [Awaited],
    },
    /// This process goes on with a job although other processes have it, because they give no sign
    /// of life.
    GoesOnWithout {
        /// These processes, as far as they are known.
        on: &'a [Awaited],
        /// How long they were waited for.
        after: Duration,
    },
    /// All tasks of a job are done that several processes share, except the output.
    TasksEnd {
        /// Those that this process has done.
        done_here: usize,
        /// All of them.
        tasks: usize,
    },
    /// The size of a raster is known, before its cells are computed.
    RasterBegins {
        /// Size and position.
        frame: Frame,
        /// Its coordinate system.
        crs: Option<&'a Crs>,
        /// Its bytes in all outputs, before they are compressed.
        bytes: u64,
    },
    /// All outputs have appeared.
    Written,
}

impl Event<'_> {
    /// Returns what is not as planned; `None` if all is.
    pub fn note(&self) -> Option<String> {
        match self {
            Event::PlannedAgain(path) => Some(format!(
                "{} was skipped, and can be read now: the job is planned again",
                path.display()
            )),
            Event::TilesChosenAgain => Some(
                "the inputs are no longer like those that the tiles were chosen for: all tasks are done again"
                    .to_owned(),
            ),
            Event::TakenOver { task, worker, age } => Some(format!(
                "task {task} is done here: {} does not go on with it, seen {} s ago",
                worker.unwrap_or("its process"),
                age.as_secs()
            )),
            Event::GoesOnWithout { on, after } => Some(format!(
                "the job goes on here: for {} s no other process gave a sign of life{}",
                after.as_secs(),
                listed(on)
            )),
            Event::WaitsForJob { on } => Some(format!(
                "waits for another process that has the job{}",
                listed(on)
            )),
            _ => None,
        }
    }
}

/// Something that a process waits for.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Awaited {
    /// The process, such as "node7:4711".
    pub who: String,
    /// What it does, such as "does task 3".
    pub what: String,
    /// How long ago it gave the last sign of life, if it gives any.
    pub silent: Option<Duration>,
}

impl Display for Awaited {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Awaited { who, what, silent } = self;
        write!(f, "{who} {what}")?;
        match silent {
            Some(silent) => write!(f, ", seen {} s ago", silent.as_secs()),
            None => Ok(()),
        }
    }
}

/// How many of those that are waited for are listed.
const LISTED: usize = 3;

/// Returns the first of them as the end of a sentence, such as `: a; b; and 2 more`; empty if there
/// are none.
pub(crate) fn listed(on: &[Awaited]) -> String {
    let mut text = String::new();
    for (i, one) in on.iter().take(LISTED).enumerate() {
        text.push_str(if i == 0 { ": " } else { "; " });
        text.push_str(&one.to_string());
    }
    if on.len() > LISTED {
        text.push_str(&format!("; and {} more", on.len() - LISTED));
    }
    text
}

/// What a plan consists of.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct JobSize {
    /// The number of files of points.
    pub files: usize,
    /// The number of points that they state.
    pub points: u64,
    /// The number of tiles.
    pub tiles: usize,
    /// True if the files are divided among the tiles first: their points are written and read once
    /// more.
    pub divides: bool,
    /// The number of merges.
    pub merges: usize,
    /// The number of all tasks.
    pub tasks: usize,
    /// About how many bytes the tasks write; 0 if that is not known, as for contours.
    pub bytes_on_disk: u64,
    /// About how much memory each task may need, in bytes.
    pub task_memory: u64,
}
