//! What is asked for by a run of several products.

use std::path::Path;

/// Where the tables of a run are.
#[derive(Debug, Clone, Copy)]
pub enum RunTables<'a> {
    /// In a file (TOML).
    File(&'a Path),
    /// In a JSON object.
    Json(&'a str),
}

/// How products are made.
#[derive(Debug, Clone, Copy, Default)]
pub struct RunOptions {
    /// True if files that exist are replaced.
    pub overwrite: bool,
    /// The memory for surfaces of points, in bytes; half of what is free if it is `None`.
    pub memory: Option<u64>,
    /// True if nothing is made.
    pub dry_run: bool,
}
