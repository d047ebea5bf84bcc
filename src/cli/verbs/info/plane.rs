use std::path::Path;

use super::Sheet;
use crate::run::PlaneFacts;

/// Returns the facts about a file of Triangle: vertices and segments of the plane, or lists about
/// triangles.
pub(super) fn sheet(path: &Path, facts: &PlaneFacts) -> Sheet {
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    let mut sheet = Sheet::default();
    sheet.silent("kind", "plane");
    sheet.plain("format", format!("Triangle, .{extension}"));
    match facts {
        PlaneFacts::Edges(count) => sheet.plain("edges", *count),
        PlaneFacts::Neighbors(count) => sheet.plain("triangles", *count),
        PlaneFacts::Graph {
            vertices,
            attributes,
            bounds,
            segments,
            holes,
            regions,
            warnings,
        } => {
            sheet.plain("vertices", *vertices);
            sheet.plain("attributes", *attributes);
            sheet.bounds(*bounds);
            sheet.plain("segments", *segments);
            sheet.plain("holes", *holes);
            sheet.plain("regions", *regions);
            sheet.warnings.clone_from(warnings);
        }
    }
    sheet
}
