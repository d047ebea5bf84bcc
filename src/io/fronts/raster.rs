//! Opens a raster in the format that its first bytes indicate.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};
use crate::io::codec::ascii_grid::AsciiGrid;
use crate::io::codec::geotiff::GeoTiffReader;
use crate::io::formats::{self, Content, Format, FormatReader, HEAD};

/// Opens a raster of heights as text; `None` for a file of another format, by its first bytes.
///
/// # Errors
/// Those of [`ascii_grid::open`](crate::io::ascii_grid::open).
pub fn open_grid(path: impl AsRef<Path>) -> Option<Result<AsciiGrid>> {
    let path = path.as_ref();
    match formats::of_bytes(&first_bytes(path).ok()?)?.reader {
        FormatReader::Grid(open) => Some(open(path)),
        _ => None,
    }
}

/// Opens a GeoTIFF of heights. Of other formats, only text is read without GDAL, see
/// [`open_grid`].
///
/// # Errors
/// If the file cannot be opened, is damaged, or has another format; the message names the format if
/// the first bytes identify it.
pub fn open(path: impl AsRef<Path>) -> Result<GeoTiffReader> {
    let path = path.as_ref();
    let head = first_bytes(path).map_err(|e| e.in_file(path))?;
    match formats::of_bytes(&head).map(|format| format.reader) {
        Some(FormatReader::Raster(open)) => open(path),
        _ => Err(refusal(&head, path).in_file(path)),
    }
}

fn first_bytes(path: &Path) -> Result<Vec<u8>> {
    let about = std::fs::metadata(path)?;
    if about.is_dir() {
        return Err(Error::usage("is a folder, not a raster file"));
    }
    // Its bytes are needed in any order. Opening a pipe would take its writer.
    if !about.is_file() {
        return Err(Error::usage("a raster is not read from a pipe or a device")
            .cure("write it to a file first"));
    }
    let mut head = Vec::new();
    File::open(path)?.take(HEAD as u64).read_to_end(&mut head)?;
    Ok(head)
}

fn refusal(head: &[u8], path: &Path) -> Error {
    if head.is_empty() {
        return Error::format("is empty");
    }
    let named = formats::named(head, path);
    match named.filter(|format| {
        format.content == Content::Picture || matches!(format.reader, FormatReader::Gdal)
    }) {
        Some(Format { name, .. }) => Error::unsupported(format!("{name} needs GDAL"))
            .cure("build with the `gdal` feature, or convert with gdal_translate to GeoTIFF"),
        None => {
            Error::unsupported("not a GeoTIFF, nor any raster format that its first bytes identify")
                .cure("build with the `gdal` feature for other raster formats")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_refused_by_name() {
        let refused = |head: &[u8], path: &str| refusal(head, Path::new(path)).to_string();
        assert_eq!(refused(b"UHL1080000", "n43.dt0"), "DTED needs GDAL");
        assert_eq!(
            refused(&[0; 100], "N50E012.HGT"),
            "SRTM height file (HGT) needs GDAL"
        );
        assert!(refused(b"hello", "a.txt").starts_with("not a GeoTIFF"));
        assert!(refused(b"hello", "a.tif").starts_with("not a GeoTIFF"));
    }
}
