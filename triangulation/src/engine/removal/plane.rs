//! Removal of a vertex from a triangulation of the plane: of any degree, and between constraints.
//! Most vertices are removed faster, see [`remove_low_degree`](super::low_degree).
//!
//! 1. The triangles around the vertex, the infinite ones included, leave a hole. Its border is a
//!    ring of vertices that the removed one saw; on the hull the infinite vertex is one of them.
//! 2. Convex corners of the ring are cut off as triangles, as long as the rest stays visible from
//!    the removed point. In the end a triangle is left; or, on the hull, a chain that is convex to
//!    the outside, which is the new hull and is joined to the infinite vertex.
//! 3. The new triangles are legalized by flips until the law holds.
//!
//! *There is always a corner to cut.* Take any triangulation of the ring (without the infinite
//! vertex). In the tree of its triangles, at least one leaf does not have the removed point inside.
//! The point sees both edges of the leaf's outer corner, hence lies beyond the third edge, or on
//! it: this is what is tested. It can be on it only once: then the point is on the ring, and all
//! other edges are visible from it as before.
//!
//! *The triangles outside of the hole stay.* A removal adds no vertices to their circles, and the
//! constraints, which limit what vertices see, do not change. So no edge of the ring is ever
//! flipped.

use crate::engine::flip::Edges;
use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::Triangulation;

/// The ring around what is not yet triangulated, counter-clockwise as seen from within.
struct HoleRing {
    corners: Vec<VertexId>,
    /// For the edge from each corner to the next: the cell beyond it, and the index of the edge
    /// there.
    beyond: Vec<(CellId, usize)>,
    next: Vec<usize>,
    previous: Vec<usize>,
    /// The number of corners left.
    length: usize,
}

impl HoleRing {
    /// Returns the corner before, the corner itself, and the one after.
    fn triple(&self, k: usize) -> [usize; 3] {
        [self.previous[k], k, self.next[k]]
    }

    /// Cuts off a corner. Beyond the edge that replaces its two edges there is now this cell, with
    /// the edge at index `i`.
    fn cut(&mut self, k: usize, cell: CellId, i: usize) {
        let [p, _, n] = self.triple(k);
        (self.next[p], self.previous[n]) = (n, p);
        (self.next[k], self.previous[k]) = (k, k);
        self.beyond[p] = (cell, i);
        self.length -= 1;
    }

    fn is_cut(&self, k: usize) -> bool {
        self.next[k] == k
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Removes a vertex that is on no constraint, and restores the law. Only the cells at the
    /// vertex are replaced; if the other points are collinear, all cells.
    ///
    /// # Complexity
    /// Linear in the degree, and in the number of flips, which at worst is the number of pairs of
    /// neighbors.
    pub(crate) fn remove_vertex(&mut self, edges: impl Edges<C>, vertex: VertexId) {
        if self.fill_low_degree(edges, vertex) {
            self.tds.remove_vertex(vertex);
        } else {
            let mut to_legalize = self.remove_lawless(edges, vertex);
            self.legalize(edges, &mut to_legalize);
        }
    }

    /// Like [`remove_vertex`](Self::remove_vertex), but without restoring the law. Returns the new
    /// cells.
    pub(crate) fn remove_lawless(&mut self, edges: impl Edges<C>, vertex: VertexId) -> Vec<CellId> {
        let mut cells = Vec::new();
        if self.dimension() == 2 {
            match self.line_without(vertex) {
                Some(line) => self.tds.set_line(&line),
                None => cells = self.fill_star(edges, vertex),
            }
        } else if self.vertex_count() > 2 {
            self.tds.skip(vertex);
        } else {
            let rest: Vec<VertexId> = self.tds.vertices().filter(|&v| v != vertex).collect();
            self.tds.set_line(&rest);
        }
        self.tds.remove_vertex(vertex);
        cells
    }

    /// Returns true if without this vertex there are no triangles.
    pub(crate) fn is_flat_without(&self, vertex: VertexId) -> bool {
        self.dimension() < 2 || self.line_without(vertex).is_some()
    }

    /// Returns the other vertices, in their order on the line, if they are collinear.
    pub(crate) fn line_without(&self, vertex: VertexId) -> Option<Vec<VertexId>> {
        let mut line = Vec::new();
        let mut is_on_hull = false;
        for (cell, i) in self.tds.corners_around(vertex) {
            if self.tds.is_infinite(cell) {
                is_on_hull = true;
            } else if self.tds.is_infinite(self.tds.neighbor(cell, i)) {
                line.extend([ccw(i), cw(i)].map(|k| self.tds.vertex(cell, k)));
            } else {
                return None;
            }
        }
        line.sort_unstable_by(|&p, &q| self.geometry.compare(self.point(p), self.point(q)));
        line.dedup();
        let turn = |w: &[VertexId]| {
            self.geometry
                .orientation([w[0], w[1], w[2]].map(|v| self.point(v)))
        };
        (is_on_hull && line.windows(3).all(|w| turn(w) == Sign::Zero)).then_some(line)
    }

    fn fill_star(&mut self, edges: impl Edges<C>, vertex: VertexId) -> Vec<CellId> {
        let mut cells: Vec<CellId> = self.tds.around(vertex).collect();
        let mut ring = self.ring_around(vertex, &cells);
        // A ring needs two triangles less than it has corners.
        for cell in cells.drain(ring.length - 2..) {
            self.tds.remove_cell(cell);
        }

        let mut open: Vec<usize> = (0..ring.length).collect();
        let mut seen = 0;
        while ring.length > 3 && seen < open.len() {
            let k = open[seen];
            seen += 1;
            if !ring.is_cut(k) && self.can_be_cut(vertex, ring.triple(k).map(|k| ring.corners[k])) {
                let [p, _, n] = ring.triple(k);
                open.extend([p, n]);
                self.cut(edges, &mut ring, k, &cells);
            }
        }
        // The rest is a triangle, or a chain of hull edges, each of which gets a triangle with the
        // infinite vertex.
        let apex = ring.corners.iter().position(|&v| v == VertexId::INFINITE);
        let apex = apex
            .or((0..ring.corners.len()).find(|&k| !ring.is_cut(k)))
            .unwrap_or(0);
        while ring.length > 2 {
            let k = ring.next[apex];
            self.cut(edges, &mut ring, k, &cells);
        }
        // One of the two sides of the last edge is the last triangle.
        let ((last, i), (neighbor, j)) = (ring.beyond[apex], ring.beyond[ring.next[apex]]);
        self.renew_edge(edges, (last, i), (neighbor, j));
        cells
    }

    /// Returns the ring around a vertex, given the cells at the vertex in their order.
    fn ring_around(&self, vertex: VertexId, cells: &[CellId]) -> HoleRing {
        let length = cells.len();
        let mut ring = HoleRing {
            corners: Vec::with_capacity(length),
            beyond: Vec::with_capacity(length),
            next: (1..length).chain([0]).collect(),
            previous: [length - 1].into_iter().chain(0..length - 1).collect(),
            length,
        };
        for &cell in cells {
            let i = self.tds.index_of(cell, vertex).unwrap_or(0);
            let beyond = self.tds.neighbor(cell, i);
            ring.corners.push(self.tds.vertex(cell, ccw(i)));
            ring.beyond
                .push((beyond, self.tds.index_of_neighbor(beyond, cell)));
        }
        ring
    }

    /// Returns true if the middle one of three corners of the ring around a vertex can be cut off.
    fn can_be_cut(&self, vertex: VertexId, corners: [VertexId; 3]) -> bool {
        if corners.contains(&VertexId::INFINITE) {
            return false;
        }
        let [a, b, c] = corners.map(|v| self.point(v));
        self.geometry.orientation([a, b, c]) == Sign::Positive
            && self.geometry.orientation([a, c, self.point(vertex)]) != Sign::Negative
    }

    /// Makes a corner of the ring and its neighbors a triangle, in the next of the cells.
    fn cut(&mut self, edges: impl Edges<C>, ring: &mut HoleRing, k: usize, cells: &[CellId]) {
        let cell = cells[ring.corners.len() - ring.length];
        let [p, _, n] = ring.triple(k);
        self.tds
            .set_corners(cell, [p, k, n].map(|k| ring.corners[k]));
        self.renew_edges(edges, cell, [(0, ring.beyond[k]), (2, ring.beyond[p])]);
        ring.cut(k, cell, 1);
    }
}
