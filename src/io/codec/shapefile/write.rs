//! Writes shapefiles.

use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

use super::header::{FILE_CODE, HEADER};
use super::kept;
use super::number::{NUMBER_DECIMALS, NUMBER_WIDTH, real};
use crate::crs::Crs;
use crate::data::{Bounds, ContourLine, Layer, Shape, ShapeKind, Value};
use crate::error::{Error, Result};
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::{Destination, Output};

/// Limit for the bytes of each file: many programs read no more.
const MAX_BYTES: u64 = i32::MAX as u64;

/// The cure if a shapefile would be too large.
const TOO_LARGE: &str = "write GeoJSON, or less data: a larger interval or a part of the area";

/// The stored value for a missing height; below [`record::NO_DATA`](super::record::NO_DATA).
const NO_HEIGHT: f64 = -1e40;

const ID_WIDTH: u8 = 10;

/// A numeric attribute.
#[derive(Debug, Clone, Copy)]
pub struct Column<'a> {
    /// The name: at most ten bytes of ASCII.
    pub name: &'a str,
    /// One number per shape; NaN for a missing one.
    pub values: &'a [f64],
}

/// Writes contours as PolyLineZ with the fields `ID` (from 1) and `ELEV`; every vertex has the
/// height of its line's level. The bytes depend only on the lines: the date in the `.dbf` is always
/// 1970-01-01.
///
/// Lines are written as they arrive; none are kept in memory. Lines with fewer than two vertices
/// are left out.
///
/// # Errors
/// If a file cannot be written, or would be larger than 2 GiB. Existing files are then left
/// untouched.
pub fn write_contours<'a>(
    target: impl Into<Destination<'a>>,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> Result<ContourSummary> {
    let target = target.into();
    let fields = [
        field("ID", ID_WIDTH, 0)?,
        field("ELEV", NUMBER_WIDTH, NUMBER_DECIMALS)?,
    ];
    let mut set = FileSet::create(target, 13, &fields)?;
    let mut summary = ContourSummary::default();
    let mut record = Vec::new();
    // `PERF:` consecutive lines have the same level; formatting its number for each would take
    // longer than tracing small lines.
    let mut elevation = (f64::NAN, String::new());
    for line in lines {
        if line.points.len() < 2 {
            continue;
        }
        let bounds = summary.add(&line);
        let vertices = line.points.iter().map(|&[x, y]| [x, y, line.level]);
        record.clear();
        poly(&mut record, 13, &[line.points.len()], vertices, &bounds);
        if elevation.0 != line.level {
            elevation = (line.level, real(line.level));
        }
        set.write(&record, &bounds, &[&id(summary.lines), &elevation.1])?;
    }
    set.finish(target, crs)?;
    Ok(summary)
}

/// Writes shapes of one kind (with null shapes among them, if any): points, lines or polygons, with
/// heights if any vertex has one. Without columns, the table has an `ID` from 1.
///
/// # Errors
/// If the layer mixes kinds or contains triangles, a column's length or name does not fit, a file
/// cannot be written or would be larger than 2 GiB.
pub fn write_layer<'a>(
    target: impl Into<Destination<'a>>,
    layer: &Layer,
    columns: &[Column<'_>],
) -> Result<()> {
    let target = target.into();
    let code = type_code(&layer.shapes).map_err(|e| e.in_file(target.path()))?;
    for column in columns {
        if column.values.len() != layer.shapes.len() {
            return Err(Error::usage(format!(
                "field {} has {} values for {} shapes",
                column.name,
                column.values.len(),
                layer.shapes.len()
            )));
        }
    }
    let fields = match columns {
        [] => vec![field("ID", ID_WIDTH, 0)?],
        _ => columns
            .iter()
            .map(|c| field(c.name, NUMBER_WIDTH, NUMBER_DECIMALS))
            .collect::<Result<_>>()?,
    };
    let mut set = FileSet::create(target, code, &fields)?;
    let mut record = Vec::new();
    for (i, shape) in layer.shapes.iter().enumerate() {
        let bounds = bounds(shape.vertices().copied());
        record.clear();
        content(&mut record, code, shape, &bounds);
        let cells: Vec<String> = match columns {
            [] => vec![id(i + 1)],
            _ => columns
                .iter()
                .map(|column| real(column.values[i]))
                .collect(),
        };
        set.write(&record, &bounds, &cells)?;
    }
    set.finish(target, layer.crs.as_ref())
}

/// Writes the lines of a layer with all its attributes, and returns warnings. Without attributes,
/// the table has an `ID` from 1.
///
/// The type of a field is that of its values: whole numbers, numbers, true and false, or else
/// texts. Names are cut to the ten bytes that the format has, and numbered where they would be
/// equal; texts are cut to 254 bytes. Each is a warning.
///
/// # Errors
/// Those of [`write_layer`], and if there are more attributes than the format has room for.
pub fn write_lines<'a>(target: impl Into<Destination<'a>>, layer: &Layer) -> Result<Vec<String>> {
    let target = target.into();
    let Some(attributes) = layer.attributes.as_ref().filter(|of| !of.names.is_empty()) else {
        write_layer(target, layer, &[])?;
        return Ok(Vec::new());
    };
    let code = type_code(&layer.shapes).map_err(|e| e.in_file(target.path()))?;
    let mut warnings = Vec::new();
    let columns = kept::columns(attributes, &mut warnings).map_err(|e| e.in_file(target.path()))?;
    let fields: Vec<[u8; 32]> = columns.iter().map(kept::KeptColumn::descriptor).collect();
    let mut set = FileSet::create(target, code, &fields)?;
    let mut record = Vec::new();
    let none = Vec::new();
    for (i, shape) in layer.shapes.iter().enumerate() {
        let bounds = bounds(shape.vertices().copied());
        record.clear();
        content(&mut record, code, shape, &bounds);
        let row = attributes.rows.get(i).unwrap_or(&none);
        let cells = columns.iter().enumerate().map(|(k, column)| {
            let value = row.get(k).unwrap_or(&Value::Missing);
            column.cell(value)
        });
        set.write(&record, &bounds, &cells.collect::<Vec<String>>())?;
    }
    set.finish(target, layer.crs.as_ref())?;
    Ok(warnings)
}

/// Returns an error if lines with heights and `vertices` vertices in total are too large for a
/// shapefile.
///
/// # Errors
/// If a file would be too large; the message states the minimum size.
pub fn check_size(vertices: u64) -> Result<()> {
    let bytes = vertices.saturating_mul(24);
    if bytes <= MAX_BYTES {
        return Ok(());
    }
    let size = bytes as f64 / 1e9;
    Err(Error::limit(format!(
        "{vertices} vertices take {size:.1} GB; a shapefile holds 2 GB"
    ))
    .cure(TOO_LARGE))
}

fn type_code(shapes: &[Shape]) -> Result<i32> {
    let mut kinds: Vec<ShapeKind> = shapes
        .iter()
        .map(Shape::kind)
        .filter(|&kind| kind != ShapeKind::Null)
        .collect();
    kinds.sort_unstable();
    kinds.dedup();
    let flat = match kinds[..] {
        [] => return Ok(0),
        [ShapeKind::Points]
            if shapes
                .iter()
                .all(|s| matches!(s, Shape::Null) || s.vertices().count() == 1) =>
        {
            1
        }
        [ShapeKind::Points] => 8,
        [ShapeKind::Lines] => 3,
        [ShapeKind::Polygon] => 5,
        _ => return Err(Error::unsupported(format!("a shapefile of {kinds:?}"))),
    };
    let heights = shapes
        .iter()
        .flat_map(Shape::vertices)
        .any(|v| !v[2].is_nan());
    Ok(if heights { flat + 10 } else { flat })
}

/// Appends the content of one record; `bounds` are those of its vertices.
fn content(out: &mut Vec<u8>, code: i32, shape: &Shape, bounds: &Bounds) {
    match shape {
        Shape::Lines(parts) | Shape::Polygon(parts) => {
            let lengths: Vec<usize> = parts.iter().map(Vec::len).collect();
            poly(out, code, &lengths, parts.iter().flatten().copied(), bounds);
        }
        Shape::Points(points) if code % 10 == 8 => {
            int(out, code);
            put_box(out, bounds);
            int(out, points.len() as i32);
            vertices(out, code, points.len(), points.iter().copied(), bounds);
        }
        Shape::Points(points) => {
            int(out, code);
            for p in points {
                let dimensions = if code > 10 { 3 } else { 2 };
                p[..dimensions]
                    .iter()
                    .for_each(|&v| double(out, if v.is_nan() { NO_HEIGHT } else { v }));
            }
        }
        Shape::Null | Shape::Faces(_) => int(out, 0),
    }
}

fn poly(
    out: &mut Vec<u8>,
    code: i32,
    lengths: &[usize],
    points: impl Iterator<Item = [f64; 3]> + Clone,
    bounds: &Bounds,
) {
    let count = lengths.iter().sum::<usize>();
    int(out, code);
    put_box(out, bounds);
    int(out, lengths.len() as i32);
    int(out, count as i32);
    let mut start = 0;
    for length in lengths {
        int(out, start);
        start += *length as i32;
    }
    vertices(out, code, count, points, bounds);
}

/// Appends all x and y of some points and, for Z types, the range of z and every z. Measures are
/// optional and left out.
fn vertices(
    out: &mut Vec<u8>,
    code: i32,
    count: usize,
    points: impl Iterator<Item = [f64; 3]> + Clone,
    bounds: &Bounds,
) {
    let plan = grown(out, 16 * count).chunks_exact_mut(16);
    for (bytes, [x, y, _]) in plan.zip(points.clone()) {
        bytes[..8].copy_from_slice(&x.to_le_bytes());
        bytes[8..].copy_from_slice(&y.to_le_bytes());
    }
    if code > 10 {
        range(out, bounds.min[2], bounds.max[2]);
        let heights = grown(out, 8 * count).chunks_exact_mut(8);
        for (bytes, [.., z]) in heights.zip(points) {
            let z = if z.is_nan() { NO_HEIGHT } else { z };
            bytes.copy_from_slice(&z.to_le_bytes());
        }
    }
}

/// Appends zeros and returns them.
fn grown(out: &mut Vec<u8>, bytes: usize) -> &mut [u8] {
    let start = out.len();
    out.resize(start + bytes, 0);
    &mut out[start..]
}

fn bounds(points: impl Iterator<Item = [f64; 3]>) -> Bounds {
    points.fold(Bounds::default(), |mut bounds, p| {
        bounds.add(p);
        bounds
    })
}

fn put_box(out: &mut Vec<u8>, Bounds { min, max }: &Bounds) {
    for value in [min[0], min[1], max[0], max[1]] {
        double(out, if value.is_finite() { value } else { 0.0 });
    }
}

/// Appends a range; an empty one as zeros, as all other programs do.
fn range(out: &mut Vec<u8>, min: f64, max: f64) {
    let empty = min > max;
    double(out, if empty { 0.0 } else { min });
    double(out, if empty { 0.0 } else { max });
}

fn int(out: &mut Vec<u8>, value: i32) {
    out.extend(value.to_le_bytes());
}

fn double(out: &mut Vec<u8>, value: f64) {
    out.extend(value.to_le_bytes());
}

fn id(number: usize) -> String {
    format!("{number:>width$}", width = usize::from(ID_WIDTH))
}

/// Returns a field descriptor of the `.dbf`.
fn field(name: &str, width: u8, decimals: u8) -> Result<[u8; 32]> {
    if name.is_empty() || name.len() > 10 || !name.is_ascii() {
        return Err(Error::usage(format!(
            "field name '{name}': expected 1 to 10 ASCII characters"
        )));
    }
    let mut bytes = [0; 32];
    bytes[..name.len()].copy_from_slice(name.as_bytes());
    bytes[11] = b'N';
    bytes[16] = width;
    bytes[17] = decimals;
    Ok(bytes)
}

/// `.shp`, `.shx` and `.dbf` while they are written.
struct FileSet {
    shp: Output,
    shx: Output,
    dbf: Output,
    code: i32,
    fields: Vec<[u8; 32]>,
    /// Bytes of the `.shp` and the `.dbf` so far.
    shp_bytes: u64,
    dbf_bytes: u64,
    records: u32,
    bounds: Bounds,
    scratch: Vec<u8>,
}

impl FileSet {
    fn create(destination: Destination, code: i32, fields: &[[u8; 32]]) -> Result<Self> {
        let target = destination.path();
        let mut set = FileSet {
            shp: destination.create_seekable_beside(target)?,
            shx: destination.create_seekable_beside(&target.with_extension("shx"))?,
            dbf: destination.create_seekable_beside(&target.with_extension("dbf"))?,
            code,
            fields: fields.to_vec(),
            shp_bytes: HEADER,
            dbf_bytes: 0,
            records: 0,
            bounds: Bounds::default(),
            scratch: Vec::new(),
        };
        // Placeholders for the headers, which are known at the end.
        set.shp
            .write_all(&[0; HEADER as usize])
            .map_err(|e| failed(e, target))?;
        set.shx
            .write_all(&[0; HEADER as usize])
            .map_err(|e| failed(e, set.shx.target()))?;
        let header = set.dbf_header();
        set.dbf_bytes = header.len() as u64;
        set.dbf
            .write_all(&header)
            .map_err(|e| failed(e, set.dbf.target()))?;
        Ok(set)
    }

    /// Adds a record; `bounds` are those of its vertices, `cells` its attributes in their full
    /// width.
    fn write(&mut self, content: &[u8], bounds: &Bounds, cells: &[impl AsRef<str>]) -> Result<()> {
        let row: usize = 1 + cells.iter().map(|cell| cell.as_ref().len()).sum::<usize>();
        let shp_bytes = self.shp_bytes + 8 + content.len() as u64;
        let dbf_bytes = self.dbf_bytes + row as u64;
        for (bytes, output) in [(shp_bytes, &self.shp), (dbf_bytes, &self.dbf)] {
            if bytes > MAX_BYTES {
                return Err(Error::limit(format!(
                    "record {} would make it larger than 2 GiB",
                    self.records + 1
                ))
                .in_file(output.target())
                .cure(TOO_LARGE));
            }
        }
        self.records += 1;
        self.bounds.merge(bounds);

        let words = |bytes: u64| ((bytes / 2) as u32).to_be_bytes();
        self.scratch.clear();
        self.scratch.extend(self.records.to_be_bytes());
        self.scratch.extend(words(content.len() as u64));
        self.shp
            .write_all(&self.scratch)
            .and_then(|()| self.shp.write_all(content))
            .map_err(|e| failed(e, self.shp.target()))?;

        self.scratch.clear();
        self.scratch.extend(words(self.shp_bytes));
        self.scratch.extend(words(content.len() as u64));
        self.shx
            .write_all(&self.scratch)
            .map_err(|e| failed(e, self.shx.target()))?;

        self.scratch.clear();
        self.scratch.push(b' ');
        cells
            .iter()
            .for_each(|cell| self.scratch.extend_from_slice(cell.as_ref().as_bytes()));
        self.dbf
            .write_all(&self.scratch)
            .map_err(|e| failed(e, self.dbf.target()))?;
        (self.shp_bytes, self.dbf_bytes) = (shp_bytes, dbf_bytes);
        Ok(())
    }

    /// Completes the files and hands them over. Files of an older set that would now be wrong are
    /// removed at the same time.
    fn finish(mut self, destination: Destination, crs: Option<&Crs>) -> Result<()> {
        let target = destination.path();
        let prj = crs.map(Crs::to_prj).filter(|text| !text.is_empty());
        let prj = prj
            .map(|text| text_file(destination, "prj", &text))
            .transpose()?;
        let cpg = text_file(destination, "cpg", "UTF-8")?;

        let shp_header = self.header(self.shp_bytes);
        rewrite(&mut self.shp, &shp_header)?;
        let shx_header = self.header(HEADER + 8 * u64::from(self.records));
        rewrite(&mut self.shx, &shx_header)?;
        self.dbf
            .write_all(&[0x1A])
            .map_err(|e| failed(e, self.dbf.target()))?;
        let dbf_header = self.dbf_header();
        rewrite(&mut self.dbf, &dbf_header)?;

        // Spatial indexes of the old shapes, and their coordinate system if the new ones have none.
        let stale = ["qix", "sbn", "sbx"]
            .into_iter()
            .chain(prj.is_none().then_some("prj"));
        let stale = stale.map(|extension| target.with_extension(extension));
        destination.put_all(
            prj.into_iter().chain([cpg, self.dbf, self.shx]),
            self.shp,
            stale,
        )
    }

    /// Returns the header of a `.shp` or `.shx` of this many bytes.
    fn header(&self, bytes: u64) -> Vec<u8> {
        let mut out = Vec::with_capacity(HEADER as usize);
        out.extend(FILE_CODE.to_be_bytes());
        out.extend([0; 20]);
        out.extend(((bytes / 2) as u32).to_be_bytes());
        int(&mut out, 1000);
        int(&mut out, self.code);
        let Bounds { min, max } = self.bounds;
        for value in [min[0], min[1], max[0], max[1]] {
            double(&mut out, if value.is_finite() { value } else { 0.0 });
        }
        range(&mut out, min[2], max[2]);
        out.extend([0; 16]);
        out
    }

    fn dbf_header(&self) -> Vec<u8> {
        let row: usize = 1 + self
            .fields
            .iter()
            .map(|field| usize::from(field[16]))
            .sum::<usize>();
        let length = 32 + 32 * self.fields.len() + 1;
        // Version 3, no memo; 1970-01-01.
        let mut out = vec![3, 70, 1, 1];
        out.extend(self.records.to_le_bytes());
        out.extend((length as u16).to_le_bytes());
        out.extend((row as u16).to_le_bytes());
        out.resize(32, 0);
        self.fields.iter().for_each(|field| out.extend(field));
        out.push(0x0D);
        out
    }
}

fn rewrite(output: &mut Output, header: &[u8]) -> Result<()> {
    output
        .seek(SeekFrom::Start(0))
        .and_then(|_| output.write_all(header))
        .and_then(|()| output.flush())
        .map_err(|e| failed(e, output.target()))
}

fn text_file(destination: Destination, extension: &str, text: &str) -> Result<Output> {
    let path = destination.path().with_extension(extension);
    let mut output = destination.create_beside(&path)?;
    output
        .write_all(text.as_bytes())
        .map_err(|e| failed(e, &path))?;
    Ok(output)
}

fn failed(error: std::io::Error, path: &Path) -> Error {
    Error::from(error).in_file(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::codec::shapefile::read_layer;

    fn layer(shapes: Vec<Shape>) -> Layer {
        Layer {
            shapes,
            ..Layer::default()
        }
    }

    #[test]
    fn layers_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("x.shp");
        let [a, b, c] = [[0., 0., 1.], [0., 5., 2.5], [5., 5., -3.]];
        for (shapes, format) in [
            (
                vec![Shape::Points(vec![a]), Shape::Null, Shape::Points(vec![b])],
                "PointZ",
            ),
            (
                vec![Shape::Points(vec![a, b]), Shape::Points(vec![])],
                "MultiPointZ",
            ),
            (
                vec![
                    Shape::Lines(vec![vec![a, b], vec![c, a, b]]),
                    Shape::Lines(vec![vec![b, c]]),
                ],
                "PolyLineZ",
            ),
            (vec![Shape::Polygon(vec![vec![a, b, c, a]])], "PolygonZ"),
            (vec![], "Null"),
        ] {
            let values: Vec<f64> = (0..shapes.len()).map(|i| 0.1 * i as f64).collect();
            write_layer(
                &target,
                &layer(shapes.clone()),
                &[Column {
                    name: "V",
                    values: &values,
                }],
            )
            .unwrap();
            let back = read_layer(&target, None).unwrap();
            assert_eq!(back.shapes, shapes);
            assert_eq!(back.format, format!("shapefile {format}"));
            assert_eq!((back.fields, back.warnings), (vec!["V".to_owned()], vec![]));
            if !shapes.is_empty() {
                let high = read_layer(&target, Some("v")).unwrap();
                for (shape, value) in high.shapes.iter().zip(values) {
                    assert!(shape.vertices().all(|v| v[2] == value));
                }
            }
        }
        // A missing height among others stays missing.
        write_layer(
            &target,
            &layer(vec![Shape::Lines(vec![vec![a, [1., 1., f64::NAN]]])]),
            &[],
        )
        .unwrap();
        let back = read_layer(&target, None).unwrap();
        let heights: Vec<f64> = back.shapes[0].vertices().map(|v| v[2]).collect();
        assert!(heights[0] == 1.0 && heights[1].is_nan());
        assert_eq!(back.fields, ["ID"]);
        // If all heights are missing, none is invented.
        write_layer(
            &target,
            &layer(vec![Shape::Lines(vec![vec![
                [0., 0., f64::NAN],
                [1., 1., f64::NAN],
            ]])]),
            &[],
        )
        .unwrap();
        assert_eq!(
            read_layer(&target, None).unwrap().format,
            "shapefile PolyLine"
        );
    }

    #[test]
    fn what_cannot_be_written_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("x.shp");
        let mixed = layer(vec![Shape::Points(vec![[0.; 3]]), Shape::Lines(vec![])]);
        assert!(write_layer(&target, &mixed, &[]).is_err());
        assert!(
            write_layer(
                &target,
                &layer(vec![Shape::Null]),
                &[Column {
                    name: "A",
                    values: &[]
                }]
            )
            .is_err()
        );
        assert!(
            write_layer(
                &target,
                &layer(vec![]),
                &[Column {
                    name: "ELEVENCHARS",
                    values: &[]
                }]
            )
            .is_err()
        );
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn limits_are_checked_before_the_bytes_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("x.shp");
        let mut set =
            FileSet::create((&target).into(), 13, &[field("ID", ID_WIDTH, 0).unwrap()]).unwrap();
        set.shp_bytes = MAX_BYTES - 100;
        assert!(set.write(&[0; 40], &Bounds::default(), &[id(1)]).is_ok());
        let error = set
            .write(&[0; 60], &Bounds::default(), &[id(2)])
            .unwrap_err();
        assert_eq!(error.kind(), crate::error::Kind::Limit);
        assert!(
            error
                .to_string()
                .ends_with("x.shp: record 2 would make it larger than 2 GiB"),
            "{error}"
        );
        set.dbf_bytes = MAX_BYTES;
        assert!(
            set.write(&[0; 4], &Bounds::default(), &[id(2)])
                .unwrap_err()
                .to_string()
                .contains("x.dbf")
        );
        drop(set);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn old_neighbors_do_not_stay() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["x.prj", "x.qix", "x.sbn", "y.prj"] {
            std::fs::write(folder.path().join(name), "old").unwrap();
        }
        write_layer(&folder.path().join("x.shp"), &layer(vec![]), &[]).unwrap();
        let mut names: Vec<_> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(names, ["x.cpg", "x.dbf", "x.shp", "x.shx", "y.prj"]);
    }
}
