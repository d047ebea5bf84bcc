use serde_json::json;

use super::Sheet;
use crate::data::Frame;
use crate::io::png::Picture;

pub(super) fn sheet(picture: &Picture) -> Sheet {
    let [width, height] = picture.size;
    let mut sheet = Sheet::default();
    sheet.silent("kind", "picture");
    sheet.plain("format", picture.format.as_str());
    sheet.row(
        "size",
        format!("{width} x {height} cells"),
        json!([width, height]),
    );
    if let Some(transform) = picture.transform {
        let frame = Frame {
            width: width as usize,
            height: height as usize,
            transform,
        };
        sheet.row("cell", super::raster::cell(&frame), json!(transform));
        sheet.bounds(frame.extent());
    }
    sheet.crs(picture.crs.as_ref());
    sheet
}
