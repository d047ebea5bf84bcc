//! Stand-ins for the functions of this module in a build without GDAL.

use std::convert::Infallible;
use std::path::Path;

use crate::crs::Crs;
use crate::data::{Frame, Grid, Layer, Window};
use crate::error::{Error, Feature, Result, Wording, wording};
use crate::io::Watch;
use crate::io::options::layer::Options;

/// A raster that GDAL has open. A build without the feature `gdal` has none.
#[derive(Debug)]
pub struct Raster {
    never: Infallible,
}

/// Returns an error: this build has no GDAL.
///
/// # Errors
/// Always; the message says how to get GDAL.
pub fn read_layer(path: &Path, _layer: Option<&str>) -> Result<Layer> {
    Err(missing("vector", path))
}

/// Returns an error: this build has no GDAL.
///
/// # Errors
/// Always; the message says how to get GDAL.
pub fn read_layer_with(path: &Path, options: &Options, _watch: Watch) -> Result<Layer> {
    read_layer(path, options.layer)
}

/// Returns an error: this build has no GDAL.
///
/// # Errors
/// Always; the message says how to get GDAL.
pub fn open_raster(path: impl AsRef<Path>) -> Result<Raster> {
    Err(missing("raster", path.as_ref()))
}

fn missing(what: &str, path: &Path) -> Error {
    Error::unsupported(format!(
        "not a {what} format that this build reads; it is without GDAL"
    ))
    .in_file(path)
    .cure(wording![
        "build with ",
        Feature::Gdal,
        " (needs libgdal-dev and pkg-config)"
    ])
}

impl Raster {
    /// Returns a description such as "AAIGrid, Float32, 1 band".
    pub fn description(&self) -> String {
        match self.never {}
    }

    /// Returns the size and position.
    pub fn frame(&self) -> Frame {
        match self.never {}
    }

    /// Returns the coordinate system, if known.
    pub fn crs(&self) -> Option<&Crs> {
        match self.never {}
    }

    /// Returns warnings for the user.
    pub fn warnings(&self) -> &[Wording] {
        match self.never {}
    }

    /// Reads the values of a window.
    ///
    /// # Errors
    /// Never.
    pub fn read_window(&self, _window: Window) -> Result<Vec<f64>> {
        match self.never {}
    }

    /// Reads all values.
    ///
    /// # Errors
    /// Never.
    pub fn read_grid(&self) -> Result<Grid> {
        match self.never {}
    }

    /// Reads all values.
    ///
    /// # Errors
    /// Never.
    pub fn read_grid_with(&self, _watch: Watch) -> Result<Grid> {
        match self.never {}
    }
}
