//! Reading: from documents and lines to a layer, its columns and its system.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::{Map, Value};

use super::shape::{Object, array, kind, shape_of};
use super::{RECORD, WGS_84};
use crate::crs::Crs;
use crate::data::{Attributes, Layer, Shape, Value as Attribute};
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::decimal_mark::DecimalMark;
use crate::io::bytes::field::{no_such_field, not_a_number, parse_number};
use crate::io::bytes::watch::{Watch, bytes_of, unwatched};
use crate::io::bytes::watched_value;
use crate::io::options::layer::Options;

/// Reads a GeoJSON file: geometries, features and collections of them. The members of a
/// GeometryCollection become separate shapes.
///
/// With `z_field`, the name of a property in any case, the height of a feature's vertices is the
/// number in that property (or in its text), NaN if there is none.
///
/// Polygons are oriented as in [`Shape::Polygon`]: outer rings clockwise, holes counter-clockwise.
/// Otherwise they could no longer be distinguished.
///
/// The coordinate system is that of the `crs` member; without one it is EPSG:4326. If a coordinate
/// cannot be a longitude or latitude, it is unknown, with a warning.
///
/// # Errors
/// If the file is not GeoJSON (the message names the feature, or line and column), or no feature
/// has such a property.
///
/// # Complexity
/// Linear. The file and all its values are in memory while it is read, which is many times the size
/// of the shapes.
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

/// Like [`read_layer`], but with the numbers of properties, and watched. Nothing is counted.
///
/// # Errors
/// Those of [`read_layer`], and that of the watch; if the layer has a different name, no feature
/// has a requested property, or a value of one is not a number.
pub fn read_layer_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let bytes = bytes_of(path, watch)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    parse(&bytes, &stem, options, watch).map_err(|e| e.in_file(path))
}

/// Parses the bytes of a file; `stem` is its name without the extension.
pub(super) fn parse(bytes: &[u8], stem: &str, options: &Options, watch: Watch) -> Result<Layer> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let value = watched_value::of(bytes, watch)?.map_err(|e| {
        Error::format(format!("not JSON: {e}"))
            .cure("GeoJSON that is cut short cannot be read in part")
    })?;
    let Value::Object(root) = value else {
        return Err(Error::format("not GeoJSON: no object with a type"));
    };
    match root.get("name").and_then(Value::as_str) {
        Some(name) if name != stem => options.check_layer(&[name, stem])?,
        _ => options.check_layer(&[stem])?,
    }
    let mut reader = GeoJsonReader::new("GeoJSON", options);
    let z_field = options.height_field;
    match kind(&root)? {
        "FeatureCollection" => {
            for (i, feature) in array(&root, "features")?.iter().enumerate() {
                if i % watched_value::VALUES_AT_ONCE == 0 {
                    watch(0)?;
                }
                reader
                    .feature(feature, z_field)
                    .map_err(|e| e.at(format!("feature {}", i + 1)))?;
            }
        }
        "Feature" => reader.feature_object(&root, z_field)?,
        _ => reader.geometry(&root, None)?,
    }
    reader.finish(&root, z_field)
}

/// Reads a file of GeoJSON lines (GDAL's GeoJSONSeq) with the numbers of properties, and watched: a
/// feature or geometry on each line, or behind each record separator (0x1e) if the file begins with
/// one, as in RFC 8142. All else is as in [`read_layer_with`].
///
/// # Errors
/// Those of [`read_layer_with`]; the message names the line or the record.
///
/// # Complexity
/// Linear. In memory are the bytes of the file, and the values of one line at a time.
pub fn read_lines_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let bytes = bytes_of(path, watch)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    options
        .check_layer(&[&stem])
        .and_then(|()| parse_lines(&bytes, options, watch))
        .map_err(|e| e.in_file(path))
}

pub(super) fn parse_lines(bytes: &[u8], options: &Options, watch: Watch) -> Result<Layer> {
    let mut reader = GeoJsonReader::new("GeoJSON lines", options);
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let (separator, noun) = match bytes.trim_ascii_start().first() {
        Some(&RECORD) => (RECORD, "record"),
        _ => (b'\n', "line"),
    };
    // Nothing is before the first separator.
    let first = usize::from(separator == b'\n');
    for (number, text) in (first..).zip(bytes.split(|&byte| byte == separator)) {
        if number % watched_value::VALUES_AT_ONCE == 0 {
            watch(0)?;
        }
        let text = text.trim_ascii();
        if !text.is_empty() {
            reader
                .record(text, options.height_field)
                .map_err(|e| e.at(format!("{noun} {number}")))?;
        }
    }
    reader.finish(&Map::new(), options.height_field)
}

#[derive(Default)]
struct GeoJsonReader {
    layer: Layer,
    fields: BTreeSet<String>,
    /// Features with the property for the height, and those of them in which it is not a number.
    found: usize,
    not_numbers: usize,
    first_text: Option<String>,
    height_mark: DecimalMark,
    /// Features that lack the member `geometry`.
    without_geometry: usize,
    /// For each column, true if a feature has it, and the decimal mark of its texts.
    found_columns: Vec<(bool, DecimalMark)>,
    /// For each shape, its properties, if all are kept.
    kept: Option<Vec<Object>>,
}

impl GeoJsonReader {
    fn new(format: &str, options: &Options) -> Self {
        let layer = Layer {
            format: format.to_owned(),
            columns: options.empty_columns(),
            ..Layer::default()
        };
        let found_columns = options.columns.iter().map(|_| Default::default()).collect();
        GeoJsonReader {
            layer,
            found_columns,
            kept: options.keeps_attributes.then(Vec::new),
            ..GeoJsonReader::default()
        }
    }

    /// Adds the feature or geometry in a record of GeoJSON lines. A geometry alone has no
    /// properties.
    fn record(&mut self, text: &[u8], z_field: Option<&str>) -> Result<()> {
        let value = serde_json::from_slice(text).map_err(|e| {
            Error::format(format!("not JSON: {e}"))
                .cure("each line is one feature: if the file is one document, give it the extension geojson")
        })?;
        let Value::Object(object) = value else {
            return Err(Error::format("not an object"));
        };
        match kind(&object)? {
            "Feature" => self.feature_object(&object, z_field),
            "FeatureCollection" => Err(Error::format(
                "a FeatureCollection, where each line is one feature",
            )
            .cure("give it the extension geojson")),
            _ => {
                self.geometry(&object, z_field.map(|_| f64::NAN))?;
                self.add_to_columns(&Map::new())
            }
        }
    }

    fn feature(&mut self, feature: &Value, z_field: Option<&str>) -> Result<()> {
        match feature {
            Value::Object(object) if kind(object)? == "Feature" => {
                self.feature_object(object, z_field)
            }
            _ => Err(Error::format("not a Feature")),
        }
    }

    fn feature_object(&mut self, feature: &Object, z_field: Option<&str>) -> Result<()> {
        let none = Map::new();
        let properties = match feature.get("properties") {
            Some(Value::Object(properties)) => properties,
            _ => &none,
        };
        for name in properties.keys() {
            if !self.fields.contains(name) {
                self.fields.insert(name.clone());
            }
        }
        let height = z_field
            .map(|name| self.height(properties, name))
            .transpose()?;
        match feature.get("geometry") {
            Some(Value::Object(geometry)) => self.geometry(geometry, height)?,
            Some(Value::Null) => self.layer.shapes.push(Shape::Null),
            None => {
                self.without_geometry += 1;
                self.layer.shapes.push(Shape::Null);
            }
            Some(_) => return Err(Error::format("its geometry is not an object")),
        }
        self.add_to_columns(properties)
    }

    fn height(&mut self, properties: &Object, name: &str) -> Result<f64> {
        let Some(value) = property(properties, name) else {
            return Ok(f64::NAN);
        };
        self.found += 1;
        match number(value) {
            Ok(height) => {
                add_mark(&mut self.height_mark, value, height)
                    .map_err(|e| e.within(format!("property {name}")))?;
                Ok(height)
            }
            Err(text) => {
                self.not_numbers += 1;
                self.first_text.get_or_insert(text);
                Ok(f64::NAN)
            }
        }
    }

    /// Adds the properties of a feature to the columns, once for each of its shapes.
    fn add_to_columns(&mut self, properties: &Object) -> Result<()> {
        let shapes = self.layer.shapes.len();
        for (column, (is_there, mark)) in self.layer.columns.iter_mut().zip(&mut self.found_columns)
        {
            let mut found = f64::NAN;
            if let Some(value) = property(properties, &column.name) {
                *is_there = true;
                found = number(value).map_err(|text| not_a_number(&column.name, &text))?;
                add_mark(mark, value, found)
                    .map_err(|e| e.within(format!("property {}", column.name)))?;
            }
            column.values.resize(shapes, found);
        }
        if let Some(kept) = &mut self.kept {
            kept.resize(shapes, properties.clone());
        }
        Ok(())
    }

    /// Adds a geometry; if `height` is given, it replaces the heights.
    fn geometry(&mut self, geometry: &Object, height: Option<f64>) -> Result<()> {
        let kind = kind(geometry)?;
        if kind == "GeometryCollection" {
            for member in array(geometry, "geometries")? {
                let Value::Object(member) = member else {
                    return Err(Error::format(
                        "a member of a GeometryCollection is not an object",
                    ));
                };
                self.geometry(member, height)?;
            }
            return Ok(());
        }
        let mut shape = shape_of(geometry, kind)?;
        if let Some(z) = height {
            shape.set_height(z);
        }
        self.layer.shapes.push(shape);
        Ok(())
    }

    fn finish(self, root: &Object, z_field: Option<&str>) -> Result<Layer> {
        let GeoJsonReader {
            mut layer,
            fields,
            found,
            not_numbers,
            first_text,
            found_columns,
            without_geometry,
            kept,
            ..
        } = self;
        if without_geometry > 0 {
            layer
                .warnings
                .push(format!("features without a member geometry: {without_geometry}").into());
        }
        if let Some((column, _)) = layer
            .columns
            .iter()
            .zip(found_columns)
            .find(|(_, (is_there, _))| !is_there)
            && !layer.shapes.is_empty()
        {
            return Err(no_such_field(
                &column.name,
                fields.iter().map(String::as_str),
            ));
        }
        if let Some(name) = z_field {
            if found == 0 && !layer.shapes.is_empty() {
                return Err(no_such_field(name, fields.iter().map(String::as_str)));
            }
            match first_text {
                Some(text) if not_numbers == found => {
                    return Err(Error::usage(format!("property {name} holds no numbers; the first value is {text}")));
                }
                Some(text) => layer.warnings.push(format!(
                    "property {name}: no number in {not_numbers} features (the first: {text}); their shapes have no height"
                ).into()),
                None => {}
            }
        }
        layer.fields = fields.into_iter().collect();
        let kept = kept.map(|rows| attributes(&rows, &layer.fields, layer.shapes.len()));
        let kept = kept.transpose()?;
        layer.attributes = kept;
        add_system(&mut layer, root.get("crs"));
        Ok(layer)
    }
}

/// The values that a table of all properties has without a property, in any case.
const MOST_MISSING: usize = 10_000_000;

/// Such values for each that is there, besides.
const MISSING_FOR_EACH: usize = 16;

/// Returns the properties of the shapes of a layer. What is an array or an object is kept as its
/// text.
///
/// # Errors
/// If nearly all values are missing of so many that they would fill the memory.
fn attributes(rows: &[Object], names: &[String], shapes: usize) -> Result<Attributes> {
    let present: usize = rows.iter().map(Map::len).sum();
    let most = MOST_MISSING.saturating_add(present.saturating_mul(MISSING_FOR_EACH));
    if names.len().saturating_mul(shapes) > most {
        return Err(Error::limit(format!(
            "{} different properties of {shapes} features, which have {present} in all: a table of them is nearly empty",
            names.len()
        ))
        .cure("remove properties that few features have, or join them to one"));
    }
    let value = |value: Option<&Value>| match value {
        None | Some(Value::Null) => Attribute::Missing,
        Some(Value::Bool(truth)) => Attribute::Truth(*truth),
        Some(Value::String(text)) => Attribute::Text(text.clone()),
        Some(Value::Number(number)) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => Attribute::Whole(whole),
            (None, Some(number)) => Attribute::Number(number),
            (None, None) => Attribute::Missing,
        },
        Some(other) => Attribute::Text(other.to_string()),
    };
    let none = Map::new();
    let rows = (0..shapes).map(|shape| rows.get(shape).unwrap_or(&none));
    let rows = rows.map(|row| names.iter().map(|name| value(row.get(name))).collect());
    Ok(Attributes {
        names: names.to_vec(),
        rows: rows.collect(),
    })
}

/// Returns the property with this name: as written, else in any case.
fn property<'a>(properties: &'a Object, name: &str) -> Option<&'a Value> {
    let in_any_case = || {
        properties
            .iter()
            .find(|(key, _)| key.eq_ignore_ascii_case(name))
            .map(|(_, value)| value)
    };
    properties.get(name).or_else(in_any_case)
}

/// Returns the number in a property or in its text, NaN if it is null. If it contains something
/// else, the error is its text.
fn number(value: &Value) -> std::result::Result<f64, String> {
    match value {
        Value::Null => Ok(f64::NAN),
        Value::Number(number) => Ok(number.as_f64().unwrap_or(f64::NAN)),
        Value::String(text) => parse_number(text.trim()),
        other => Err(other.to_string()),
    }
}

/// Adds the decimal mark of a number in a text; a number of JSON always has a point.
fn add_mark(mark: &mut DecimalMark, value: &Value, number: f64) -> Result<()> {
    match value {
        Value::String(text) if !number.is_nan() => {
            mark.add(text.trim().as_bytes(), || format!("\"{text}\""))
        }
        _ => Ok(()),
    }
}

/// Adds the coordinate system of a layer: that of its member `crs`; without one, longitude and
/// latitude if all coordinates can be that.
fn add_system(layer: &mut Layer, stated: Option<&Value>) {
    let may_be_degrees = |v: &[f64; 3]| v[0].abs() <= 180.0 && v[1].abs() <= 90.0;
    layer.crs = match stated {
        Some(Value::Null) => None,
        Some(crs) => match stated_crs(crs) {
            Ok(crs) => Some(crs),
            Err(e) => {
                layer.warnings.push(format!("crs not used: {e}").into());
                layer.unread_crs = Some(
                    crs["properties"]["name"]
                        .as_str()
                        .map_or(crs.to_string(), str::to_owned),
                );
                None
            }
        },
        None if layer
            .shapes
            .iter()
            .flat_map(Shape::vertices)
            .all(may_be_degrees) =>
        {
            Crs::from_epsg(WGS_84)
                .map_err(|e| layer.warnings.push(format!("crs not used: {e}").into()))
                .ok()
        }
        None => {
            let text = "no crs member, and its coordinates are not longitude and latitude";
            layer.warnings.push(wording![
                text,
                " (state their system with ",
                Setting::Crs,
                ")"
            ]);
            None
        }
    };
}

/// Parses a system such as
/// `{"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}`.
fn stated_crs(member: &Value) -> Result<Crs> {
    let name = member["properties"]["name"].as_str();
    Crs::from_user(name.ok_or_else(|| Error::unsupported("a crs that is not given by name"))?)
}
