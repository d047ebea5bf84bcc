//! What a part of a surface says about the contours of the whole.

use super::{LevelParts, LevelSide, LineEnd, OpenLine, VertexKey};
use crate::data::Surface;
use crate::terrain::contour::index::LevelIndex;
use crate::terrain::contour::trace::{LooseEnd, Trace, Traces};
use crate::triangulation::num::unsigned_zero;
use std::cmp::Ordering;

/// A part of a surface, with the key that each of its vertices has in the whole.
pub(super) struct Keyed<'a, S: ?Sized, K> {
    pub(super) surface: &'a S,
    pub(super) key_of: K,
}

impl<S: Surface + ?Sized, K: Fn(u32) -> VertexKey> Keyed<'_, S, K> {
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

    fn line_end(&self, end: LooseEnd) -> LineEnd {
        match end {
            LooseEnd::Edge(ends) => {
                let [a, b] = ends.map(|end| (self.key_of)(end));
                LineEnd::Edge([a.min(b), a.max(b)])
            }
            LooseEnd::Vertex { vertex, toward } => LineEnd::Vertex {
                vertex: (self.key_of)(vertex),
                toward: self.plan(toward),
            },
        }
    }

    /// The sides of edges on levels that have no face on the other side, of some faces with their
    /// corners; each with the index of its level.
    pub(super) fn level_sides(
        &self,
        faces: impl Iterator<Item = (u32, [u32; 3])>,
        index: &LevelIndex,
    ) -> impl Iterator<Item = (usize, LevelSide)> {
        let sides = faces.flat_map(move |(face, corners)| {
            let is_open = move |i: &usize| self.surface.neighbor(face, *i).is_none();
            (0..3)
                .filter(is_open)
                .map(move |i| [0, 1, 2].map(|k| corners[(i + k) % 3]))
        });
        sides.filter_map(|[third, a, b]| {
            let [third_height, height, other_height] =
                [third, a, b].map(|v| self.surface.position(v)[2]);
            let level = index.first_from(height);
            let is_on_level = height == other_height && index.levels().get(level) == Some(&height);
            let side = || LevelSide {
                vertices: [a, b].map(|v| (self.key_of)(v)),
                at: [a, b].map(|v| self.plan(v)),
                is_high: third_height.partial_cmp(&height) != Some(Ordering::Less),
            };
            is_on_level.then(|| (level, side()))
        })
    }

    /// A vertex in plan, as it is in contours.
    fn plan(&self, vertex: u32) -> [f64; 2] {
        let [x, y, _] = self.surface.position(vertex);
        [x, y].map(unsigned_zero)
    }
}
