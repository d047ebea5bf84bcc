//! GeoJSON (RFC 7946, and the 2008 draft with its `crs` member), and GeoJSON lines (RFC 8142): a
//! feature on each line of the file.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

use serde_json::{Map, Value};

use super::contour_summary::ContourSummary;
use crate::crs::{Crs, CrsKind};
use crate::data::{Column, ContourLine, Layer, Shape};
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::decimal_mark::DecimalMark;
use crate::io::bytes::field::{no_such_field, not_a_number, parse_number};
use crate::io::bytes::output::{Destination, Output};
use crate::io::bytes::watch::{Watch, bytes_of, unwatched};
use crate::io::bytes::watched_value;
use crate::io::options::layer::Options;
use crate::triangulation::num::unsigned_zero;

/// Longitude and latitude on WGS 84, the default of GeoJSON.
const WGS_84: u32 = 4326;

/// The separator of records in RFC 8142.
const RECORD: u8 = 0x1e;

type Object = Map<String, Value>;

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
    read_layer_with(path, &Options { height_field: z_field, ..Options::default() }, &unwatched)
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
fn parse(bytes: &[u8], stem: &str, options: &Options, watch: Watch) -> Result<Layer> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let value = watched_value::of(bytes, watch)?.map_err(|e| {
        Error::format(format!("not JSON: {e}")).cure("GeoJSON that is cut short cannot be read in part")
    })?;
    let Value::Object(root) = value else {
        return Err(Error::format("not GeoJSON: no object with a type"));
    };
    match root.get("name").and_then(Value::as_str) {
        Some(name) if name != stem => options.check_layer(&[name, stem])?,
        _ => options.check_layer(&[stem])?,
    }
    let mut reader = Reader::new("GeoJSON", options);
    let z_field = options.height_field;
    match kind(&root)? {
        "FeatureCollection" => {
            for (i, feature) in array(&root, "features")?.iter().enumerate() {
                if i % watched_value::VALUES_AT_ONCE == 0 {
                    watch(0)?;
                }
                reader.feature(feature, z_field).map_err(|e| e.at(format!("feature {}", i + 1)))?;
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
    options.check_layer(&[&stem]).and_then(|()| parse_lines(&bytes, options, watch)).map_err(|e| e.in_file(path))
}

fn parse_lines(bytes: &[u8], options: &Options, watch: Watch) -> Result<Layer> {
    let mut reader = Reader::new("GeoJSON lines", options);
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
            reader.record(text, options.height_field).map_err(|e| e.at(format!("{noun} {number}")))?;
        }
    }
    reader.finish(&Map::new(), options.height_field)
}

#[derive(Default)]
struct Reader {
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
}

impl Reader {
    fn new(format: &str, options: &Options) -> Self {
        let columns = options.columns.iter().map(|&name| Column { name: name.to_owned(), ..Column::default() });
        let layer = Layer { format: format.to_owned(), columns: columns.collect(), ..Layer::default() };
        let found_columns = options.columns.iter().map(|_| Default::default()).collect();
        Reader { layer, found_columns, ..Reader::default() }
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
            "FeatureCollection" => Err(Error::format("a FeatureCollection, where each line is one feature")
                .cure("give it the extension geojson")),
            _ => {
                self.geometry(&object, z_field.map(|_| f64::NAN))?;
                self.add_to_columns(&Map::new())
            }
        }
    }

    fn feature(&mut self, feature: &Value, z_field: Option<&str>) -> Result<()> {
        match feature {
            Value::Object(object) if kind(object)? == "Feature" => self.feature_object(object, z_field),
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
        let height = z_field.map(|name| self.height(properties, name)).transpose()?;
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
        let Some(value) = property(properties, name) else { return Ok(f64::NAN) };
        self.found += 1;
        match number(value) {
            Ok(height) => {
                add_mark(&mut self.height_mark, value, height).map_err(|e| e.within(format!("property {name}")))?;
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
        for (column, (is_there, mark)) in self.layer.columns.iter_mut().zip(&mut self.found_columns) {
            let mut found = f64::NAN;
            if let Some(value) = property(properties, &column.name) {
                *is_there = true;
                found = number(value).map_err(|text| not_a_number(&column.name, &text))?;
                add_mark(mark, value, found).map_err(|e| e.within(format!("property {}", column.name)))?;
            }
            column.values.resize(shapes, found);
        }
        Ok(())
    }

    /// Adds a geometry; if `height` is given, it replaces the heights.
    fn geometry(&mut self, geometry: &Object, height: Option<f64>) -> Result<()> {
        let kind = kind(geometry)?;
        if kind == "GeometryCollection" {
            for member in array(geometry, "geometries")? {
                let Value::Object(member) = member else {
                    return Err(Error::format("a member of a GeometryCollection is not an object"));
                };
                self.geometry(member, height)?;
            }
            return Ok(());
        }
        let coordinates = || array(geometry, "coordinates");
        let mut shape = match kind {
            "Point" => {
                let position = coordinates()?;
                match position.is_empty() {
                    true => Shape::Null,
                    false => Shape::Points(vec![vertex(position)?]),
                }
            }
            "MultiPoint" => Shape::Points(line(coordinates()?)?),
            "LineString" => Shape::Lines(vec![line(coordinates()?)?]),
            "MultiLineString" => Shape::Lines(lines(coordinates()?)?),
            "Polygon" => Shape::Polygon(rings(coordinates()?)?),
            "MultiPolygon" => {
                let polygons = coordinates()?.iter().map(|polygon| rings(list(polygon)?));
                Shape::Polygon(polygons.collect::<Result<Vec<_>>>()?.concat())
            }
            other => return Err(Error::format(format!("type {other} is not a GeoJSON type"))),
        };
        if let Some(z) = height {
            shape.set_height(z);
        }
        self.layer.shapes.push(shape);
        Ok(())
    }

    fn finish(self, root: &Object, z_field: Option<&str>) -> Result<Layer> {
        let Reader { mut layer, fields, found, not_numbers, first_text, found_columns, without_geometry, .. } = self;
        if without_geometry > 0 {
            layer.warnings.push(format!("features without a member geometry: {without_geometry}").into());
        }
        if let Some((column, _)) = layer.columns.iter().zip(found_columns).find(|(_, (is_there, _))| !is_there)
            && !layer.shapes.is_empty()
        {
            return Err(no_such_field(&column.name, fields.iter().map(String::as_str)));
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
        layer.crs = match root.get("crs") {
            Some(Value::Null) => None,
            Some(crs) => match stated_crs(crs) {
                Ok(crs) => Some(crs),
                Err(e) => {
                    layer.warnings.push(format!("crs not used: {e}").into());
                    layer.unread_crs = Some(crs["properties"]["name"].as_str().map_or(crs.to_string(), str::to_owned));
                    None
                }
            },
            None if layer
                .shapes
                .iter()
                .flat_map(Shape::vertices)
                .all(|v| v[0].abs() <= 180.0 && v[1].abs() <= 90.0) =>
            {
                Crs::from_epsg(WGS_84).map_err(|e| layer.warnings.push(format!("crs not used: {e}").into())).ok()
            }
            None => {
                let text = "no crs member, and its coordinates are not longitude and latitude";
                layer.warnings.push(wording![text, " (state their system with ", Setting::Crs, ")"]);
                None
            }
        };
        Ok(layer)
    }
}

/// Returns the property with this name: as written, else in any case.
fn property<'a>(properties: &'a Object, name: &str) -> Option<&'a Value> {
    let in_any_case = || properties.iter().find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value);
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
        Value::String(text) if !number.is_nan() => mark.add(text.trim().as_bytes(), || format!("\"{text}\"")),
        _ => Ok(()),
    }
}

/// Parses a system such as
/// `{"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}`.
fn stated_crs(member: &Value) -> Result<Crs> {
    let name = member["properties"]["name"].as_str();
    Crs::from_user(name.ok_or_else(|| Error::unsupported("a crs that is not given by name"))?)
}

fn kind(object: &Object) -> Result<&str> {
    object.get("type").and_then(Value::as_str).ok_or_else(|| Error::format("not GeoJSON: an object without a type"))
}

fn array<'a>(object: &'a Object, name: &str) -> Result<&'a [Value]> {
    object
        .get(name)
        .and_then(Value::as_array)
        .map(Vec::as_slice)
        .ok_or_else(|| Error::format(format!("no array {name}")))
}

fn list(value: &Value) -> Result<&[Value]> {
    value.as_array().map(Vec::as_slice).ok_or_else(|| Error::format(format!("{value} instead of an array")))
}

fn vertex(position: &[Value]) -> Result<[f64; 3]> {
    let number = |value: &Value| value.as_f64().ok_or_else(|| Error::format(format!("coordinate {value}")));
    match position {
        [x, y] => Ok([number(x)?, number(y)?, f64::NAN]),
        // A null height is not allowed, but occurs in files.
        [x, y, Value::Null, ..] => Ok([number(x)?, number(y)?, f64::NAN]),
        [x, y, z, ..] => Ok([number(x)?, number(y)?, number(z)?]),
        _ => Err(Error::format(format!("a position of {} numbers", position.len()))),
    }
}

fn line(positions: &[Value]) -> Result<Vec<[f64; 3]>> {
    positions.iter().map(|position| vertex(list(position)?)).collect()
}

fn lines(parts: &[Value]) -> Result<Vec<Vec<[f64; 3]>>> {
    parts.iter().map(|part| line(list(part)?)).collect()
}

/// Returns the rings of one polygon, the outer one first.
fn rings(parts: &[Value]) -> Result<Vec<Vec<[f64; 3]>>> {
    let mut rings = lines(parts)?;
    for (i, ring) in rings.iter_mut().enumerate() {
        if let (Some(&first), Some(&last)) = (ring.first(), ring.last())
            && first[..2] != last[..2]
        {
            ring.push(first);
        }
        let clockwise = twice_area(ring) < 0.0;
        if clockwise != (i == 0) {
            ring.reverse();
        }
    }
    Ok(rings)
}

/// Returns twice the signed area of a ring, positive if it runs counter-clockwise.
fn twice_area(ring: &[[f64; 3]]) -> f64 {
    let Some(o) = ring.first() else { return 0.0 };
    // Relative to the first vertex, so that small rings keep their precision at large coordinates.
    ring.windows(2).map(|w| (w[0][0] - o[0]) * (w[1][1] - o[1]) - (w[1][0] - o[0]) * (w[0][1] - o[1])).sum()
}

/// Writes contours as a FeatureCollection of LineStrings with the properties `ID` (from 1) and
/// `ELEV`, one feature per line; every vertex has the height of its line's level.
///
/// Numbers read back as the same numbers. A system other than EPSG:4326 is named by a `crs` member,
/// which RFC 7946 dropped but programs use.
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
    put_contours(target.into(), |out| write(out, lines, crs))
}

/// Writes contours as GeoJSON lines (GDAL's GeoJSONSeq): a feature on each line, as
/// [`write_contours`] has them, so that programs can read them one by one. In a file with the
/// extension `geojsons` each begins with the record separator of RFC 8142.
///
/// The format names no system: readers take coordinates as longitude and latitude. If they are not,
/// the summary warns.
///
/// # Errors
/// As [`write_contours`].
pub fn write_contour_lines<'a>(
    target: impl Into<Destination<'a>>,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> Result<ContourSummary> {
    let target = target.into();
    let is_sequence = target.format_path().extension().is_some_and(|known| known.eq_ignore_ascii_case("geojsons"));
    put_contours(target, |out| {
        let mut summary = ContourSummary::default();
        if crs.is_none_or(|crs| !is_default(crs)) {
            let name = crs.map_or_else(|| "unknown".to_owned(), ToString::to_string);
            summary.warnings.push(format!(
                "GeoJSON lines state no system, and readers take degrees: tell them that it is {name} (ogr2ogr -s_srs)"
            ));
        }
        for line in lines.filter(|line| line.points.len() > 1) {
            summary.add(&line);
            if is_sequence {
                out.write_all(&[RECORD])?;
            }
            write_feature(out, &line, summary.lines)?;
            out.write_all(b"\n")?;
        }
        Ok(summary)
    })
}

fn put_contours(
    target: Destination,
    write: impl FnOnce(&mut Output) -> std::io::Result<ContourSummary>,
) -> Result<ContourSummary> {
    let mut output = target.create()?;
    let summary = write(&mut output).map_err(|e| Error::from(e).in_file(target.path()))?;
    target.put(output)?;
    Ok(summary)
}

fn is_default(crs: &Crs) -> bool {
    crs.kind == CrsKind::Geographic && crs.epsg == Some(WGS_84)
}

fn write(
    out: &mut impl Write,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> std::io::Result<ContourSummary> {
    let mut summary = ContourSummary::default();
    out.write_all(b"{\"type\":\"FeatureCollection\",")?;
    match crs.filter(|crs| !is_default(crs)).map(|crs| (crs, crs.epsg)) {
        Some((_, Some(code))) => {
            let name = format!("urn:ogc:def:crs:EPSG::{code}");
            write!(out, "\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"{name}\"}}}},")?;
        }
        Some((crs, None)) => summary.warnings.push(format!("GeoJSON cannot name a system without a code: {crs}")),
        None => {}
    }
    out.write_all(b"\"features\":[")?;
    for line in lines.filter(|line| line.points.len() > 1) {
        out.write_all(if summary.lines == 0 { b"\n" } else { b",\n" })?;
        summary.add(&line);
        write_feature(out, &line, summary.lines)?;
    }
    out.write_all(b"\n]}\n")?;
    Ok(summary)
}

/// Writes a contour as a feature, without a line break.
fn write_feature(out: &mut impl Write, line: &ContourLine, number: usize) -> std::io::Result<()> {
    let level = unsigned_zero(line.level);
    // `800.0` and not `800`, so that readers infer a field of real numbers.
    write!(out, "{{\"type\":\"Feature\",\"properties\":{{\"ID\":{number},\"ELEV\":{level:?}}},")?;
    out.write_all(b"\"geometry\":{\"type\":\"LineString\",\"coordinates\":[")?;
    for (i, [x, y]) in line.points.iter().enumerate() {
        let comma = if i == 0 { "" } else { "," };
        write!(out, "{comma}[{x},{y},{level}]")?;
    }
    out.write_all(b"]}}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Layer> {
        parse(text.as_bytes(), "a", &Options::default(), &unwatched)
    }

    fn read_heights(text: &str, field: &str) -> Result<Layer> {
        parse(text.as_bytes(), "a", &Options { height_field: Some(field), ..Options::default() }, &unwatched)
    }

    #[test]
    fn the_layer_has_the_name_of_the_file_or_that_within() {
        let text = r#"{"type":"FeatureCollection","name":"roads","features":[]}"#;
        let read =
            |layer| parse(text.as_bytes(), "a", &Options { layer: Some(layer), ..Options::default() }, &unwatched);
        assert!(read("a").is_ok() && read("Roads").is_ok());
        let error = read("rivers").unwrap_err();
        assert_eq!(error.to_string(), "there is no layer \"rivers\"");
        let cure = error.cure_text().unwrap();
        assert_eq!(*cure, "its only layer is \"roads\" or \"a\": name that, or write FILE::FIELD");
    }

    fn read_columns(text: &str, columns: &[&str]) -> Result<Layer> {
        parse(text.as_bytes(), "a", &Options { columns, ..Options::default() }, &unwatched)
    }

    fn features(list: &[&str]) -> String {
        let list: Vec<String> = list
            .iter()
            .enumerate()
            .map(|(i, geometry)| {
                format!(r#"{{"type":"Feature","properties":{{"Z":{i}.5,"name":"n"}},"geometry":{geometry}}}"#)
            })
            .collect();
        format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, list.join(","))
    }

    const LINE: &str = r#"{"type":"LineString","coordinates":[[0,0,1],[2,2,2]]}"#;

    #[test]
    fn every_geometry() {
        let text = features(&[
            r#"{"type":"Point","coordinates":[1,2,3]}"#,
            r#"{"type":"MultiPoint","coordinates":[[1,2,3],[4,5,6,7]]}"#,
            LINE,
            r#"{"type":"MultiLineString","coordinates":[[[0,0,1],[2,2,2]],[]]}"#,
            "null",
            r#"{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[]},{"type":"Point","coordinates":[1,2,3]}]}"#,
        ]);
        let layer = read(&text).unwrap();
        let line = vec![[0., 0., 1.], [2., 2., 2.]];
        let point = Shape::Points(vec![[1., 2., 3.]]);
        assert_eq!(
            layer.shapes,
            [
                point.clone(),
                Shape::Points(vec![[1., 2., 3.], [4., 5., 6.]]),
                Shape::Lines(vec![line.clone()]),
                Shape::Lines(vec![line, vec![]]),
                Shape::Null,
                Shape::Null,
                point,
            ]
        );
        assert_eq!(layer.fields, ["Z", "name"]);
        let flat = read(r#"{"type":"Point","coordinates":[1,2]}"#).unwrap();
        assert!(flat.shapes[0].vertices().next().unwrap()[2].is_nan());
    }

    #[test]
    fn rings_get_the_order_of_shapefiles() {
        let [ccw, cw] = ["[[0,0,0],[9,0,0],[9,9,0],[0,0,0]]", "[[1,1,0],[9,9,0],[9,1,0]]"];
        for [outer, inner] in [[ccw, cw], [cw, ccw], [ccw, ccw], [cw, cw]] {
            let text = format!(r#"{{"type":"MultiPolygon","coordinates":[[{outer},{inner}],[{outer}]]}}"#);
            let Shape::Polygon(rings) = read(&text).unwrap().shapes.remove(0) else { panic!() };
            let signs: Vec<bool> = rings.iter().map(|ring| twice_area(ring) < 0.0).collect();
            assert_eq!(signs, [true, false, true]);
            assert!(rings.iter().all(|ring| ring.len() == 4 && ring[0] == ring[3]));
        }
    }

    #[test]
    fn heights_from_a_property() {
        let text = features(&[LINE, "null", LINE]).replace("2.5", "\"12,5\"");
        let layer = read_heights(&text, "z").unwrap();
        let heights: Vec<f64> = layer.shapes.iter().flat_map(Shape::vertices).map(|v| v[2]).collect();
        assert_eq!(heights, [0.5, 0.5, 12.5, 12.5]);
        let error = read_heights(&text, "ELEV").unwrap_err();
        assert_eq!(
            (error.to_string().as_str(), error.cure_text().map(|cure| cure.plain())),
            ("there is no field ELEV", Some("name one of Z, name".to_owned()))
        );
        let error = read_heights(&text, "name").unwrap_err();
        assert_eq!(error.to_string(), "property name holds no numbers; the first value is n");
        let text = features(&[LINE, LINE]).replace("1.5", "\"high\"");
        let layer = read_heights(&text, "Z").unwrap();
        assert!(layer.warnings[0].plain().contains("no number in 1 features (the first: high)"));
        let text = features(&[LINE, LINE]).replace("1.5", "null");
        let layer = read_heights(&text, "Z").unwrap();
        assert!(layer.shapes[1].vertices().all(|v| v[2].is_nan()));
    }

    #[test]
    fn columns_have_a_number_for_each_shape() {
        let both = format!(r#"{{"type":"GeometryCollection","geometries":[{LINE},{LINE}]}}"#);
        let text = features(&[&both, "null", LINE, LINE]).replace("2.5", "null").replace(r#""Z":3.5"#, r#""z":"3,5""#);
        let layer = read_columns(&text, &["z"]).unwrap();
        assert_eq!((layer.shapes.len(), layer.columns.len()), (5, 1));
        let values = &layer.column("Z").unwrap().values;
        assert_eq!((&values[..3], values[3].is_nan(), values[4]), (&[0.5, 0.5, 1.5][..], true, 3.5));
        let error = read_columns(&text, &["Z", "WIDTH"]).unwrap_err();
        assert_eq!(error.to_string(), "there is no field WIDTH");
        assert_eq!(*error.cure_text().unwrap(), "name one of Z, name, z");
        let error = read_columns(&text.replace("1.5", "true"), &["Z"]).unwrap_err();
        assert_eq!(error.to_string(), "feature 2: field Z: expected a number, found 'true'");
        assert!(read_columns(LINE, &["Z"]).unwrap_err().to_string().contains("no field Z"));
        assert_eq!(read_columns(&features(&[]), &["Z"]).unwrap().columns[0].values, [0.0; 0]);
    }

    #[test]
    fn errors_name_the_position() {
        for (text, message) in [
            ("", "not JSON: EOF while parsing a value at line 1 column 0"),
            ("[]", "not GeoJSON: no object with a type"),
            ("{}", "not GeoJSON: an object without a type"),
            (r#"{"type":"Topology"}"#, "type Topology is not a GeoJSON type"),
            (r#"{"type":"FeatureCollection"}"#, "no array features"),
            (&features(&[LINE, r#"{"type":"Point","coordinates":[1]}"#]), "feature 2: a position of 1 numbers"),
            (&features(&[r#"{"type":"Point","coordinates":[1,"a"]}"#]), "feature 1: coordinate \"a\""),
            (&features(&[r#"{"type":"LineString","coordinates":[1,2]}"#]), "feature 1: 1 instead of an array"),
            (&features(&["7"]), "feature 1: its geometry is not an object"),
        ] {
            assert_eq!(read(text).unwrap_err().to_string(), message);
        }
        assert!(read(&"[".repeat(100_000)).is_err());
        let good = features(&[LINE]);
        assert!((0..good.len()).all(|cut| read(&good[..cut]).is_err()));
    }

    #[test]
    fn systems_that_are_not_stated() {
        let far = read(r#"{"type":"Point","coordinates":[500000,2]}"#).unwrap();
        assert!(far.crs.is_none() && far.warnings[0].plain().contains("not longitude and latitude"));
        let unknown = read(r#"{"type":"Point","coordinates":[1,2],"crs":null}"#).unwrap();
        assert!(unknown.crs.is_none() && unknown.warnings.is_empty());
        let linked = read(r#"{"type":"Point","coordinates":[1,2],"crs":{"type":"link"}}"#).unwrap();
        assert!(linked.warnings[0].plain().contains("not given by name"));
        assert_eq!(linked.unread_crs.as_deref(), Some(r#"{"type":"link"}"#));
    }

    #[test]
    fn systems_that_are_stated() {
        let system = |name: &str| {
            let crs = format!(r#"{{"type":"name","properties":{{"name":"{name}"}}}}"#);
            read(&format!(r#"{{"type":"Point","coordinates":[500000,2],"crs":{crs}}}"#)).unwrap()
        };
        for (name, codes) in [
            ("urn:ogc:def:crs:EPSG::32633", (Some(32633), None)),
            ("EPSG:32633", (Some(32633), None)),
            ("urn:ogc:def:crs,crs:EPSG::32633,crs:EPSG::5783", (Some(32633), Some(5783))),
            ("urn:ogc:def:crs:OGC:1.3:CRS84", (Some(4326), None)),
        ] {
            let Layer { crs, unread_crs, warnings, .. } = system(name);
            let crs = crs.unwrap_or_else(|| panic!("{name}: {warnings:?}"));
            assert_eq!((crs.epsg, crs.vertical_epsg), codes, "{name}");
            assert!(unread_crs.is_none() && warnings.is_empty());
        }
        let unknown = system("urn:ogc:def:crs:IGNF::LAMB93");
        assert_eq!((unknown.crs, unknown.unread_crs.as_deref()), (None, Some("urn:ogc:def:crs:IGNF::LAMB93")));
        assert!(unknown.warnings[0].plain().contains("the codes of IGNF are not known"), "{:?}", unknown.warnings);
    }

    #[test]
    fn texts_with_different_decimal_marks_are_refused() {
        let feature = |z: &str| {
            format!(
                r#"{{"type":"Feature","geometry":{{"type":"Point","coordinates":[1,2]}},"properties":{{"z":"{z}"}}}}"#
            )
        };
        let collection = |z: &[&str]| {
            let list: Vec<String> = z.iter().map(|z| feature(z)).collect();
            format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, list.join(","))
        };
        for read in [read_heights as fn(&str, &str) -> Result<Layer>, |text, name| read_columns(text, &[name])] {
            assert!(read(&collection(&["1,5", "500,000", "", "7"]), "z").is_ok());
            let error = read(&collection(&["500,000", "3.5"]), "z").unwrap_err().to_string();
            assert!(error.starts_with("feature 2: ") || error.contains("property z"), "{error}");
            assert!(error.contains("3.5 has a point and 500,000"), "{error}");
        }
    }

    #[test]
    fn contours_come_back() {
        let lines = vec![
            ContourLine { level: 0.1 + 0.2, points: vec![[1e-9, -0.1], [500_000.123_456_789, 5e6]] },
            ContourLine { level: -0.0, points: vec![[0., 0.]] },
            ContourLine { level: -0.0, points: vec![[0., 0.], [1., 0.], [1., 1.], [0., 0.]] },
        ];
        let mut bytes = Vec::new();
        let summary = write(&mut bytes, &mut lines.clone().into_iter(), None).unwrap();
        assert_eq!((summary.lines, summary.vertices, summary.closed), (2, 6, 1));
        let layer = read_heights(std::str::from_utf8(&bytes).unwrap(), "ELEV").unwrap();
        assert_eq!(layer.fields, ["ELEV", "ID"]);
        for (shape, line) in layer.shapes.iter().zip([&lines[0], &lines[2]]) {
            let vertices: Vec<[f64; 3]> = line.points.iter().map(|p| [p[0], p[1], line.level]).collect();
            assert_eq!(*shape, Shape::Lines(vec![vertices]));
        }
        assert_eq!(read(std::str::from_utf8(&bytes).unwrap()).unwrap().shapes, layer.shapes);
        let mut bytes = Vec::new();
        write(&mut bytes, &mut std::iter::empty(), None).unwrap();
        assert!(read(std::str::from_utf8(&bytes).unwrap()).unwrap().shapes.is_empty());
    }

    #[test]
    fn lines_are_read_one_by_one() {
        let read = |text: &str| parse_lines(text.as_bytes(), &Options::default(), &unwatched);
        let feature = format!(r#"{{"type":"Feature","properties":{{"Z":1}},"geometry":{LINE}}}"#);
        let spread = feature.replace(',', ",\n");
        for text in [
            format!("\u{feff}{feature}\r\n\n{feature}\n{LINE}"),
            format!("\u{feff}\n\x1e{spread}\n\x1e{feature}\x1e\x1e{LINE}"),
        ] {
            let layer = read(&text).unwrap();
            assert_eq!((layer.format.as_str(), layer.shapes.len()), ("GeoJSON lines", 3));
            assert!(layer.crs.is_some() && layer.shapes.iter().all(|shape| *shape == layer.shapes[0]));
        }
        // A geometry alone has no properties, also not those of the feature behind it.
        let options = Options { columns: &["Z"], height_field: Some("z"), ..Options::default() };
        let layer = parse_lines(format!("{LINE}\n{feature}").as_bytes(), &options, &unwatched).unwrap();
        assert!(layer.columns[0].values[0].is_nan() && layer.columns[0].values[1] == 1.0);
        assert!(layer.shapes[0].vertices().all(|v| v[2].is_nan()));
        let with_z = Options { height_field: Some("z"), ..Options::default() };
        let layer = parse_lines(feature.as_bytes(), &with_z, &unwatched).unwrap();
        assert!(layer.shapes[0].vertices().all(|v| v[2] == 1.0));
        for (second, message) in [
            ("{", "line 2: not JSON: EOF while parsing an object at line 1 column 1"),
            ("7", "line 2: not an object"),
            ("{}", "line 2: not GeoJSON: an object without a type"),
            (r#"{"type":"Point","coordinates":[1]}"#, "line 2: a position of 1 numbers"),
            (&features(&[LINE]).replace('\n', ""), "line 2: a FeatureCollection, where each line is one feature"),
        ] {
            assert_eq!(read(&format!("{LINE}\n{second}")).unwrap_err().to_string(), message);
        }
        let error = read(&format!("\x1e{LINE}\n\x1e7")).unwrap_err();
        assert_eq!(error.to_string(), "record 2: not an object");
        assert!(read("").unwrap().shapes.is_empty());
    }

    #[test]
    fn contours_come_back_from_lines() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.geojsonl");
        let line = |level| ContourLine { level, points: vec![[0.5, 1.0], [2.0, 3.0]] };
        let short = ContourLine { level: 1.0, points: vec![[0.0, 0.0]] };
        let mut lines = vec![line(1.0), short, line(2.5)].into_iter();
        let summary = write_contour_lines(&target, &mut lines, None).unwrap();
        assert_eq!((summary.lines, summary.vertices, summary.warnings.len()), (2, 4, 1));
        let text = std::fs::read_to_string(&target).unwrap();
        assert_eq!(text.lines().count(), 2);
        assert!(text.lines().all(|line| line.starts_with(r#"{"type":"Feature""#) && line.ends_with("]}}")));
        let with_level = Options { height_field: Some("ELEV"), ..Options::default() };
        let layer = read_lines_with(&target, &with_level, &unwatched).unwrap();
        let expected = [1.0, 2.5].map(|z| Shape::Lines(vec![vec![[0.5, 1.0, z], [2.0, 3.0, z]]]));
        assert_eq!(layer.shapes, expected);
        let sequence = target.with_extension("geojsons");
        write_contour_lines(&sequence, &mut vec![line(1.0), line(2.5)].into_iter(), None).unwrap();
        assert!(std::fs::read_to_string(&sequence).unwrap().lines().all(|line| line.starts_with("\x1e{")));
        assert_eq!(read_lines_with(&sequence, &with_level, &unwatched).unwrap().shapes, layer.shapes);
        let degrees = Crs::from_epsg(WGS_84).unwrap();
        assert!(write_contour_lines(&target, &mut std::iter::empty(), Some(&degrees)).unwrap().warnings.is_empty());
    }
}
