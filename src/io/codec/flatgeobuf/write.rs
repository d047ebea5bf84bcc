//! Writing: records are collected in a file without a name, and copied behind the header and the
//! index when all are known.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};

use super::builder::{Builder, Open, Slot};
use super::index::{self, Extent, NOTHING, merged};
use super::schema::{self, ColumnType, MAGIC, kind};
use crate::crs::Crs;
use crate::data::{ContourLine, Layer, Shape, ShapeKind, Value, ValueKind, polygons};
use crate::error::{Error, Result};
use crate::io::bytes::output::{Destination, Output};
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::codec::stated_system;

/// Writes contours as line strings with heights, with the attributes `ID` (from 1) and `ELEV` and a
/// spatial index; the layer has the name of the file. Lines are in the order of the index.
///
/// Lines are written as they arrive; of each, 48 bytes are kept in memory. Lines with fewer than
/// two vertices are left out.
///
/// # Errors
/// If the file cannot be written. An existing file is then left untouched.
pub fn write_contours<'a>(
    target: impl Into<Destination<'a>>,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> Result<ContourSummary> {
    let head = Head {
        kind: kind::LINE,
        has_heights: true,
        columns: vec![
            ("ID".to_owned(), ColumnType::Long),
            ("ELEV".to_owned(), ColumnType::Double),
        ],
        crs,
    };
    write(target.into(), &head, |records| {
        let mut summary = ContourSummary::default();
        for line in lines.filter(|line| line.points.len() > 1) {
            summary.add(&line);
            let (shape, values) = summary.last_record(&line);
            records.add(&shape, &values)?;
        }
        Ok(summary)
    })
}

/// Writes the shapes of a layer with all its attributes, and returns warnings; without attributes,
/// there is an `ID` from 1.
///
/// Shapes are geometries of several parts if one of them has several. Heights are written if a
/// vertex has one; missing ones are then NaN. The type of an attribute is that of its values: whole
/// numbers, numbers, true and false, or else texts. If every shape has a vertex, records are sorted
/// for a spatial index; else they keep their order, and there is none.
///
/// # Errors
/// As [`write_contours`]; if there are more than 65535 attributes.
pub fn write_lines<'a>(target: impl Into<Destination<'a>>, layer: &Layer) -> Result<Vec<String>> {
    let target: Destination<'a> = target.into();
    let attributes = layer.attributes.as_ref();
    let attributes = attributes.filter(|attributes| !attributes.names.is_empty());
    let columns = match attributes {
        Some(attributes) => (attributes.names.iter().enumerate())
            .map(|(number, name)| (name.clone(), type_of(attributes.kind(number))))
            .collect(),
        None => vec![("ID".to_owned(), ColumnType::Long)],
    };
    if columns.len() > usize::from(u16::MAX) {
        let error = format!(
            "{} attributes, where FlatGeobuf has room for 65535",
            columns.len()
        );
        return Err(Error::limit(error)
            .in_file(target.path())
            .cure("write GeoJSON, or remove attributes"));
    }
    let shapes = || layer.shapes.iter();
    let head = Head {
        kind: common_kind(shapes().filter_map(kind_of)),
        has_heights: shapes().flat_map(Shape::vertices).any(|p| p[2].is_finite()),
        columns,
        crs: layer.crs.as_ref(),
    };
    write(target, &head, |records| {
        for (i, shape) in shapes().enumerate() {
            match attributes {
                Some(attributes) => {
                    let row = attributes.rows.get(i).map_or(&[][..], Vec::as_slice);
                    records.add(shape, row)?;
                }
                None => records.add(shape, &[Value::Whole(i as i64 + 1)])?,
            }
        }
        Ok(Vec::new())
    })
}

fn type_of(kind: ValueKind) -> ColumnType {
    match kind {
        ValueKind::Whole => ColumnType::Long,
        ValueKind::Number => ColumnType::Double,
        ValueKind::Truth => ColumnType::Bool,
        ValueKind::Text => ColumnType::String,
    }
}

/// Returns the type of the geometry of a shape; `None` if it has none.
fn kind_of(shape: &Shape) -> Option<u8> {
    let (single, several) = match shape.kind() {
        ShapeKind::Null => return None,
        ShapeKind::Points => (kind::POINT, kind::MULTI_POINT),
        ShapeKind::Lines => (kind::LINE, kind::MULTI_LINE),
        ShapeKind::Polygon | ShapeKind::Faces => (kind::POLYGON, kind::MULTI_POLYGON),
    };
    Some(match shape.part_count() {
        1 => single,
        _ => several,
    })
}

/// Returns the type of a layer with geometries of these types.
fn common_kind(kinds: impl Iterator<Item = u8>) -> u8 {
    let common = |a: u8, b: u8| match (a, b) {
        (a, b) if a == b => a,
        // The type of several is that of one, and 3.
        (a, b) if a % 3 == b % 3 && a > 0 && b > 0 => a.max(b),
        _ => kind::UNKNOWN,
    };
    kinds.reduce(common).unwrap_or(kind::UNKNOWN)
}

/// What is known of a layer before its records.
struct Head<'a> {
    kind: u8,
    has_heights: bool,
    columns: Vec<(String, ColumnType)>,
    crs: Option<&'a Crs>,
}

fn write<T>(
    target: Destination,
    head: &Head,
    add: impl FnOnce(&mut Records) -> Result<T>,
) -> Result<T> {
    let write = || {
        let mut records = Records {
            head,
            bytes: BufWriter::new(target.scratch()?),
            written: 0,
            records: Vec::new(),
        };
        let written = add(&mut records)?;
        let name = target
            .path()
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        let mut output = target.create()?;
        records.finish(&name, &mut output)?;
        target.put(output)?;
        Ok(written)
    };
    write().map_err(|error: Error| error.in_file(target.path()))
}

/// The records of a layer while they are written.
struct Records<'a> {
    head: &'a Head<'a>,
    bytes: BufWriter<File>,
    written: u64,
    /// The extent, the position and the length of each.
    records: Vec<(Extent, u64, u64)>,
}

impl Records<'_> {
    fn add(&mut self, shape: &Shape, values: &[Value]) -> Result<()> {
        let mut properties = Vec::new();
        for (number, (value, (_, kind))) in (0_u16..).zip(values.iter().zip(&self.head.columns)) {
            add_value(number, value, *kind, &mut properties);
        }
        let (mut builder, root) = Builder::new();
        let mut slots = Vec::new();
        let has_geometry = !matches!(shape, Shape::Null);
        if has_geometry {
            slots.push((schema::feature::GEOMETRY, Slot::Offset));
        }
        slots.push((schema::feature::PROPERTIES, Slot::Offset));
        let mut opens = builder.table(root, &slots).into_iter();
        if has_geometry && let Some(open) = opens.next() {
            add_shape(&mut builder, open, shape, self.head);
        }
        if let Some(open) = opens.next() {
            builder.bytes(open, &properties);
        }
        let record = builder.finish().ok_or_else(|| {
            Error::limit("the record takes more than 2 GB, which a FlatGeobuf has no room for")
                .at(format!("record {}", self.records.len() + 1))
                .cure("write GeoPackage, or divide the shape")
        })?;
        self.bytes.write_all(&record)?;
        let of_vertex = |p: &[f64; 3]| [p[0], p[1], p[0], p[1]];
        let extent = shape.vertices().map(of_vertex).fold(NOTHING, merged);
        let length = record.len() as u64;
        self.records.push((extent, self.written, length));
        self.written += length;
        Ok(())
    }

    fn finish(self, name: &str, out: &mut Output) -> Result<()> {
        let mut bytes = self.bytes.into_inner().map_err(|e| e.into_error())?;
        let extents: Vec<Extent> = self.records.iter().map(|&(extent, ..)| extent).collect();
        // A record without an extent has no node.
        let is_indexed = !extents.is_empty()
            && extents
                .iter()
                .all(|extent| extent.iter().all(|side| side.is_finite()));
        out.write_all(MAGIC)?;
        let all = extents.iter().fold(NOTHING, |all, &one| merged(all, one));
        let header = header(self.head, name, all, self.records.len() as u64, is_indexed);
        let header = header.ok_or_else(|| Error::limit("the header takes more than 2 GB"))?;
        out.write_all(&header)?;
        bytes.seek(SeekFrom::Start(0))?;
        if !is_indexed {
            std::io::copy(&mut bytes, out)?;
            return Ok(());
        }
        let order = index::order(&extents);
        let mut position = 0;
        let mut nodes = Vec::with_capacity(order.len());
        for &record in &order {
            nodes.push((extents[record], position));
            position += self.records[record].2;
        }
        index::write(out, &nodes)?;
        let mut record_bytes = Vec::new();
        let mut bytes = BufReader::new(bytes);
        let mut at = 0_u64;
        for &record in &order {
            let (_, start, length) = self.records[record];
            // Within the buffer, no system call is made.
            bytes.seek_relative(start as i64 - at as i64)?;
            record_bytes.resize(length as usize, 0);
            bytes.read_exact(&mut record_bytes)?;
            at = start + length;
            out.write_all(&record_bytes)?;
        }
        Ok(())
    }
}

/// Appends the value of an attribute with its number, unless it is missing.
fn add_value(number: u16, value: &Value, kind: ColumnType, out: &mut Vec<u8>) {
    if *value == Value::Missing {
        return;
    }
    out.extend_from_slice(&number.to_le_bytes());
    match (kind, value) {
        (ColumnType::Long, Value::Whole(whole)) => out.extend_from_slice(&whole.to_le_bytes()),
        (ColumnType::Double, Value::Whole(whole)) => {
            out.extend_from_slice(&(*whole as f64).to_le_bytes());
        }
        (ColumnType::Double, Value::Number(number)) => {
            out.extend_from_slice(&number.to_le_bytes());
        }
        (ColumnType::Bool, Value::Truth(truth)) => out.push(u8::from(*truth)),
        _ => {
            let text = value.text();
            out.extend_from_slice(&(text.len() as u32).to_le_bytes());
            out.extend_from_slice(text.as_bytes());
        }
    }
}

/// A list of rings or parts.
type Parts<'a> = Vec<Vec<&'a [f64; 3]>>;

/// Adds the geometry of a shape.
fn add_shape(builder: &mut Builder, open: Open, shape: &Shape, head: &Head) {
    let own = kind_of(shape).unwrap_or(kind::UNKNOWN);
    let kind = if head.kind == kind::UNKNOWN {
        own
    } else {
        head.kind
    };
    let heights = head.has_heights;
    fn parts(parts: &[Vec<[f64; 3]>]) -> Parts<'_> {
        parts.iter().map(|part| part.iter().collect()).collect()
    }
    // Outer rings are clockwise in a layer, and counter-clockwise here.
    fn reversed<'a>(polygon: &&'a [Vec<[f64; 3]>]) -> Parts<'a> {
        let back = |ring: &'a Vec<[f64; 3]>| ring.iter().rev().collect();
        polygon.iter().map(back).collect()
    }
    match shape {
        Shape::Null => {}
        Shape::Points(points) => {
            add_parts(builder, open, kind, &vec![points.iter().collect()], heights);
        }
        Shape::Lines(lines) => add_parts(builder, open, kind, &parts(lines), heights),
        Shape::Polygon(rings) => {
            let polygons = polygons(rings);
            add_polygons(
                builder,
                open,
                kind,
                polygons.iter().map(reversed).collect(),
                heights,
            );
        }
        Shape::Faces(faces) => {
            let faces = faces.iter().map(|face| parts(face)).collect();
            add_polygons(builder, open, kind, faces, heights);
        }
    }
}

fn add_polygons(
    builder: &mut Builder,
    open: Open,
    kind: u8,
    mut polygons: Vec<Parts>,
    has_heights: bool,
) {
    if kind == kind::POLYGON {
        let polygon = polygons.pop().unwrap_or_default();
        add_parts(builder, open, kind, &polygon, has_heights);
        return;
    }
    let slots = [
        (schema::geometry::KIND, Slot::Byte(kind)),
        (schema::geometry::PARTS, Slot::Offset),
    ];
    for list in builder.table(open, &slots) {
        let members = builder.tables(list, polygons.len());
        for (member, polygon) in members.into_iter().zip(&polygons) {
            add_parts(builder, member, kind::POLYGON, polygon, has_heights);
        }
    }
}

/// Adds a geometry whose vertices are one list, with the end of each part if there are several.
fn add_parts(builder: &mut Builder, open: Open, kind: u8, parts: &Parts, has_heights: bool) {
    let vertices: Vec<&[f64; 3]> = parts.iter().flatten().copied().collect();
    let has_ends = parts.len() != 1 || kind == kind::MULTI_LINE;
    let mut slots = vec![
        (schema::geometry::XY, Slot::Offset),
        (schema::geometry::KIND, Slot::Byte(kind)),
    ];
    if has_heights {
        slots.push((schema::geometry::Z, Slot::Offset));
    }
    if has_ends {
        slots.push((schema::geometry::ENDS, Slot::Offset));
    }
    let mut opens = builder.table(open, &slots).into_iter();
    if let Some(xy) = opens.next() {
        let numbers: Vec<f64> = vertices.iter().flat_map(|p| [p[0], p[1]]).collect();
        builder.doubles(xy, numbers.into_iter());
    }
    if has_heights && let Some(z) = opens.next() {
        builder.doubles(z, vertices.iter().map(|p| p[2]));
    }
    if let Some(ends) = opens.next() {
        let mut end = 0;
        let each = parts.iter().map(|part| {
            end += part.len() as u32;
            end
        });
        builder.words(ends, each);
    }
}

/// Returns the header; `None` if it is too large.
fn header(head: &Head, name: &str, all: Extent, count: u64, is_indexed: bool) -> Option<Vec<u8>> {
    let (mut builder, root) = Builder::new();
    let has_extent = all[0].is_finite();
    let node_size = if is_indexed { index::NODE_SIZE } else { 0 };
    let mut slots = vec![
        (schema::header::NAME, Slot::Offset),
        (schema::header::COLUMNS, Slot::Offset),
        (schema::header::KIND, Slot::Byte(head.kind)),
        (
            schema::header::HAS_Z,
            Slot::Byte(u8::from(head.has_heights)),
        ),
        (schema::header::COUNT, Slot::Long(count)),
        (schema::header::NODE_SIZE, Slot::Short(node_size)),
    ];
    if has_extent {
        slots.push((schema::header::ENVELOPE, Slot::Offset));
    }
    if head.crs.is_some() {
        slots.push((schema::header::CRS, Slot::Offset));
    }
    let mut opens = builder.table(root, &slots).into_iter();
    builder.text(opens.next()?, name);
    let members = builder.tables(opens.next()?, head.columns.len());
    for (member, (name, kind)) in members.into_iter().zip(&head.columns) {
        let slots = [
            (schema::column::NAME, Slot::Offset),
            (schema::column::KIND, Slot::Byte(*kind as u8)),
        ];
        for open in builder.table(member, &slots) {
            builder.text(open, name);
        }
    }
    if has_extent {
        builder.doubles(opens.next()?, all.into_iter());
    }
    if let Some(crs) = head.crs {
        add_system(&mut builder, opens.next()?, crs);
    }
    builder.finish()
}

fn add_system(builder: &mut Builder, open: Open, crs: &Crs) {
    let mut slots = vec![
        (schema::crs::NAME, Slot::Offset),
        (schema::crs::WKT, Slot::Offset),
    ];
    if let Some(code) = stated_system::code_of(crs) {
        slots.push((schema::crs::ORGANIZATION, Slot::Offset));
        slots.push((schema::crs::CODE, Slot::Int(code)));
    }
    let texts = [crs.name.clone(), crs.to_wkt(), "EPSG".to_owned()];
    for (open, text) in builder.table(open, &slots).into_iter().zip(texts) {
        builder.text(open, &text);
    }
}
