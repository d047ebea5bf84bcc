//! `.node`: vertices.
//!
//! | line | contains |
//! |---|---|
//! | first | number of vertices, dimension (2 or 3), number of attributes, number of boundary markers (0 or 1) |
//! | each of the others | vertex number, x, y, in space z, attributes, boundary marker |
//!
//! Values missing at the end of the first line default to 2, 0 and 0.

use std::io::{self, Write};
use std::path::Path;

use super::graph::{LineGraph, Nodes};
use super::lists::{Surplus, counted, listed, marker, read_rows, room, site};
use crate::error::{Result, Wording};
use crate::io::Watch;
use crate::io::bytes::decimal::Decimal;
use crate::io::bytes::rows::Rows;

const COUNTS: &str = "VERTICES DIMENSION ATTRIBUTES MARKERS";
const VERTEX: &str =
    "NUMBER X Y ATTRIBUTES MARKER, the last two as many as the first line announces";
const VERTEX_OF_SPACE: &str =
    "NUMBER X Y Z ATTRIBUTES MARKER, the last two as many as the first line announces";

/// The vertices of a file, or of part of one.
pub(crate) struct Listed<const D: usize = 2> {
    pub(crate) nodes: Nodes<D>,
    pub(super) lines: Vec<usize>,
    pub(super) surplus: Surplus,
}

/// Returns the dimension that the first line states.
pub(crate) fn dimension(rows: &mut Rows) -> Result<u32> {
    counted(rows, "vertices", COUNTS)?
        .0
        .within_or("dimension", 2)
}

pub(super) fn read_file(path: &Path, watch: Watch) -> Result<LineGraph> {
    let (Listed { nodes, lines, .. }, warnings) = read_alone(path, watch)?;
    Ok(LineGraph {
        nodes,
        node_file: path.to_path_buf(),
        node_lines: lines,
        warnings,
        ..Default::default()
    })
}

/// Reads a file that contains vertices and nothing else; returns them with warnings.
pub(crate) fn read_alone<const D: usize>(
    path: &Path,
    watch: Watch,
) -> Result<(Listed<D>, Vec<Wording>)> {
    let mut warnings = Vec::new();
    let listed = read_rows(path, watch, &mut warnings, |mut rows| {
        let vertices: Listed<D> = read(&mut rows)?;
        rows.end("the last vertex")?;
        Ok(vertices)
    })?;
    warnings.extend(listed.surplus.warning());
    Ok((listed, warnings))
}

/// Reads the `.node` file that contains the vertices of another file.
pub(super) fn read_beside(path: &Path, watch: Watch) -> Result<LineGraph> {
    read_file(&path.with_extension("node"), watch).map_err(|e| match e.cure_text() {
        Some(_) => e,
        None => e.cure(format!("{} needs its vertices next to it", path.display())),
    })
}

/// Reads a list of vertices, with the line that counts them.
pub(super) fn read<const D: usize>(rows: &mut Rows) -> Result<Listed<D>> {
    let (mut header, count) = counted(rows, "vertices", COUNTS)?;
    let dimension = header.within_or("dimension", 2)?;
    if dimension != D {
        return Err(header.wrong(format!("the dimension is {dimension}, expected {D}")));
    }
    let attribute_count: usize = header.within_or("number of attributes", 0)?;
    let marker_count: usize = header.within_or("number of boundary markers", 0)?;
    if marker_count > 1 {
        return Err(header.wrong(format!(
            "the number of boundary markers is {marker_count}, expected 0 or 1"
        )));
    }
    let room = room(count, rows);
    let mut nodes = Nodes {
        attribute_count,
        ..Nodes::<D>::default()
    };
    nodes.points.reserve_exact(room);
    nodes.markers.reserve_exact(room);
    let mut surplus = Surplus::default();
    let pattern = if D == 2 { VERTEX } else { VERTEX_OF_SPACE };
    let lines = listed(rows, count, "vertex", pattern, |row, number| {
        if nodes.points.is_empty() {
            nodes.first_number = u32::try_from(number)
                .ok()
                .filter(|&first| first <= 1)
                .ok_or_else(|| {
                    row.wrong(format!(
                        "the first vertex has the number {number}, expected 0 or 1"
                    ))
                })?;
        }
        let expected = nodes.points.len() as i64 + i64::from(nodes.first_number);
        if number != expected {
            return Err(row.wrong(format!(
                "vertex number {number} is out of sequence, expected {expected}"
            )));
        }
        nodes.points.push(site(row)?);
        for _ in 0..attribute_count {
            nodes.attributes.push(row.finite("attribute")?);
        }
        nodes.markers.push(marker(row, marker_count)?);
        surplus.look(row);
        Ok(row.line)
    })?;
    Ok(Listed {
        nodes,
        lines,
        surplus,
    })
}

pub(crate) fn write<const D: usize>(out: &mut impl Write, nodes: &Nodes<D>) -> io::Result<()> {
    writeln!(
        out,
        "{}  {D}  {}  1",
        nodes.points.len(),
        nodes.attribute_count
    )?;
    for (i, (point, marker)) in nodes.points.iter().zip(&nodes.markers).enumerate() {
        write!(out, "{:4}  ", i + nodes.first_number as usize)?;
        point
            .iter()
            .try_for_each(|&coordinate| write!(out, "  {}", Decimal(coordinate)))?;
        nodes
            .attributes_of(i)
            .iter()
            .try_for_each(|&value| write!(out, "  {}", Decimal(value)))?;
        writeln!(out, "    {marker}")?;
    }
    Ok(())
}
