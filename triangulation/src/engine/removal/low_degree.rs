//! Removal of a vertex that has few neighbors and is not on the hull. Nearly all removals are of
//! this kind.
//!
//! Without constraints, the triangles that fill the hole belong to the Delaunay triangulation of
//! all remaining points (Devillers 2011, *Vertex removal in two-dimensional Delaunay triangulation:
//! speed-up by low degrees optimization*), so they need no flips. The third corner of the triangle
//! at an edge of the hole is the vertex of the ring, left of the edge, whose circle through the
//! edge contains none of the others. The triangle leaves a hole on either side. This is quadratic
//! in the degree, but for few neighbors it takes the fewest tests, on points in registers and
//! without allocations. Vertices with more neighbors, or with the infinite vertex among them, are
//! left to [`remove`](super::plane).
//!
//! Constraints around the hole change nothing. The removed vertex sees all corners of the ring, so
//! no corner is in the circle of one of the triangles at it: these are the Delaunay triangles of
//! the vertex and its ring alone. So the hole is filled by the Delaunay triangles of the ring.
//!
//! `PERF:` every second one of 100 000 uniform points removed (`bench_editing`): 0.6 us each,
//! instead of 1.4 by cutting off ears and flipping.

use crate::engine::flip::Edges;
use crate::geometry::{Geometry, in_sphere};
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::Triangulation;

/// The largest degree. Uniform points have a mean degree of 6; fewer than one in 10 000 have more
/// than this.
const MOST: usize = 12;

/// A face, and the index of an edge in it.
type FaceEdge = (CellId, usize);

/// The vertices around a vertex, counter-clockwise.
struct SmallRing<P> {
    faces: [CellId; MOST],
    corners: [VertexId; MOST],
    points: [P; MOST],
    /// Beyond the edge from each corner to the next.
    beyond: [FaceEdge; MOST],
    degree: usize,
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Fills the hole left by the triangles around a vertex on no constraint. Returns false, and
    /// changes nothing, if the vertex has too many neighbors, or the infinite vertex is one of
    /// them.
    pub(crate) fn fill_low_degree(&mut self, edges: impl Edges<C>, vertex: VertexId) -> bool {
        if self.dimension() < 2 {
            return false;
        }
        let Some(ring) = self.low_ring(vertex) else {
            return false;
        };
        let (inner, superfluous) = ring.faces[..ring.degree].split_at(ring.degree - 2);
        for &face in superfluous {
            self.tds.remove_cell(face);
        }

        // Chains of the ring to be filled, each with the face beyond the edge from its last corner
        // to its first.
        let last = ring.degree - 1;
        let mut chains = [(0, last, ring.beyond[last]); MOST];
        let mut open = 1;
        for &face in inner {
            open -= 1;
            let (first, last, beyond) = chains[open];
            let apex = self.third_corner(&ring.points, first, last);
            self.tds
                .set_corners(face, [first, apex, last].map(|k| ring.corners[k]));
            self.renew_edges(edges, face, [(1, beyond)]);
            for (first, last, side) in [(first, apex, (face, 2)), (apex, last, (face, 0))] {
                if first + 1 < last {
                    chains[open] = (first, last, side);
                    open += 1;
                } else {
                    self.renew_edge(edges, side, ring.beyond[first]);
                }
            }
        }
        true
    }

    /// Returns the corner within a chain whose triangle with the edge from the chain's last corner
    /// to its first is Delaunay.
    #[inline]
    fn third_corner(&self, points: &[G::Point; MOST], first: usize, last: usize) -> usize {
        let [a, b] = [&points[last], &points[first]];
        let is_left = |&k: &usize| self.geometry.orientation([a, b, &points[k]]) == Sign::Positive;
        let mut apex = first + 1;
        if apex + 1 < last {
            let mut left = (apex..last).filter(is_left);
            apex = left.next().unwrap_or(apex);
            for k in left {
                if in_sphere(&self.geometry, [a, b, &points[apex]], &points[k]) {
                    apex = k;
                }
            }
        }
        apex
    }

    fn low_ring(&self, vertex: VertexId) -> Option<SmallRing<G::Point>> {
        let (around, left_end, right_end) = self.low_star(vertex)?;
        let mut ring = SmallRing {
            faces: around,
            corners: [vertex; MOST],
            points: [*self.point(vertex); MOST],
            beyond: [(around[0], 0); MOST],
            degree: 0,
        };
        for &face in around[..left_end].iter().chain(&around[right_end..]) {
            let i = self.tds.index_of(face, vertex)?;
            let (corner, beyond) = (self.tds.vertex(face, ccw(i)), self.tds.neighbor(face, i));
            if corner == VertexId::INFINITE {
                return None;
            }
            let k = ring.degree;
            ring.faces[k] = face;
            ring.corners[k] = corner;
            ring.points[k] = *self.point(corner);
            ring.beyond[k] = (beyond, self.tds.index_of_neighbor(beyond, face));
            ring.degree += 1;
        }
        Some(ring)
    }

    /// Returns the faces around a vertex, counter-clockwise: those before the first returned index,
    /// and then those from the second one on.
    ///
    /// `PERF:` collects in both directions at a time, because each face determines the next one:
    /// with a million points, each step waits for memory. A removal takes 1.37 instead of 1.58 us
    /// then.
    fn low_star(&self, vertex: VertexId) -> Option<([CellId; MOST], usize, usize)> {
        let first = self.tds.cell_of(vertex)?;
        let mut around = [first; MOST];
        let (mut left, mut right) = (first, first);
        let (mut left_end, mut right_end) = (1, MOST);
        loop {
            let next = self
                .tds
                .neighbor(left, ccw(self.tds.index_of(left, vertex)?));
            let previous = self
                .tds
                .neighbor(right, cw(self.tds.index_of(right, vertex)?));
            if next == right {
                break;
            }
            if left_end == right_end {
                return None;
            }
            around[left_end] = next;
            left_end += 1;
            left = next;
            if previous == left {
                break;
            }
            if left_end == right_end {
                return None;
            }
            right_end -= 1;
            around[right_end] = previous;
            right = previous;
        }
        Some((around, left_end, right_end))
    }
}
