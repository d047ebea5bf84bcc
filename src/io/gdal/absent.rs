//! The same functions in a build without GDAL.

use std::convert::Infallible;
use std::path::Path;

use crate::crs::Crs;
use crate::data::{Frame, Grid, Layer, Window};
use crate::error::{Error, Result};

/// A raster that GDAL has open. A build without the feature `gdal` has none.
#[derive(Debug)]
pub struct Raster {
    never: Infallible,
}

/// Fails: this build has no GDAL.
///
/// # Errors
/// Always, with the cure.
pub fn read_layer(path: &Path, _name: Option<&str>) -> Result<Layer> {
    Err(missing("vector", &super::split(path).0))
}

/// Fails: this build has no GDAL.
///
/// # Errors
/// Always, with the cure.
pub fn open_raster(path: impl AsRef<Path>) -> Result<Raster> {
    Err(missing("raster", path.as_ref()))
}

fn missing(what: &str, path: &Path) -> Error {
    Error::unsupported(format!("not a {what} format that this build reads; it is without GDAL"))
        .in_file(path)
        .cure("build with `cargo build --release --features gdal` (needs libgdal-dev and pkg-config)")
}

impl Raster {
    /// "AAIGrid, Float32, 1 band"
    pub fn description(&self) -> String {
        match self.never {}
    }

    /// Size and place.
    pub fn frame(&self) -> Frame {
        match self.never {}
    }

    /// Coordinate system, if known.
    pub fn crs(&self) -> Option<&Crs> {
        match self.never {}
    }

    /// What a user should be told.
    pub fn warnings(&self) -> &[String] {
        match self.never {}
    }

    /// The values of a window.
    ///
    /// # Errors
    /// Never.
    pub fn read_window(&self, _window: Window) -> Result<Vec<f64>> {
        match self.never {}
    }

    /// All values.
    ///
    /// # Errors
    /// Never.
    pub fn read_grid(&self) -> Result<Grid> {
        match self.never {}
    }
}
