//! Auxiliary files of GDAL (`relief.png.aux.xml`): the coordinate system of a picture whose format
//! cannot store it.

use std::path::{Path, PathBuf};

use crate::crs::Crs;
use crate::error::{Error, Result};
use crate::io::bytes::appended::appended;
use crate::io::codec::xml::{escaped, unescaped};

/// Limit for the bytes of the file; a larger one contains statistics, which are not used.
const MAX_BYTES: u64 = 1 << 20;

/// Returns the path of the auxiliary file of a picture: `relief.png` has `relief.png.aux.xml`.
pub(crate) fn path_of(picture: &Path) -> PathBuf {
    appended(picture, ".aux.xml")
}

/// Returns the text of an auxiliary file that states the coordinate system, with x before y.
pub(crate) fn text(crs: &Crs) -> String {
    let wkt = escaped(&crs.to_wkt());
    format!("<PAMDataset>\n  <SRS dataAxisToSRSAxisMapping=\"1,2\">{wkt}</SRS>\n</PAMDataset>\n")
}

/// Reads the coordinate system from the auxiliary file of a picture; `None` if the file
/// does not exist or states none.
pub(crate) fn read_beside(picture: &Path) -> Result<Option<Crs>> {
    let path = path_of(picture);
    if !path
        .metadata()
        .is_ok_and(|metadata| metadata.is_file() && metadata.len() < MAX_BYTES)
    {
        return Ok(None);
    }
    let read = || {
        let text = std::fs::read_to_string(&path)?;
        let Some((_, element)) = text.split_once("<SRS") else {
            return Ok(None);
        };
        let wkt = element
            .split_once('>')
            .and_then(|(_, rest)| rest.split_once("</SRS>"));
        let (wkt, _) = wkt.ok_or_else(|| Error::format("the element SRS has no end"))?;
        Crs::from_user(&unescaped(wkt)).map(Some)
    };
    read().map_err(|e: Error| e.in_file(&path))
}
