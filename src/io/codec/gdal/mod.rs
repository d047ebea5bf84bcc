//! Reads any format that [GDAL](https://gdal.org) reads, behind the feature `gdal`: vector layers
//! as [`Layer`](crate::data::Layer), rasters as [`Grid`](crate::data::Grid) or window by window;
//! and writes by any of its drivers, which a [`Destination`](crate::io::Destination) has.
//!
//! The formats that this crate reads or writes itself (LAS, GeoTIFF, shapefile, GeoJSON) do not go
//! through GDAL. Coordinates are always easting (or longitude) first. Messages that GDAL would
//! print become errors and warnings.
//!
//! Without the feature the functions exist and return an error that says how to get GDAL. A program
//! that links this library with both features `proj` and `gdal` must be linked with
//! `-Wl,--exclude-libs,ALL`, as this package's `build.rs` does for its own program: otherwise the
//! system's libgdal finds the SQLite that PROJ was built with, and crashes.

#[cfg(not(feature = "gdal"))]
mod absent;
#[cfg(feature = "gdal")]
mod copied;
#[cfg(feature = "gdal")]
mod drivers;
#[cfg(feature = "gdal")]
mod features;
#[cfg(feature = "gdal")]
mod messages;
mod names;
#[cfg(feature = "gdal")]
mod raster;
#[cfg(feature = "gdal")]
mod vector;

#[cfg(not(feature = "gdal"))]
pub use absent::{Raster, find_driver, holds_layers, open_raster, read_layer, read_layer_with};
#[cfg(not(feature = "gdal"))]
pub(crate) use absent::{write_contours, write_layer, write_raster};
#[cfg(feature = "gdal")]
pub(crate) use copied::write_raster;
#[cfg(feature = "gdal")]
pub use drivers::find_driver;
#[cfg(feature = "gdal")]
pub(crate) use features::{write_contours, write_layer};
pub(crate) use names::{is_connection, split};
pub use names::{is_name, without_secrets};
#[cfg(feature = "gdal")]
pub use raster::{Raster, open_raster};
#[cfg(feature = "gdal")]
pub use vector::{holds_layers, read_layer, read_layer_with};

/// True if this build has GDAL.
pub const IS_AVAILABLE: bool = cfg!(feature = "gdal");

/// What a data set contains that a driver writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriverContent {
    /// A raster of numbers with fractions.
    Heights,
    /// A raster of bytes.
    Shades,
    /// A raster of red, green, blue and opacity, a byte each.
    Colors,
    /// The shapes of a vector layer.
    Shapes,
}
