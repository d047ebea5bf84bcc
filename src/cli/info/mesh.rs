use std::path::Path;

use serde_json::json;

use super::Sheet;
use crate::cli::open::{self, Solid};
use crate::cli::summary::SurfaceFacts;
use crate::data::Surface;
use crate::error::Result;
use crate::run::units::neat;

pub(super) fn sheet(path: &Path) -> Result<Sheet> {
    if let Some(solid) = open::solid(path) {
        return solid.map(|solid| of_solid(&solid));
    }
    let (mesh, flaws) = open::linked_mesh(path)?;
    let facts = SurfaceFacts::of(&mesh);
    let no_surface = flaws.first().map(|flaw| format!("this is no surface: {flaw}; `breakline check` lists all flaws"));
    let mut sheet = Sheet::with_warnings(no_surface.into_iter().collect());
    sheet.silent("kind", "mesh");
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_uppercase();
    sheet.plain("format", format!("TIN, {extension}"));
    sheet.plain("vertices", facts.vertices);
    sheet.plain("triangles", facts.triangles);
    sheet.row("breaklines", format!("{} edges", facts.breaklines), facts.breaklines);
    if facts.clips > 0 {
        sheet.row("clip_lines", format!("{} edges", facts.clips), facts.clips);
    }
    sheet.bounds(facts.extent);
    sheet.crs(mesh.crs());
    Ok(sheet)
}

/// STL has single triangles and no exact coordinates.
fn of_solid(solid: &Solid) -> Sheet {
    let mut sheet = Sheet::default();
    sheet.silent("kind", "mesh");
    sheet.plain("format", "STL, binary");
    sheet.plain("triangles", solid.triangles);
    let origin = solid.origin.map(neat);
    sheet.row("origin", origin.join(" "), json!(solid.origin));
    sheet.bounds(solid.bounds);
    sheet
}
