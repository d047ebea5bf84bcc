use serde_json::{Value, json};

use super::Sheet;
use crate::data::Frame;
use crate::run::RasterFacts;
use crate::run::units::neat;

pub(super) fn sheet(facts: &RasterFacts) -> Sheet {
    let frame = facts.frame;
    let mut sheet = Sheet::with_warnings(facts.warnings.clone());
    sheet.silent("kind", "raster");
    sheet.plain("format", facts.format.as_str());
    if let Some(sample) = &facts.sample {
        sheet.plain("sample", sample.as_str());
    }
    sheet.row(
        "size",
        format!("{} x {} cells", frame.width, frame.height),
        json!([frame.width, frame.height]),
    );
    sheet.row("cell", cell(&frame), json!(frame.transform));
    sheet.bounds(frame.extent());
    sheet.crs(facts.crs.as_ref());
    match facts.nodata {
        Some(nodata) if nodata.is_finite() => sheet.plain("nodata", nodata),
        // JSON has no infinity and no NaN.
        Some(nodata) => sheet.plain("nodata", nodata.to_string()),
        None => sheet.row("nodata", "not stated", Value::Null),
    }
    if facts.scale != 1.0 || facts.offset != 0.0 {
        sheet.plain("scale", facts.scale);
        sheet.plain("offset", facts.offset);
    }
    let cells = frame.width as u64 * frame.height as u64;
    sheet.row(
        "valid",
        format!("{} of {cells} cells", facts.valid),
        facts.valid,
    );
    if let Some([low, high]) = facts.range {
        sheet.plain("min", low);
        sheet.plain("max", high);
    }
    sheet
}

pub(super) fn cell(frame: &Frame) -> String {
    let t = frame.transform;
    if frame.is_north_up() {
        format!(
            "{} x {}, first corner at {} {}",
            neat(t[1]),
            neat(-t[5]),
            neat(t[0]),
            neat(t[3])
        )
    } else if t[2] == 0.0 && t[4] == 0.0 {
        let size = format!("{} x {}", neat(t[1]), neat(-t[5]));
        format!(
            "{size} (south up or mirrored), first corner at {} {}",
            neat(t[0]),
            neat(t[3])
        )
    } else {
        format!(
            "rotated, transform {}",
            t.map(|value| value.to_string()).join(" ")
        )
    }
}
