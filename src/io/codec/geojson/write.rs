//! Writing: contours as a document or as lines.

use std::io::Write;

use super::{RECORD, WGS_84};
use crate::crs::{Crs, CrsKind};
use crate::data::ContourLine;
use crate::error::{Error, Result};
use crate::io::bytes::output::{Destination, Output};
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
    let is_sequence = target
        .format_path()
        .extension()
        .is_some_and(|known| known.eq_ignore_ascii_case("geojsons"));
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

pub(super) fn write(
    out: &mut impl Write,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> std::io::Result<ContourSummary> {
    let mut summary = ContourSummary::default();
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
        Some((crs, None)) => summary.warnings.push(format!(
            "GeoJSON cannot name a system without a code: {crs}"
        )),
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
