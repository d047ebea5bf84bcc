//! The files of Triangle (Shewchuk 1996, "Triangle: Engineering a 2D Quality Mesh Generator and Delaunay
//! Triangulator"; the formats are those of its version 1.6).
//!
//! | file | holds | read | written |
//! |---|---|---|---|
//! | `.node` | vertices with attributes and boundary markers | yes | yes |
//! | `.poly` | the same, or none; segments; holes; regions | yes | yes, without vertices |
//! | `.ele` | triangles, with attributes | yes, with the `.node` beside it | yes |
//! | `.edge` | edges with boundary markers | beside an `.ele` without a `.poly` | yes |
//! | `.neigh` | the neighbors of the triangles | beside an `.ele` | yes |
//!
//! All are text: one item a line, its number first, words separated by blanks (or commas), `#` starts a
//! comment. Each list begins with a line that counts it.
//!
//! # Numbers
//! Vertices are numbered from 0 or from 1, which the number of the first vertex tells; the others must
//! follow. All files that belong together use the same. The numbers of segments, holes, regions, triangles
//! and edges are read and mean nothing; written, they count from the same 0 or 1.
//!
//! # Names
//! Files belong together that have the same name but for the last extension: `x.1.ele`, `x.1.node`,
//! `x.1.poly`. A `.poly` without vertices has those of its `.node`. What is written about vertices by number is
//! about the `.node` that is written with it, in which those of the input come first and unchanged.
//!
//! # Boundary markers
//! As Triangle has them. An edge has the marker of the first segment it is part of that has one other than
//! 0; else 1 if it has a triangle on one side only; else 0. A vertex keeps its own if that is not 0;
//! else it has that of the first such segment through it; else 1 on the boundary; else 0. They are always
//! written.
//!
//! # What is refused
//! Nothing is believed that the bytes do not bear out: a list that ends early or goes on too long, a line
//! with a value missing, a number that is not finite, a vertex number that is out of sequence or names no
//! vertex are errors that say file, line, value and what was expected. More values in a line than were
//! announced are a warning.

mod edge;
mod ele;
mod neigh;
mod node;
mod poly;

use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::rows::{Row, Rows};
use crate::io::{Destination, Output};

/// Vertices as a `.node` file has them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Nodes {
    /// The number of the first vertex: 0 or 1.
    pub first_number: u32,
    /// Where they are.
    pub points: Vec<[f64; 2]>,
    /// Attributes of each vertex.
    pub attribute_count: usize,
    /// The attributes, vertex by vertex.
    pub attributes: Vec<f64>,
    /// Boundary markers, one for each vertex; 0 where the file has none.
    pub markers: Vec<i32>,
}

impl Nodes {
    /// The attributes of one vertex.
    pub fn attributes_of(&self, vertex: usize) -> &[f64] {
        &self.attributes[vertex * self.attribute_count..(vertex + 1) * self.attribute_count]
    }
}

/// A segment of a `.poly` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment {
    /// Positions of its vertices, from 0.
    pub ends: [u32; 2],
    /// Boundary marker, 0 if there is none.
    pub marker: i32,
    /// Its number in the file.
    pub number: i64,
    /// The line that it stands in.
    pub line: usize,
}

/// A place from which something is flooded: a hole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hole {
    /// The place.
    pub at: [f64; 2],
    /// The line that it stands in.
    pub line: usize,
}

/// What the triangles around a place get.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// The place.
    pub at: [f64; 2],
    /// The attribute of the triangles.
    pub attribute: f64,
    /// Their largest area; none if the file does not say or the value is not positive.
    pub max_area: Option<f64>,
    /// The line that it stands in.
    pub line: usize,
}

/// A planar straight line graph: what a `.poly` file holds, or a `.node` file, without segments.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LineGraph {
    /// Vertices.
    pub nodes: Nodes,
    /// The file that the vertices stand in.
    pub node_file: PathBuf,
    /// The line of each vertex in it.
    pub node_lines: Vec<usize>,
    /// Segments.
    pub segments: Vec<Segment>,
    /// Holes.
    pub holes: Vec<Hole>,
    /// Regions.
    pub regions: Vec<Region>,
    /// What is odd.
    pub warnings: Vec<String>,
}

/// An edge of a triangulation, by the positions of its vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge {
    /// Its vertices.
    pub ends: [u32; 2],
    /// Boundary marker.
    pub marker: i32,
}

/// A triangulation as Triangle's files hold it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Triangulated {
    /// Vertices: those of the input, then those added.
    pub nodes: Nodes,
    /// Corners of the triangles, counter-clockwise, as positions of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle opposite each corner.
    pub neighbors: Vec<[Option<u32>; 3]>,
    /// An attribute for each triangle; empty if they have none.
    pub attributes: Vec<f64>,
    /// All edges of triangles.
    pub edges: Vec<Edge>,
    /// Pieces of segments, and the boundary.
    pub segments: Vec<Edge>,
    /// Holes, as in the input.
    pub holes: Vec<Hole>,
    /// Regions, as in the input.
    pub regions: Vec<Region>,
}

/// Reads a `.node` or a `.poly` file, the latter with its `.node` where it needs one.
///
/// # Errors
/// If a file is damaged, see [above](self); the error names it and the line.
pub fn read(path: &Path) -> Result<LineGraph> {
    match extension(path).as_str() {
        "node" => node::read_file(path),
        "poly" => poly::read_file(path),
        _ => Err(unknown(path, "use .node or .poly")),
    }
}

/// Reads an `.ele` file and the vertices in the `.node` beside it, with heights of 0. Constraints are the
/// segments of the `.poly` beside it, if that has no vertices of its own; else the edges of the `.edge`
/// beside it whose marker is not 0. Neighbors are those of the `.neigh` beside it.
///
/// # Errors
/// If a file is damaged, see [above](self); the error names it and the line.
pub fn read_triangles(path: &Path) -> Result<Triangles> {
    ele::read_file(path)
}

/// Writes files of Triangle. What each holds is told by its extension.
///
/// # Errors
/// If an extension is not one of Triangle's or a file cannot be written.
pub fn write(targets: &[Destination], triangulated: &Triangulated) -> Result<()> {
    for target in targets {
        let mut output = Output::create(target.path())?;
        let written = match extension(&target.format_path()).as_str() {
            "node" => node::write(&mut output, triangulated),
            "ele" => ele::write(&mut output, triangulated),
            "poly" => poly::write(&mut output, triangulated),
            "edge" => edge::write(&mut output, triangulated),
            "neigh" => neigh::write(&mut output, triangulated),
            _ => return Err(unknown(target.path(), "use .node, .ele, .poly, .edge or .neigh")),
        };
        let written = written.and_then(|()| writeln!(output, "# Generated by breakline"));
        written.map_err(|e| Error::from(e).in_file(target.path()))?;
        target.put(output)?;
    }
    Ok(())
}

#[cold]
fn unknown(path: &Path, cure: &str) -> Error {
    Error::usage("the file's extension names no file of Triangle").in_file(path).cure(cure)
}

fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|mut file| file.read_to_end(&mut bytes))
        .map_err(|e| Error::from(e).in_file(path))?;
    Ok(bytes)
}

/// What `read` makes of the lines of a file. Its errors name the file.
fn read_rows<T>(path: &Path, read: impl FnOnce(Rows) -> Result<T>) -> Result<T> {
    let bytes = bytes_of(path)?;
    read(Rows::new(&bytes)).map_err(|e| e.in_file(path))
}

/// Counts the items of a list: edges, neighborhoods, triangles, vertices.
///
/// # Errors
/// If the file does not begin with a count, or has fewer or more lines.
pub fn count(path: &Path) -> Result<usize> {
    read_rows(path, |mut rows| {
        let (_, count) = counted(&mut rows, "items", "ITEMS ...")?;
        for i in 0..count {
            rows.expect(|| format!("item {} of {count}", i + 1), "NUMBER ...")?;
        }
        rows.end("the last item")?;
        Ok(count)
    })
}

/// The line that begins a list, and the count that it begins with.
fn counted<'a>(rows: &mut Rows<'a>, items: &str, pattern: &'static str) -> Result<(Row<'a>, usize)> {
    let what = format!("number of {items}");
    let mut header = rows.expect(|| format!("the {what}"), pattern)?;
    let count = header.within(&what)?;
    Ok((header, count))
}

/// The items of a list: what `read` makes of each line and the number that it begins with.
fn listed<T>(
    rows: &mut Rows,
    count: usize,
    item: &str,
    pattern: &'static str,
    mut read: impl FnMut(&mut Row, i64) -> Result<T>,
) -> Result<Vec<T>> {
    let what = format!("{item} number");
    let mut items = Vec::with_capacity(room(count, rows));
    for i in 0..count {
        let mut row = rows.expect(|| format!("{item} {} of {count}", i + 1), pattern)?;
        let number = row.whole(&what)?;
        items.push(read(&mut row, number)?);
    }
    Ok(items)
}

/// Room for what a count announces, as far as the bytes can hold it: an item takes six at least.
fn room(count: usize, rows: &Rows) -> usize {
    count.min(rows.bytes_left() / 6 + 1)
}

fn site(row: &mut Row) -> Result<[f64; 2]> {
    Ok([row.finite("x coordinate")?, row.finite("y coordinate")?])
}

/// The boundary marker; 0 where the list has none.
fn marker(row: &mut Row, marker_count: usize) -> Result<i32> {
    if marker_count > 0 { row.within("boundary marker") } else { Ok(0) }
}

/// How vertices are numbered.
#[derive(Clone, Copy)]
struct Numbering {
    first: u32,
    count: usize,
}

impl Numbering {
    /// The position of a vertex that a line names; `what` is for messages.
    fn vertex(self, row: &mut Row, what: &str) -> Result<u32> {
        let number = row.whole(what)?;
        let position = number.checked_sub(i64::from(self.first)).and_then(|position| u32::try_from(position).ok());
        position.filter(|&position| (position as usize) < self.count).ok_or_else(|| {
            let last = self.count as i64 + i64::from(self.first) - 1;
            let there = match self.count {
                0 => "there are no vertices".to_owned(),
                _ => format!("the vertices are numbered {} to {last}", self.first),
            };
            row.wrong(format!("the {what} is vertex {number}, but {there}"))
        })
    }
}

/// Lines with more values than were announced: the first of them, and how many there are.
#[derive(Default)]
struct Surplus {
    first_line: Option<usize>,
    lines: usize,
}

impl Surplus {
    fn look(&mut self, row: &Row) {
        if row.has_more() {
            self.first_line.get_or_insert(row.line);
            self.lines += 1;
        }
    }

    fn warning(&self) -> Option<String> {
        let (first, lines) = (self.first_line?, self.lines);
        Some(format!("line {first}: there are more values than announced; they are not read ({lines} such lines)"))
    }
}
