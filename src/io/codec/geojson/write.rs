//! Writing: contours and lines, as a document or one feature on each line of the file.

use std::io::Write;

use super::{RECORD, WGS_84};
use crate::crs::{Crs, CrsKind};
use crate::data::{ContourLine, Layer, Shape, Value, polygons};
use crate::error::Result;
use crate::io::bytes::output::Destination;
use crate::io::codec::contour_summary::ContourSummary;
use crate::triangulation::num::unsigned_zero;

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
    Destination::write_with(target.into(), |out| write(out, lines, crs))
}

/// Writes the points, lines and polygons of a layer as a FeatureCollection, with all its attributes
/// as properties, and returns warnings. Heights that are missing are left out. Other records become
/// features without geometry.
///
/// # Errors
/// As [`write_contours`].
pub fn write_lines<'a>(target: impl Into<Destination<'a>>, layer: &Layer) -> Result<Vec<String>> {
    Destination::write_with(target.into(), |out| {
        let mut warnings = Vec::new();
        begin(out, layer.crs.as_ref(), &mut warnings)?;
        for record in 0..layer.shapes.len() {
            out.write_all(if record == 0 { b"\n" } else { b",\n" })?;
            write_record(out, layer, record)?;
        }
        out.write_all(b"\n]}\n")?;
        Ok(warnings)
    })
}

/// Writes the lines of a layer as GeoJSON lines: a feature on each line of the file, as
/// [`write_lines`] has them. See [`write_contour_lines`] for what the format does not state.
///
/// # Errors
/// As [`write_contours`].
pub fn write_line_records<'a>(
    target: impl Into<Destination<'a>>,
    layer: &Layer,
) -> Result<Vec<String>> {
    let target: Destination<'a> = target.into();
    let is_sequence = is_sequence(&target);
    target.write_with(|out| {
        for record in 0..layer.shapes.len() {
            if is_sequence {
                out.write_all(&[RECORD])?;
            }
            write_record(out, layer, record)?;
            out.write_all(b"\n")?;
        }
        Ok(unstated(layer.crs.as_ref()).into_iter().collect())
    })
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
    let target: Destination<'a> = target.into();
    let is_sequence = is_sequence(&target);
    target.write_with(|out| {
        let mut summary = ContourSummary::default();
        summary.warnings.extend(unstated(crs));
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

/// Returns true if each record begins with the separator of RFC 8142.
fn is_sequence(target: &Destination) -> bool {
    let path = target.format_path();
    let extension = path.extension();
    extension.is_some_and(|known| known.eq_ignore_ascii_case("geojsons"))
}

/// Returns the warning for a system that GeoJSON lines cannot state.
fn unstated(crs: Option<&Crs>) -> Option<String> {
    crs.is_none_or(|crs| !is_default(crs)).then(|| {
        let name = crs.map_or_else(|| "unknown".to_owned(), ToString::to_string);
        format!(
            "GeoJSON lines state no system, and readers take degrees: tell them that it is {name} (ogr2ogr -s_srs)"
        )
    })
}

fn is_default(crs: &Crs) -> bool {
    crs.kind == CrsKind::Geographic && crs.epsg == Some(WGS_84)
}

pub(super) fn write(
    out: &mut impl Write,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> std::io::Result<ContourSummary> {
    let mut summary = ContourSummary::default();
    begin(out, crs, &mut summary.warnings)?;
    for line in lines.filter(|line| line.points.len() > 1) {
        out.write_all(if summary.lines == 0 { b"\n" } else { b",\n" })?;
        summary.add(&line);
        write_feature(out, &line, summary.lines)?;
    }
    out.write_all(b"\n]}\n")?;
    Ok(summary)
}

/// Writes a document up to its first feature.
fn begin(
    out: &mut impl Write,
    crs: Option<&Crs>,
    warnings: &mut Vec<String>,
) -> std::io::Result<()> {
    out.write_all(b"{\"type\":\"FeatureCollection\",")?;
    match crs
        .filter(|crs| !is_default(crs))
        .map(|crs| (crs, crs.epsg))
    {
        Some((_, Some(code))) => {
            let name = format!("urn:ogc:def:crs:EPSG::{code}");
            write!(
                out,
                "\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"{name}\"}}}},"
            )?;
        }
        Some((crs, None)) => warnings.push(format!(
            "GeoJSON cannot name a system without a code: {crs}"
        )),
        None => {}
    }
    out.write_all(b"\"features\":[")
}

/// Writes a record of a layer as a feature, without a line break.
fn write_record(out: &mut impl Write, layer: &Layer, record: usize) -> std::io::Result<()> {
    out.write_all(b"{\"type\":\"Feature\",\"properties\":{")?;
    if let Some(attributes) = &layer.attributes {
        let row = attributes.rows.get(record).map_or(&[][..], Vec::as_slice);
        for (i, (name, value)) in attributes.names.iter().zip(row).enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(out, "{comma}{}:", serde_json::to_string(name)?)?;
            match value {
                Value::Missing => out.write_all(b"null")?,
                Value::Whole(whole) => write!(out, "{whole}")?,
                Value::Number(number) if number.is_finite() => write!(out, "{number:?}")?,
                Value::Number(_) => out.write_all(b"null")?,
                Value::Truth(truth) => write!(out, "{truth}")?,
                Value::Text(text) => out.write_all(serde_json::to_string(text)?.as_bytes())?,
            }
        }
    }
    out.write_all(b"},\"geometry\":")?;
    match layer.shapes.get(record) {
        Some(Shape::Points(points)) => match &points[..] {
            [] => out.write_all(b"null")?,
            [point] => {
                out.write_all(b"{\"type\":\"Point\",\"coordinates\":")?;
                write_position(out, *point)?;
                out.write_all(b"}")?;
            }
            points => {
                out.write_all(b"{\"type\":\"MultiPoint\",\"coordinates\":")?;
                write_positions(out, points)?;
                out.write_all(b"}")?;
            }
        },
        Some(Shape::Lines(parts)) => match &parts[..] {
            [] => out.write_all(b"null")?,
            [part] => {
                out.write_all(b"{\"type\":\"LineString\",\"coordinates\":")?;
                write_positions(out, part)?;
                out.write_all(b"}")?;
            }
            parts => {
                out.write_all(b"{\"type\":\"MultiLineString\",\"coordinates\":[")?;
                for (i, part) in parts.iter().enumerate() {
                    out.write_all(if i == 0 { b"" } else { b"," })?;
                    write_positions(out, part)?;
                }
                out.write_all(b"]}")?;
            }
        },
        Some(Shape::Polygon(rings)) => write_polygons(out, rings)?,
        _ => out.write_all(b"null")?,
    }
    out.write_all(b"}")
}

/// Writes rings as a polygon, or several if there are several outer rings. GeoJSON has all rings
/// the other way around.
fn write_polygons(out: &mut impl Write, rings: &[Vec<[f64; 3]>]) -> std::io::Result<()> {
    let polygons = polygons(rings);
    match polygons[..] {
        [] => return out.write_all(b"null"),
        [_] => out.write_all(b"{\"type\":\"Polygon\",\"coordinates\":")?,
        _ => out.write_all(b"{\"type\":\"MultiPolygon\",\"coordinates\":[")?,
    }
    for (i, polygon) in polygons.iter().enumerate() {
        out.write_all(if i == 0 { b"[" } else { b",[" })?;
        for (k, ring) in polygon.iter().enumerate() {
            out.write_all(if k == 0 { b"" } else { b"," })?;
            let reversed: Vec<[f64; 3]> = ring.iter().rev().copied().collect();
            write_positions(out, &reversed)?;
        }
        out.write_all(b"]")?;
    }
    out.write_all(if polygons.len() > 1 { b"]}" } else { b"}" })
}

fn write_positions(out: &mut impl Write, part: &[[f64; 3]]) -> std::io::Result<()> {
    out.write_all(b"[")?;
    for (i, position) in part.iter().enumerate() {
        out.write_all(if i == 0 { b"" } else { b"," })?;
        write_position(out, *position)?;
    }
    out.write_all(b"]")
}

fn write_position(out: &mut impl Write, [x, y, z]: [f64; 3]) -> std::io::Result<()> {
    match z.is_finite() {
        true => write!(out, "[{x},{y},{}]", unsigned_zero(z)),
        false => write!(out, "[{x},{y}]"),
    }
}

/// Writes a contour as a feature, without a line break.
fn write_feature(out: &mut impl Write, line: &ContourLine, number: usize) -> std::io::Result<()> {
    let level = unsigned_zero(line.level);
    // `800.0` and not `800`, so that readers infer a field of real numbers.
    write!(
        out,
        "{{\"type\":\"Feature\",\"properties\":{{\"ID\":{number},\"ELEV\":{level:?}}},"
    )?;
    out.write_all(b"\"geometry\":{\"type\":\"LineString\",\"coordinates\":[")?;
    for (i, [x, y]) in line.points.iter().enumerate() {
        let comma = if i == 0 { "" } else { "," };
        write!(out, "{comma}[{x},{y},{level}]")?;
    }
    out.write_all(b"]}}")
}
