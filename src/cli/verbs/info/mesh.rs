use std::path::Path;

use serde_json::json;

use super::Sheet;
use crate::data::EdgeKind;
use crate::io::mesh::Solid;
use crate::io::{formats, layer};
use crate::run::MeshFacts;
use crate::run::units::neat;

pub(super) fn sheet(path: &Path, facts: &MeshFacts) -> Sheet {
    let MeshFacts { surface, crs, flaw } = facts;
    let no_surface = flaw
        .map(|flaw| format!("this is not a surface: {flaw}; `breakline check` lists all flaws"));
    let mut sheet = Sheet::with_warnings(no_surface.into_iter().map(Into::into).collect());
    sheet.silent("kind", "mesh");
    let text = path.to_string_lossy();
    let name = formats::of_name(layer::file_of(&text)).map_or("", |format| format.name);
    let format = match name.starts_with("TIN") {
        true => name.to_owned(),
        false => format!("TIN, {name}"),
    };
    sheet.plain("format", format);
    sheet.plain("vertices", surface.vertices);
    sheet.plain("triangles", surface.triangles);
    let breaklines = surface.edges.of(EdgeKind::Breakline);
    sheet.row("breaklines", format!("{breaklines} edges"), breaklines);
    for (kind, count) in surface
        .edges
        .kinds()
        .filter(|(kind, _)| *kind != EdgeKind::Breakline)
    {
        sheet.row(
            kind.noun().replace(' ', "_"),
            format!("{count} edges"),
            count,
        );
    }
    sheet.bounds(surface.extent);
    sheet.crs(crs.as_ref());
    sheet
}

/// Returns the facts about an STL file, which has unconnected triangles without exact coordinates.
pub(super) fn of_solid(solid: &Solid) -> Sheet {
    let mut sheet = Sheet::default();
    sheet.silent("kind", "mesh");
    sheet.plain("format", "STL, binary");
    sheet.plain("triangles", solid.triangles);
    let origin = solid.origin.map(neat);
    sheet.row("origin", origin.join(" "), json!(solid.origin));
    sheet.bounds(solid.bounds);
    sheet
}
