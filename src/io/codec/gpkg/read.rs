//! Reading: a layer, its attributes and its system.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use rusqlite::types::ValueRef;
use rusqlite::{Connection, ErrorCode, OpenFlags, OptionalExtension, Row};

use super::geometry;
use crate::data::{Layer, Shape, Value};
use crate::error::{Error, Result};
use crate::io::bytes::appended::appended;
use crate::io::bytes::field::{finite_or_none, not_a_number, parse_number};
use crate::io::bytes::watch::Watch;
use crate::io::codec::stated_system;
use crate::io::options::layer::Options;
use crate::io::options::layers::{Fields, set_heights, warn_of_bytes, warn_of_missing_heights};

/// The first bytes of a database.
const MAGIC: &[u8] = b"SQLite format 3\0";

/// Records that are read between two calls of the watch.
const RECORDS_AT_ONCE: usize = 1024;

/// Reads a layer of a GeoPackage, watched; nothing is counted. If there are several layers, one
/// must be named.
///
/// Polygons are oriented as in [`Shape::Polygon`]. The parts of a collection become separate
/// shapes. Records come in the order of their identifiers, which are no attribute. Attributes of
/// bytes are left out.
///
/// # Errors
/// If the file is not a GeoPackage or is damaged, it has no such layer or attribute, or a value of
/// a requested column is not a number; if a geometry has arcs; that of the watch.
///
/// # Complexity
/// Linear in the size of the layer.
pub fn read_layer_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let read = || {
        let database = open(path)?;
        interruptible(&database, watch, || {
            let source = Source::choose(&database, options)?;
            source.read(&database, options, watch)
        })
    };
    read().map_err(|error| error.in_file(path))
}

/// How often a watch is called while SQLite works.
const OFTEN: Duration = Duration::from_millis(50);

/// Calls a function, in which SQLite may work for any time: the query of a view can have more steps
/// than anyone waits for. Another thread calls the watch meanwhile, and interrupts SQLite when it
/// ends the reading.
fn interruptible<T>(
    database: &Connection,
    watch: Watch,
    read: impl FnOnce() -> Result<T>,
) -> Result<T> {
    let handle = database.get_interrupt_handle();
    let (is_read, waits) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        let watching = scope.spawn(move || {
            loop {
                match waits.recv_timeout(OFTEN) {
                    Err(RecvTimeoutError::Timeout) => {}
                    _ => return None,
                }
                if let Err(ended) = watch(0) {
                    handle.interrupt();
                    return Some(ended);
                }
            }
        });
        let result = read();
        drop(is_read);
        let ended = watching.join().ok().flatten();
        result.map_err(|error| ended.unwrap_or(error))
    })
}

/// Returns the error of a database that cannot be read.
fn damaged(error: rusqlite::Error) -> Error {
    let cannot_open = error.sqlite_error_code() == Some(ErrorCode::CannotOpen);
    let stated = Error::format(format!("SQLite: {error}"));
    match cannot_open {
        true => stated.cure(
            "changes may be in a log beside it (-wal): copy both to a folder that can be written",
        ),
        false => stated,
    }
}

fn open(path: &Path) -> Result<Connection> {
    let changes = check_head(path)?;
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let has_log = std::fs::metadata(appended(path, "-wal")).is_ok_and(|log| log.len() > 0);
    // Without a log SQLite would write an empty one beside the file, and leave it there.
    let uri = (changes == Changes::InLog && !has_log).then(|| as_uri(path));
    let database = match uri.flatten() {
        Some(uri) => Connection::open_with_flags(uri, flags | OpenFlags::SQLITE_OPEN_URI),
        None => Connection::open_with_flags(path, flags),
    };
    let database = database.map_err(damaged)?;
    // Views and triggers of a file call no functions that have effects.
    database
        .execute_batch("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;")
        .map_err(damaged)?;
    Ok(database)
}

/// How a database keeps changes until they are in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Changes {
    InFile,
    /// In a log beside the file, which each reader needs, too.
    InLog,
}

/// Returns how changes are kept.
///
/// # Errors
/// If the file is not an SQLite database, or is cut within a page: SQLite would read what is
/// missing as zeros.
fn check_head(path: &Path) -> Result<Changes> {
    let mut file = File::open(path)?;
    let mut head = [0; 20];
    let is_read = file.read_exact(&mut head).is_ok();
    if !is_read || !head.starts_with(MAGIC) {
        return Err(Error::format(
            "it does not begin as an SQLite database does, which a GeoPackage is",
        )
        .cure("fetch the file again: this may be a page or a pointer in its place"));
    }
    let page = match u64::from(u16::from_be_bytes([head[16], head[17]])) {
        1 => 1 << 16,
        size => size,
    };
    let size = file.metadata()?.len();
    if page > 0 && size % page != 0 {
        return Err(Error::format(format!(
            "{size} bytes are no whole number of pages, which have {page}: it is cut"
        )));
    }
    Ok(match head[18..] {
        [2, 2] => Changes::InLog,
        _ => Changes::InFile,
    })
}

/// Returns a path as SQLite takes it with parameters.
fn as_uri(path: &Path) -> Option<String> {
    let absolute = std::path::absolute(path).ok()?;
    let mut uri = "file:".to_owned();
    for byte in absolute.to_str()?.bytes() {
        match byte {
            b'/' | b'.' | b'-' | b'_' | b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' => {
                uri.push(char::from(byte));
            }
            _ => uri += &format!("%{byte:02x}"),
        }
    }
    Some(uri + "?immutable=1")
}

/// Returns a name as SQL has it.
pub(super) fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

/// A column of a table.
struct Field {
    name: String,
    /// The type that the table states.
    kind: String,
    /// Whether it is the key, or a part of it.
    is_key: bool,
}

impl Field {
    /// Returns true if its values are bytes, which are kept as missing values.
    fn has_bytes(&self) -> bool {
        self.kind.to_ascii_uppercase().contains("BLOB")
    }
}

/// What is read of a database.
struct Source {
    table: String,
    geometry: String,
    kind: String,
    system: i64,
    key: Option<String>,
    fields: Vec<Field>,
    height_field: Option<String>,
}

impl Source {
    fn choose(database: &Connection, options: &Options) -> Result<Self> {
        let is_package = "SELECT 1 FROM sqlite_master WHERE name = 'gpkg_geometry_columns'";
        let is_package = database
            .query_row(is_package, [], |_| Ok(()))
            .optional()
            .map_err(damaged)?;
        if is_package.is_none() {
            return Err(Error::unsupported(
                "an SQLite database that is not a GeoPackage, or one without layers of geometries",
            )
            .cure("save its layers as GeoPackage"));
        }
        let layers = "SELECT table_name, column_name, geometry_type_name, srs_id \
                      FROM gpkg_geometry_columns ORDER BY rowid";
        let mut statement = database.prepare(layers).map_err(damaged)?;
        let layers = statement.query_map([], |row| {
            Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?))
        });
        let layers: Vec<(String, String, String, i64)> =
            layers.and_then(Iterator::collect).map_err(damaged)?;
        let names: Vec<String> = layers.iter().map(|(table, ..)| table.clone()).collect();
        let is_field = |wanted: &str| {
            let fields = names
                .iter()
                .filter_map(|table| columns(database, table).ok());
            let mut fields = fields.flatten();
            fields.any(|field| field.name.eq_ignore_ascii_case(wanted))
        };
        let (at, height_field) = options.choose(&names, is_field)?;
        let (table, geometry, kind, system) = layers.into_iter().nth(at).unwrap_or_default();
        let mut key = None;
        let mut fields = Vec::new();
        let columns = columns(database, &table)?;
        if !columns
            .iter()
            .any(|column| column.name.eq_ignore_ascii_case(&geometry))
        {
            return Err(Error::format(format!(
                "layer {table} has no column {geometry}, which is to have the geometries"
            )));
        }
        // Only a whole number is an identifier of the standard; other keys are attributes.
        let keys = columns.iter().filter(|column| column.is_key).count();
        for column in columns {
            if column.is_key && keys == 1 && column.kind.eq_ignore_ascii_case("INTEGER") {
                key = Some(column.name);
            } else if !column.name.eq_ignore_ascii_case(&geometry) {
                fields.push(column);
            }
        }
        Ok(Source {
            table,
            geometry,
            kind,
            system,
            key,
            fields,
            height_field,
        })
    }

    fn read(&self, database: &Connection, options: &Options, watch: Watch) -> Result<Layer> {
        let names: Vec<String> = self.fields.iter().map(|field| field.name.clone()).collect();
        let fields = Fields::of(&names, self.height_field.as_deref(), options.columns)?;
        let mut layer = Layer {
            format: format!("GeoPackage {}", self.kind),
            ..options.empty_layer(names)
        };
        self.read_system(database, &mut layer)?;
        let mut choosing = options.choosing(&layer)?;
        let mut statement = database.prepare(&self.query()).map_err(damaged)?;
        let mut rows = statement.query([]).map_err(damaged)?;
        let mut without_height = 0;
        let mut record = 0;
        while let Some(row) = rows.next().map_err(damaged)? {
            if record % RECORDS_AT_ONCE == 0 {
                watch(0)?;
            }
            record += 1;
            let added = self.add(row, &fields, &mut layer);
            without_height += usize::from(added.map_err(|e| e.at(self.name_of(row, record)))?);
            choosing.added(&mut layer)?;
        }
        choosing.finish(&mut layer)?;
        let of_bytes = self.fields.iter().filter(|field| field.has_bytes());
        warn_of_bytes(of_bytes.map(|field| field.name.as_str()), &mut layer);
        warn_of_missing_heights(without_height, &mut layer);
        Ok(layer)
    }

    /// Returns what messages call a record: its identifier as other programs show it, or its
    /// position, counted from 1.
    fn name_of(&self, row: &Row, record: usize) -> String {
        let key = self.key.as_ref().map(|name| (name, self.fields.len() + 1));
        match key.and_then(|(name, at)| Some((name, row.get::<_, i64>(at).ok()?))) {
            Some((name, value)) => format!("layer {}, {name} {value}", self.table),
            None => format!("layer {}, record {record}", self.table),
        }
    }

    /// Returns the query for the geometry, after it the attributes, and the key.
    fn query(&self) -> String {
        let fields = self.fields.iter().map(|field| &field.name);
        let columns = std::iter::once(&self.geometry)
            .chain(fields)
            .chain(&self.key);
        let columns: Vec<String> = columns.map(|name| quoted(name)).collect();
        let mut query = format!("SELECT {} FROM {}", columns.join(", "), quoted(&self.table));
        if let Some(key) = &self.key {
            query += &format!(" ORDER BY {}", quoted(key));
        }
        query
    }

    /// Adds the shapes and the values of a record. Returns true if heights are in an attribute, and
    /// it has no number there.
    fn add(&self, row: &Row, fields: &Fields, layer: &mut Layer) -> Result<bool> {
        let first = layer.shapes.len();
        match row.get_ref(0).map_err(damaged)? {
            ValueRef::Null => layer.shapes.push(Shape::Null),
            ValueRef::Blob(blob) => geometry::read(blob, &mut layer.shapes)?,
            other => {
                let found = other.data_type();
                return Err(Error::format(format!("{found} in place of a geometry")));
            }
        }
        let count = layer.shapes.len();
        let value = |field: usize| row.get_ref(field + 1).map_err(damaged);
        for (column, &field) in layer.columns.iter_mut().zip(&fields.columns) {
            let number = number(value(field)?).map_err(|text| not_a_number(&column.name, &text))?;
            column.values.resize(count, number);
        }
        if let Some(attributes) = &mut layer.attributes {
            let values = self.fields.iter().enumerate();
            let is_truth = |field: &Field| field.kind.eq_ignore_ascii_case("BOOLEAN");
            let values = values.map(|(at, field)| Ok(kept(value(at)?, is_truth(field))));
            attributes
                .rows
                .resize(count, values.collect::<Result<_>>()?);
        }
        let Some(field) = fields.height else {
            return Ok(false);
        };
        let height = number(value(field)?).unwrap_or(f64::NAN);
        Ok(set_heights(&mut layer.shapes[first..], height))
    }

    fn read_system(&self, database: &Connection, layer: &mut Layer) -> Result<()> {
        let query = "SELECT organization, organization_coordsys_id, definition \
                     FROM gpkg_spatial_ref_sys WHERE srs_id = ?1";
        let found = database.query_row(query, [self.system], |row| {
            Ok((
                row.get::<_, Option<String>>(0)?.unwrap_or_default(),
                row.get::<_, Option<i64>>(1)?.unwrap_or_default(),
                row.get::<_, Option<String>>(2)?.unwrap_or_default(),
            ))
        });
        let Some((organization, code, mut definition)) = found.optional().map_err(damaged)? else {
            return Ok(());
        };
        // -1 and 0 are systems that are not known.
        if matches!(self.system, -1 | 0) {
            return Ok(());
        }
        // An extension of the standard: a text of 2019 where that of 2001 cannot say it.
        if definition.is_empty() || definition.eq_ignore_ascii_case("undefined") {
            let later = "SELECT definition_12_063 FROM gpkg_spatial_ref_sys WHERE srs_id = ?1";
            let later = database.query_row(later, [self.system], |row| row.get(0));
            // Most files have no such column.
            definition = later.unwrap_or(definition);
        }
        stated_system::read(&organization, code, definition, layer);
        Ok(())
    }
}

/// Returns the columns of a table.
fn columns(database: &Connection, table: &str) -> Result<Vec<Field>> {
    let query = "SELECT name, type, pk FROM pragma_table_info(?1)";
    let mut statement = database.prepare(query).map_err(damaged)?;
    let columns = statement.query_map([table], |row| {
        Ok(Field {
            name: row.get(0)?,
            kind: row.get(1)?,
            is_key: row.get::<_, i64>(2)? > 0,
        })
    });
    columns.and_then(Iterator::collect).map_err(damaged)
}

/// Returns a number, or that in a text; NaN if there is none or it is not finite. If the value is
/// something else, the error is its text.
fn number(value: ValueRef) -> std::result::Result<f64, String> {
    let number = match value {
        ValueRef::Null => f64::NAN,
        ValueRef::Integer(whole) => whole as f64,
        ValueRef::Real(number) => number,
        ValueRef::Text(text) => parse_number(String::from_utf8_lossy(text).trim())?,
        ValueRef::Blob(bytes) => return Err(format!("{} bytes", bytes.len())),
    };
    Ok(finite_or_none(number))
}

fn kept(value: ValueRef, is_truth: bool) -> Value {
    match value {
        ValueRef::Null | ValueRef::Blob(_) => Value::Missing,
        ValueRef::Integer(whole) if is_truth => Value::Truth(whole != 0),
        ValueRef::Integer(whole) => Value::Whole(whole),
        ValueRef::Real(number) => Value::Number(number),
        ValueRef::Text(text) => Value::Text(String::from_utf8_lossy(text).into_owned()),
    }
}
