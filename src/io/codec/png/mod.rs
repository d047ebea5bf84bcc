//! Shaded and colored relief as PNG pictures, behind the feature `png`. The position is stored in a
//! world file, the coordinate system in an auxiliary file of GDAL.
//!
//! Without the feature the functions exist and return an error that says so.

use std::path::{Path, PathBuf};

use crate::crs::Crs;

#[cfg(not(feature = "png"))]
mod absent;
#[cfg(feature = "png")]
mod auxiliary;
#[cfg(feature = "png")]
mod with_png;

#[cfg(not(feature = "png"))]
pub use absent::{describe, write_colors, write_gray};
#[cfg(feature = "png")]
pub use with_png::{describe, write_colors, write_gray};

/// Returns the path of the world file of a picture: `relief.png` has `relief.pgw`.
pub fn world_file_of(target: &Path) -> PathBuf {
    target.with_extension("pgw")
}

/// A description of a picture and the files next to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Number of columns and rows.
    pub size: [u32; 2],
    /// Description of the format: "PNG, 8 bits, gray and alpha".
    pub format: String,
    /// The transform of cell corners to the map (in GDAL's order), if there is a world file.
    pub transform: Option<[f64; 6]>,
    /// Coordinate system, if there is an auxiliary file.
    pub crs: Option<Crs>,
}
