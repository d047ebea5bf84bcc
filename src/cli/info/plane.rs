use std::path::Path;

use super::Sheet;
use crate::cli::open;
use crate::data::Bounds;
use crate::error::Result;

/// A file of Triangle's: vertices and segments of the plane, or lists about triangles.
pub(super) fn sheet(path: &Path) -> Result<Sheet> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let mut sheet = Sheet::default();
    sheet.silent("kind", "plane");
    sheet.plain("format", format!("Triangle, .{extension}"));
    match extension.as_str() {
        "edge" => sheet.plain("edges", open::listed(path)?),
        "neigh" => sheet.plain("triangles", open::listed(path)?),
        _ => {
            let graph = open::line_graph(path)?;
            let mut bounds = Bounds::default();
            graph.nodes.points.iter().for_each(|&[x, y]| bounds.add([x, y, f64::NAN]));
            sheet.plain("vertices", graph.nodes.points.len());
            sheet.plain("attributes", graph.nodes.attribute_count);
            sheet.bounds(bounds);
            sheet.plain("segments", graph.segments.len());
            sheet.plain("holes", graph.holes.len());
            sheet.plain("regions", graph.regions.len());
            sheet.warnings = graph.warnings;
        }
    }
    Ok(sheet)
}
