//! Contours to a file.

pub use super::contour_summary::ContourSummary;
use super::output::Destination;
use super::{geojson, shapefile};
use crate::crs::Crs;
use crate::data::ContourLine;
use crate::error::{Error, Result};

/// Returns an error if lines of so many vertices in all are too large for the format of `target`.
///
/// # Errors
/// With the size that they would have at least.
pub fn foresee<'a>(target: impl Into<Destination<'a>>, vertices: u64) -> Result<()> {
    let target = target.into();
    let is_shapefile = target.format_path().extension().is_some_and(|e| e.eq_ignore_ascii_case("shp"));
    if is_shapefile { shapefile::foresee(vertices).map_err(|e| e.in_file(target.path())) } else { Ok(()) }
}

/// Writes contours in the format that the extension of `target` names: `.shp`, `.geojson` or
/// `.json`.
///
/// # Errors
/// If the extension is another, or a file cannot be written.
pub fn write<'a>(
    target: impl Into<Destination<'a>>,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> Result<ContourSummary> {
    let target = target.into();
    let path = target.format_path();
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    match extension.as_deref() {
        Some("shp") => shapefile::write_contours(target, lines, crs),
        Some("geojson" | "json") => geojson::write_contours(target, lines, crs),
        _ => Err(Error::usage("contours are written as .shp, .geojson or .json").in_file(target.path())),
    }
}
