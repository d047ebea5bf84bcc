//! Writes contours to a file.

use std::path::Path;

use super::layer;
use crate::crs::Crs;
use crate::data::ContourLine;
use crate::error::{Error, Result};
use crate::io::bytes::output::Destination;
pub use crate::io::codec::contour_summary::ContourSummary;
use crate::io::codec::gdal;
use crate::io::formats::{self, Holding, Product, Writers};
pub(crate) use crate::io::options::map_sheet::MapSheet;

/// Returns an error if lines with `vertices` vertices in total are too large for the format of
/// `target`.
///
/// # Errors
/// If the file would be too large; the message states the minimum size.
pub fn check_size<'a>(target: impl Into<Destination<'a>>, vertices: u64) -> Result<()> {
    let target = target.into();
    if target.driver().is_some() {
        return Ok(());
    }
    let check_size =
        formats::of_name(&target.format_path()).and_then(|format| format.writers.check_size);
    check_size.map_or(Ok(()), |check_size| {
        check_size(vertices).map_err(|e| e.in_file(target.path()))
    })
}

/// Returns true if the format that the extension of a path names takes contours of a map with their
/// labels in one file.
pub(crate) fn takes_labels(path: &Path) -> bool {
    formats::of_name(path).is_some_and(|format| format.writers.map.is_some())
}

/// Returns an error unless the format that the extension of `target` names takes polygons.
///
/// # Errors
/// Names the file, and formats that do.
pub(crate) fn require_areas<'a>(target: impl Into<Destination<'a>>) -> Result<()> {
    let target = target.into();
    match formats::of_name(&target.format_path()).filter(|_| target.driver().is_none()) {
        Some(format) if !format.can_hold(Holding::Polygons) => {
            let error = format!("{} has no areas, only their outlines", format.noun);
            Err(Error::usage(error)
                .in_file(target.path())
                .cure("write the areas as .gpkg, .shp or .geojson"))
        }
        _ => Ok(()),
    }
}

/// Writes contours of a map in the format that the extension of `target` names, and returns
/// warnings. Labels beside contours are left out unless the format [takes both](takes_labels).
///
/// # Errors
/// Those of [`layer::write_lines`].
pub(crate) fn write_map(target: Destination, sheet: &MapSheet) -> Result<Vec<String>> {
    let format = formats::of_name(&target.format_path()).filter(|_| target.driver().is_none());
    match (
        format.and_then(|format| format.writers.map),
        sheet.shapes.or(sheet.labels),
    ) {
        (Some(write), _) => write(target, sheet),
        (None, Some(layer)) => layer::write_lines(target, layer),
        (None, None) => Ok(Vec::new()),
    }
}

/// Writes contours in the format that the extension of `target` names, see
/// [`FORMATS`](formats::FORMATS), or by its driver of GDAL.
///
/// # Errors
/// If contours cannot be written in a format with this extension, or a file cannot be written.
pub fn write<'a>(
    target: impl Into<Destination<'a>>,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> Result<ContourSummary> {
    let target = target.into();
    if let Some(driver) = target.driver() {
        return gdal::write_contours(target, driver, lines, crs);
    }
    match formats::of_name(&target.format_path()).map(|format| format.writers) {
        Some(Writers {
            contours: Some(write),
            ..
        }) => write(target, lines, crs),
        _ => {
            let known = formats::extensions_or(Product::Contours);
            Err(Error::usage(format!("contours are written as {known}")).in_file(target.path()))
        }
    }
}
