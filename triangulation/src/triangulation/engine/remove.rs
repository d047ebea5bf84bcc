//! Taking a vertex out of a triangulation of the plane: any vertex, of any degree, among walls. Most are taken out by a
//! shorter way, see [`remove_low_degree`](super::remove_low_degree).
//!
//! 1. The triangles around the vertex, the infinite ones included, leave a hole. Its rim is a ring of vertices
//!    that the removed one saw; at the hull the infinite vertex is one of them.
//! 2. Convex corners of the ring are cut off as triangles, as long as what is left can still be seen from
//!    the place of the removed vertex. In the end a triangle is left; or, at the hull, a chain that is convex
//!    to the outside, which is the new hull and is joined to infinity.
//! 3. The new triangles are flipped until the law holds.
//!
//! *There is always a corner to cut.* Take any triangulation of the ring (without infinity). In the tree of its
//! triangles, one leaf at least does not have the removed place inside. The place sees both edges of
//! the leaf's outer corner, hence lies beyond the third edge, or on it: that is what is asked. On it only
//! once: then the place is on the rim, and all other edges are seen from it as before.
//!
//! *The triangles outside of the hole stay.* Nothing can enter their circles by a removal, and the walls, which
//! say who sees whom, do not change. So no edge of the rim is ever flipped.

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};

use super::super::Triangulation;
use super::flip::Edges;

/// The ring around what is not yet triangulated, counter-clockwise as seen from within.
struct Ring {
    corners: Vec<VertexId>,
    /// Beyond the edge from each corner to the next: the cell there, and the index of the edge in it.
    beyond: Vec<(CellId, usize)>,
    next: Vec<usize>,
    previous: Vec<usize>,
    /// How many corners are left.
    length: usize,
}

impl Ring {
    /// The corner before, the corner itself, and the one after.
    fn triple(&self, k: usize) -> [usize; 3] {
        [self.previous[k], k, self.next[k]]
    }

    /// Takes a corner off; a cell, with the edge of this index, is now beyond the edge that replaces its two.
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
    /// Takes out a vertex on no wall and restores the law. Cells are replaced only where they had it as a corner; all
    /// of them where the rest are collinear.
    ///
    /// # Complexity
    /// Linear in the degree, and the flips, of which there are in the worst case as many as pairs of neighbors.
    pub(in super::super) fn remove_vertex(&mut self, edges: impl Edges<C>, vertex: VertexId) {
        if self.fill_low_degree(edges, vertex) {
            self.tds.remove_vertex(vertex);
        } else {
            let mut to_legalize = self.remove_lawless(edges, vertex);
            self.legalize(edges, &mut to_legalize);
        }
    }

    /// The same without restoring the law; returns the cells that are new.
    pub(in super::super) fn remove_lawless(&mut self, edges: impl Edges<C>, vertex: VertexId) -> Vec<CellId> {
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

    /// Whether without this vertex there are no triangles.
    pub(in super::super) fn is_flat_without(&self, vertex: VertexId) -> bool {
        self.dimension() < 2 || self.line_without(vertex).is_some()
    }

    /// The vertices that are left, in their order, if they are collinear without this one.
    pub(in super::super) fn line_without(&self, vertex: VertexId) -> Option<Vec<VertexId>> {
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
        let turn = |w: &[VertexId]| self.geometry.orientation([w[0], w[1], w[2]].map(|v| self.point(v)));
        (is_on_hull && line.windows(3).all(|w| turn(w) == Sign::Zero)).then_some(line)
    }

    fn fill_star(&mut self, edges: impl Edges<C>, vertex: VertexId) -> Vec<CellId> {
        let mut cells: Vec<CellId> = self.tds.around(vertex).collect();
        let mut ring = self.ring_around(vertex, &cells);
        // A ring takes two triangles less than it has corners.
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
        // What is left is a triangle, or a chain of hull edges, each of which gets a triangle with infinity.
        let apex = ring.corners.iter().position(|&v| v == VertexId::INFINITE);
        let apex = apex.or((0..ring.corners.len()).find(|&k| !ring.is_cut(k))).unwrap_or(0);
        while ring.length > 2 {
            let k = ring.next[apex];
            self.cut(edges, &mut ring, k, &cells);
        }
        // Of the two sides of the last edge, one is the last triangle.
        let ((last, i), (beside, j)) = (ring.beyond[apex], ring.beyond[ring.next[apex]]);
        self.renew_edge(edges, (last, i), (beside, j));
        cells
    }

    /// The rim of the cells around a vertex, which are given in their order.
    fn ring_around(&self, vertex: VertexId, cells: &[CellId]) -> Ring {
        let length = cells.len();
        let mut ring = Ring {
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
            ring.beyond.push((beyond, self.tds.index_of_neighbor(beyond, cell)));
        }
        ring
    }

    /// Whether the middle one of three corners of the ring around a vertex can be cut off.
    fn can_be_cut(&self, vertex: VertexId, corners: [VertexId; 3]) -> bool {
        if corners.contains(&VertexId::INFINITE) {
            return false;
        }
        let [a, b, c] = corners.map(|v| self.point(v));
        self.geometry.orientation([a, b, c]) == Sign::Positive
            && self.geometry.orientation([a, c, self.point(vertex)]) != Sign::Negative
    }

    /// Makes a corner of the ring and its neighbors a triangle, with the next of the cells.
    fn cut(&mut self, edges: impl Edges<C>, ring: &mut Ring, k: usize, cells: &[CellId]) {
        let cell = cells[ring.corners.len() - ring.length];
        let [p, _, n] = ring.triple(k);
        self.tds.set_corners(cell, [p, k, n].map(|k| ring.corners[k]));
        self.renew_edges(edges, cell, [(0, ring.beyond[k]), (2, ring.beyond[p])]);
        ring.cut(k, cell, 1);
    }
}
