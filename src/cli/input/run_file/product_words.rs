//! Products in the words of single commands.

use std::ffi::OsString;

/// A product, in the words of a single command.
#[derive(Debug)]
pub(crate) struct ProductWords {
    pub(crate) verb: String,
    /// The words after the name of the program.
    pub(crate) words: Vec<OsString>,
    /// Its number, from 1.
    pub(crate) number: usize,
    /// True if one word stands for all files of the first surface.
    pub(crate) is_of_several: bool,
    /// Where the product is, for errors.
    pub(crate) location: String,
    /// Where each of its keys is, and those of the surface.
    pub(crate) locations: Vec<(String, String)>,
}
