//! What a verb does between reading and writing, without a command line.

pub(crate) mod lines;
pub(crate) mod memory;
pub(crate) mod overlaps;
mod rings;
pub(crate) mod units;
