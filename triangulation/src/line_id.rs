//! The numbers of lines.

use crate::tds::Id;

/// The type tag of line numbers.
#[derive(Debug)]
pub enum LineTag {}

/// The number of a line: its position among all lines that were given.
pub type LineId = Id<LineTag>;
