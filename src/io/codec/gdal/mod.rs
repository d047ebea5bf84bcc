//! Reads any format that [GDAL](https://gdal.org) reads, behind the feature `gdal`: vector layers
//! as [`Layer`](crate::data::Layer), rasters as [`Grid`](crate::data::Grid) or window by window.
//!
//! The formats that this crate reads itself (LAS, GeoTIFF, shapefile, GeoJSON) are not read through
//! GDAL. Coordinates are always easting (or longitude) first. Messages that GDAL would print become
//! errors and warnings.
//!
//! Without the feature the functions exist and return an error that says how to get GDAL. A program
//! that links this library with both features `proj` and `gdal` must be linked with
//! `-Wl,--exclude-libs,ALL`, as this package's `build.rs` does for its own program: otherwise the
//! system's libgdal finds the SQLite that PROJ was built with, and crashes.

#[cfg(not(feature = "gdal"))]
mod absent;
#[cfg(feature = "gdal")]
mod messages;
#[cfg(feature = "gdal")]
mod raster;
#[cfg(feature = "gdal")]
mod vector;

#[cfg(not(feature = "gdal"))]
pub use absent::{Raster, open_raster, read_layer, read_layer_with};
#[cfg(feature = "gdal")]
pub use raster::{Raster, open_raster};
#[cfg(feature = "gdal")]
pub use vector::{read_layer, read_layer_with};

/// True if this build has GDAL.
pub const IS_AVAILABLE: bool = cfg!(feature = "gdal");
