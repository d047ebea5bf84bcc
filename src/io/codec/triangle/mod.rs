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
mod neigh;
pub(crate) mod node;
mod poly;

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::data::Triangles;
use crate::error::{Error, Result, Wording, wording};
use crate::io::Destination;
use crate::io::bytes::rows::{Row, Rows};
use crate::io::bytes::watch::{Watch, bytes_of, unwatched};
use crate::io::options::cut::open_line;

/// Vertices as in a `.node` file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Nodes<const D: usize = 2> {
    /// The number of the first vertex: 0 or 1.
    pub first_number: u32,
    /// Positions of the vertices.
    pub points: Vec<[f64; D]>,
    /// Number of attributes of each vertex.
    pub attribute_count: usize,
    /// The attributes, vertex by vertex.
    pub attributes: Vec<f64>,
    /// Boundary markers, one per vertex; 0 if the file has none.
    pub markers: Vec<i32>,
}

impl<const D: usize> Nodes<D> {
    /// Returns the attributes of one vertex.
    pub fn attributes_of(&self, vertex: usize) -> &[f64] {
        &self.attributes[vertex * self.attribute_count..(vertex + 1) * self.attribute_count]
    }
}

/// A segment of a `.poly` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment {
    /// Indices of its vertices, from 0.
    pub ends: [u32; 2],
    /// Boundary marker; 0 if there is none.
    pub marker: i32,
    /// Its number in the file.
    pub number: i64,
    /// The line of the file that states it.
    pub line: usize,
}

/// A hole: a site from which triangles are removed up to the surrounding segments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hole {
    /// A site in the hole.
    pub at: [f64; 2],
    /// The line of the file that states it.
    pub line: usize,
}

/// Values for the triangles in the region around a site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// A site in the region.
    pub at: [f64; 2],
    /// The attribute of the triangles.
    pub attribute: f64,
    /// The largest area of the triangles; `None` if the file states none or the value is not
    /// positive.
    pub max_area: Option<f64>,
    /// The line of the file that states it.
    pub line: usize,
}

/// A planar straight-line graph: the content of a `.poly` file, or of a `.node` file, without
/// segments.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LineGraph {
    /// The vertices.
    pub nodes: Nodes,
    /// The file that contains the vertices.
    pub node_file: PathBuf,
    /// The line of each vertex in `node_file`.
    pub node_lines: Vec<usize>,
    /// The segments.
    pub segments: Vec<Segment>,
    /// The holes.
    pub holes: Vec<Hole>,
    /// The regions.
    pub regions: Vec<Region>,
    /// Warnings for the user.
    pub warnings: Vec<Wording>,
}

/// An edge of a triangulation, by the indices of its vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge {
    /// Its vertices.
    pub ends: [u32; 2],
    /// Boundary marker.
    pub marker: i32,
}

/// A triangulation as stored in Triangle's files.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Triangulated {
    /// Vertices: those of the input, then those added.
    pub nodes: Nodes,
    /// Corners of the triangles, counter-clockwise, as indices of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle opposite each corner.
    pub neighbors: Vec<[Option<u32>; 3]>,
    /// An attribute for each triangle; empty if they have none.
    pub attributes: Vec<f64>,
    /// All edges of triangles.
    pub edges: Vec<Edge>,
    /// Sub-constraints, and the edges of the boundary.
    pub segments: Vec<Edge>,
    /// Holes, as in the input.
    pub holes: Vec<Hole>,
    /// Regions, as in the input.
    pub regions: Vec<Region>,
}

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
    Error::usage("the file's extension is not that of a file of Triangle").in_file(path).cure(cure)
}

pub(crate) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// Runs `read` on the lines of a file and returns its result; errors name the file. Adds a warning
/// if the last line has no end.
pub(crate) fn read_rows<T>(
    path: &Path,
    watch: Watch,
    warnings: &mut Vec<Wording>,
    read: impl FnOnce(Rows) -> Result<T>,
) -> Result<T> {
    let bytes = bytes_of(path, watch)?;
    warnings.extend(open_line(&bytes).map(|text| wording![format!(".{}: ", extension(path)), text]));
    read(Rows::new(&bytes, watch)).map_err(|e| e.in_file(path))
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

/// Returns the line that begins a list, and its count.
pub(crate) fn counted<'a>(rows: &mut Rows<'a>, items: &str, pattern: &'static str) -> Result<(Row<'a>, usize)> {
    let what = format!("number of {items}");
    let mut header = rows.expect(|| format!("the {what}"), pattern)?;
    let count = header.within(&what)?;
    Ok((header, count))
}

/// Reads the items of a list: calls `read` with each line and the number at its start.
pub(crate) fn listed<T>(
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

/// Returns the capacity for a stated count, limited by the bytes that are left: an item takes at
/// least six.
fn room(count: usize, rows: &Rows) -> usize {
    count.min(rows.bytes_left() / 6 + 1)
}

fn site<const D: usize>(row: &mut Row) -> Result<[f64; D]> {
    let mut site = [0.0; D];
    for (coordinate, what) in site.iter_mut().zip(["x coordinate", "y coordinate", "z coordinate"]) {
        *coordinate = row.finite(what)?;
    }
    Ok(site)
}

/// Reads the boundary marker; 0 if the list has none.
fn marker(row: &mut Row, marker_count: usize) -> Result<i32> {
    if marker_count > 0 { row.within("boundary marker") } else { Ok(0) }
}

/// The numbering of vertices.
#[derive(Clone, Copy)]
pub(crate) struct Numbering {
    pub(crate) first: u32,
    pub(crate) count: usize,
}

impl Numbering {
    /// Reads the number of a vertex and returns its index; messages call it `what`.
    pub(crate) fn vertex(self, row: &mut Row, what: &str) -> Result<u32> {
        let number = row.whole(what)?;
        self.index(number).ok_or_else(|| {
            let there = match self.count {
                0 => "there are no vertices".to_owned(),
                _ => format!("the vertices are numbered {} to {}", self.first, self.last()),
            };
            row.wrong(format!("the {what} is vertex {number}, but {there}"))
        })
    }

    /// Reads the number of a neighbor and returns its index, or `None` for -1; messages call it
    /// `what`.
    pub(crate) fn neighbor(self, row: &mut Row, what: &str) -> Result<Option<u32>> {
        let number = row.whole("neighbor")?;
        if number == -1 {
            return Ok(None);
        }
        self.index(number).map(Some).ok_or_else(|| {
            let [first, last] = [i64::from(self.first), self.last()];
            row.wrong(format!("the neighbor is {what} {number}, but they are numbered {first} to {last}"))
        })
    }

    /// Returns the index of what has this number, if there is one.
    fn index(self, number: i64) -> Option<u32> {
        let index = u32::try_from(number.checked_sub(i64::from(self.first))?).ok()?;
        ((index as usize) < self.count).then_some(index)
    }

    fn last(self) -> i64 {
        self.count as i64 + i64::from(self.first) - 1
    }
}

/// Lines with more values than announced: the first of them, and their number.
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

    fn warning(&self) -> Option<Wording> {
        let (first, lines) = (self.first_line?, self.lines);
        let text =
            format!("line {first}: there are more values than announced; they are not read ({lines} such lines)");
        Some(text.into())
    }
}
