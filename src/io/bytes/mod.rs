//! What formats are made of: files and outputs, numbers and rows of text.

pub(crate) mod appended;
pub(crate) mod code_page;
pub(crate) mod contain;
pub(crate) mod csv;
pub(crate) mod decimal;
pub(crate) mod decimal_mark;
pub(crate) mod field;
pub(crate) mod lines;
pub(crate) mod little_endian;
pub mod mapped;
pub(crate) mod output;
pub(crate) mod rows;
pub(crate) mod watch;
pub(crate) mod watched_value;
pub(crate) mod zip;
