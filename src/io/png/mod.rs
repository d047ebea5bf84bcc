//! Shaded relief as a PNG picture, with its place in a world file and its coordinate system in an auxiliary file of GDAL
//! beside it; behind the feature `png`.
//!
//! Without the feature the functions are there, and fail with the cure.

use std::path::{Path, PathBuf};

use crate::crs::Crs;

#[cfg(not(feature = "png"))]
mod absent;
#[cfg(feature = "png")]
mod auxiliary;
#[cfg(feature = "png")]
mod with_png;

#[cfg(not(feature = "png"))]
pub use absent::{describe, write_gray};
#[cfg(feature = "png")]
pub use with_png::{describe, write_gray};

/// The name of the world file of a picture: `relief.png` has `relief.pgw`.
pub fn world_file_of(target: &Path) -> PathBuf {
    target.with_extension("pgw")
}

/// What a picture and the files beside it say.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Columns and rows.
    pub size: [u32; 2],
    /// "PNG, 8 bits, gray and alpha"
    pub format: String,
    /// The corners of its cells on the map (GDAL's order), if a world file is beside it.
    pub transform: Option<[f64; 6]>,
    /// Coordinate system, if an auxiliary file is beside it.
    pub crs: Option<Crs>,
}
