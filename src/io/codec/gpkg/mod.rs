//! GeoPackage (OGC 12-128r15), behind the feature `gpkg`: layers of points, lines and polygons with
//! their attributes in an SQLite database.
//!
//! Without the feature the functions exist and return an error that says so.

#[cfg(not(feature = "gpkg"))]
mod absent;
#[cfg(feature = "gpkg")]
mod geometry;
#[cfg(feature = "gpkg")]
mod read;
#[cfg(all(test, feature = "gpkg"))]
mod tests;
#[cfg(feature = "gpkg")]
mod write;

#[cfg(not(feature = "gpkg"))]
pub(crate) use absent::write_map;
#[cfg(not(feature = "gpkg"))]
pub use absent::{read_layer_with, write_contours, write_lines};
#[cfg(feature = "gpkg")]
pub use read::read_layer_with;
#[cfg(feature = "gpkg")]
pub(crate) use write::write_map;
#[cfg(feature = "gpkg")]
pub use write::{write_contours, write_lines};

/// True if this build reads and writes GeoPackage itself.
pub const IS_AVAILABLE: bool = cfg!(feature = "gpkg");
