//! Coordinate systems as JSON.

use serde_json::{Value, json};

use crate::crs::{Crs, CrsKind, Unit};

/// Returns the kind of a system as a word.
pub(crate) fn kind_of(crs: &Crs) -> &'static str {
    match crs.kind {
        CrsKind::Projected => "projected",
        CrsKind::Geographic => "geographic",
        CrsKind::Geocentric => "geocentric",
        CrsKind::Local => "local",
    }
}

/// Returns a system as a JSON object.
pub(crate) fn crs_json(crs: &Crs) -> Value {
    let unit = |unit: &Unit| json!({ "name": unit.name, "factor": unit.factor });
    json!({
        "name": crs.name,
        "epsg": crs.epsg,
        "vertical_epsg": crs.vertical_epsg,
        "kind": kind_of(crs),
        "unit": unit(&crs.unit),
        "vertical_unit": crs.vertical_unit.as_ref().map(unit),
        "wkt": crs.wkt,
    })
}
