//! `.poly`: a planar straight line graph.
//!
//! | list | first line | each of the others |
//! |---|---|---|
//! | vertices | as in a `.node` file; with 0 vertices they are in the `.node` of the same name | as there |
//! | segments | number of segments, number of boundary markers (0 or 1) | number, two vertices, boundary marker |
//! | holes | number of holes | number, x, y of a place in the hole |
//! | regions, may be missing | number of regions | number, x, y of a place in the region, attribute, largest area |
//!
//! A region with one value has it as attribute and as largest area, as Triangle reads it.

use std::io::{self, Write};
use std::path::Path;

use super::node::{self, Listed};
use super::{Hole, LineGraph, Numbering, Region, Segment, Surplus, Triangulated, bytes_of, room};
use crate::error::{Error, Result};
use crate::io::decimal::Decimal;
use crate::io::rows::Rows;

const SEGMENTS: &str = "SEGMENTS MARKERS";
const SEGMENT: &str = "NUMBER VERTEX VERTEX MARKER, the last if the list's first line announces it";

pub(super) fn read_file(path: &Path) -> Result<LineGraph> {
    let bytes = bytes_of(path)?;
    let mut rows = Rows::new(&bytes);
    let here = |e: Error| e.in_file(path);
    let Listed { nodes, lines, mut surplus } = node::read(&mut rows).map_err(here)?;
    let mut graph = if nodes.points.is_empty() {
        let mut graph = node::read_beside(path)?;
        let file = graph.node_file.display().to_string();
        graph.warnings.iter_mut().for_each(|text| text.insert_str(0, &format!("{file}: ")));
        graph
    } else {
        LineGraph { nodes, node_file: path.to_path_buf(), node_lines: lines, ..Default::default() }
    };
    let numbering = Numbering { first: graph.nodes.first_number, count: graph.nodes.points.len() };
    graph.segments = read_segments(&mut rows, numbering, &mut surplus).map_err(here)?;
    graph.holes = read_holes(&mut rows, &mut surplus).map_err(here)?;
    graph.regions = read_regions(&mut rows, &mut surplus).map_err(here)?;
    rows.end("the last list").map_err(here)?;
    graph.warnings.extend(surplus.warning());
    Ok(graph)
}

/// The segments of a file that has no vertices of its own; `None` if it has some.
pub(super) fn read_segments_alone(path: &Path, numbering: Numbering) -> Result<Option<Vec<Segment>>> {
    let bytes = bytes_of(path)?;
    let mut rows = Rows::new(&bytes);
    let mut read = || {
        if !node::read(&mut rows)?.nodes.points.is_empty() {
            return Ok(None);
        }
        read_segments(&mut rows, numbering, &mut Surplus::default()).map(Some)
    };
    read().map_err(|e: Error| e.in_file(path))
}

fn read_segments(rows: &mut Rows, numbering: Numbering, surplus: &mut Surplus) -> Result<Vec<Segment>> {
    let mut header = rows.expect(|| "the number of segments".to_owned(), SEGMENTS)?;
    let count: usize = header.within("number of segments")?;
    let marker_count: usize = header.within_or("number of boundary markers", 0)?;
    if marker_count > 1 || header.has_more() {
        // A vertex that the list above does not count looks like this.
        return Err(
            header.wrong("this is no line that counts segments: expected two numbers, the second 0 or 1".into())
        );
    }
    let mut segments = Vec::with_capacity(room(count, rows));
    for i in 0..count {
        let mut row = rows.expect(|| format!("segment {} of {count}", i + 1), SEGMENT)?;
        let number = row.whole("segment number")?;
        let ends = [numbering.vertex(&mut row, "first end")?, numbering.vertex(&mut row, "second end")?];
        let marker = if marker_count == 1 { row.within("boundary marker")? } else { 0 };
        surplus.look(&row);
        segments.push(Segment { ends, marker, number, line: row.line });
    }
    Ok(segments)
}

fn read_holes(rows: &mut Rows, surplus: &mut Surplus) -> Result<Vec<Hole>> {
    let mut header = rows.expect(|| "the number of holes".to_owned(), "HOLES, 0 if there are none")?;
    let count: usize = header.within("number of holes")?;
    if header.has_more() {
        return Err(header.wrong("this is no line that counts holes: expected one number".into()));
    }
    let mut holes = Vec::with_capacity(room(count, rows));
    for i in 0..count {
        let mut row = rows.expect(|| format!("hole {} of {count}", i + 1), "NUMBER X Y")?;
        row.whole("hole number")?;
        holes.push(Hole { at: [row.finite("x coordinate")?, row.finite("y coordinate")?], line: row.line });
        surplus.look(&row);
    }
    Ok(holes)
}

fn read_regions(rows: &mut Rows, surplus: &mut Surplus) -> Result<Vec<Region>> {
    let Some(mut header) = rows.next("REGIONS") else { return Ok(Vec::new()) };
    let count: usize = header.within("number of regions")?;
    if header.has_more() {
        return Err(header.wrong("this is no line that counts regions: expected one number".into()));
    }
    let mut regions = Vec::with_capacity(room(count, rows));
    for i in 0..count {
        let mut row = rows.expect(|| format!("region {} of {count}", i + 1), "NUMBER X Y ATTRIBUTE AREA")?;
        row.whole("region number")?;
        let at = [row.finite("x coordinate")?, row.finite("y coordinate")?];
        let attribute = row.finite("attribute")?;
        let area = if row.has_more() { row.finite("largest area")? } else { attribute };
        regions.push(Region { at, attribute, max_area: Some(area).filter(|&area| area > 0.0), line: row.line });
        surplus.look(&row);
    }
    Ok(regions)
}

pub(super) fn write(out: &mut impl Write, triangulated: &Triangulated) -> io::Result<()> {
    let nodes = &triangulated.nodes;
    let first = nodes.first_number;
    writeln!(out, "0  2  {}  1", nodes.attribute_count)?;
    writeln!(out, "{}  1", triangulated.segments.len())?;
    for (number, segment) in (first as usize..).zip(&triangulated.segments) {
        let [a, b] = segment.ends.map(|v| v + first);
        writeln!(out, "{number:4}    {a}  {b}    {}", segment.marker)?;
    }
    writeln!(out, "{}", triangulated.holes.len())?;
    for (number, hole) in (first as usize..).zip(&triangulated.holes) {
        let [x, y] = hole.at.map(Decimal);
        writeln!(out, "{number:4}    {x}  {y}")?;
    }
    if !triangulated.regions.is_empty() {
        writeln!(out, "{}", triangulated.regions.len())?;
    }
    for (number, region) in (first as usize..).zip(&triangulated.regions) {
        let ([x, y], attribute) = (region.at.map(Decimal), Decimal(region.attribute));
        // Without a limit the area is negative, as Triangle takes it.
        writeln!(out, "{number:4}    {x}  {y}  {attribute}  {}", Decimal(region.max_area.unwrap_or(-1.0)))?;
    }
    Ok(())
}
