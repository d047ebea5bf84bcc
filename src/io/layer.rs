//! Reads vector layers of any format.

use std::path::{Path, PathBuf};

use super::formats::{self, Reader};
pub use super::layer_options::Options;
use super::watch::{Watch, unwatched};
use crate::data::Layer;
use crate::error::{Error, Result};

/// Reads `FILE` or `FILE:FIELD`; the format follows from the extension or, failing that, from the
/// first bytes.
///
/// `FIELD` names the attribute that contains the heights; see
/// [`shapefile::read_layer`](super::shapefile::read_layer) and
/// [`geojson::read_layer`](super::geojson::read_layer).
///
/// # Errors
/// If the file does not exist or is not a vector layer.
pub fn read(spec: &str) -> Result<Layer> {
    read_with(spec, &[], &unwatched)
}

/// Like [`read`], but with the numbers of the attributes that `columns` names, and watched: the
/// bytes that were parsed are counted, if the format allows it.
///
/// # Errors
/// Those of [`read`], and that of the watch; if an attribute does not exist, or a value is not a
/// number.
pub fn read_with(spec: &str, columns: &[&str], watch: Watch) -> Result<Layer> {
    let (path, field) = split(spec);
    if field == Some("") {
        return Err(Error::usage(format!("{spec}: no field after the colon")).cure("write FILE or FILE:FIELD"));
    }
    if let Some((whole, part)) = formats::format_of_part(&path) {
        let whole_path = path.with_extension(whole.extensions[0]);
        return Err(Error::usage(format!("a .{part} is part of {}", whole.noun)).in_file(&path).cure(format!(
            "name its .{}: {}",
            whole.extensions[0],
            whole_path.display()
        )));
    }
    match formats::detect_file(&path)?.map(|format| format.reader) {
        Some(Reader::Layer(read)) => read(&path, &Options { height_field: field, columns }, watch),
        _ => Err(unsupported(&path)),
    }
}

/// Splits `FILE:FIELD` into its parts.
///
/// If a file with the whole name exists, it takes precedence. The colon after a drive letter and
/// colons before the last separator belong to the path.
pub fn split(spec: &str) -> (PathBuf, Option<&str>) {
    let whole = (PathBuf::from(spec), None);
    if Path::new(spec).exists() {
        return whole;
    }
    match spec.rsplit_once(':') {
        Some((path, field)) if path.len() > 1 && !field.contains(['/', '\\']) => (PathBuf::from(path), Some(field)),
        _ => whole,
    }
}

/// Returns the error for formats that only GDAL may read; what follows the colon is then a layer,
/// not a field.
fn unsupported(path: &Path) -> Error {
    Error::unsupported("not a vector format of this build, which reads shapefiles (.shp) and GeoJSON (.geojson)")
        .in_file(path)
        .cure("build with `--features gdal` to read what GDAL reads")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specs() {
        for (spec, path, field) in [
            ("a.shp", "a.shp", None),
            ("a.shp:Z", "a.shp", Some("Z")),
            ("dir/a.shp:RecupZ", "dir/a.shp", Some("RecupZ")),
            ("C:a.shp", "C:a.shp", None),
            (r"C:\dir\a.shp", r"C:\dir\a.shp", None),
            (r"C:\dir\a.shp:Z", r"C:\dir\a.shp", Some("Z")),
            ("C:/dir/a.shp", "C:/dir/a.shp", None),
            ("10:30/a.shp", "10:30/a.shp", None),
            ("10:30/a.shp:Z", "10:30/a.shp", Some("Z")),
            ("a.shp:", "a.shp", Some("")),
        ] {
            assert_eq!(split(spec), (PathBuf::from(path), field), "{spec}");
        }
    }

    #[test]
    fn an_existing_path_wins() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a:Z");
        std::fs::write(&path, "").unwrap();
        let spec = path.to_str().unwrap();
        assert_eq!(split(spec), (path.clone(), None));
        assert_eq!(split(&format!("{spec}:F")), (path, Some("F")));
    }

    #[test]
    fn other_formats_are_refused_with_the_cure() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gpkg");
        std::fs::write(&path, "SQLite format 3").unwrap();
        let error = read(&format!("{}:roads", path.display())).unwrap_err();
        assert!(error.to_string().ends_with(
            "a.gpkg: not a vector format of this build, which reads shapefiles (.shp) and GeoJSON (.geojson)"
        ));
        assert!(error.cure_text().unwrap().contains("--features gdal"));
        assert!(read(&format!("{}.shp:", path.display())).unwrap_err().to_string().contains("no field"));
        assert!(read("nowhere/a.gpkg").unwrap_err().to_string().starts_with("nowhere/a.gpkg: "));
        let error = read("nowhere/a.dbf").unwrap_err();
        assert_eq!(error.cure_text(), Some("name its .shp: nowhere/a.shp"));
    }
}
