use serde_json::{Map, json};

use super::Sheet;
use crate::cli::report::summary::counted;
use crate::data::ShapeKind;
use crate::run::LayerFacts;

pub(super) fn sheet(facts: &LayerFacts) -> Sheet {
    let LayerFacts {
        records,
        kinds,
        vertices,
        without_height,
        ..
    } = facts;
    let mut sheet = Sheet::with_warnings(facts.warnings.clone());
    sheet.silent("kind", "layer");
    sheet.plain("format", facts.format.as_str());
    sheet.row("count", counted(*records as u64, "record"), *records);
    let words: Vec<String> = kinds
        .iter()
        .map(|(kind, count)| format!("{}: {count}", name(*kind)))
        .collect();
    let object: Map<_, _> = kinds
        .iter()
        .map(|(kind, count)| (name(*kind).to_owned(), json!(count)))
        .collect();
    sheet.row("shapes", words.join(", "), object);
    sheet.plain("parts", facts.parts);
    sheet.plain("vertices", *vertices);
    sheet.bounds(facts.bounds);
    let text = match *without_height {
        0 if *vertices > 0 => "at every vertex".to_owned(),
        n if n == *vertices => "none".to_owned(),
        n => format!("missing at {n} vertices"),
    };
    sheet.row("heights", text, vertices - without_height);
    sheet.crs(facts.crs.as_ref());
    let fields = if facts.fields.is_empty() {
        "none".to_owned()
    } else {
        facts.fields.join(", ")
    };
    sheet.row("fields", fields, facts.fields.clone());
    sheet
}

fn name(kind: ShapeKind) -> &'static str {
    match kind {
        ShapeKind::Null => "null",
        ShapeKind::Points => "points",
        ShapeKind::Lines => "lines",
        ShapeKind::Polygon => "polygon",
        ShapeKind::Faces => "faces",
    }
}
