//! Triangles of a task that meet a level, as a mesh.

use super::{LevelParts, LevelSide, LineEnd, OpenLine, VertexKey};
use crate::data::{self, LinkFlaw, Mesh, Surface, Triangles};
use crate::error::{Error, Result};
use crate::terrain::contour::index::LevelIndex;
use crate::terrain::contour::narrow::{self, Narrowness};
use crate::terrain::contour::trace::{LooseEnd, Trace, Traces};
use crate::terrain::tiles::{TileTriangle, TileVertex};
use crate::triangulation::num::unsigned_zero;
use rustc_hash::FxHashMap;
use std::cmp::Ordering;

/// Triangles that are not linked yet.
#[derive(Default)]
pub(super) struct Patch {
    number_of: FxHashMap<VertexKey, u32>,
    vertices: Vec<[f64; 3]>,
    /// The key of each vertex.
    keys: Vec<VertexKey>,
    faces: Vec<[u32; 3]>,
}

/// Triangles, linked to their neighbors.
pub(super) struct LinkedPatch {
    pub(super) mesh: Mesh,
    /// The key of each vertex.
    keys: Vec<VertexKey>,
}

impl Patch {
    pub(super) fn push(&mut self, triangle: &TileTriangle) {
        let Patch {
            number_of,
            vertices,
            keys,
            faces,
        } = self;
        faces.push(triangle.corners.map(
            |TileVertex {
                 tile,
                 number,
                 position,
                 ..
             }| {
                *number_of.entry([tile, number]).or_insert_with(|| {
                    vertices.push(position);
                    keys.push([tile, number]);
                    vertices.len() as u32 - 1
                })
            },
        ));
    }

    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Links the faces that share an edge.
    ///
    /// # Errors
    /// If two of them are on the same side of an edge.
    pub(super) fn linked(self) -> Result<LinkedPatch> {
        let Patch {
            vertices,
            keys,
            faces,
            ..
        } = self;
        let (mesh, flaws) = Mesh::link(Triangles {
            vertices,
            faces,
            ..Triangles::default()
        })?;
        if let Some(&LinkFlaw::Folded { edge, .. }) = flaws.first() {
            let [a, b] = edge.map(|end| mesh.position(end));
            return Err(Error::usage(format!(
                "two triangles are on the same side of the edge from {a:?} to {b:?}"
            ))
            .cure("give each triangle of the whole to one collector, once"));
        }
        Ok(LinkedPatch { mesh, keys })
    }
}

impl LinkedPatch {
    /// The parts that the lines of a level are.
    pub(super) fn parts(
        &self,
        level: f64,
        Traces {
            traces,
            touches_vertices,
        }: Traces,
    ) -> LevelParts {
        let mut parts = LevelParts {
            touches_vertices,
            ..LevelParts::new(level)
        };
        for trace in traces {
            match trace {
                Trace::Closed(points) => parts.closed.push(points),
                Trace::Open { points, ends } => {
                    parts.open.push(OpenLine {
                        points,
                        ends: ends.map(|end| self.line_end(end)),
                    });
                }
            }
        }
        parts
    }

    /// The sites at narrow faces, each with the index of its level.
    pub(super) fn narrow_sites(
        &self,
        index: &LevelIndex,
        narrowness: Narrowness,
    ) -> Vec<(usize, Vec<[f64; 2]>)> {
        let is_narrow =
            |corners: [u32; 3]| narrowness.includes(corners.map(|v| self.mesh.position(v)));
        let narrow = data::corners(&self.mesh).filter(|&(_, corners)| is_narrow(corners));
        let sites = narrow.flat_map(|(face, _)| narrow::sites_of(&self.mesh, index, face));
        narrow::by_level(sites.collect())
    }

    fn line_end(&self, end: LooseEnd) -> LineEnd {
        match end {
            LooseEnd::Edge(ends) => {
                let [a, b] = ends.map(|end| self.keys[end as usize]);
                LineEnd::Edge([a.min(b), a.max(b)])
            }
            LooseEnd::Vertex { vertex, toward } => LineEnd::Vertex {
                vertex: self.keys[vertex as usize],
                toward: self.plan(toward),
            },
        }
    }

    /// The sides of edges on levels that have no face on the other side, each with the index of its
    /// level.
    pub(super) fn level_sides(
        &self,
        index: &LevelIndex,
    ) -> impl Iterator<Item = (usize, LevelSide)> {
        let sides = data::corners(&self.mesh).flat_map(move |(face, corners)| {
            let is_open = move |i: &usize| self.mesh.neighbor(face, *i).is_none();
            (0..3)
                .filter(is_open)
                .map(move |i| [0, 1, 2].map(|k| corners[(i + k) % 3]))
        });
        sides.filter_map(|[third, a, b]| {
            let [third_height, height, other_height] =
                [third, a, b].map(|v| self.mesh.position(v)[2]);
            let level = index.first_from(height);
            let is_on_level = height == other_height && index.levels().get(level) == Some(&height);
            let side = || LevelSide {
                vertices: [a, b].map(|v| self.keys[v as usize]),
                at: [a, b].map(|v| self.plan(v)),
                is_high: third_height.partial_cmp(&height) != Some(Ordering::Less),
            };
            is_on_level.then(|| (level, side()))
        })
    }

    /// A vertex in plan, as it is in contours.
    fn plan(&self, vertex: u32) -> [f64; 2] {
        let [x, y, _] = self.mesh.position(vertex);
        [x, y].map(unsigned_zero)
    }
}
