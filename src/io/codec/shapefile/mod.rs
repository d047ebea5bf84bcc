//! Shapefiles (ESRI Shapefile Technical Description, 1998).
//!
//! [`read_layer`] reads what real deliveries contain. The records of the `.shp`, in order, are
//! authoritative; every other file may be missing or damaged:
//!
//! | file | supplies | if missing | if damaged |
//! |---|---|---|---|
//! | `.shp` | shapes | error | an error; with [`OnDamage::Accept`] complete records are read, and a warning names each damaged one; an error if none is complete |
//! | `.shx` | a record's attribute row; where to continue after damage | order of the `.shp` | not used, a warning |
//! | `.dbf` | names, heights and numbers if requested, deleted rows | no fields | a warning; an error if heights or numbers are requested |
//! | `.prj` | coordinate system | unknown | unknown, a warning |
//! | `.cpg` | encoding of the names | guessed | guessed |
//!
//! Within the `.shp`:
//!
//! | found | result |
//! |---|---|
//! | counts, part indices or a type that make no sense, in a record of plausible length | an error; with [`OnDamage::Accept`] the record is left out, a warning |
//! | a record header that makes no sense | an error; with [`OnDamage::Accept`] reading continues at the next record of the `.shx`, or ends; a warning |
//! | a record that extends beyond the end of the file | the same |
//! | bytes after all records that the `.shx` lists; without it, after the length that the header states, or too few for a record | a warning |
//! | a header that states more bytes than there are | an error, with [`OnDamage::Accept`] a warning; a warning, if the `.shx` lists exactly the records that are there |
//! | x or y not a finite number | an error: the record is well formed, so the value was wrong before it was written |
//! | z not finite or "no data" (below -1e38) | no height (NaN), a warning with the count |
//! | null shapes; no parts, no points | read as they are |
//! | a null shape with coordinates | read as null, a warning with the count |
//! | a ring that is not closed | closed, a warning |
//! | types that differ from the header's, or mixed | read, a warning |
//! | an older copy of a record that the `.shx` lists elsewhere | left out, a warning |
//!
//! [`write_contours`], [`write_lines`] and [`write_layer`] write `.shp`, `.shx`, `.dbf`, `.prj` and
//! `.cpg`, all of them or none.
//!
//! The crate `shapefile` is not used: it trusts counts in the file and stops at the first damage,
//! and its writer stores the current date in the `.dbf` and ignores errors on closing.

mod append;
mod header;
mod index;
mod kept;
mod number;
mod patch;
mod record;
mod table;
mod walk;
mod write;

use std::collections::{BTreeMap, HashSet};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use crate::data::{Attributes, Column as Attribute, Layer, Shape, Value};
use crate::error::{Error, Result, Wording, wording};
use crate::io::OnDamage;
use crate::io::bytes::field;
use crate::io::bytes::watch::{Watch, unwatched};
use crate::io::codec::prj::{self, Prj, sibling};
use crate::io::options::layer::Options;
pub use append::append_fields;
use header::{FILE_CODE, HEADER};
use index::Index;
use record::type_name;
use table::{Field, Numbers, Table};
use walk::{Damage, Record, Shp, Walk};
pub use write::{Column, check_size, write_contours, write_layer, write_lines};

/// Reads a shapefile; `path` names its `.shp`. The files next to it are found whatever the case of
/// their extensions.
///
/// With `z_field`, the name of an attribute in any case, the heights of a shape's vertices are the
/// number in that field, NaN if there is none; heights of the geometry are then ignored. Text
/// fields that contain numbers are accepted, also with a decimal comma.
///
/// The tables of this module list what is read of damaged files, and what leads to an error.
///
/// # Errors
/// If the file cannot be read, is not a shapefile, is damaged or has been cut, or has a plan
/// coordinate that is not finite; if there is no such field.
///
/// # Complexity
/// Linear. Memory is needed for the shapes and one record.
pub fn read_layer(path: &Path, z_field: Option<&str>) -> Result<Layer> {
    read_layer_with(
        path,
        &Options {
            height_field: z_field,
            ..Options::default()
        },
        &unwatched,
    )
}

/// Like [`read_layer`], but with the numbers of attributes, and watched: the bytes of the `.shp`
/// that were parsed are counted.
///
/// # Errors
/// Those of [`read_layer`], and that of the watch; if the layer or an attribute does not exist, or
/// a value of a requested column is not a number.
pub fn read_layer_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    read(path, options, watch).map_err(|e| e.in_file(path))
}

fn read(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    options.check_layer(&[&stem])?;
    let file = File::open(path)?;
    let size = file.metadata()?.len();
    let mut file = BufReader::with_capacity(1 << 16, file);
    let header_type = read_header(&mut file, size)?;
    let mut warnings = Vec::new();

    let index = read_index(path, &mut warnings);
    let mut file = Shp {
        file,
        size,
        stated: header_type.stated,
        code: header_type.code,
    };
    let Walk {
        records,
        types,
        damage,
        end,
        trailing,
        mut odd,
    } = walk::walk(&mut file, index.as_ref(), watch)?;
    require_a_record(&records, &damage)?;
    let rows = index.as_ref().map(|index| {
        let starts: Vec<u64> = records.iter().map(|record| record.offset).collect();
        index.rows(&starts, end)
    });
    if file.stated > size {
        let text = format!(
            "its header states {} bytes, the file has {size}",
            file.stated
        );
        // An index of exactly these records shows that the header is wrong, and no record missing.
        let cut = if matches!(rows, Some(Ok(_))) && end.is_none() {
            OnDamage::Accept
        } else {
            options.cut
        };
        cut.refuse_or_warn(text, &format!("byte {size}"), &mut warnings)?;
    }
    damage.refuse_or_warn(options.cut, &mut warnings)?;
    warnings.extend(trailing);
    warn_of_types(&mut warnings, header_type.code, &types);
    if options.height_field.is_some() {
        // Heights of the geometry are then irrelevant.
        odd.no_height = 0;
    }
    warn_of_oddities(&mut warnings, &odd);

    let rows = rows.and_then(|rows| {
        rows.map_err(|e| warnings.push(format!(".shx not used: {e}").into()))
            .ok()
    });
    let mut layer = Layer {
        format: format!(
            "shapefile {}",
            type_name(header_type.code).unwrap_or("of unknown type")
        ),
        ..Layer::default()
    };
    read_prj(path, &mut layer, &mut warnings)?;
    watch(0)?;
    let attributes = read_table(
        path,
        options,
        records.len(),
        &mut layer.fields,
        &mut warnings,
    )?;
    let mut origins = Vec::new();
    layer.shapes = join(records, rows, &attributes, &mut origins, &mut warnings);
    for (&name, numbers) in options.columns.iter().zip(&attributes.columns) {
        layer.columns.push(column(name, numbers, &origins)?);
    }
    if let Some(rows) = attributes.kept {
        let missing = vec![Value::Missing; layer.fields.len()];
        let row = |&(_, row): &RecordAndRow| {
            let known = row.and_then(|row| rows.get(row));
            known.unwrap_or(&missing).clone()
        };
        layer.attributes = Some(Attributes {
            names: layer.fields.clone(),
            rows: origins.iter().map(row).collect(),
        });
    }
    layer.warnings = warnings;
    Ok(layer)
}

/// Reads the `.shx`, if there is one; a damaged one is not used, with a warning.
fn read_index(path: &Path, warnings: &mut Vec<Wording>) -> Option<Index> {
    match Index::read(&sibling(path, "shx")?) {
        Ok(index) => Some(index),
        Err(e) => {
            warnings.push(format!(".shx not used: {e}").into());
            None
        }
    }
}

/// Returns an error if all records are damaged.
fn require_a_record(records: &[Record], damage: &Damage) -> Result<()> {
    match damage.reported.first() {
        Some(first) if records.iter().all(|record| record.shape.is_none()) => Err(Error::format(
            wording!["no record can be read: ", first.clone()],
        )
        .cure("ask for the file again")),
        _ => Ok(()),
    }
}

/// What the header of a `.shp` states.
struct Header {
    /// The type of the shapes.
    code: i32,
    /// The length of the file in bytes.
    stated: u64,
}

fn read_header(file: &mut impl Read, size: u64) -> Result<Header> {
    let mut bytes = [0; HEADER as usize];
    file.read_exact(&mut bytes).map_err(|_| {
        Error::format(format!(
            "{size} bytes, the header of a shapefile has {HEADER}"
        ))
    })?;
    let word = |at: usize| [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
    if u32::from_be_bytes(word(0)) != FILE_CODE {
        return Err(Error::format(format!(
            "not a shapefile: it begins with {}, not {FILE_CODE}",
            u32::from_be_bytes(word(0))
        )));
    }
    Ok(Header {
        code: i32::from_le_bytes(word(32)),
        stated: u64::from(u32::from_be_bytes(word(24))) * 2,
    })
}

/// Sets the coordinate system of a layer to that of the `.prj`.
fn read_prj(path: &Path, layer: &mut Layer, warnings: &mut Vec<Wording>) -> Result<()> {
    match prj::read_beside(path)? {
        Prj::Stated(crs) => layer.crs = crs,
        Prj::Unread(text, error) => {
            warnings.push(format!(".prj not used: {error}").into());
            layer.unread_crs = Some(text);
        }
    }
    Ok(())
}

/// What was read of the `.dbf`, by its rows.
#[derive(Default)]
struct TableRows {
    /// For each row, true if it is marked as deleted.
    deleted: Vec<bool>,
    height: Option<Numbers>,
    columns: Vec<Numbers>,
    /// For each row, its values, if all attributes are kept.
    kept: Option<Vec<Vec<Value>>>,
}

fn read_table(
    path: &Path,
    options: &Options,
    records: usize,
    fields: &mut Vec<String>,
    warnings: &mut Vec<Wording>,
) -> Result<TableRows> {
    let first_wanted = options.height_field.or(options.columns.first().copied());
    let Some(dbf) = sibling(path, "dbf") else {
        return match first_wanted {
            None => Ok(TableRows::default()),
            Some(name) => Err(Error::usage(format!(
                "there is no .dbf next to it with the field {name}"
            ))),
        };
    };
    let code_page = sibling(path, "cpg").and_then(|path| std::fs::read_to_string(path).ok());
    let mut table = match Table::open(&dbf, code_page.as_deref()) {
        Ok(table) => table,
        Err(e) if first_wanted.is_none() => {
            warnings.push(format!(".dbf not used: {e}").into());
            return Ok(TableRows::default());
        }
        Err(e) => return Err(e.in_file(dbf)),
    };
    *fields = table
        .fields
        .iter()
        .map(|field| field.name.clone())
        .collect();
    let wanted = options
        .height_field
        .iter()
        .chain(options.columns)
        .map(|name| table.find(name));
    let wanted: Vec<Field> = wanted.collect::<Result<_>>().map_err(|e| e.in_file(&dbf))?;
    let room = table.room()?;
    let kept = match options.keeps_attributes {
        true => table.fields.clone(),
        false => Vec::new(),
    };
    let rows = table
        .rows(&wanted, &kept, records.saturating_add(1))
        .map_err(|e| e.in_file(&dbf))?;
    if table.stated > room {
        warnings.push(
            format!(
                ".dbf: its header states {} rows, it has {room}",
                table.stated
            )
            .into(),
        );
    }
    // One row more than there are records was requested, to detect surplus rows.
    match rows.deleted.len() {
        there if there < records => {
            warnings.push(format!(".dbf: {there} rows for {records} records").into())
        }
        there if there > records => {
            warnings.push(
                format!(
                    ".dbf: {} rows for {records} records",
                    table.stated.max(there as u64)
                )
                .into(),
            );
        }
        _ => {}
    }
    let mut columns = rows.numbers;
    let height = options.height_field.map(|_| columns.remove(0));
    if let (Some(numbers), Some(field)) = (&height, wanted.first()) {
        warn_of_texts(&field.name, numbers, warnings).map_err(|e| e.in_file(dbf))?;
    }
    Ok(TableRows {
        deleted: rows.deleted,
        height,
        columns,
        kept: (!kept.is_empty()).then_some(rows.kept),
    })
}

/// Warns of texts in a field of heights that are no numbers.
///
/// # Errors
/// If no record has a number in this field.
fn warn_of_texts(field: &str, heights: &Numbers, warnings: &mut Vec<Wording>) -> Result<()> {
    let Some((_, text)) = heights.texts.first() else {
        return Ok(());
    };
    if heights.values.iter().all(|value| value.is_nan()) {
        return Err(Error::usage(format!(
            "field {field} holds no numbers; the first text is '{text}'"
        )));
    }
    let count = heights.texts.len();
    warnings.push(
        format!("field {field}: {count} rows hold no number (the first: '{text}'); their shapes have no height").into(),
    );
    Ok(())
}

/// The position of a shape's record in the `.shp`, and its row in the `.dbf`.
type RecordAndRow = (usize, Option<usize>);

/// Returns the numbers of an attribute, one per shape.
///
/// # Errors
/// If a value is not a number; the error names the record, counted from 1.
fn column(name: &str, numbers: &Numbers, origins: &[RecordAndRow]) -> Result<Attribute> {
    let value = |&(record, row): &RecordAndRow| match row {
        Some(row) => match numbers.text(row) {
            Some(text) => Err(field::not_a_number(name, text).at(format!("record {}", record + 1))),
            None => Ok(numbers.values.get(row).copied().unwrap_or(f64::NAN)),
        },
        None => Ok(f64::NAN),
    };
    Ok(Attribute {
        name: name.to_owned(),
        values: origins.iter().map(value).collect::<Result<_>>()?,
    })
}

/// Assigns a row to each record: drops damaged, stale and deleted ones, and sets heights. If
/// columns were read, `origins` gets the origin of each shape.
fn join(
    records: Vec<Record>,
    rows: Option<Vec<Option<usize>>>,
    attributes: &TableRows,
    origins: &mut Vec<RecordAndRow>,
    warnings: &mut Vec<Wording>,
) -> Vec<Shape> {
    // If the index leaves out a record but lists another with the same number, an editor appended
    // the new one and left the old one in the file.
    let listed: HashSet<i32> = match &rows {
        Some(rows) => records
            .iter()
            .zip(rows)
            .filter(|(_, row)| row.is_some())
            .filter_map(|(r, _)| r.number)
            .collect(),
        None => HashSet::new(),
    };
    let (mut stale, mut deleted) = (0, 0);
    let mut shapes = Vec::with_capacity(records.len());
    for (position, record) in records.into_iter().enumerate() {
        let row = match &rows {
            Some(rows) => rows[position],
            None => Some(position),
        };
        if row.is_none() && record.number.is_some_and(|number| listed.contains(&number)) {
            stale += 1;
            continue;
        }
        if row.is_some_and(|row| attributes.deleted.get(row) == Some(&true)) {
            deleted += 1;
            continue;
        }
        let Some(mut shape) = record.shape else {
            continue;
        };
        if let Some(height) = attributes
            .height
            .as_ref()
            .filter(|height| !height.values.is_empty())
        {
            let z = row
                .and_then(|row| height.values.get(row))
                .copied()
                .unwrap_or(f64::NAN);
            shape.set_height(z);
        }
        if !attributes.columns.is_empty() || attributes.kept.is_some() {
            origins.push((position, row));
        }
        shapes.push(shape);
    }
    if stale > 0 {
        warnings.push(
            format!(
                "{stale} records are older copies of others (the .shx does not list them); left out"
            )
            .into(),
        );
    }
    if deleted > 0 {
        warnings
            .push(format!("{deleted} records are marked as deleted in the .dbf; left out").into());
    }
    shapes
}

fn warn_of_types(warnings: &mut Vec<Wording>, header: i32, types: &BTreeMap<i32, usize>) {
    if types.keys().all(|&code| code == header) {
        return;
    }
    let name = |code: i32| type_name(code).map_or_else(|| format!("type {code}"), str::to_owned);
    let list: Vec<String> = types
        .iter()
        .map(|(&code, count)| format!("{count} {}", name(code)))
        .collect();
    warnings.push(
        format!(
            "the header states {}, the records are {}",
            name(header),
            list.join(", ")
        )
        .into(),
    );
}

fn warn_of_oddities(warnings: &mut Vec<Wording>, odd: &record::Oddities) {
    for (count, what) in [
        (odd.unclosed, "rings did not end where they began; closed"),
        (odd.empty_parts, "parts without points; left out"),
        (odd.loose, "points belong to no part; left out"),
        (
            odd.no_height,
            "points have no height (not a number, or \"no data\")",
        ),
        (
            odd.unknown_parts,
            "parts of multipatches are of an unknown type; left out",
        ),
        (
            odd.full_nulls,
            "records are of the type null, but have coordinates; these are left out",
        ),
    ] {
        if count > 0 {
            warnings.push(format!("{count} {what}").into());
        }
    }
}
