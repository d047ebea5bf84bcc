use std::path::Path;

use serde_json::{Value, json};

use super::Sheet;
use crate::cli::open;
use crate::data::{Bounds, Frame};
use crate::error::Result;

pub(super) fn sheet(path: &Path) -> Result<Sheet> {
    let (facts, grid) = open::raster_facts(path)?;
    let frame = facts.place.frame;
    let mut sheet = Sheet::with_warnings(facts.warnings);
    sheet.silent("kind", "raster");
    sheet.plain("format", facts.format);
    sheet.plain("sample", facts.sample);
    sheet.row("size", format!("{} x {} cells", frame.width, frame.height), json!([frame.width, frame.height]));
    sheet.row("cell", cell(&frame), json!(frame.transform));
    sheet.bounds(extent(&frame));
    sheet.crs(facts.place.crs.as_ref());
    match facts.nodata {
        Some(nodata) if nodata.is_finite() => sheet.plain("nodata", nodata),
        // JSON has no such numbers.
        Some(nodata) => sheet.plain("nodata", nodata.to_string()),
        None => sheet.row("nodata", "not stated", Value::Null),
    }
    let mut heights: Option<(f64, f64)> = None;
    let mut valid = 0u64;
    for &value in grid.values.iter().filter(|value| !value.is_nan()) {
        valid += 1;
        let (low, high) = heights.unwrap_or((value, value));
        heights = Some((low.min(value), high.max(value)));
    }
    sheet.row("valid", format!("{valid} of {} cells", grid.values.len()), valid);
    if let Some((low, high)) = heights {
        sheet.plain("min", low);
        sheet.plain("max", high);
    }
    Ok(sheet)
}

fn cell(frame: &Frame) -> String {
    let t = frame.transform;
    if frame.is_north_up() {
        format!("{} x {}, first corner at {} {}", t[1], -t[5], t[0], t[3])
    } else if t[2] == 0.0 && t[4] == 0.0 {
        format!("{} x {} (south up or mirrored), first corner at {} {}", t[1], -t[5], t[0], t[3])
    } else {
        format!("rotated, transform {}", t.map(|value| value.to_string()).join(" "))
    }
}

fn extent(frame: &Frame) -> Bounds {
    let mut bounds = Bounds::default();
    let (width, height) = (frame.width as f64, frame.height as f64);
    for (column, row) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
        let [x, y] = frame.to_map(column, row);
        bounds.add([x, y, f64::NAN]);
    }
    bounds
}
