//! `.ele`: triangles.
//!
//! | line | contains |
//! |---|---|
//! | first | number of triangles, vertices of each (3, or 6 with the midpoints of the edges), number of attributes |
//! | each of the others | triangle number, vertices, attributes |
//!
//! Midpoints of edges and attributes are read, but not used.

use std::io::{self, Write};
use std::path::Path;

use super::graph::{LineGraph, Triangulated};
use super::lists::{Numbering, counted, listed, read_rows};
use super::{edge, neigh, node, poly};
use crate::data::{EdgeKind, Triangles};
use crate::error::Result;
use crate::io::Watch;
use crate::io::bytes::decimal::Decimal;
use crate::io::bytes::rows::Rows;

const COUNTS: &str = "TRIANGLES 3 ATTRIBUTES";
const TRIANGLE: &str = "NUMBER VERTEX VERTEX VERTEX ATTRIBUTES";

pub(super) fn read_file(path: &Path, watch: Watch) -> Result<Triangles> {
    let LineGraph {
        nodes,
        mut warnings,
        ..
    } = node::read_beside(path, watch)?;
    let numbering = Numbering {
        first: nodes.first_number,
        count: nodes.points.len(),
    };
    let faces = read_rows(path, watch, &mut warnings, |rows| read(rows, numbering))?;
    let beside =
        |extension: &str| Some(path.with_extension(extension)).filter(|path| path.exists());
    let segments = match beside("poly") {
        Some(path) => poly::read_segments_alone(&path, numbering, watch, &mut warnings)?,
        None => None,
    };
    let edges = match (segments, beside("edge")) {
        // Segments between collinear points have no adjacent triangles.
        _ if faces.is_empty() => Vec::new(),
        (Some(segments), _) => segments.into_iter().map(|segment| segment.ends).collect(),
        (None, Some(path)) => edge::read_marked(&path, numbering, watch, &mut warnings)?,
        (None, None) => Vec::new(),
    };
    let lines = edges
        .into_iter()
        .map(|edge| (edge, EdgeKind::Breakline))
        .collect();
    let neighbors = match beside("neigh") {
        Some(path) => Some(neigh::read_file(
            &path,
            numbering.first,
            faces.len(),
            watch,
            &mut warnings,
        )?),
        None => None,
    };
    let vertices = nodes.points.into_iter().map(|[x, y]| [x, y, 0.0]).collect();
    Ok(Triangles {
        vertices,
        faces,
        lines,
        neighbors,
        warnings,
        ..Triangles::default()
    })
}

fn read(mut rows: Rows, numbering: Numbering) -> Result<Vec<[u32; 3]>> {
    let (mut header, count) = counted(&mut rows, "triangles", COUNTS)?;
    let corner_count: usize = header.within_or("number of vertices of a triangle", 3)?;
    if corner_count != 3 && corner_count != 6 {
        return Err(header.wrong(format!(
            "a triangle has {corner_count} vertices, expected 3 or 6"
        )));
    }
    let attribute_count: usize = header.within_or("number of attributes", 0)?;
    let faces = listed(&mut rows, count, "triangle", TRIANGLE, |row, _| {
        let mut face = [0; 3];
        for corner in &mut face {
            *corner = numbering.vertex(row, "corner")?;
        }
        for _ in 3..corner_count {
            numbering.vertex(row, "middle of an edge")?;
        }
        for _ in 0..attribute_count {
            row.finite("attribute")?;
        }
        Ok(face)
    })?;
    rows.end("the last triangle")?;
    Ok(faces)
}

pub(super) fn write(out: &mut impl Write, triangulated: &Triangulated) -> io::Result<()> {
    let first = triangulated.nodes.first_number;
    let attribute_count = usize::from(!triangulated.attributes.is_empty());
    writeln!(
        out,
        "{}  3  {attribute_count}",
        triangulated.triangles.len()
    )?;
    for (i, corners) in triangulated.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| v + first);
        write!(out, "{:4}    {a}  {b}  {c}", i + first as usize)?;
        match triangulated.attributes.get(i) {
            Some(&value) => writeln!(out, "    {}", Decimal(value))?,
            None => writeln!(out)?,
        }
    }
    Ok(())
}
