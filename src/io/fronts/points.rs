//! Reads points from any file that contains them, and writes points.
//!
//! | file | known by | read by |
//! |---|---|---|
//! | LAS, LAZ, COPC | first bytes `LASF`; `.las`, `.laz` | [`las`](crate::io::codec::las) |
//! | shapefile of points | first bytes; `.shp` | [`from_layer`] |
//! | text | any other text: `.xyz`, `.txt`, `.csv`, `.asc`, `.pts` | [`text`](crate::io::codec::text) |

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::data::{Layer, PointBatch, PointInfo, PointSink, PointSource, Shape};
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::output::Destination;
use crate::io::bytes::watch::unwatched;
use crate::io::codec::las::{Detail, Rounding};
use crate::io::formats::{self, Format, FormatReader, HEAD, PointWriter, Product};
use crate::io::options::layer as layer_options;
pub use crate::io::options::points::Options;

/// Points in a batch.
const BATCH: usize = 1 << 16;

/// Opens a file of points; `-` is the standard input (LAS, LAZ or text).
///
/// # Errors
/// If the file cannot be read or contains no points that can be read; the message says what it
/// contains instead.
pub fn open(path: impl AsRef<Path>) -> Result<Box<dyn PointSource + Send>> {
    open_with(path, Options::default())
}

/// Like [`open`], but with options.
///
/// # Errors
/// As [`open`].
pub fn open_with(path: impl AsRef<Path>, options: Options) -> Result<Box<dyn PointSource + Send>> {
    let path = path.as_ref();
    let mut source = open_whole(path, options)?;
    if let Some(spacing) = options.resolution {
        if spacing.is_nan() || spacing <= 0.0 {
            return Err(Error::usage(wording![
                Setting::CopcResolution,
                format!(" is {spacing}, expected a length above zero")
            ]));
        }
        source
            .coarsen(spacing)?
            .ok_or_else(|| without_levels(path))?;
    }
    Ok(source)
}

#[cold]
fn without_levels(path: &Path) -> Error {
    Error::usage("the file has no octree, so its points have no levels to choose from")
        .in_file(path)
        .cure(wording![
            "leave out ",
            Setting::CopcResolution,
            ", which is for COPC; ",
            Setting::Thin,
            " thins points of any format"
        ])
}

/// Opens a file with all of its levels.
fn open_whole(path: &Path, options: Options) -> Result<Box<dyn PointSource + Send>> {
    if path.as_os_str() == "-" {
        return open_stream(io::stdin(), Path::new("standard input"), options);
    }
    let named = |error: io::Error| Error::from(error).in_file(path);
    let mut file = File::open(path).map_err(named)?;
    if !file.metadata().map_err(named)?.is_file() {
        return open_stream(file, path, options);
    }
    let head = head(&mut file).map_err(named)?;
    match formats::detect(&head, path).map(|format| format.reader) {
        Some(FormatReader::Points { file, .. }) => file(path, options),
        Some(FormatReader::Layer(read) | FormatReader::Layers(read)) => {
            let of_layer = layer_options::Options {
                cut: options.cut,
                ..layer_options::Options::default()
            };
            Ok(Box::new(
                from_layer(read(path, &of_layer, &unwatched)?).map_err(|e| e.in_file(path))?,
            ))
        }
        _ => Err(refusal(&head, path)),
    }
}

/// Like [`open_with`], but for input that can be read only once.
fn open_stream(
    mut stream: impl Read + Send + 'static,
    name: &Path,
    options: Options,
) -> Result<Box<dyn PointSource + Send>> {
    let head = head(&mut stream).map_err(|error| Error::from(error).in_file(name))?;
    let Some(format) = formats::detect(&head, name) else {
        return Err(refusal(&head, name));
    };
    let cure = match format.reader {
        FormatReader::Points { stream: open, .. } => {
            let whole = io::Cursor::new(head).chain(stream);
            return open(Box::new(whole), name, options);
        }
        FormatReader::Layer(_) => "give its path: it is a set of files",
        FormatReader::Layers(_) => "give the path of a file",
        _ => return Err(refusal(&head, name)),
    };
    let error = format!("{} cannot be read from a stream", format.noun);
    Err(Error::unsupported(error).in_file(name).cure(cure))
}

/// Returns the detail that must be read of points that are to be written to `target`.
///
/// # Errors
/// If its extension names no format in which points can be written.
pub fn detail_for<'a>(target: impl Into<Destination<'a>>) -> Result<Detail> {
    writer(target.into()).map(|writer| writer.detail)
}

/// Starts to write the points of `sources`, in the format that the extension of `target` names.
///
/// # Errors
/// If points cannot be written in a format with this extension, or not without loss, or the target
/// cannot be written.
pub fn create<'a>(
    target: impl Into<Destination<'a>>,
    sources: &[&PointInfo],
    rounding: Rounding,
) -> Result<Box<dyn PointSink + 'a>> {
    let target = target.into();
    (writer(target)?.create)(target, sources, rounding)
}

fn writer(target: Destination) -> Result<PointWriter> {
    let format = formats::for_output(&target.format_path(), Product::Points);
    format
        .and_then(|format| format.writers.points)
        .ok_or_else(|| {
            let known = formats::extensions_or(Product::Points);
            Error::usage(format!("points are written as {known}")).in_file(target.path())
        })
}

fn head(source: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut head = Vec::with_capacity(HEAD);
    source.take(HEAD as u64).read_to_end(&mut head)?;
    Ok(head)
}

/// Returns the error for a file without points that can be read.
fn refusal(head: &[u8], path: &Path) -> Error {
    const SUPPORTED: &str = "points are read from LAS, LAZ, COPC, shapefiles and text (x y z)";
    let error = match formats::named(head, path) {
        Some(Format { noun, cure, .. }) => {
            Error::unsupported(format!("{noun}; {SUPPORTED}")).cure(cure())
        }
        None => Error::unsupported(format!("a binary file of an unknown kind; {SUPPORTED}"))
            .cure(wording!["if GDAL knows it: ", formats::with_gdal()]),
    };
    error.in_file(path)
}

/// Returns the points of a vector layer; other shapes are left out with a warning.
///
/// # Errors
/// If the layer has shapes but no points, or a point has no height.
pub fn from_layer(mut layer: Layer) -> Result<LayerPoints> {
    let all = std::mem::take(&mut layer.shapes);
    let total = all
        .iter()
        .filter(|shape| !matches!(shape, Shape::Null))
        .count();
    let mut points = Vec::new();
    let mut others = 0_usize;
    for (i, shape) in all.into_iter().enumerate() {
        match shape {
            Shape::Points(found) => {
                if let Some([x, y, _]) = found.iter().find(|point| point[2].is_nan()) {
                    return Err(Error::format(format!("the point at {x} {y} has no height"))
                        .at(format!("record {}", layer.record(i)))
                        .cure("if an attribute holds the heights, name it: FILE:FIELD, or FILE:LAYER:FIELD for one of several layers"));
                }
                points.extend(found);
            }
            Shape::Null => {}
            Shape::Lines(_) | Shape::Polygon(_) | Shape::Faces(_) => others += 1,
        }
    }
    let Layer {
        format,
        crs,
        unread_crs,
        mut warnings,
        ..
    } = layer;
    if others > 0 && others == total {
        return Err(
            Error::usage(format!("{format} has no points, but {others} other shapes")).cure(
                wording!["lines and polygons are read with ", Setting::Breaklines],
            ),
        );
    }
    if others > 0 {
        warnings.push(format!("shapes that are not points are left out: {others}").into());
    }
    let count = Some(points.len() as u64);
    let info = PointInfo {
        format,
        count,
        crs,
        unread_crs,
        warnings,
        ..PointInfo::default()
    };
    Ok(LayerPoints {
        info,
        points: points.into_iter(),
    })
}

/// The points of a layer, made by [`from_layer`].
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
        Layer {
            format: "shapefile PointZ".into(),
            shapes,
            ..Layer::default()
        }
    }

    #[test]
    fn points_of_a_layer_come_in_batches() {
        let many: Vec<[f64; 3]> = (0..BATCH + 5).map(|i| [i as f64, 1.0, 2.0]).collect();
        let shapes = vec![
            Shape::Points(vec![[9.0, 8.0, 7.0]]),
            Shape::Null,
            Shape::Points(many),
        ];
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
        assert!(
            error
                .to_string()
                .contains("has no points, but 1 other shapes"),
            "{error}"
        );
        let flat = Shape::Points(vec![[1.0, 2.0, f64::NAN]]);
        let error = from_layer(layer(vec![Shape::Null, flat])).unwrap_err();
        assert_eq!(
            error.to_string(),
            "record 2: the point at 1 2 has no height"
        );
        let mixed = from_layer(layer(vec![line, Shape::Points(vec![[1.0, 2.0, 3.0]])])).unwrap();
        assert_eq!(
            mixed.info().warnings,
            ["shapes that are not points are left out: 1"]
        );
        assert_eq!(from_layer(layer(Vec::new())).unwrap().info().count, Some(0));
    }

    #[test]
    fn a_stream_is_known_by_its_first_bytes() {
        let open =
            |bytes: &'static [u8]| open_stream(bytes, Path::new("stream"), Options::default());
        let mut source = open(b"1 2 3\n4 5 6\n").unwrap();
        let mut batch = PointBatch::default();
        source.read(&mut batch).unwrap();
        assert_eq!(batch.x, [1.0, 4.0]);
        assert_eq!(
            open(b"").unwrap().info().format,
            "text, separated by blanks"
        );
        for (bytes, message, cure) in [
            (&b"LASF"[..], "ends after 4 bytes", "cut"),
            (
                b"II*\0\x08\0\0\0",
                "a TIFF file; points are read from LAS, LAZ",
                "raster",
            ),
            (b"AC1032\0\0", "a DWG drawing", "the feature `gdal`"),
            (
                b"{\"type\": \"FeatureCollection\"}",
                "a JSON file",
                "the feature `gdal`",
            ),
            (
                b"\x7fELF\0\0",
                "a binary file of an unknown kind; points are read from LAS, LAZ",
                "gdal",
            ),
            (
                b"\0\0\x27\x0a\0\0",
                "a shapefile cannot be read from a stream",
                "path",
            ),
        ] {
            let error = open(bytes).map(|_| ()).unwrap_err();
            assert!(error.to_string().contains(message), "{error}");
            assert!(error.to_string().starts_with("stream: "), "{error}");
            assert!(error.cure_text().unwrap().plain().contains(cure), "{error}");
        }
    }

    #[test]
    fn what_is_not_there_is_named() {
        let error = open("no/such/file.xyz").map(|_| ()).unwrap_err();
        assert!(
            error.to_string().starts_with("no/such/file.xyz: "),
            "{error}"
        );
    }
}
