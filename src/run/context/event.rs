//! What happens while files are written.

use std::path::Path;

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
    /// The tasks of the job in a folder begin.
    TasksBegin(&'a Path),
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
