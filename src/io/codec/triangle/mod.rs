//! The files of Triangle (Shewchuk 1996, "Triangle: Engineering a 2D Quality Mesh Generator and
//! Delaunay Triangulator"; the formats are those of version 1.6).
//!
//! | file | contains | read | written |
//! |---|---|---|---|
//! | `.node` | vertices with attributes and boundary markers | yes | yes |
//! | `.poly` | vertices or none; segments; holes; regions | yes | yes, without vertices |
//! | `.ele` | triangles, with attributes | yes, with the `.node` next to it | yes |
//! | `.edge` | edges with boundary markers | next to an `.ele` without a `.poly` | yes |
//! | `.neigh` | the neighbors of the triangles | next to an `.ele` | yes |
//!
//! All are text: one item per line, its number first, words separated by blanks (or commas); `#`
//! starts a comment. Each list begins with a line that counts its items.
//!
//! # Numbers
//! Vertices are numbered consecutively from 0 or from 1; the number of the first vertex decides.
//! All files that belong together start with the same number. The numbers of segments, holes,
//! regions, triangles and edges are read, but have no meaning; written, they start with the same
//! number as the vertices.
//!
//! # Names
//! Files with the same name up to the last extension belong together: `x.1.ele`, `x.1.node`,
//! `x.1.poly`. A `.poly` without vertices uses those of its `.node`. Vertex numbers in written
//! files refer to the `.node` that is written with them, in which the vertices of the input come
//! first and unchanged.
//!
//! # Boundary markers
//! Boundary markers are those of Triangle, and are always written. An edge has the marker of the
//! first segment that contains it and whose marker is not 0; else 1 if it has a triangle on one
//! side only; else 0. A vertex keeps its own marker if that is not 0; else it has the marker of the
//! first such segment through it; else 1 on the boundary; else 0.
//!
//! # Errors
//! Every number is checked against the rest of the file. A list that ends early or is too long, a
//! line with a missing value, a number that is not finite, and a vertex number that is out of
//! sequence or does not exist are errors, which state the file, the line, the value and what was
//! expected. More values in a line than were announced lead to a warning.

mod edge;
mod ele;
mod graph;
mod lists;
mod neigh;
pub(crate) mod node;
mod poly;

use std::io::Write;
use std::path::Path;

pub use self::graph::{Edge, Hole, LineGraph, Nodes, Region, Segment, Triangulated};
pub(crate) use self::lists::{Numbering, counted, extension, listed, read_rows};
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::bytes::watch::{Watch, unwatched};

/// Reads a `.node` file, or a `.poly` file with its `.node` if it has no vertices.
///
/// # Errors
/// If a file is damaged, see [above](self); the error names the file and the line.
pub fn read(path: &Path) -> Result<LineGraph> {
    read_with(path, &unwatched)
}

/// Like [`read`], but watched: the bytes that were parsed are counted.
///
/// # Errors
/// Those of [`read`], and that of the watch.
pub fn read_with(path: &Path, watch: Watch) -> Result<LineGraph> {
    match extension(path).as_str() {
        "node" => node::read_file(path, watch),
        "poly" => poly::read_file(path, watch),
        _ => Err(unknown(path, "use .node or .poly")),
    }
}

/// Reads an `.ele` file and the vertices in the `.node` next to it, with heights of 0.
///
/// Constraints are the segments of the `.poly` next to it if that has no vertices of its own; else
/// the edges of the `.edge` next to it whose marker is not 0. Neighbors are those of the `.neigh`
/// next to it.
///
/// # Errors
/// If a file is damaged, see [above](self); the error names the file and the line.
pub fn read_triangles(path: &Path) -> Result<Triangles> {
    read_triangles_with(path, &unwatched)
}

/// Like [`read_triangles`], but watched: the bytes that were parsed are counted.
///
/// # Errors
/// Those of [`read_triangles`], and that of the watch.
pub fn read_triangles_with(path: &Path, watch: Watch) -> Result<Triangles> {
    ele::read_file(path, watch)
}

/// Writes files of Triangle; the extension of each target decides its content.
///
/// # Errors
/// If an extension is not one of Triangle's or a file cannot be written.
pub fn write(targets: &[Destination], triangulated: &Triangulated) -> Result<()> {
    for target in targets {
        let mut output = target.create()?;
        let written = match extension(&target.format_path()).as_str() {
            "node" => node::write(&mut output, &triangulated.nodes),
            "ele" => ele::write(&mut output, triangulated),
            "poly" => poly::write(&mut output, triangulated),
            "edge" => edge::write(&mut output, triangulated),
            "neigh" => neigh::write(&mut output, triangulated),
            _ => {
                return Err(unknown(
                    target.path(),
                    "use .node, .ele, .poly, .edge or .neigh",
                ));
            }
        };
        let written = written.and_then(|()| writeln!(output, "# Generated by breakline"));
        written.map_err(|e| Error::from(e).in_file(target.path()))?;
        target.put(output)?;
    }
    Ok(())
}

#[cold]
fn unknown(path: &Path, cure: &str) -> Error {
    Error::usage("the file's extension is not that of a file of Triangle")
        .in_file(path)
        .cure(cure)
}

/// Counts the items of a file: edges, neighborhoods, triangles or vertices.
///
/// # Errors
/// If the file does not begin with a count, or has fewer or more lines.
pub fn count(path: &Path) -> Result<usize> {
    read_rows(path, &unwatched, &mut Vec::new(), |mut rows| {
        let (_, count) = counted(&mut rows, "items", "ITEMS ...")?;
        for i in 0..count {
            rows.expect(|| format!("item {} of {count}", i + 1), "NUMBER ...")?;
        }
        rows.end("the last item")?;
        Ok(count)
    })
}
