//! Stand-ins for the functions of this module in a build without PNG.

use std::path::Path;

use super::Picture;
use crate::data::{BlockSource, Colors};
use crate::error::{Error, Result};
use crate::io::bytes::output::Destination;

/// Returns an error: this build writes no pictures.
///
/// # Errors
/// Always; the message says which feature is missing.
pub fn write_gray<'a>(target: impl Into<Destination<'a>>, _source: &dyn BlockSource) -> Result<()> {
    Err(missing(target.into().path()))
}

/// Returns an error: this build writes no pictures.
///
/// # Errors
/// Always; the message says which feature is missing.
pub fn write_colors<'a>(
    target: impl Into<Destination<'a>>,
    _source: &dyn BlockSource,
    _colors: &Colors,
) -> Result<()> {
    Err(missing(target.into().path()))
}

/// Returns an error: this build reads no pictures.
///
/// # Errors
/// Always; the message says which feature is missing.
pub fn describe(path: &Path) -> Result<Picture> {
    Err(missing(path))
}

fn missing(path: &Path) -> Error {
    Error::unsupported("PNG, which this build does not have")
        .in_file(path)
        .cure("build with the feature `png`")
}
