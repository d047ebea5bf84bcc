//! Which part of a file of points is read for a window, by the index that the file has.

use std::path::Path;

use super::file_extent::stated_extent;
use crate::data::{Bounds, PointSource};
use crate::error::Result;
use crate::run::context::Journal;
use crate::run::context::notice::Notice;

/// How much of a file is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Share {
    /// All of it.
    Whole,
    /// What may have points in the window.
    Part,
    /// Nothing: by its index it has no points there.
    Nothing,
}

/// Restricts a source to what may have points in a window, in the coordinates of the file.
///
/// A file that does not state where its points are is read whole: that has to be found out. So is
/// one whose points are all within the window, whatever its index says.
///
/// # Errors
/// If the index is damaged.
pub(crate) fn narrow(
    source: &mut (dyn PointSource + Send),
    window: &Bounds,
    path: &Path,
    journal: &Journal,
) -> Result<Share> {
    let Some(Bounds { min, max }) = stated_extent(source.info()).bounds else {
        return Ok(Share::Whole);
    };
    if (0..2).all(|k| window.min[k] <= min[k] && max[k] <= window.max[k]) {
        return Ok(Share::Whole);
    }
    let part = source
        .narrow(window)
        .map_err(|error| error.in_file(path))?
        .filter(|part| part.parts < part.of);
    let Some(part) = part else {
        return Ok(Share::Whole);
    };
    if part.parts == 0 {
        return Ok(Share::Nothing);
    }
    journal.add(Notice::NodesRead {
        path: path.to_path_buf(),
        read: part.parts,
        nodes: part.of,
    });
    Ok(Share::Part)
}
