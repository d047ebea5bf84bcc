//! Reading: all records, in the order of the file.

use std::fs::File;
use std::io::{BufReader, Read, Take};
use std::path::Path;

use super::buffer::{Buffer, Table};
use super::index;
use super::schema::{self, ColumnType, MAGIC, MAGIC_COMPARED, kind};
use crate::data::{Layer, Shape, Value, oriented};
use crate::error::{Error, Result};
use crate::io::bytes::field::{not_a_number, number_of};
use crate::io::bytes::little_endian::u32_at;
use crate::io::bytes::watch::{Meter, Watch, bytes_of};
use crate::io::codec::stated_system;
use crate::io::options::choosing::Choosing;
use crate::io::options::layer::Options;
use crate::io::options::layers::{
    Fields, check_depth, set_heights, warn_of_bytes, warn_of_missing_heights,
};

/// Limit for the bytes of a header, where other readers have it.
const LARGEST_HEADER: usize = 10 << 20;

/// Reads the layer of a FlatGeobuf file, watched: bytes that were parsed are counted.
///
/// Polygons are oriented as in [`Shape::Polygon`]. The parts of a collection become separate
/// shapes. Records come in the order of the file. Attributes of bytes are left out.
///
/// # Errors
/// If the file is damaged, has another version, or has no such layer or attribute; if a value of a
/// requested column is not a number, or a geometry has arcs; that of the watch.
///
/// # Complexity
/// Linear. In memory are a record, and the layer.
pub fn read_layer_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let read = || {
        let file = File::open(path)?;
        let facts = file.metadata()?;
        if facts.is_file() {
            let file = BufReader::with_capacity(1 << 18, file);
            return parse(file, facts.len(), &stem, options, watch);
        }
        // A pipe does not say how much there is.
        let bytes = bytes_of(path, watch)?;
        parse(&bytes[..], bytes.len() as u64, &stem, options, watch)
    };
    read().map_err(|error: Error| error.in_file(path))
}

/// Reads a layer from its bytes, of which there are said to be this many.
pub(super) fn parse(
    from: impl Read,
    length: u64,
    stem: &str,
    options: &Options,
    watch: Watch,
) -> Result<Layer> {
    let mut source = Source {
        from,
        length,
        left: length,
    };
    source.magic()?;
    let mut header = Vec::new();
    source
        .sized(LARGEST_HEADER, &mut header)
        .map_err(|error| error.at("header"))?;
    let buffer = Buffer::new(&header);
    let head = Head::read(&buffer).map_err(|error| error.at("header"))?;
    let names = [stem, &head.name];
    let known = if head.name.is_empty() { 1 } else { 2 };
    options.check_layer(&names[..known])?;
    source
        .skip(head.index_bytes)
        .map_err(|error| error.at("index"))?;
    let fields: Vec<String> = head.columns.iter().map(|(name, _)| name.clone()).collect();
    let mut reading = Reading {
        fields: Fields::of(&fields, options.height_field, options.columns)?,
        layer: Layer {
            format: format!("FlatGeobuf {}", kind_name(head.kind)),
            ..options.empty_layer(fields)
        },
        head: &head,
        without_height: 0,
    };
    head.read_system(&mut reading.layer)
        .map_err(|error| error.at("header"))?;
    let mut choosing = options.choosing(&reading.layer)?;
    reading.records(&mut source, &mut choosing, watch)?;
    let Reading {
        mut layer,
        without_height,
        ..
    } = reading;
    choosing.finish(&mut layer)?;
    let of_bytes = head.columns.iter();
    let of_bytes = of_bytes.filter(|(_, kind)| *kind == ColumnType::Binary);
    warn_of_bytes(of_bytes.map(|(name, _)| name.as_str()), &mut layer);
    warn_of_missing_heights(without_height, &mut layer);
    Ok(layer)
}

/// The bytes of a file that were not read yet.
struct Source<R> {
    from: R,
    length: u64,
    left: u64,
}

impl<R: Read> Source<R> {
    #[cold]
    fn cut(&self) -> Error {
        let length = self.length;
        Error::format(format!(
            "it goes on behind the end of the file, at byte {length}"
        ))
        .cure("copy or download the file again")
    }

    /// Fills a list with the next bytes, which must be there.
    fn take(&mut self, count: u64, into: &mut Vec<u8>) -> Result<()> {
        into.clear();
        self.pass(count, |mut next| {
            next.read_to_end(into).map(|read| read as u64)
        })
    }

    fn skip(&mut self, count: u64) -> Result<()> {
        self.pass(count, |mut next| {
            std::io::copy(&mut next, &mut std::io::sink())
        })
    }

    /// Calls a function that reads the next bytes, which must be there, and returns how many it
    /// found: fewer if the file became shorter while it was read.
    fn pass(
        &mut self,
        count: u64,
        read: impl FnOnce(Take<&mut R>) -> std::io::Result<u64>,
    ) -> Result<()> {
        if count > self.left {
            return Err(self.cut());
        }
        self.left -= count;
        match read(self.from.by_ref().take(count))? == count {
            true => Ok(()),
            false => Err(self.cut()),
        }
    }

    /// Fills a list with a buffer, which begins with its length.
    fn sized(&mut self, most: usize, into: &mut Vec<u8>) -> Result<()> {
        self.take(4, into)?;
        let size = u32_at(into, 0);
        if size as usize > most && u64::from(size) <= self.left {
            return Err(Error::limit(format!("{size} bytes of header")));
        }
        self.take(size.into(), into)
    }

    /// Reads the first bytes.
    fn magic(&mut self) -> Result<()> {
        let mut found = Vec::new();
        self.take(self.left.min(MAGIC.len() as u64), &mut found)?;
        if found.len() == MAGIC.len() && found[..MAGIC_COMPARED] == MAGIC[..MAGIC_COMPARED] {
            return Ok(());
        }
        let error = match found.starts_with(b"fgb") && found.len() == MAGIC.len() {
            true => Error::unsupported(format!("version {} of FlatGeobuf", found[3]))
                .cure("save it as version 3, or as GeoPackage"),
            false => Error::format("it does not begin as a FlatGeobuf file does"),
        };
        Err(error.at("byte 0"))
    }
}

/// Splits off a text or a list of bytes that begins with its length.
fn sized(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}

/// What a header states.
struct Head<'a> {
    name: String,
    kind: u8,
    columns: Vec<(String, ColumnType)>,
    /// The records, if they are counted.
    count: Option<u64>,
    index_bytes: u64,
    crs: Option<Table<'a>>,
}

impl<'a> Head<'a> {
    fn read(buffer: &'a Buffer<'a>) -> Result<Self> {
        let header = buffer.root()?;
        let count = header.long(schema::header::COUNT)?.unwrap_or(0);
        let node_size = header
            .short(schema::header::NODE_SIZE)?
            .unwrap_or(index::NODE_SIZE);
        let index_bytes = index::size(count, node_size);
        Ok(Head {
            name: header.text(schema::header::NAME)?.unwrap_or_default(),
            kind: header.byte(schema::header::KIND)?.unwrap_or(kind::UNKNOWN),
            columns: columns(&header.tables(schema::header::COLUMNS)?)?,
            count: (count > 0).then_some(count),
            index_bytes: index_bytes
                .ok_or_else(|| Error::format(format!("{count} records are stated")))?,
            crs: header.table(schema::header::CRS)?,
        })
    }

    fn read_system(&self, layer: &mut Layer) -> Result<()> {
        let Some(crs) = self.crs else {
            return Ok(());
        };
        let text = |slot| crs.text(slot).map(Option::unwrap_or_default);
        let code = crs.int(schema::crs::CODE)?.unwrap_or(0);
        let organization = text(schema::crs::ORGANIZATION)?;
        let wkt = text(schema::crs::WKT)?;
        // A number alone is one of EPSG's; neither is an unknown system.
        let organization = match organization.is_empty() {
            true => "EPSG",
            false => &organization,
        };
        if code > 0 || !wkt.is_empty() {
            stated_system::read(organization, i64::from(code), wkt, layer);
        }
        Ok(())
    }
}

/// Returns the names and types of columns.
fn columns(tables: &[Table]) -> Result<Vec<(String, ColumnType)>> {
    let column = |column: &Table| {
        let kind = column.byte(schema::column::KIND)?.unwrap_or(0);
        let known = ColumnType::ALL.get(usize::from(kind)).copied();
        let name = column.text(schema::column::NAME)?.unwrap_or_default();
        let unknown = || Error::format(format!("attribute {name} has values of the type {kind}"));
        let known = known.ok_or_else(unknown)?;
        Ok((name, known))
    };
    tables.iter().map(column).collect()
}

/// A layer while its records are read.
struct Reading<'a> {
    head: &'a Head<'a>,
    fields: Fields,
    layer: Layer,
    without_height: usize,
}

impl Reading<'_> {
    fn records(
        &mut self,
        source: &mut Source<impl Read>,
        choosing: &mut Choosing,
        watch: Watch,
    ) -> Result<()> {
        let mut meter = Meter::new(watch, source.left as usize);
        let (mut record, mut bytes) = (0, Vec::new());
        while source.left > 0 && self.head.count != Some(record) {
            record += 1;
            let at = source.length - source.left;
            let location = |error: Error| error.within(format!("record {record}"));
            source
                .sized(usize::MAX, &mut bytes)
                .map_err(|error| location(error.at(format!("byte {at}"))))?;
            self.add(&bytes).map_err(location)?;
            choosing.added(&mut self.layer)?;
            meter.left(source.left as usize)?;
        }
        match self.head.count {
            Some(count) if record < count => Err(Error::format(format!(
                "{count} records are stated, {record} are there"
            ))
            .at(format!("byte {}", source.length))
            .cure("copy or download the file again")),
            _ => Ok(()),
        }
    }

    fn add(&mut self, bytes: &[u8]) -> Result<()> {
        let buffer = Buffer::new(bytes);
        let feature = buffer.root()?;
        let first = self.layer.shapes.len();
        match feature.table(schema::feature::GEOMETRY)? {
            Some(geometry) => shapes(geometry, self.head.kind, 0, &mut self.layer.shapes)?,
            None => self.layer.shapes.push(Shape::Null),
        }
        if feature
            .list(schema::feature::COLUMNS, 4)?
            .is_some_and(|own| !own.is_empty())
        {
            return Err(Error::unsupported("a record with attributes of its own")
                .cure("save the layer again, with the same attributes for all records"));
        }
        let properties = feature.list(schema::feature::PROPERTIES, 1)?;
        let row = row(properties.unwrap_or_default(), &self.head.columns)?;
        let count = self.layer.shapes.len();
        for (column, &field) in self.layer.columns.iter_mut().zip(&self.fields.columns) {
            let number = number_of(&row[field]);
            let number = number.map_err(|text| not_a_number(&column.name, &text))?;
            column.values.resize(count, number);
        }
        if let Some(field) = self.fields.height {
            let height = number_of(&row[field]).unwrap_or(f64::NAN);
            let is_missing = set_heights(&mut self.layer.shapes[first..], height);
            self.without_height += usize::from(is_missing);
        }
        if let Some(attributes) = &mut self.layer.attributes {
            attributes.rows.resize(count, row);
        }
        Ok(())
    }
}

/// Returns the values of a record, one for each column.
fn row(mut bytes: &[u8], columns: &[(String, ColumnType)]) -> Result<Vec<Value>> {
    let mut row = vec![Value::Missing; columns.len()];
    while !bytes.is_empty() {
        let ends = || Error::format("its attributes end within a value");
        let (number, rest) = bytes.split_first_chunk().ok_or_else(ends)?;
        let number = usize::from(u16::from_le_bytes(*number));
        let Some((name, kind)) = columns.get(number) else {
            return Err(Error::format(format!(
                "a value of attribute {number}, where there are {}",
                columns.len()
            )));
        };
        let (value, rest) = match kind.size() {
            Some(size) => rest.split_at_checked(size),
            None => sized(rest),
        }
        .ok_or_else(|| ends().within(format!("attribute {name}")))?;
        row[number] = kept(value, *kind);
        bytes = rest;
    }
    Ok(row)
}

/// Returns a value of a type, whose bytes are as many as the type has.
fn kept(bytes: &[u8], kind: ColumnType) -> Value {
    fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
        bytes.first_chunk().copied().unwrap_or([0; N])
    }
    match kind {
        ColumnType::Byte => Value::Whole(i64::from(i8::from_le_bytes(array(bytes)))),
        ColumnType::UByte => Value::Whole(i64::from(u8::from_le_bytes(array(bytes)))),
        ColumnType::Bool => Value::Truth(bytes.first().is_some_and(|&byte| byte != 0)),
        ColumnType::Short => Value::Whole(i64::from(i16::from_le_bytes(array(bytes)))),
        ColumnType::UShort => Value::Whole(i64::from(u16::from_le_bytes(array(bytes)))),
        ColumnType::Int => Value::Whole(i64::from(i32::from_le_bytes(array(bytes)))),
        ColumnType::UInt => Value::Whole(i64::from(u32::from_le_bytes(array(bytes)))),
        ColumnType::Long => Value::Whole(i64::from_le_bytes(array(bytes))),
        ColumnType::ULong => {
            let whole = u64::from_le_bytes(array(bytes));
            i64::try_from(whole).map_or(Value::Number(whole as f64), Value::Whole)
        }
        ColumnType::Float => Value::Number(f64::from(f32::from_le_bytes(array(bytes)))),
        ColumnType::Double => Value::Number(f64::from_le_bytes(array(bytes))),
        ColumnType::String | ColumnType::Json | ColumnType::DateTime => {
            Value::Text(String::from_utf8_lossy(bytes).into_owned())
        }
        ColumnType::Binary => Value::Missing,
    }
}

fn kind_name(kind: u8) -> &'static str {
    const NAMES: [&str; 18] = [
        "of several types",
        "Point",
        "LineString",
        "Polygon",
        "MultiPoint",
        "MultiLineString",
        "MultiPolygon",
        "GeometryCollection",
        "CircularString",
        "CompoundCurve",
        "CurvePolygon",
        "MultiCurve",
        "MultiSurface",
        "Curve",
        "Surface",
        "PolyhedralSurface",
        "TIN",
        "Triangle",
    ];
    NAMES
        .get(usize::from(kind))
        .copied()
        .unwrap_or("of an unknown type")
}

/// Adds the shape of a geometry, or several for a collection. `stated` is the type that the header
/// states for all.
fn shapes(geometry: Table, stated: u8, depth: usize, into: &mut Vec<Shape>) -> Result<()> {
    check_depth(depth)?;
    let own = geometry
        .byte(schema::geometry::KIND)?
        .unwrap_or(kind::UNKNOWN);
    let kind = if own == kind::UNKNOWN { stated } else { own };
    let members = || geometry.tables(schema::geometry::PARTS);
    let polygon = |member: &Table| parts(*member);
    into.push(match kind {
        kind::POINT | kind::MULTI_POINT => Shape::Points(vertices(geometry)?),
        kind::LINE | kind::MULTI_LINE => Shape::Lines(parts(geometry)?),
        kind::POLYGON | kind::TRIANGLE => Shape::Polygon(oriented(parts(geometry)?)),
        kind::MULTI_POLYGON => {
            let polygons: Vec<_> = members()?.iter().map(polygon).collect::<Result<_>>()?;
            Shape::Polygon(polygons.into_iter().flat_map(oriented).collect())
        }
        kind::POLYHEDRAL_SURFACE | kind::TIN => {
            let members = members()?;
            // Triangles of a TIN may be the rings of one geometry.
            let faces = match members.is_empty() {
                true => parts(geometry)?
                    .into_iter()
                    .map(|ring| vec![ring])
                    .collect(),
                false => members.iter().map(polygon).collect::<Result<_>>()?,
            };
            Shape::of_faces(faces)
        }
        kind::COLLECTION => {
            for member in members()? {
                shapes(member, kind::UNKNOWN, depth + 1, into)?;
            }
            return Ok(());
        }
        8..=14 => {
            return Err(Error::unsupported("a geometry with arcs")
                .cure("replace them by lines: ogr2ogr -nlt CONVERT_TO_LINEAR straight.fgb FILE"));
        }
        other => return Err(Error::format(format!("a geometry of the type {other}"))),
    });
    Ok(())
}

/// Returns all vertices of a geometry.
fn vertices(geometry: Table) -> Result<Vec<[f64; 3]>> {
    let numbers = |slot, size| -> Result<&[[u8; 8]]> {
        let bytes = geometry.list(slot, size)?.unwrap_or_default();
        Ok(bytes.as_chunks().0)
    };
    let (xy, odd) = numbers(schema::geometry::XY, 8)?.as_chunks::<2>();
    let z = numbers(schema::geometry::Z, 8)?;
    if !odd.is_empty() || !(z.is_empty() || z.len() == xy.len()) {
        return Err(Error::format(format!(
            "a geometry of {} coordinates in plan and {} heights",
            2 * xy.len() + odd.len(),
            z.len()
        )));
    }
    let number = |bytes: &[u8; 8]| f64::from_le_bytes(*bytes);
    let vertex = |(i, [x, y]): (usize, &[[u8; 8]; 2])| {
        [number(x), number(y), z.get(i).map_or(f64::NAN, number)]
    };
    Ok(xy.iter().enumerate().map(vertex).collect())
}

/// Returns the parts of a geometry, without empty ones.
fn parts(geometry: Table) -> Result<Vec<Vec<[f64; 3]>>> {
    let vertices = vertices(geometry)?;
    let ends = geometry
        .list(schema::geometry::ENDS, 4)?
        .unwrap_or_default();
    let (ends, _) = ends.as_chunks();
    if ends.is_empty() {
        return Ok(match vertices.is_empty() {
            true => Vec::new(),
            false => vec![vertices],
        });
    }
    let mut start = 0;
    let mut parts = Vec::with_capacity(ends.len());
    for end in ends {
        let end = u32::from_le_bytes(*end) as usize;
        let part = vertices.get(start..end).ok_or_else(|| {
            Error::format(format!(
                "a part that ends at vertex {end}, of {} behind vertex {start}",
                vertices.len()
            ))
        })?;
        if !part.is_empty() {
            parts.push(part.to_vec());
        }
        start = end;
    }
    if start != vertices.len() {
        return Err(Error::format(format!(
            "{} vertices, of which the parts have {start}",
            vertices.len()
        )));
    }
    Ok(parts)
}
