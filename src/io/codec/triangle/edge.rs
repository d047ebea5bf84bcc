//! `.edge`: the edges of triangles.
//!
//! | line | contains |
//! |---|---|
//! | first | number of edges, number of boundary markers (0 or 1) |
//! | each of the others | edge number, two vertices, boundary marker |

use std::io::{self, Write};
use std::path::Path;

use super::graph::Triangulated;
use super::lists::{Numbering, counted, listed, marker, read_rows};
use crate::error::{Result, Wording};
use crate::io::Watch;
use crate::io::bytes::rows::Rows;

const COUNTS: &str = "EDGES MARKERS";
const EDGE: &str = "NUMBER VERTEX VERTEX MARKER";

/// Returns the edges whose marker is not 0: sub-constraints, and edges of the boundary.
pub(super) fn read_marked(
    path: &Path,
    numbering: Numbering,
    watch: Watch,
    warnings: &mut Vec<Wording>,
) -> Result<Vec<[u32; 2]>> {
    read_rows(path, watch, warnings, |rows| read(rows, numbering))
}

fn read(mut rows: Rows, numbering: Numbering) -> Result<Vec<[u32; 2]>> {
    let (mut header, count) = counted(&mut rows, "edges", COUNTS)?;
    let marker_count: usize = header.within_or("number of boundary markers", 0)?;
    let edges = listed(&mut rows, count, "edge", EDGE, |row, _| {
        let ends = [
            numbering.vertex(row, "first end")?,
            numbering.vertex(row, "second end")?,
        ];
        let is_marked = marker(row, marker_count)? != 0;
        Ok(is_marked.then_some(ends))
    })?;
    rows.end("the last edge")?;
    Ok(edges.into_iter().flatten().collect())
}

pub(super) fn write(out: &mut impl Write, triangulated: &Triangulated) -> io::Result<()> {
    let first = triangulated.nodes.first_number;
    writeln!(out, "{}  1", triangulated.edges.len())?;
    for (number, edge) in (first as usize..).zip(&triangulated.edges) {
        let [a, b] = edge.ends.map(|v| v + first);
        writeln!(out, "{number:4}    {a}  {b}    {}", edge.marker)?;
    }
    Ok(())
}
