//! TINs in their files: mapped to memory, and written by the surface itself.

use std::path::Path;

use super::listing::Listing;
use crate::error::{Command, Error, Result, wording};
use crate::io::bytes::mapped::{self, Mapped};
use crate::io::bytes::output::Destination;

/// Maps a file to memory.
pub(crate) fn map(path: &Path) -> Result<Mapped> {
    mapped::open(path)
}

/// Reads the index of a TIN in parts.
pub(crate) fn index(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|e| Error::from(e).in_file(path))
}

/// Returns the error for a surface that is in memory as a whole.
#[cold]
pub(crate) fn needs_tiles() -> Error {
    Error::unsupported("a TIN in parts is written tile by tile, from points").cure(wording![
        "use ",
        Command::Tin,
        " for points, with an output OUT.tins; or write one .tin"
    ])
}

/// Writes the surface with its triangulation and its own coordinate system.
pub(crate) fn write(target: Destination, mesh: &Listing) -> Result<()> {
    let mut output = target.create()?;
    mesh.surface.write_tin(&mut output)?;
    target.put(output)
}
