//! Writing: one layer to a new file.

use std::collections::BTreeSet;

use rusqlite::types::{ToSql, ToSqlOutput, ValueRef};
use rusqlite::{Connection, OpenFlags, Statement, params, params_from_iter};

use super::geometry::{Form, Kind};
use super::read::quoted;
use crate::crs::Crs;
use crate::data::{Bounds, ContourLine, Layer, Shape, ShapeKind, Value, ValueKind};
use crate::error::{Error, Result};
use crate::io::bytes::appended::appended;
use crate::io::bytes::output::{Destination, is_stream};
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::codec::stated_system;
use crate::io::options::map_sheet::MapSheet;

/// The columns of the key and of the geometry.
const KEY: &str = "fid";
const GEOMETRY: &str = "geom";

/// The attributes that a table of SQLite has room for, beside the key and the geometry.
const MOST_COLUMNS: usize = 1998;

/// The number of a system that is stated by its text.
const OWN_SYSTEM: i32 = 100_000;

/// The number of an unknown system with coordinates in a plane.
const UNKNOWN_SYSTEM: i32 = -1;

/// The file is new and appears as a whole, so that no journal is needed. Version 1.3, and its
/// tables.
const BEGIN: &str = "
PRAGMA journal_mode = OFF;
PRAGMA synchronous = OFF;
PRAGMA locking_mode = EXCLUSIVE;
PRAGMA application_id = 0x47504B47;
PRAGMA user_version = 10300;
BEGIN;
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL PRIMARY KEY,
  organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL,
  definition TEXT NOT NULL,
  description TEXT
);
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY,
  data_type TEXT NOT NULL,
  identifier TEXT UNIQUE,
  description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE,
  srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id)
);
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL,
  column_name TEXT NOT NULL,
  geometry_type_name TEXT NOT NULL,
  srs_id INTEGER NOT NULL,
  z TINYINT NOT NULL,
  m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id)
);
CREATE TABLE gpkg_extensions (
  table_name TEXT,
  column_name TEXT,
  extension_name TEXT NOT NULL,
  definition TEXT NOT NULL,
  scope TEXT NOT NULL,
  CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name)
);
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', NULL),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', NULL);
";

/// Keeps the index true when other programs change the layer: they have the functions that it
/// calls. From annex F.3 of the standard; T, I and G stand for the table, its index and the column.
const TRIGGERS: &str = "
CREATE TRIGGER I_insert AFTER INSERT ON T
  WHEN (NEW.G NOT NULL AND NOT ST_IsEmpty(NEW.G))
BEGIN
  INSERT OR REPLACE INTO I VALUES (NEW.fid, ST_MinX(NEW.G), ST_MaxX(NEW.G), ST_MinY(NEW.G), ST_MaxY(NEW.G));
END;
CREATE TRIGGER I_update1 AFTER UPDATE OF G ON T
  WHEN OLD.fid = NEW.fid AND (NEW.G NOTNULL AND NOT ST_IsEmpty(NEW.G))
BEGIN
  INSERT OR REPLACE INTO I VALUES (NEW.fid, ST_MinX(NEW.G), ST_MaxX(NEW.G), ST_MinY(NEW.G), ST_MaxY(NEW.G));
END;
CREATE TRIGGER I_update2 AFTER UPDATE OF G ON T
  WHEN OLD.fid = NEW.fid AND (NEW.G ISNULL OR ST_IsEmpty(NEW.G))
BEGIN
  DELETE FROM I WHERE id = OLD.fid;
END;
CREATE TRIGGER I_update3 AFTER UPDATE ON T
  WHEN OLD.fid != NEW.fid AND (NEW.G NOTNULL AND NOT ST_IsEmpty(NEW.G))
BEGIN
  DELETE FROM I WHERE id = OLD.fid;
  INSERT OR REPLACE INTO I VALUES (NEW.fid, ST_MinX(NEW.G), ST_MaxX(NEW.G), ST_MinY(NEW.G), ST_MaxY(NEW.G));
END;
CREATE TRIGGER I_update4 AFTER UPDATE ON T
  WHEN OLD.fid != NEW.fid AND (NEW.G ISNULL OR ST_IsEmpty(NEW.G))
BEGIN
  DELETE FROM I WHERE id IN (OLD.fid, NEW.fid);
END;
CREATE TRIGGER I_delete AFTER DELETE ON T
  WHEN OLD.G NOT NULL
BEGIN
  DELETE FROM I WHERE id = OLD.fid;
END;
";

/// Writes contours as a layer of line strings with heights, with the attributes `ID` (from 1) and
/// `ELEV` and a spatial index. The layer has the name of the file. The bytes depend only on the
/// lines: the date of the last change is always 1970-01-01.
///
/// Lines are written as they arrive; none are kept in memory. Lines with fewer than two vertices
/// are left out.
///
/// # Errors
/// If the file cannot be written. An existing file is then left untouched.
pub fn write_contours<'a>(
    target: impl Into<Destination<'a>>,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> Result<ContourSummary> {
    let head = Head {
        form: Form {
            kind: Kind::Line,
            is_multiple: false,
            has_heights: true,
            system: system_of(crs),
        },
        columns: vec![("ID".to_owned(), "INTEGER"), ("ELEV".to_owned(), "REAL")],
        crs,
    };
    let fill = |layer: &mut Records| {
        let mut summary = ContourSummary::default();
        for line in lines.filter(|line| line.points.len() > 1) {
            let bounds = summary.add(&line);
            let (shape, values) = summary.last_record(&line);
            layer.add(&shape, &bounds, &values)?;
        }
        Ok(summary)
    };
    write(target.into(), |database, name| {
        add_layer(database, name, &head, fill)
    })
}

/// Writes the shapes of a layer with all its attributes, as [`write_contours`] writes contours, and
/// returns warnings. Without attributes, there is an `ID` from 1.
///
/// Shapes are geometries of several parts if one of them has several. Heights are written if a
/// vertex has one; missing ones are then NaN. The type of an attribute is that of its values: whole
/// numbers, numbers, true and false, or else texts.
///
/// # Errors
/// As [`write_contours`].
pub fn write_lines<'a>(target: impl Into<Destination<'a>>, layer: &Layer) -> Result<Vec<String>> {
    write(target.into(), |database, name| {
        add_shapes(database, name, layer)
    })
}

/// Writes contours of a map as [`write_lines`] does, and labels as a second layer, whose name is
/// that of the file and `_labels`; without contours, as the only one. Returns warnings.
///
/// # Errors
/// As [`write_contours`].
pub(crate) fn write_map(target: Destination, sheet: &MapSheet) -> Result<Vec<String>> {
    write(target, |database, name| {
        let mut warnings = Vec::new();
        if let Some(shapes) = sheet.shapes {
            warnings = add_shapes(database, name, shapes)?;
        }
        if let Some(labels) = sheet.labels {
            let own = match sheet.shapes {
                Some(_) => format!("{name}_labels"),
                None => name.to_owned(),
            };
            warnings.extend(add_shapes(database, &own, labels)?);
        }
        Ok(warnings)
    })
}

/// Adds the shapes of a layer with all its attributes to a database, and returns warnings.
fn add_shapes(database: &Connection, name: &str, layer: &Layer) -> Result<Vec<String>> {
    let mut warnings = Vec::new();
    let columns = columns(layer, &mut warnings);
    if columns.len() > MOST_COLUMNS {
        let error = format!(
            "{} attributes, where a GeoPackage has room for {MOST_COLUMNS}",
            columns.len()
        );
        return Err(Error::limit(error).cure("write GeoJSON, or remove attributes"));
    }
    let shapes = || layer.shapes.iter();
    let crs = layer.crs.as_ref();
    let head = Head {
        form: Form {
            kind: kind(layer),
            is_multiple: shapes().any(|shape| shape.part_count() > 1),
            has_heights: shapes().flat_map(Shape::vertices).any(|p| p[2].is_finite()),
            system: system_of(crs),
        },
        columns,
        crs,
    };
    add_layer(database, name, &head, |out| {
        for (i, shape) in shapes().enumerate() {
            let mut bounds = Bounds::default();
            shape.vertices().for_each(|p| bounds.add(*p));
            match &layer.attributes {
                Some(attributes) if !attributes.names.is_empty() => {
                    let row = attributes.rows.get(i).map_or(&[][..], Vec::as_slice);
                    out.add(shape, &bounds, row)?;
                }
                _ => out.add(shape, &bounds, &[Value::Whole(i as i64 + 1)])?,
            }
        }
        Ok(())
    })?;
    Ok(warnings)
}

/// Returns the kind of the geometries of a layer.
fn kind(layer: &Layer) -> Kind {
    let kinds: BTreeSet<ShapeKind> = layer.shapes.iter().map(Shape::kind).collect();
    let mut kinds = kinds.into_iter().filter(|&kind| kind != ShapeKind::Null);
    match (kinds.next(), kinds.next()) {
        (Some(ShapeKind::Points), None) => Kind::Point,
        (Some(ShapeKind::Lines), None) => Kind::Line,
        (Some(ShapeKind::Polygon | ShapeKind::Faces), None) => Kind::Polygon,
        _ => Kind::Any,
    }
}

/// Returns the names and types of the attributes of a layer. A name that another column has, in any
/// case, is numbered.
fn columns(layer: &Layer, warnings: &mut Vec<String>) -> Vec<(String, &'static str)> {
    let attributes = match &layer.attributes {
        Some(attributes) if !attributes.names.is_empty() => attributes,
        _ => return vec![("ID".to_owned(), "INTEGER")],
    };
    let mut taken: BTreeSet<String> = [KEY, GEOMETRY].map(str::to_owned).into();
    let mut columns = Vec::new();
    for (number, name) in attributes.names.iter().enumerate() {
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let mut names = std::iter::once(name.clone()).chain(numbered);
        let free = names.find(|name| !taken.contains(&name.to_lowercase()));
        let free = free.unwrap_or_default();
        if free != *name {
            warnings.push(format!("the attribute {name} is {free} in the GeoPackage"));
        }
        taken.insert(free.to_lowercase());
        columns.push((free, type_of(attributes.kind(number))));
    }
    columns
}

/// Returns the type of a column with values of a kind.
fn type_of(kind: ValueKind) -> &'static str {
    match kind {
        ValueKind::Whole => "INTEGER",
        ValueKind::Number => "REAL",
        ValueKind::Truth => "BOOLEAN",
        ValueKind::Text => "TEXT",
    }
}

/// What is known of a layer before its records.
struct Head<'a> {
    form: Form,
    columns: Vec<(String, &'static str)>,
    crs: Option<&'a Crs>,
}

/// Returns the error of a database that cannot be written.
fn unwritten(error: rusqlite::Error) -> Error {
    std::io::Error::other(error).into()
}

/// Creates a database, calls a function that adds layers with the name of the file, and takes the
/// file.
fn write<T>(target: Destination, fill: impl FnOnce(&Connection, &str) -> Result<T>) -> Result<T> {
    let no_file = || {
        Error::usage("a GeoPackage is a database, which a pipe cannot take")
            .in_file(target.path())
            .cure("write it to a file")
    };
    // A pipe is not opened: that would wait for its reader.
    if is_stream(target.path()) {
        return Err(no_file());
    }
    let output = target.create()?;
    let (hidden, replaced) = output.paths().ok_or_else(no_file)?;
    let name = target.path().file_stem().unwrap_or_default();
    let name = name.to_string_lossy();
    // Names with these beginnings are those of the standard's own tables, and of SQLite's.
    let begins = |with: &str| {
        let start = name.get(..with.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(with))
    };
    let name = match ["gpkg_", "rtree_", "sqlite_"].into_iter().any(begins) {
        true => format!("layer_{name}"),
        false => name.into_owned(),
    };
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let write = || {
        let database = Connection::open_with_flags(hidden, flags).map_err(unwritten)?;
        database.execute_batch(BEGIN).map_err(unwritten)?;
        let written = fill(&database, &name)?;
        database.execute_batch("COMMIT").map_err(unwritten)?;
        database.close().map_err(|(_, error)| unwritten(error))?;
        Ok(written)
    };
    let written = write().map_err(|error: Error| error.in_file(target.path()))?;
    // SQLite would make the pending changes of the replaced file in the new one.
    let stale = ["-wal", "-shm", "-journal"].map(|end| appended(replaced, end));
    target.put_all([], output, stale)?;
    Ok(written)
}

/// Adds a layer to a database, whose records a function adds.
fn add_layer<T>(
    database: &Connection,
    name: &str,
    head: &Head,
    add: impl FnOnce(&mut Records) -> Result<T>,
) -> Result<T> {
    let form = head.form;
    add_systems(database, head.crs, form.system)?;
    let (table, index) = (quoted(name), quoted(&format!("rtree_{name}_{GEOMETRY}")));
    let columns = head.columns.iter();
    let columns: String = columns
        .map(|(name, kind)| format!(", {} {kind}", quoted(name)))
        .collect();
    database
        .execute_batch(&format!(
            "CREATE TABLE {table} ({KEY} INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, \
             {GEOMETRY} {}{columns});
             CREATE VIRTUAL TABLE {index} USING rtree(id, minx, maxx, miny, maxy);",
            form.name()
        ))
        .map_err(unwritten)?;
    let blanks = ", ?".repeat(head.columns.len());
    let prepare = |sql: &str| database.prepare(sql).map_err(unwritten);
    let mut records = Records {
        form,
        insert: prepare(&format!("INSERT INTO {table} VALUES (NULL, ?{blanks})"))?,
        index: prepare(&format!("INSERT INTO {index} VALUES (?, ?, ?, ?, ?)"))?,
        count: 0,
        bounds: Bounds::default(),
        geometry: Vec::new(),
        types: head.columns.iter().map(|&(_, kind)| kind).collect(),
    };
    let written = add(&mut records)?;
    let Bounds { min, max } = records.bounds;
    drop(records);
    let known = |number: f64| number.is_finite().then_some(number);
    database
        .execute(
            "INSERT INTO gpkg_contents VALUES \
             (?1, 'features', ?1, '', '1970-01-01T00:00:00.000Z', ?2, ?3, ?4, ?5, ?6)",
            params![
                name,
                known(min[0]),
                known(min[1]),
                known(max[0]),
                known(max[1]),
                form.system
            ],
        )
        .and_then(|_| {
            database.execute(
                "INSERT INTO gpkg_geometry_columns VALUES (?, ?, ?, ?, ?, 0)",
                params![name, GEOMETRY, form.name(), form.system, form.has_heights],
            )
        })
        .and_then(|_| {
            let definition = "http://www.geopackage.org/spec120/#extension_rtree";
            database.execute(
                "INSERT INTO gpkg_extensions VALUES (?, ?, 'gpkg_rtree_index', ?, 'write-only')",
                params![name, GEOMETRY, definition],
            )
        })
        .map_err(unwritten)?;
    database
        .execute_batch(&triggers(name, &table))
        .map_err(unwritten)?;
    Ok(written)
}

/// Returns the triggers for a table and its index.
fn triggers(name: &str, table: &str) -> String {
    let index = format!("rtree_{name}_{GEOMETRY}");
    let mut triggers = String::new();
    // Words that are to be replaced stand between blanks, dots, brackets and lines.
    let mut word = String::new();
    for c in TRIGGERS.chars() {
        if c.is_ascii_alphanumeric() || c == '_' {
            word.push(c);
            continue;
        }
        match word.strip_prefix("I_") {
            Some(rest) => triggers += &quoted(&format!("{index}_{rest}")),
            None => match &word[..] {
                "T" => triggers += table,
                "I" => triggers += &quoted(&index),
                "G" => triggers += GEOMETRY,
                _ => triggers += &word,
            },
        }
        word.clear();
        triggers.push(c);
    }
    triggers
}

/// Returns the number of the system of a layer in the file.
fn system_of(crs: Option<&Crs>) -> i32 {
    crs.map_or(UNKNOWN_SYSTEM, |crs| {
        stated_system::code_of(crs).unwrap_or(OWN_SYSTEM)
    })
}

/// Adds longitude and latitude, which each file has, and the system of the layer with its number.
fn add_systems(database: &Connection, crs: Option<&Crs>, number: i32) -> Result<()> {
    let add = |crs: &Crs, number: i32| {
        let organization = match number {
            OWN_SYSTEM => "NONE",
            _ => "EPSG",
        };
        let values = params![crs.name, number, organization, number, crs.to_wkt()];
        let add = "INSERT OR IGNORE INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, NULL)";
        database.execute(add, values).map_err(unwritten)
    };
    add(&Crs::from_epsg(4326)?, 4326)?;
    crs.map_or(Ok(0), |crs| add(crs, number))?;
    Ok(())
}

/// The records of a layer while they are written.
struct Records<'a> {
    form: Form,
    insert: Statement<'a>,
    index: Statement<'a>,
    count: i64,
    bounds: Bounds,
    geometry: Vec<u8>,
    types: Vec<&'static str>,
}

impl Records<'_> {
    /// Adds a shape with these bounds, and its values.
    fn add(&mut self, shape: &Shape, bounds: &Bounds, values: &[Value]) -> Result<()> {
        self.count += 1;
        self.geometry.clear();
        let has_geometry = self.form.write(shape, bounds, &mut self.geometry);
        let geometry = match has_geometry {
            true => Cell::Geometry(&self.geometry),
            false => Cell::Value(&Value::Missing),
        };
        let missing = std::iter::repeat(&Value::Missing);
        let values = values.iter().chain(missing).zip(&self.types);
        let cells = values.map(|(value, kind)| match (value, *kind) {
            // SQLite would write a number among texts with 15 digits.
            (Value::Whole(_) | Value::Number(_) | Value::Truth(_), "TEXT") => {
                Cell::Text(value.text())
            }
            _ => Cell::Value(value),
        });
        let cells = std::iter::once(geometry).chain(cells);
        self.insert
            .execute(params_from_iter(cells))
            .map_err(unwritten)?;
        if has_geometry && bounds.min[0].is_finite() {
            let Bounds { min, max } = bounds;
            self.index
                .execute(params![self.count, min[0], max[0], min[1], max[1]])
                .map_err(unwritten)?;
            self.bounds.merge(bounds);
        }
        Ok(())
    }
}

/// A cell of a record.
enum Cell<'a> {
    Geometry(&'a [u8]),
    Value(&'a Value),
    Text(String),
}

impl ToSql for Cell<'_> {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(ToSqlOutput::Borrowed(match self {
            Cell::Geometry(bytes) => ValueRef::Blob(bytes),
            Cell::Text(text) => ValueRef::Text(text.as_bytes()),
            Cell::Value(Value::Missing) => ValueRef::Null,
            Cell::Value(Value::Whole(whole)) => ValueRef::Integer(*whole),
            Cell::Value(Value::Number(number)) => ValueRef::Real(*number),
            Cell::Value(Value::Text(text)) => ValueRef::Text(text.as_bytes()),
            Cell::Value(Value::Truth(truth)) => ValueRef::Integer(i64::from(*truth)),
        }))
    }
}
