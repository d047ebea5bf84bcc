//! Reads vector layers of any format, and writes lines.

use std::path::{Path, PathBuf};

use crate::data::Layer;
use crate::error::{Error, Feature, Result, wording};
use crate::io::bytes::output::Destination;
use crate::io::bytes::watch::{Watch, unwatched};
use crate::io::codec::{gdal, gpkg};
use crate::io::formats::{self, FormatReader, Product, Writers};
pub use crate::io::options::condition::{BoundCondition, Condition};
use crate::io::options::cut::OnDamage;
pub use crate::io::options::layer::Options;

/// A vector layer as a user names it: a file, the layer and the attribute to read of it, and which
/// records.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spec {
    /// The file, or the folder of a file geodatabase.
    pub path: PathBuf,
    /// The layer; `None` for the only one.
    pub layer: Option<String>,
    /// The attribute that contains the heights; without one, they come from the geometry.
    pub field: Option<String>,
    /// Which records are read; `None` for all.
    pub condition: Option<Condition>,
}

impl Spec {
    /// Parses what a user wrote:
    ///
    /// | | layer | attribute with the heights |
    /// |---|---|---|
    /// | `FILE` | the only one | none |
    /// | `FILE:NAME`, if the format has one layer per file (shapefile, GeoJSON, FlatGeobuf) | the only one | `NAME` |
    /// | `FILE:NAME`, for all other formats | `NAME` | none |
    /// | `FILE:LAYER:FIELD` | `LAYER` | `FIELD` |
    /// | `FILE::FIELD` | the only one | `FIELD` |
    ///
    /// Each may be followed by ` where ` in any case and a [`Condition`], as in `edges.gpkg:lines
    /// where kind = 'toe'`: only such records are read.
    ///
    /// The file is the longest part before a colon that exists; if none does, the part before the
    /// first colon. The colon after a drive letter and colons before the last separator belong to
    /// the path. The format follows from the first bytes and the extension of the file.
    ///
    /// # Errors
    /// If a name is missing after a colon, or the condition is none.
    pub fn parse(text: &str) -> Result<Self> {
        let (text, condition) = without_condition(text);
        let condition = condition.map(Condition::parse).transpose();
        let condition = condition.map_err(|error| error.in_file(text))?;
        let (path, names) = split(text);
        let of_path = |layer: Option<&str>, field: Option<&str>| {
            Ok(Spec {
                path: path.to_owned(),
                layer: layer.map(str::to_owned),
                field: field.map(str::to_owned),
                condition: condition.clone(),
            })
        };
        match names.map(|names| (names, names.split_once(':'))) {
            None => of_path(None, None),
            Some(("", _) | (_, Some((_, "")))) => {
                Err(Error::usage(format!("{text}: no name after the colon")).cure(FORMS))
            }
            Some((name, None)) if has_one_layer(path) => of_path(None, Some(name)),
            Some((name, None)) => of_path(Some(name), None),
            Some((_, Some(("", field)))) => of_path(None, Some(field)),
            Some((_, Some((layer, field)))) => of_path(Some(layer), Some(field)),
        }
    }

    /// Returns the layer of a file that may have several, if it is named.
    pub fn layer_of_several(&self) -> Option<&str> {
        self.layer.as_deref().filter(|_| !has_one_layer(&self.path))
    }

    /// Returns what to read of the layer, with these columns.
    pub(crate) fn options<'a>(&'a self, columns: &'a [&'a str], cut: OnDamage) -> Options<'a> {
        Options {
            layer: self.layer.as_deref(),
            height_field: self.field.as_deref(),
            columns,
            condition: self.condition.as_ref(),
            cut,
            ..Options::default()
        }
    }
}

/// The forms that [`Spec::parse`] reads, for a message.
const FORMS: &str = "write FILE, FILE:FIELD, FILE:LAYER:FIELD or FILE::FIELD";

/// Returns the file of a layer as a user names it, without the names and the condition that may
/// follow.
pub fn file_of(text: &str) -> &Path {
    split(without_condition(text).0).0
}

/// Returns a layer as a user names it with a condition, in the form that [`Spec::parse`] reads.
pub fn with_condition(text: &str, condition: &str) -> String {
    format!("{text}{WHERE}{condition}")
}

/// What is between the name of a layer and its condition, in any case.
const WHERE: &str = " where ";

/// Splits a text into the name of a layer and the condition after it. A file may have a name that
/// looks as if there were one.
pub(super) fn without_condition(text: &str) -> (&str, Option<&str>) {
    if Path::new(text).exists() {
        return (text, None);
    }
    // Only ASCII is changed, so positions remain.
    let lower = text.to_ascii_lowercase();
    let splits = lower.match_indices(WHERE);
    let mut splits = splits.map(|(at, _)| (&text[..at], Some(&text[at + WHERE.len()..])));
    let first = splits.clone().next();
    let is_there = |path: &Path| path.exists() || gdal::is_name(path);
    let of_file = splits.find(|(name, _)| is_there(split(name).0));
    of_file.or(first).unwrap_or((text, None))
}

/// Splits a text into the file and the names after it.
pub(super) fn split(text: &str) -> (&Path, Option<&str>) {
    let whole = (Path::new(text), None);
    if whole.0.exists() {
        return whole;
    }
    if gdal::is_name(text) {
        return gdal::split(text);
    }
    let name_start = text.rfind(['/', '\\']).map_or(0, |at| at + 1);
    // A single letter before a colon is a drive.
    let colons = text
        .match_indices(':')
        .map(|(at, _)| at)
        .filter(|&at| at > 1 && at > name_start);
    let parts = colons.map(|at| (Path::new(&text[..at]), Some(&text[at + 1..])));
    let mut parts: Vec<(&Path, Option<&str>)> = parts.collect();
    match parts.iter().rposition(|(path, _)| path.exists()) {
        Some(longest) => parts.swap_remove(longest),
        None => parts.first().copied().unwrap_or(whole),
    }
}

/// Returns true if a file of this format is one layer.
fn has_one_layer(path: &Path) -> bool {
    // A file that does not exist is known by its name.
    let format = formats::detect_file(path).unwrap_or_else(|_| formats::of_name(path));
    format.is_some_and(|format| matches!(format.reader, FormatReader::Layer(_)))
}

/// Reads a layer that is named as in [`Spec::parse`]; the format follows from the extension or,
/// failing that, from the first bytes.
///
/// What an attribute with heights may contain is documented at
/// [`shapefile::read_layer`](crate::io::codec::shapefile::read_layer) and
/// [`geojson::read_layer`](crate::io::codec::geojson::read_layer).
///
/// # Errors
/// If the file does not exist or is not a vector layer; if it has no such layer or attribute.
pub fn read(text: &str) -> Result<Layer> {
    let spec = Spec::parse(text)?;
    read_with(&spec.path, &spec.options(&[], OnDamage::Refuse), &unwatched)
}

/// Like [`read`], but of a file, with options, and watched: the bytes that were parsed are counted,
/// if the format allows it.
///
/// # Errors
/// Those of [`read`], and that of the watch; if an attribute does not exist, or a value is not a
/// number.
pub fn read_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    if let Some((whole, part)) = formats::format_of_part(path) {
        let whole_path = path.with_extension(whole.extensions[0]);
        return Err(Error::usage(format!("a .{part} is part of {}", whole.noun))
            .in_file(path)
            .cure(format!(
                "name its .{}: {}",
                whole.extensions[0],
                whole_path.display()
            )));
    }
    match formats::detect_file(path)?.and_then(|format| format.reader.layer()) {
        Some(read) => options
            .read_chosen(|options| read(path, options, watch))
            .map_err(|error| error.in_input(path)),
        None => Err(unsupported(path)),
    }
}

/// Writes the lines of a layer with all its attributes, in the format that the extension of
/// `target` names, see [`FORMATS`](formats::FORMATS). Returns warnings.
///
/// # Errors
/// If lines cannot be written in a format with this extension, the format has no room for them, or
/// a file cannot be written.
pub fn write_lines<'a>(target: impl Into<Destination<'a>>, layer: &Layer) -> Result<Vec<String>> {
    let target = target.into();
    if let Some(driver) = target.driver() {
        return gdal::write_layer(target, driver, layer);
    }
    match formats::of_name(&target.format_path()).map(|format| format.writers) {
        Some(Writers {
            lines: Some(write), ..
        }) => write(target, layer),
        _ => {
            let known = formats::extensions_or(Product::Lines);
            Err(Error::usage(format!("lines are written as {known}")).in_file(target.path()))
        }
    }
}

/// Returns the error for formats that only GDAL may read.
fn unsupported(path: &Path) -> Error {
    let package = match gpkg::IS_AVAILABLE {
        true => ", GeoPackage (.gpkg)",
        false => "",
    };
    Error::unsupported(format!(
        "not a vector format of this build, which reads shapefiles (.shp), GeoJSON (.geojson)\
         {package}, FlatGeobuf (.fgb) and DXF"
    ))
    .in_file(path)
    .cure(wording![
        "build with ",
        Feature::Gdal,
        " to read what GDAL reads"
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spec(path: impl Into<PathBuf>, layer: Option<&str>, field: Option<&str>) -> Spec {
        Spec {
            path: path.into(),
            layer: layer.map(str::to_owned),
            field: field.map(str::to_owned),
            condition: None,
        }
    }

    #[test]
    fn specs() {
        for (text, path, layer, field) in [
            ("a.shp", "a.shp", None, None),
            ("a.shp:Z", "a.shp", None, Some("Z")),
            ("a.geojson:Z", "a.geojson", None, Some("Z")),
            ("a.shp:a:Z", "a.shp", Some("a"), Some("Z")),
            ("a.shp::Z", "a.shp", None, Some("Z")),
            (
                "a.geojson::ele:height",
                "a.geojson",
                None,
                Some("ele:height"),
            ),
            ("dir/a.shp:RecupZ", "dir/a.shp", None, Some("RecupZ")),
            ("a.gpkg", "a.gpkg", None, None),
            ("a.gpkg:roads", "a.gpkg", Some("roads"), None),
            ("a.gpkg:roads:Z", "a.gpkg", Some("roads"), Some("Z")),
            ("a.gpkg::Z", "a.gpkg", None, Some("Z")),
            ("dir/a.gdb:roads", "dir/a.gdb", Some("roads"), None),
            ("a.dxf::Z", "a.dxf", None, Some("Z")),
            ("C:a.shp", "C:a.shp", None, None),
            ("C:a.shp:Z", "C:a.shp", None, Some("Z")),
            (r"C:\dir\a.shp", r"C:\dir\a.shp", None, None),
            (r"C:\dir\a.shp:Z", r"C:\dir\a.shp", None, Some("Z")),
            (
                r"C:\dir\a.gpkg:roads:Z",
                r"C:\dir\a.gpkg",
                Some("roads"),
                Some("Z"),
            ),
            (r"C:\dir\a.gpkg::Z", r"C:\dir\a.gpkg", None, Some("Z")),
            ("C:/dir/a.shp", "C:/dir/a.shp", None, None),
            ("10:30/a.shp", "10:30/a.shp", None, None),
            ("10:30/a.shp:Z", "10:30/a.shp", None, Some("Z")),
            (
                "10:30/a.gpkg:roads:Z",
                "10:30/a.gpkg",
                Some("roads"),
                Some("Z"),
            ),
            (":Z", ":Z", None, None),
        ] {
            assert_eq!(
                Spec::parse(text).unwrap(),
                spec(path, layer, field),
                "{text}"
            );
        }
        for text in ["a.shp:", "a.shp::", "a.shp:a:", "a.gpkg:", "a.gpkg:roads:"] {
            let error = Spec::parse(text).unwrap_err();
            assert_eq!(
                error.to_string(),
                format!("{text}: no name after the colon")
            );
            assert_eq!(*error.cure_text().unwrap(), FORMS);
        }
    }

    #[test]
    fn the_longest_existing_path_wins() {
        let folder = tempfile::tempdir().unwrap();
        let name = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        for file in ["a:Z.shp", "a", "b.gpkg", "b.gpkg:roads"] {
            std::fs::write(name(file), "").unwrap();
        }
        assert_eq!(
            Spec::parse(&name("a:Z.shp")).unwrap(),
            spec(name("a:Z.shp"), None, None)
        );
        assert_eq!(
            Spec::parse(&name("a:Z.shp:F")).unwrap(),
            spec(name("a:Z.shp"), None, Some("F"))
        );
        assert_eq!(
            Spec::parse(&name("a:Z.shp:L:F")).unwrap(),
            spec(name("a:Z.shp"), Some("L"), Some("F"))
        );
        assert_eq!(
            Spec::parse(&name("b.gpkg:rivers:Z")).unwrap(),
            spec(name("b.gpkg"), Some("rivers"), Some("Z"))
        );
        assert_eq!(
            Spec::parse(&name("b.gpkg:roads")).unwrap(),
            spec(name("b.gpkg:roads"), None, None)
        );
        // A folder is a path like a file: a geodatabase is one.
        std::fs::create_dir(name("c.gdb")).unwrap();
        assert_eq!(
            Spec::parse(&name("c.gdb:roads:Z")).unwrap(),
            spec(name("c.gdb"), Some("roads"), Some("Z"))
        );
        assert_eq!(file_of(&name("c.gdb:roads:Z")), Path::new(&name("c.gdb")));
    }

    #[test]
    fn other_formats_are_refused_with_the_cure() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.kml");
        std::fs::write(&path, "<?xml version=\"1.0\"?><kml/>").unwrap();
        let error = read(&format!("{}:roads", path.display())).unwrap_err();
        assert!(error.to_string().ends_with(
            "a.kml: not a vector format of this build, which reads shapefiles (.shp), GeoJSON (.geojson), GeoPackage (.gpkg), FlatGeobuf (.fgb) and DXF"
        ));
        assert!(
            error
                .cure_text()
                .unwrap()
                .plain()
                .contains("the feature `gdal`")
        );
        assert!(
            read(&format!("{}.shp:", path.display()))
                .unwrap_err()
                .to_string()
                .contains("no name")
        );
        assert!(
            read("nowhere/a.kml")
                .unwrap_err()
                .to_string()
                .starts_with("nowhere/a.kml: ")
        );
        let error = read("nowhere/a.dbf").unwrap_err();
        assert_eq!(*error.cure_text().unwrap(), "name its .shp: nowhere/a.shp");
    }
}
