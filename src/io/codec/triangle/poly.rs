//! `.poly`: a planar straight-line graph.
//!
//! | list | first line | each of the others |
//! |---|---|---|
//! | vertices | as in a `.node` file; with 0 vertices they are in the `.node` of the same name | as there |
//! | segments | number of segments, number of boundary markers (0 or 1) | number, two vertices, boundary marker |
//! | holes | number of holes | number, x, y of a site in the hole |
//! | regions, optional | number of regions | number, x, y of a site in the region, attribute, largest area |
//!
//! If a region has only one value, it is both the attribute and the largest area, as in Triangle.

use std::io::{self, Write};
use std::path::Path;

use super::graph::{Hole, LineGraph, Region, Segment, Triangulated};
use super::lists::{Numbering, Surplus, counted, listed, marker, read_rows, site};
use super::node::{self, Listed};
use crate::error::{Error, Result, Wording, wording};
use crate::io::bytes::decimal::Decimal;
use crate::io::bytes::rows::{Row, Rows};
use crate::io::bytes::watch::{Watch, bytes_of};
use crate::io::options::cut::open_line;

const SEGMENTS: &str = "SEGMENTS MARKERS";
const SEGMENT: &str = "NUMBER VERTEX VERTEX MARKER, the last if the list's first line announces it";

pub(super) fn read_file(path: &Path, watch: Watch) -> Result<LineGraph> {
    let bytes = bytes_of(path, watch)?;
    let mut rows = Rows::new(&bytes, watch);
    let here = |e: Error| e.in_file(path);
    let Listed {
        nodes,
        lines,
        mut surplus,
    } = node::read(&mut rows).map_err(here)?;
    let mut graph = if nodes.points.is_empty() {
        let mut graph = node::read_beside(path, watch)?;
        let file = graph.node_file.display().to_string();
        graph
            .warnings
            .iter_mut()
            .for_each(|text| *text = wording![format!("{file}: "), text.clone()]);
        graph
    } else {
        LineGraph {
            nodes,
            node_file: path.to_path_buf(),
            node_lines: lines,
            ..Default::default()
        }
    };
    let numbering = Numbering {
        first: graph.nodes.first_number,
        count: graph.nodes.points.len(),
    };
    graph.segments = read_segments(&mut rows, numbering, &mut surplus).map_err(here)?;
    graph.holes = read_holes(&mut rows, &mut surplus).map_err(here)?;
    graph.regions = read_regions(&mut rows, &mut surplus).map_err(here)?;
    rows.end("the last list").map_err(here)?;
    graph.warnings.extend(surplus.warning());
    graph.warnings.extend(open_line(&bytes));
    Ok(graph)
}

/// Returns the segments of a file that has no vertices of its own; `None` if it has some.
pub(super) fn read_segments_alone(
    path: &Path,
    numbering: Numbering,
    watch: Watch,
    warnings: &mut Vec<Wording>,
) -> Result<Option<Vec<Segment>>> {
    read_rows(path, watch, warnings, |mut rows| {
        if !node::read::<2>(&mut rows)?.nodes.points.is_empty() {
            return Ok(None);
        }
        read_segments(&mut rows, numbering, &mut Surplus::default()).map(Some)
    })
}

fn read_segments(
    rows: &mut Rows,
    numbering: Numbering,
    surplus: &mut Surplus,
) -> Result<Vec<Segment>> {
    let (mut header, count) = counted(rows, "segments", SEGMENTS)?;
    let marker_count: usize = header.within_or("number of boundary markers", 0)?;
    if marker_count > 1 || header.has_more() {
        // A vertex that the list before does not count leads here.
        return Err(header.wrong(
            "this is not a line that counts segments: expected two numbers, the second 0 or 1"
                .into(),
        ));
    }
    listed(rows, count, "segment", SEGMENT, |row, number| {
        let ends = [
            numbering.vertex(row, "first end")?,
            numbering.vertex(row, "second end")?,
        ];
        let marker = marker(row, marker_count)?;
        surplus.look(row);
        Ok(Segment {
            ends,
            marker,
            number,
            line: row.line,
        })
    })
}

/// Returns the count in a line that contains nothing else.
fn count_alone(mut header: Row, items: &str) -> Result<usize> {
    let count = header.within(&format!("number of {items}"))?;
    if header.has_more() {
        return Err(header.wrong(format!(
            "this is not a line that counts {items}: expected one number"
        )));
    }
    Ok(count)
}

fn read_holes(rows: &mut Rows, surplus: &mut Surplus) -> Result<Vec<Hole>> {
    let header = rows.expect(
        || "the number of holes".to_owned(),
        "HOLES, 0 if there are none",
    )?;
    let count = count_alone(header, "holes")?;
    listed(rows, count, "hole", "NUMBER X Y", |row, _| {
        let at = site(row)?;
        surplus.look(row);
        Ok(Hole { at, line: row.line })
    })
}

fn read_regions(rows: &mut Rows, surplus: &mut Surplus) -> Result<Vec<Region>> {
    let Some(header) = rows.next("REGIONS") else {
        return Ok(Vec::new());
    };
    let count = count_alone(header, "regions")?;
    listed(
        rows,
        count,
        "region",
        "NUMBER X Y ATTRIBUTE AREA",
        |row, _| {
            let at = site(row)?;
            let attribute = row.finite("attribute")?;
            let area = if row.has_more() {
                row.finite("largest area")?
            } else {
                attribute
            };
            surplus.look(row);
            Ok(Region {
                at,
                attribute,
                max_area: Some(area).filter(|&area| area > 0.0),
                line: row.line,
            })
        },
    )
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
        // A negative area means no limit, as in Triangle.
        writeln!(
            out,
            "{number:4}    {x}  {y}  {attribute}  {}",
            Decimal(region.max_area.unwrap_or(-1.0))
        )?;
    }
    Ok(())
}
