//! `.edge`: the edges of triangles.
//!
//! | line | holds |
//! |---|---|
//! | first | number of edges, number of boundary markers (0 or 1) |
//! | each of the others | edge number, two vertices, boundary marker |

use std::io::{self, Write};
use std::path::Path;

use super::{Numbering, Triangulated, bytes_of};
use crate::error::{Error, Result};
use crate::io::rows::Rows;

const COUNTS: &str = "EDGES MARKERS";
const EDGE: &str = "NUMBER VERTEX VERTEX MARKER";

/// The edges whose marker is not 0: pieces of segments, and the boundary.
pub(super) fn read_marked(path: &Path, numbering: Numbering) -> Result<Vec<[u32; 2]>> {
    let bytes = bytes_of(path)?;
    read(&bytes, numbering).map_err(|e: Error| e.in_file(path))
}

fn read(bytes: &[u8], numbering: Numbering) -> Result<Vec<[u32; 2]>> {
    let mut rows = Rows::new(bytes);
    let mut header = rows.expect(|| "the number of edges".to_owned(), COUNTS)?;
    let count: usize = header.within("number of edges")?;
    let marker_count: usize = header.within_or("number of boundary markers", 0)?;
    let mut marked = Vec::new();
    for i in 0..count {
        let mut row = rows.expect(|| format!("edge {} of {count}", i + 1), EDGE)?;
        row.whole("edge number")?;
        let ends = [numbering.vertex(&mut row, "first end")?, numbering.vertex(&mut row, "second end")?];
        let marker: i32 = if marker_count > 0 { row.within("boundary marker")? } else { 0 };
        if marker != 0 {
            marked.push(ends);
        }
    }
    rows.end("the last edge")?;
    Ok(marked)
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
