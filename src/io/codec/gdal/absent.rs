//! Stand-ins for the functions of this module in a build without GDAL.

use std::convert::Infallible;
use std::path::Path;

use super::{DriverContent, names};
use crate::crs::Crs;
use crate::data::{BlockSource, ContourLine, Frame, Grid, Layer, Window};
use crate::error::{Error, Feature, Result, Setting, Wording, wording};
use crate::io::Watch;
use crate::io::bytes::output::{Destination, DriverOptions, OutputDriver};
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::codec::geotiff::{CellFormat, RasterSummary};
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

/// Returns true: a build without GDAL finds out nothing of a name that only GDAL can open, and what
/// reads a layer says so.
pub fn holds_layers(_path: &Path) -> bool {
    true
}

/// Returns the name of the driver that writes an output: in a build without GDAL, none.
///
/// # Errors
/// If a driver or one of its options is named, or the output is one that only GDAL could write.
pub fn find_driver(
    options: &DriverOptions,
    path: &Path,
    _content: DriverContent,
) -> Result<Option<String>> {
    if options.is_default() && !names::is_name(path) {
        return Ok(None);
    }
    let asked = match &options.name {
        Some(name) => wording![Setting::Driver.text(name.clone()), " is a driver of GDAL"],
        None => "this output is written by GDAL".into(),
    };
    let error = wording![asked, ", without which this program was built"];
    Err(without_gdal(Error::unsupported(error)).in_file(names::shown(path)))
}

fn missing(what: &str, path: &Path) -> Error {
    let error = match names::is_name(path) {
        true => "this name is for GDAL, without which this program was built".to_owned(),
        false => format!("not a {what} format that this build reads; it is without GDAL"),
    };
    without_gdal(Error::unsupported(error)).in_file(names::shown(path))
}

fn without_gdal(error: Error) -> Error {
    error.cure(wording![
        "build with ",
        Feature::Gdal,
        " (needs libgdal-dev and pkg-config)"
    ])
}

/// Returns an error: this build has no GDAL.
pub(crate) fn write_raster(
    target: Destination,
    _driver: &OutputDriver,
    _source: &dyn BlockSource,
    _cells: CellFormat,
    _watch: Watch,
) -> Result<(RasterSummary, Vec<String>)> {
    Err(missing("raster", target.path()))
}

/// Returns an error: this build has no GDAL.
pub(crate) fn write_contours(
    target: Destination,
    _driver: &OutputDriver,
    _lines: &mut dyn Iterator<Item = ContourLine>,
    _crs: Option<&Crs>,
) -> Result<ContourSummary> {
    Err(missing("vector", target.path()))
}

/// Returns an error: this build has no GDAL.
pub(crate) fn write_layer(
    target: Destination,
    _driver: &OutputDriver,
    _layer: &Layer,
) -> Result<Vec<String>> {
    Err(missing("vector", target.path()))
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
