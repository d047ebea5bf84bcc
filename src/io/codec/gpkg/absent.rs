//! Stand-ins for the functions of this module in a build without SQLite.

use std::path::Path;

use crate::crs::Crs;
use crate::data::{ContourLine, Layer};
use crate::error::{Error, Feature, Result, wording};
use crate::io::Watch;
use crate::io::bytes::output::Destination;
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::options::layer::Options;
use crate::io::options::map_sheet::MapSheet;

/// Returns an error: this build has no SQLite.
///
/// # Errors
/// Always; the message says which feature is missing.
pub fn read_layer_with(path: &Path, _options: &Options, _watch: Watch) -> Result<Layer> {
    Err(missing(path))
}

/// Returns an error: this build has no SQLite.
///
/// # Errors
/// Always; the message says which feature is missing.
pub fn write_contours<'a>(
    target: impl Into<Destination<'a>>,
    _lines: &mut dyn Iterator<Item = ContourLine>,
    _crs: Option<&Crs>,
) -> Result<ContourSummary> {
    Err(missing(target.into().path()))
}

/// Returns an error: this build has no SQLite.
///
/// # Errors
/// Always; the message says which feature is missing.
pub fn write_lines<'a>(target: impl Into<Destination<'a>>, _layer: &Layer) -> Result<Vec<String>> {
    Err(missing(target.into().path()))
}

/// Returns an error: this build has no SQLite.
///
/// # Errors
/// Always; the message says which feature is missing.
pub(crate) fn write_map(target: Destination, _sheet: &MapSheet) -> Result<Vec<String>> {
    Err(missing(target.path()))
}

fn missing(path: &Path) -> Error {
    Error::unsupported("GeoPackage, which this build does not have")
        .in_file(path)
        .cure(wording!["build with ", Feature::Gpkg])
}
