//! Opens a raster by what its first bytes say it is.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::geotiff::{self, GeoTiffReader};
use crate::error::{Error, Result};

/// Opens a raster of heights. GeoTIFF is read by this crate itself.
///
/// # Errors
/// If the file cannot be opened, is damaged, or is of another format; the message names the format
/// where its first bytes tell it.
pub fn open(path: impl AsRef<Path>) -> Result<GeoTiffReader> {
    let path = path.as_ref();
    let head = first_bytes(path).map_err(|e| e.in_file(path))?;
    if is_tiff(&head) {
        return geotiff::open(path);
    }
    Err(refusal(&head, path).in_file(path))
}

/// Whether a file begins like a TIFF or BigTIFF file.
pub fn is_tiff(head: &[u8]) -> bool {
    matches!(head, [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..])
}

fn first_bytes(path: &Path) -> Result<Vec<u8>> {
    let mut head = Vec::new();
    let file = File::open(path)?;
    if file.metadata()?.is_dir() {
        return Err(Error::usage("is a folder, not a raster file"));
    }
    file.take(512).read_to_end(&mut head)?;
    Ok(head)
}

fn refusal(head: &[u8], path: &Path) -> Error {
    if head.is_empty() {
        return Error::format("is empty");
    }
    match format_name(head, path) {
        Some(name) => Error::unsupported(format!("{name} needs GDAL"))
            .cure("build with the `gdal` feature, or convert with gdal_translate to GeoTIFF"),
        None => Error::unsupported("is no GeoTIFF, nor any raster format that is known by its first bytes")
            .cure("build with the `gdal` feature for other raster formats"),
    }
}

/// The name of a raster format that is not read here.
fn format_name(head: &[u8], path: &Path) -> Option<&'static str> {
    let has = |at: usize, magic: &[u8]| head.get(at..).is_some_and(|rest| rest.starts_with(magic));
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let lower = head.to_ascii_lowercase();
    let by_magic = [
        (has(0, b"UHL1") || has(0, b"HDR") || has(80, b"UHL1"), "DTED"),
        (lower.starts_with(b"ncols") || lower.starts_with(b"nrows"), "Esri ASCII grid"),
        (has(0, b"DSAA") || has(0, b"DSBB") || has(0, b"DSRB"), "Surfer grid"),
        (has(0, b"EHFA_HEADER_TAG"), "Erdas Imagine"),
        (has(0, b"CDF\x01") || has(0, b"CDF\x02") || has(0, b"\x89HDF"), "netCDF or HDF"),
        (has(0, b"GRIB"), "GRIB"),
        (has(0, b"\x89PNG"), "PNG"),
        (has(0, b"\xff\xd8\xff"), "JPEG"),
        (has(4, b"jP  ") || has(0, b"\xff\x4f\xff\x51"), "JPEG 2000"),
        (has(0, b"SQLite format 3"), "GeoPackage (SQLite)"),
        (has(0, b"<VRTDataset"), "GDAL virtual raster"),
        (extension == "hgt", "SRTM height file (HGT)"),
        (extension == "dem", "USGS DEM"),
        (extension == "bil" || extension == "flt", "raw raster (BIL, FLT)"),
    ];
    by_magic.into_iter().find(|(is_it, _)| *is_it).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_their_first_bytes() {
        let name = |head: &[u8], path: &str| format_name(head, Path::new(path));
        assert_eq!(name(b"UHL1080000", "n43.dt0"), Some("DTED"));
        assert_eq!(name(b"NCOLS 4\nNROWS 5", "a.txt"), Some("Esri ASCII grid"));
        assert_eq!(name(&[0; 100], "N50E012.HGT"), Some("SRTM height file (HGT)"));
        assert_eq!(name(b"hello", "a.txt"), None);
        assert!(is_tiff(b"II*\0rest") && is_tiff(b"MM\0+rest") && !is_tiff(b"II") && !is_tiff(b"IIII"));
    }
}
