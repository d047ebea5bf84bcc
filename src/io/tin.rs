//! TINs in their files: mapped to memory, and written by the surface itself.

use std::path::Path;

use super::listing::Listing;
use super::mapped::{self, Mapped};
use super::output::{Destination, Output};
use crate::error::Result;

/// Maps a file to memory.
pub(super) fn map(path: &Path) -> Result<Mapped> {
    mapped::open(path)
}

/// Writes the surface with its triangulation and its own coordinate system.
pub(super) fn write(target: Destination, mesh: &Listing) -> Result<()> {
    let mut output = Output::create(target.path())?;
    mesh.surface.write_tin(&mut output)?;
    target.put(output)
}
