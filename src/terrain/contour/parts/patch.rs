//! Triangles of a task that meet a level, as a surface.

use super::super::index::LevelIndex;
use super::super::trace::{LooseEnd, Trace, Traces};
use super::{LevelParts, LevelSide, LineEnd, OpenLine, VertexKey};
use crate::crs::Crs;
use crate::data::{EdgeKind, Surface};
use crate::error::{Error, Result};
use crate::terrain::tiles::{TileTriangle, TileVertex};
use crate::triangulation::num::unsigned_zero;
use rustc_hash::FxHashMap;
use std::cmp::Ordering;

/// Triangles that are not linked yet.
#[derive(Default)]
pub(super) struct Patch {
    number_of: FxHashMap<VertexKey, u32>,
    vertices: Vec<TileVertex>,
    faces: Vec<[u32; 3]>,
}

/// A surface of triangles.
pub(super) struct LinkedPatch {
    vertices: Vec<TileVertex>,
    faces: Vec<[u32; 3]>,
    neighbors: Vec<[Option<u32>; 3]>,
}

impl Patch {
    pub(super) fn push(&mut self, triangle: &TileTriangle) {
        let Patch { number_of, vertices, faces } = self;
        faces.push(triangle.corners.map(|corner| {
            *number_of.entry(key(&corner)).or_insert_with(|| {
                vertices.push(corner);
                vertices.len() as u32 - 1
            })
        }));
    }

    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Links the faces that share an edge.
    ///
    /// # Errors
    /// If two of them are on the same side of an edge.
    pub(super) fn linked(self) -> Result<LinkedPatch> {
        let Patch { vertices, faces, .. } = self;
        let mut sides = Vec::with_capacity(3 * faces.len());
        for (face, corners) in (0..).zip(&faces) {
            for i in 0..3 {
                let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
                sides.push(([a.min(b), a.max(b)], a < b, face, i));
            }
        }
        sides.sort_unstable();
        let mut neighbors = vec![[None; 3]; faces.len()];
        for pair in sides.windows(2) {
            let [(edge, side, face, i), (other_edge, other_side, other, j)] = [pair[0], pair[1]];
            if edge != other_edge {
                continue;
            }
            if side == other_side {
                let [a, b] = edge.map(|end| vertices[end as usize].position);
                return Err(Error::usage(format!(
                    "two triangles are on the same side of the edge from {a:?} to {b:?}"
                ))
                .cure("give each triangle of the whole to one collector, once"));
            }
            neighbors[face as usize][i] = Some(other);
            neighbors[other as usize][j] = Some(face);
        }
        Ok(LinkedPatch { vertices, faces, neighbors })
    }
}

impl LinkedPatch {
    /// The parts that the lines of a level are.
    pub(super) fn parts(&self, level: f64, Traces { traces, touches_vertices }: Traces) -> LevelParts {
        let mut parts = LevelParts { touches_vertices, ..LevelParts::new(level) };
        for trace in traces {
            match trace {
                Trace::Closed(points) => parts.closed.push(points),
                Trace::Open { points, ends } => {
                    parts.open.push(OpenLine { points, ends: ends.map(|end| self.line_end(end)) });
                }
            }
        }
        parts
    }

    fn line_end(&self, end: LooseEnd) -> LineEnd {
        match end {
            LooseEnd::Edge(ends) => {
                let [a, b] = ends.map(|v| key(&self.vertices[v as usize]));
                LineEnd::Edge([a.min(b), a.max(b)])
            }
            LooseEnd::Vertex { vertex, toward } => {
                LineEnd::Vertex { vertex: key(&self.vertices[vertex as usize]), toward: self.plan(toward) }
            }
        }
    }

    /// The sides of edges on levels that have no face on the other side, each with the index of its
    /// level.
    pub(super) fn level_sides(&self, index: &LevelIndex) -> impl Iterator<Item = (usize, LevelSide)> {
        let sides = self.faces.iter().zip(&self.neighbors).flat_map(|(corners, neighbors)| {
            (0..3).filter(|&i| neighbors[i].is_none()).map(move |i| [0, 1, 2].map(|k| corners[(i + k) % 3]))
        });
        sides.filter_map(|[third, a, b]| {
            let [third_height, height, other_height] = [third, a, b].map(|v| self.position(v)[2]);
            let level = index.first_from(height);
            let is_on_level = height == other_height && index.levels().get(level) == Some(&height);
            let side = || LevelSide {
                vertices: [a, b].map(|v| key(&self.vertices[v as usize])),
                at: [a, b].map(|v| self.plan(v)),
                is_high: third_height.partial_cmp(&height) != Some(Ordering::Less),
            };
            is_on_level.then(|| (level, side()))
        })
    }

    /// A vertex in plan, as it is in contours.
    fn plan(&self, vertex: u32) -> [f64; 2] {
        let [x, y, _] = self.position(vertex);
        [x, y].map(unsigned_zero)
    }
}

fn key(vertex: &TileVertex) -> VertexKey {
    [vertex.tile, vertex.number]
}

impl Surface for LinkedPatch {
    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.vertices[vertex as usize].position
    }

    fn face_count(&self) -> usize {
        self.faces.len()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.faces.get(face as usize).copied()
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        self.neighbors[face as usize][i]
    }

    fn edge_kind(&self, _face: u32, _i: usize) -> EdgeKind {
        EdgeKind::Plain
    }

    fn crs(&self) -> Option<&Crs> {
        None
    }
}
