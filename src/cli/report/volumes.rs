//! Volumes as a table, as JSON and as CSV.

use serde_json::{Map, Value, json};

use super::escape;
use crate::io::csv_field;
use crate::run::units::number;
use crate::run::{VolumeProduct, VolumeRow, VolumeUnit};

/// What a number of a row is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measure {
    Volume,
    Area,
}

/// A number of a row.
struct Field {
    name: &'static str,
    measure: Measure,
    of: fn(&VolumeRow) -> f64,
}

/// The numbers of every row, in the order of all outputs.
const FIELDS: &[Field] = &[
    Field::volume("cut", |row| row.volume.cut),
    Field::volume("fill", |row| row.volume.fill),
    Field::volume("net", |row| row.volume.net()),
    Field::area("cut area", |row| row.volume.cut_area),
    Field::area("fill area", |row| row.volume.fill_area),
    Field::area("level area", |row| row.volume.level_area()),
    Field::area("common area", |row| row.volume.common_area),
    Field::area("surface only", |row| row.volume.surface_only_area),
    Field::area("base only", |row| row.volume.base_only_area),
    Field::area("slope area", |row| row.volume.slope_area),
];

/// The numbers of rows that know what is moved; these follow.
const OF_EARTHWORK: &[Field] = &[
    Field::volume("loose cut", |row| {
        row.earthwork.map_or(0.0, |e| e.loose_cut)
    }),
    Field::volume("bank fill", |row| {
        row.earthwork.map_or(0.0, |e| e.bank_fill)
    }),
    Field::volume("balance", |row| row.earthwork.map_or(0.0, |e| e.balance)),
];

/// What only rows of polygons have, after [`FIELDS`].
const OF_POLYGONS: &[Field] = &[Field::area("polygon area", |row| {
    row.polygon_area.unwrap_or(0.0)
})];

/// Returns the numbers that rows have; all rows have the same.
fn fields(rows: &[VolumeRow]) -> Vec<&'static Field> {
    let has_earthwork = rows.iter().any(|row| row.earthwork.is_some());
    let has_polygons = rows.iter().any(|row| row.polygon_area.is_some());
    let of_polygons = OF_POLYGONS.iter().filter(|_| has_polygons);
    let more = OF_EARTHWORK.iter().filter(|_| has_earthwork);
    FIELDS.iter().chain(of_polygons).chain(more).collect()
}

impl Field {
    const fn volume(name: &'static str, of: fn(&VolumeRow) -> f64) -> Self {
        Field {
            name,
            measure: Measure::Volume,
            of,
        }
    }

    const fn area(name: &'static str, of: fn(&VolumeRow) -> f64) -> Self {
        Field {
            name,
            measure: Measure::Area,
            of,
        }
    }

    /// Returns the name for files, such as `cut_area`.
    fn key(&self) -> String {
        self.name.replace(' ', "_")
    }
}

/// Returns a number without a sign if it is 0.
fn plain(value: f64) -> f64 {
    value + 0.0
}

/// Returns rounded numbers for a terminal: one row as lines, several as a table.
pub(crate) fn text(product: &VolumeProduct) -> String {
    match &product.rows[..] {
        [row] => lines(row, product.unit),
        rows => table(rows, product.unit),
    }
}

fn lines(row: &VolumeRow, unit: Option<VolumeUnit>) -> String {
    let [of_volumes, of_areas] = VolumeUnit::symbols_of(unit);
    let mut text = String::new();
    for (name, value) in keys(row) {
        text += &format!("{name:<12} {value:>16}\n");
    }
    for field in fields(std::slice::from_ref(row)) {
        let symbol = match field.measure {
            Measure::Volume => of_volumes,
            Measure::Area => of_areas,
        };
        let value = number(plain((field.of)(row)));
        text += &format!("{:<12} {value:>16} {symbol}\n", field.name);
    }
    text
}

fn table(rows: &[VolumeRow], unit: Option<VolumeUnit>) -> String {
    let [of_volumes, of_areas] = VolumeUnit::symbols_of(unit);
    let first = rows.first().map(keys).unwrap_or_default();
    let fields = fields(rows);
    let mut cells: Vec<Vec<String>> = vec![
        first
            .iter()
            .map(|(name, _)| (*name).to_owned())
            .chain(fields.iter().map(|field| field.name.to_owned()))
            .collect(),
    ];
    cells.extend(rows.iter().map(|row| {
        let values = fields.iter().map(|field| number(plain((field.of)(row))));
        let keys = keys(row).into_iter().map(|(_, value)| value);
        keys.chain(values).collect()
    }));
    let columns = first.len() + fields.len();
    let width = |column: usize| {
        cells
            .iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = format!("volumes in {of_volumes}, areas in {of_areas}\n");
    for row in &cells {
        let aligned = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:>width$}"));
        text += &aligned.collect::<Vec<_>>().join("  ");
        text.push('\n');
    }
    text
}

/// Returns what a row is about: its polygon and its level, if there are any.
fn keys(row: &VolumeRow) -> Vec<(&'static str, String)> {
    let record = row.record.map(|record| ("record", record.to_string()));
    let name = row
        .name
        .as_deref()
        .map(|name| ("name", escape::line(name).into_owned()));
    let level = row.level.map(|level| ("level", plain(level).to_string()));
    record.into_iter().chain(name).chain(level).collect()
}

/// Returns exact numbers as JSON.
pub(crate) fn json(product: &VolumeProduct) -> Value {
    let [of_volumes, of_areas] = match product.unit {
        Some(unit) => unit.symbols().map(Value::from),
        None => [Value::Null, Value::Null],
    };
    let fields = fields(&product.rows);
    let row = |row: &VolumeRow| {
        let mut object = Map::new();
        if let Some(record) = row.record {
            object.insert("record".to_owned(), record.into());
        }
        if let Some(name) = &row.name {
            object.insert("name".to_owned(), name.as_str().into());
        }
        if let Some(level) = row.level {
            object.insert("level".to_owned(), plain(level).into());
        }
        for field in &fields {
            object.insert(field.key(), plain((field.of)(row)).into());
        }
        Value::Object(object)
    };
    let rows: Vec<Value> = product.rows.iter().map(row).collect();
    json!({ "unit": of_volumes, "area_unit": of_areas, "rows": rows })
}

/// Returns exact numbers as CSV.
pub(crate) fn csv(product: &VolumeProduct) -> String {
    let units = product.unit.map_or(["", ""], |unit| unit.symbols());
    let fields = fields(&product.rows);
    let names: Vec<String> = fields.iter().map(|field| field.key()).collect();
    let has_names = product.rows.iter().any(|row| row.name.is_some());
    let name = if has_names { "name," } else { "" };
    let mut text = format!("record,{name}level,{},unit,area_unit\n", names.join(","));
    for row in &product.rows {
        let record = row
            .record
            .map(|record| record.to_string())
            .unwrap_or_default();
        let name = has_names.then(|| csv_field(row.name.as_deref().unwrap_or_default()));
        let level = row.level.map(|level| plain(level).to_string());
        let values = fields
            .iter()
            .map(|field| plain((field.of)(row)).to_string());
        let cells: Vec<String> = std::iter::once(record)
            .chain(name)
            .chain([level.unwrap_or_default()])
            .chain(values)
            .chain(units.map(str::to_owned))
            .collect();
        text += &cells.join(",");
        text.push('\n');
    }
    text
}
