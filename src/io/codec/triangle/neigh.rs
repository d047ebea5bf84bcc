//! `.neigh`: the neighbors of the triangles of an `.ele` file.
//!
//! | line | contains |
//! |---|---|
//! | first | number of triangles, neighbors of each (3) |
//! | each of the others | triangle number, the triangles opposite its corners, -1 for none |

use std::io::{self, Write};
use std::path::Path;

use super::graph::Triangulated;
use super::lists::{Numbering, counted, listed, read_rows};
use crate::error::{Result, Wording};
use crate::io::Watch;
use crate::io::bytes::rows::Rows;

const COUNTS: &str = "TRIANGLES 3";
const NEIGHBORS: &str = "NUMBER NEIGHBOR NEIGHBOR NEIGHBOR, -1 for none";

pub(super) fn read_file(
    path: &Path,
    first: u32,
    triangle_count: usize,
    watch: Watch,
    warnings: &mut Vec<Wording>,
) -> Result<Vec<[Option<u32>; 3]>> {
    read_rows(path, watch, warnings, |rows| {
        read(rows, first, triangle_count)
    })
}

fn read(mut rows: Rows, first: u32, triangle_count: usize) -> Result<Vec<[Option<u32>; 3]>> {
    let (header, count) = counted(&mut rows, "triangles", COUNTS)?;
    if count != triangle_count {
        return Err(header.wrong(format!(
            "there are {count} triangles, but the .ele file has {triangle_count}"
        )));
    }
    let numbering = Numbering { first, count };
    let neighbors = listed(&mut rows, count, "triangle", NEIGHBORS, |row, _| {
        let mut around = [None; 3];
        for beside in &mut around {
            *beside = numbering.neighbor(row, "triangle")?;
        }
        Ok(around)
    })?;
    rows.end("the last triangle")?;
    Ok(neighbors)
}

pub(super) fn write(out: &mut impl Write, triangulated: &Triangulated) -> io::Result<()> {
    let first = triangulated.nodes.first_number;
    writeln!(out, "{}  3", triangulated.neighbors.len())?;
    for (number, around) in (first as usize..).zip(&triangulated.neighbors) {
        let [a, b, c] =
            around.map(|beside| beside.map_or(-1, |beside| i64::from(beside) + i64::from(first)));
        writeln!(out, "{number:4}    {a}  {b}  {c}")?;
    }
    Ok(())
}
