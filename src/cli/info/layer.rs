use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Map, json};

use super::Sheet;
use crate::cli::open;
use crate::data::{Bounds, Shape, ShapeKind};
use crate::error::Result;
use crate::run::units::counted;

pub(super) fn sheet(path: &Path) -> Result<Sheet> {
    let layer = open::layer(path)?;
    let mut sheet = Sheet::with_warnings(layer.warnings.clone());
    let mut kinds: BTreeMap<ShapeKind, u64> = BTreeMap::new();
    let (mut parts, mut vertices, mut without_height) = (0, 0u64, 0u64);
    let mut bounds = Bounds::default();
    for shape in &layer.shapes {
        *kinds.entry(shape.kind()).or_default() += 1;
        parts += match shape {
            Shape::Lines(parts) | Shape::Polygon(parts) => parts.len(),
            Shape::Null | Shape::Points(_) | Shape::Triangles(_) => 0,
        };
        for &vertex in shape.vertices() {
            vertices += 1;
            without_height += u64::from(vertex[2].is_nan());
            bounds.add(vertex);
        }
    }
    sheet.silent("kind", "layer");
    sheet.plain("format", layer.format.as_str());
    sheet.row("count", counted(layer.shapes.len() as u64, "record"), layer.shapes.len());
    let words: Vec<String> = kinds.iter().map(|(kind, count)| format!("{}: {count}", name(*kind))).collect();
    let object: Map<_, _> = kinds.iter().map(|(kind, count)| (name(*kind).to_owned(), json!(count))).collect();
    sheet.row("shapes", words.join(", "), object);
    sheet.plain("parts", parts);
    sheet.plain("vertices", vertices);
    sheet.bounds(bounds);
    let text = match without_height {
        0 if vertices > 0 => "at every vertex".to_owned(),
        n if n == vertices => "none".to_owned(),
        n => format!("missing at {n} vertices"),
    };
    sheet.row("heights", text, vertices - without_height);
    sheet.crs(layer.crs.as_ref());
    let fields = if layer.fields.is_empty() { "none".to_owned() } else { layer.fields.join(", ") };
    sheet.row("fields", fields, layer.fields.clone());
    Ok(sheet)
}

fn name(kind: ShapeKind) -> &'static str {
    match kind {
        ShapeKind::Null => "null",
        ShapeKind::Points => "points",
        ShapeKind::Lines => "lines",
        ShapeKind::Polygon => "polygon",
        ShapeKind::Triangles => "triangles",
    }
}
