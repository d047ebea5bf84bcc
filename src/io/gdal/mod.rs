//! Reads any format that [GDAL](https://gdal.org) reads, behind the feature `gdal`: vector layers
//! as [`Layer`](crate::data::Layer), rasters as [`Grid`](crate::data::Grid) or window by window.
//!
//! The formats that this crate reads itself (LAS, GeoTIFF, shapefile, GeoJSON) are not read through
//! GDAL. Coordinates are always easting (or longitude) first. Messages that GDAL would print become
//! errors and warnings.
//!
//! Without the feature the functions exist and return an error that says how to get GDAL. A program
//! that links this library with both features `proj` and `gdal` must be linked with
//! `-Wl,--exclude-libs,ALL`, as this package's `build.rs` does for its own program: otherwise the
//! system's libgdal finds the SQLite that PROJ was built with, and crashes.

use std::path::{Path, PathBuf};

#[cfg(not(feature = "gdal"))]
mod absent;
#[cfg(feature = "gdal")]
mod messages;
#[cfg(feature = "gdal")]
mod raster;
#[cfg(feature = "gdal")]
mod vector;

#[cfg(not(feature = "gdal"))]
pub use absent::{Raster, open_raster, read_layer, read_layer_with};
#[cfg(feature = "gdal")]
pub use raster::{Raster, open_raster};
#[cfg(feature = "gdal")]
pub use vector::{read_layer, read_layer_with};

/// True if this build has GDAL.
pub const IS_AVAILABLE: bool = cfg!(feature = "gdal");

/// Splits `FILE:NAME`. Returns the path unchanged if it is the path of a file as a whole, or if
/// `FILE` does not exist.
fn split(path: &Path) -> (PathBuf, Option<String>) {
    let whole = (path.to_path_buf(), None);
    let (Some(text), false) = (path.to_str(), path.exists()) else {
        return whole;
    };
    text.match_indices(':')
        .map(|(at, _)| (Path::new(&text[..at]), &text[at + 1..]))
        .find(|(file, name)| file.exists() && !name.is_empty())
        .map_or(whole, |(file, name)| (file.to_path_buf(), Some(name.to_owned())))
}

#[cfg(test)]
mod tests {
    use super::split;

    #[test]
    fn the_file_ends_at_the_first_colon_behind_which_no_file_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.gpkg");
        std::fs::write(&file, "").unwrap();
        let text = file.to_str().unwrap();
        assert_eq!(split(&file), (file.clone(), None));
        assert_eq!(split(format!("{text}:roads:Z").as_ref()), (file.clone(), Some("roads:Z".into())));
        assert_eq!(split("nowhere:roads".as_ref()), ("nowhere:roads".into(), None));
    }
}
