//! What Triangle's files contain.

use std::path::PathBuf;

use crate::error::Wording;

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
