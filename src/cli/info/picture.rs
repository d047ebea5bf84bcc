use std::path::Path;

use serde_json::json;

use super::Sheet;
use crate::cli::open;
use crate::cli::raster::extent;
use crate::data::Frame;
use crate::error::Result;

pub(super) fn sheet(path: &Path) -> Result<Sheet> {
    let picture = open::picture(path)?;
    let [width, height] = picture.size;
    let mut sheet = Sheet::default();
    sheet.silent("kind", "picture");
    sheet.plain("format", picture.format);
    sheet.row("size", format!("{width} x {height} cells"), json!([width, height]));
    if let Some(transform) = picture.transform {
        let frame = Frame { width: width as usize, height: height as usize, transform };
        sheet.row("cell", super::raster::cell(&frame), json!(transform));
        sheet.bounds(extent(&frame));
    }
    sheet.crs(picture.crs.as_ref());
    Ok(sheet)
}
