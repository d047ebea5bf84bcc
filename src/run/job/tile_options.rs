//! How a surface is divided into tiles.

use std::path::PathBuf;

use super::division::Division;
use crate::run::sources::point_files::BadFiles;

/// How a surface is divided into tiles.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct TileOptions {
    /// The tiles.
    pub division: Division,
    /// The memory to use, in bytes; half of the free memory if it is `None`.
    pub memory: Option<u64>,
    /// The folder of the job, in which its tasks write. By default it has the name of the first
    /// output with `.job`, and is removed when the outputs are written, unless files were skipped.
    #[serde(skip)]
    pub folder: Option<PathBuf>,
    /// What becomes of files that cannot be read. A job that was planned to skip them does.
    pub bad: BadFiles,
    /// How far files are read to plan.
    pub look: Look,
    /// The memory of one task, in bytes, where the tasks run; by default what there is to use here,
    /// through the number of threads.
    pub task_memory: Option<u64>,
}

/// How far files are read to plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Look {
    /// A sample of the points of large files.
    #[default]
    Points,
    /// Their headers, if these state number and extent: points are taken to be spread evenly.
    Headers,
}
