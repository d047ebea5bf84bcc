//! Points from a file of any kind that has them.
//!
//! | file | known by | read by |
//! |---|---|---|
//! | LAS, LAZ, COPC | first bytes `LASF`; `.las`, `.laz` | [`las`] |
//! | shapefile of points | first bytes; `.shp` | [`from_layer`] |
//! | text | what else is text: `.xyz`, `.txt`, `.csv`, `.asc`, `.pts` | [`text`] |

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::{las, text};
use crate::data::{Columns, Layer, PointBatch, PointInfo, PointSource, Shape};
use crate::error::{Error, Result};

/// Points in a batch.
const BATCH: usize = 1 << 16;

/// Bytes that are enough to tell what a file is.
const HEAD: usize = 1024;

/// How points are read, where a file leaves that open.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// The columns of text; without them a header or the first three are taken.
    pub columns: Option<Columns>,
    /// What becomes of LAS and LAZ files that were cut.
    pub cut: las::Cut,
}

/// Opens a file of points; `-` is the standard input (LAS, LAZ or text).
///
/// # Errors
/// If the file cannot be read or holds no points that can be read; the message says what it is
/// instead.
pub fn open(path: impl AsRef<Path>) -> Result<Box<dyn PointSource + Send>> {
    open_with(path, Options::default())
}

/// Like [`open`], but reads as the options say.
///
/// # Errors
/// As [`open`].
pub fn open_with(path: impl AsRef<Path>, options: Options) -> Result<Box<dyn PointSource + Send>> {
    let path = path.as_ref();
    if path.as_os_str() == "-" {
        return open_stream(io::stdin(), Path::new("standard input"), options);
    }
    let named = |error: io::Error| Error::from(error).in_file(path);
    let mut file = File::open(path).map_err(named)?;
    if !file.metadata().map_err(named)?.is_file() {
        return open_stream(file, path, options);
    }
    let head = head(&mut file).map_err(named)?;
    match Kind::of(&head, path) {
        Kind::Las => Ok(Box::new(las::open_with(path, options.cut)?)),
        Kind::Shapefile => shapefile(path),
        Kind::Text => Ok(Box::new(text::open(path, options.columns)?)),
        Kind::Other(other) => Err(other.refuse(path)),
    }
}

/// The same for what can be read only once.
fn open_stream(
    mut stream: impl Read + Send + 'static,
    name: &Path,
    options: Options,
) -> Result<Box<dyn PointSource + Send>> {
    let head = head(&mut stream).map_err(|error| Error::from(error).in_file(name))?;
    let kind = Kind::of(&head, name);
    let whole = io::Cursor::new(head).chain(stream);
    match kind {
        Kind::Las => Ok(Box::new(las::from_stream_with(whole, name, options.cut)?)),
        Kind::Text => Ok(Box::new(text::from_stream(whole, name, options.columns)?)),
        Kind::Shapefile => Err(Error::unsupported("a shapefile cannot be read from a stream")
            .in_file(name)
            .cure("give its path: it is a set of files")),
        Kind::Other(other) => Err(other.refuse(name)),
    }
}

fn head(source: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut head = Vec::with_capacity(HEAD);
    source.take(HEAD as u64).read_to_end(&mut head)?;
    Ok(head)
}

/// What a file is.
enum Kind {
    Las,
    Shapefile,
    Text,
    Other(Other),
}

/// A file that has no points for us.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Other {
    /// Its name, and what to do.
    Known(&'static str, &'static str),
    Unknown,
}

const WITH_GDAL: &str = "build with the feature `gdal` to read it: cargo build --release --features gdal";
const AS_RASTER: &str = "this is a raster: points are expected here";

const TRIANGULATE: &str = "`breakline triangulate` reads it and writes its triangulation, to .ele, .ply or .obj";

/// First bytes of files that are often given for points.
const KNOWN: &[(&[u8], &str, &str)] = &[
    (b"II*\0", "a TIFF file", AS_RASTER),
    (b"MM\0*", "a TIFF file", AS_RASTER),
    (b"II+\0", "a BigTIFF file", AS_RASTER),
    (b"MM\0+", "a BigTIFF file", AS_RASTER),
    (b"\x89PNG", "a PNG picture", AS_RASTER),
    (b"ncols", "an ESRI ASCII grid", AS_RASTER),
    (b"NCOLS", "an ESRI ASCII grid", AS_RASTER),
    (b"ply", "a PLY mesh", "save its vertices as text or LAS"),
    (b"ASTM-E57", "an E57 scan", "save it as LAS or LAZ"),
    (b"PK\x03\x04", "a ZIP archive", "unpack it"),
    (b"\x1f\x8b", "a gzip archive", "unpack it"),
    (b"SQLite format 3\0", "a GeoPackage or another SQLite database", WITH_GDAL),
    (b"fgb\x03fgb", "a FlatGeobuf file", WITH_GDAL),
    (b"AC10", "a DWG drawing", WITH_GDAL),
    (b"\x89HDF", "an HDF5 file", WITH_GDAL),
    (b"<?xml", "an XML file (GML, KML, LandXML)", WITH_GDAL),
    (b"{", "a JSON file", WITH_GDAL),
];

/// Text that is no list of points, by extension.
const NAMED: &[(&str, &str, &str)] = &[
    ("dxf", "a DXF drawing", WITH_GDAL),
    ("node", "a .node file of Triangle", TRIANGULATE),
    ("poly", "a .poly file of Triangle", TRIANGULATE),
];

impl Kind {
    fn of(head: &[u8], path: &Path) -> Self {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        let is = |known: &str| extension.eq_ignore_ascii_case(known);
        if head.starts_with(b"LASF") || is("las") || is("laz") {
            return Kind::Las;
        }
        // File code 9994, big endian.
        if head.starts_with(&[0, 0, 0x27, 0x0a]) || is("shp") {
            return Kind::Shapefile;
        }
        if let Some(&(_, name, cure)) = KNOWN.iter().find(|(magic, ..)| head.starts_with(magic)) {
            return Kind::Other(Other::Known(name, cure));
        }
        if let Some(&(_, name, cure)) = NAMED.iter().find(|(known, ..)| is(known)) {
            return Kind::Other(Other::Known(name, cure));
        }
        // UTF-16 has zeros too; the reader of text refuses it by name.
        let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
        if head.contains(&0) && !is_utf16 {
            return Kind::Other(Other::Unknown);
        }
        Kind::Text
    }
}

impl Other {
    fn refuse(self, path: &Path) -> Error {
        const SUPPORTED: &str = "points are read from LAS, LAZ, COPC, shapefiles and text (x y z)";
        let error = match self {
            Other::Known(name, cure) => Error::unsupported(format!("{name}; {SUPPORTED}")).cure(cure),
            Other::Unknown => Error::unsupported(format!("a binary file of an unknown kind; {SUPPORTED}"))
                .cure(format!("if GDAL knows it: {WITH_GDAL}")),
        };
        error.in_file(path)
    }
}

fn shapefile(path: &Path) -> Result<Box<dyn PointSource + Send>> {
    let layer = super::shapefile::read_layer(path, None)?;
    Ok(Box::new(from_layer(layer).map_err(|e| e.in_file(path))?))
}

/// The points of a vector layer; shapes of other kinds are left out with a warning.
///
/// # Errors
/// If the layer has shapes but no points, or a point has no height.
pub fn from_layer(layer: Layer) -> Result<LayerPoints> {
    let Layer { format, shapes, crs, mut warnings, .. } = layer;
    let mut points = Vec::new();
    let mut others = 0_usize;
    let total = shapes.iter().filter(|shape| !matches!(shape, Shape::Null)).count();
    for (i, shape) in shapes.into_iter().enumerate() {
        match shape {
            Shape::Points(found) => {
                if let Some([x, y, _]) = found.iter().find(|point| point[2].is_nan()) {
                    return Err(Error::format(format!("the point at {x} {y} has no height"))
                        .at(format!("record {}", i + 1))
                        .cure("if an attribute holds the heights, name it: FILE:FIELD"));
                }
                points.extend(found);
            }
            Shape::Null => {}
            Shape::Lines(_) | Shape::Polygon(_) | Shape::Triangles(_) => others += 1,
        }
    }
    if others > 0 && others == total {
        return Err(Error::usage(format!("{format} has no points, but {others} other shapes"))
            .cure("lines and polygons are read with --breaklines"));
    }
    if others > 0 {
        warnings.push(format!("shapes that are not points are left out: {others}"));
    }
    let info = PointInfo { format, count: Some(points.len() as u64), crs, warnings, ..PointInfo::default() };
    Ok(LayerPoints { info, points: points.into_iter() })
}

/// The points of a layer; made by [`from_layer`].
#[derive(Debug)]
pub struct LayerPoints {
    info: PointInfo,
    points: std::vec::IntoIter<[f64; 3]>,
}

impl PointSource for LayerPoints {
    fn info(&self) -> &PointInfo {
        &self.info
    }

    fn read(&mut self, batch: &mut PointBatch) -> Result<()> {
        batch.clear();
        for [x, y, z] in self.points.by_ref().take(BATCH) {
            batch.x.push(x);
            batch.y.push(y);
            batch.z.push(z);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(shapes: Vec<Shape>) -> Layer {
        Layer { format: "shapefile PointZ".into(), shapes, ..Layer::default() }
    }

    #[test]
    fn points_of_a_layer_come_in_batches() {
        let many: Vec<[f64; 3]> = (0..BATCH + 5).map(|i| [i as f64, 1.0, 2.0]).collect();
        let shapes = vec![Shape::Points(vec![[9.0, 8.0, 7.0]]), Shape::Null, Shape::Points(many)];
        let mut source = from_layer(layer(shapes)).unwrap();
        assert_eq!(source.info().count, Some(BATCH as u64 + 6));
        assert_eq!(source.info().format, "shapefile PointZ");
        let mut batch = PointBatch::default();
        let mut sizes = Vec::new();
        loop {
            source.read(&mut batch).unwrap();
            if sizes.is_empty() {
                assert_eq!([batch.x[0], batch.y[0], batch.z[0]], [9.0, 8.0, 7.0]);
                assert_eq!([batch.x[1], batch.x[2]], [0.0, 1.0]);
                assert!(batch.class.is_empty());
            }
            sizes.push(batch.len());
            if batch.is_empty() {
                break;
            }
        }
        assert_eq!(sizes, [BATCH, 6, 0]);
    }

    #[test]
    fn a_layer_without_points_or_heights_is_refused() {
        let line = Shape::Lines(vec![vec![[0.0; 3], [1.0; 3]]]);
        let error = from_layer(layer(vec![line.clone(), Shape::Null])).unwrap_err();
        assert!(error.to_string().contains("has no points, but 1 other shapes"), "{error}");
        let flat = Shape::Points(vec![[1.0, 2.0, f64::NAN]]);
        let error = from_layer(layer(vec![Shape::Null, flat])).unwrap_err();
        assert_eq!(error.to_string(), "record 2: the point at 1 2 has no height");
        let mixed = from_layer(layer(vec![line, Shape::Points(vec![[1.0, 2.0, 3.0]])])).unwrap();
        assert_eq!(mixed.info().warnings, ["shapes that are not points are left out: 1"]);
        assert_eq!(from_layer(layer(Vec::new())).unwrap().info().count, Some(0));
    }

    #[test]
    fn a_stream_is_known_by_its_first_bytes() {
        let open = |bytes: &'static [u8]| open_stream(bytes, Path::new("stream"), Options::default());
        let mut source = open(b"1 2 3\n4 5 6\n").unwrap();
        let mut batch = PointBatch::default();
        source.read(&mut batch).unwrap();
        assert_eq!(batch.x, [1.0, 4.0]);
        assert_eq!(open(b"").unwrap().info().format, "text, separated by blanks");
        for (bytes, message, cure) in [
            (&b"LASF"[..], "ends after 4 bytes", "cut"),
            (b"II*\0\x08\0\0\0", "a TIFF file; points are read from LAS, LAZ", "raster"),
            (b"SQLite format 3\0", "a GeoPackage", "--features gdal"),
            (b"{\"type\": \"FeatureCollection\"}", "a JSON file", "--features gdal"),
            (b"\x7fELF\0\0", "a binary file of an unknown kind; points are read from LAS, LAZ", "gdal"),
            (b"\0\0\x27\x0a\0\0", "a shapefile cannot be read from a stream", "path"),
        ] {
            let error = open(bytes).map(|_| ()).unwrap_err();
            assert!(error.to_string().contains(message), "{error}");
            assert!(error.to_string().starts_with("stream: "), "{error}");
            assert!(error.cure_text().unwrap().contains(cure), "{error}");
        }
    }

    #[test]
    fn what_is_not_there_is_named() {
        let error = open("no/such/file.xyz").map(|_| ()).unwrap_err();
        assert!(error.to_string().starts_with("no/such/file.xyz: "), "{error}");
    }
}
