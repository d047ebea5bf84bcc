//! Contours to a file.

use super::{Destination, geojson, shapefile};
use crate::crs::Crs;
use crate::data::{Bounds, ContourLine};
use crate::error::{Error, Result};

/// What was written.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContourSummary {
    /// Lines.
    pub lines: usize,
    /// Vertices of all lines; the last of a closed line counts.
    pub vertices: usize,
    /// Lines that end where they begin.
    pub closed: usize,
    /// In plan and in height.
    pub bounds: Bounds,
    /// What a user should be told.
    pub warnings: Vec<String>,
}

impl ContourSummary {
    pub(super) fn add(&mut self, line: &ContourLine) {
        self.lines += 1;
        self.vertices += line.points.len();
        self.closed += usize::from(line.is_closed());
        line.points.iter().for_each(|&[x, y]| self.bounds.add([x, y, line.level]));
    }
}

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
