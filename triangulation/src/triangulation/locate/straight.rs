use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};

use super::super::Triangulation;
use super::{Locate, Location};

/// Walks along the straight line from a vertex, through the triangles that it meets; without a
/// vertex, from one near the last insertion. In the plane.
///
/// Visits `O(sqrt n)` triangles on uniformly distributed points (Devroye, Lemaire and Moreau 2004),
/// with one orientation each and one for the edge through which the line leaves.
#[derive(Debug, Clone, Copy, Default)]
pub struct StraightLine(pub Option<VertexId>);

impl<G: Geometry<3>> Locate<G, 3> for StraightLine {
    fn locate<V, C: Copy + Default>(&self, triangulation: &Triangulation<G, 3, V, C>, q: &G::Point) -> Location {
        let last = || {
            let finite = triangulation.last.filter(|&cell| triangulation.tds.is_used(cell))?;
            triangulation.tds.cell_vertices(finite).iter().copied().find(|&v| v != VertexId::INFINITE)
        };
        let start = self.0.filter(|&v| triangulation.tds.is_vertex(v));
        let start = start.or_else(last).or_else(|| triangulation.tds.vertices().next());
        let start = start.filter(|_| triangulation.geometry.admits(q));
        let cell = start.and_then(|from| triangulation.walk_straight(from, q));
        triangulation.locate(q, cell)
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns the last triangle on the line from a vertex to a point: the one that contains the
    /// point, or the last one in the hull. `None` if there is none, or the line does not start in a
    /// triangle.
    ///
    /// *Touching.* The line enters each triangle through an edge whose one end, `r`, is strictly on
    /// the right, while the other, `l`, is on the left or on the line. So a vertex on the line is
    /// passed on its right side, and the position of the opposite vertex decides through which edge
    /// the line leaves.
    fn walk_straight(&self, from: VertexId, q: &G::Point) -> Option<CellId> {
        let p = self.point(from);
        let side = |v: VertexId| self.geometry.orientation([p, q, self.point(v)]);
        let starts = |&(cell, i): &(CellId, usize)| {
            !self.tds.is_infinite(cell)
                && side(self.tds.vertex(cell, ccw(i))) == Sign::Negative
                && side(self.tds.vertex(cell, cw(i))) != Sign::Negative
        };
        let (mut cell, mut i) = self.tds.corners_around(from).find(starts)?;
        loop {
            // `r` and `l` are the ends of the edge opposite vertex `i`.
            let [r, l] = self.tds.edge_ends(cell, i);
            if self.geometry.orientation([self.point(r), self.point(l), q]) != Sign::Negative {
                return Some(cell);
            }
            let beyond = self.tds.neighbor(cell, i);
            if self.tds.is_infinite(beyond) {
                return Some(cell);
            }
            let j = self.tds.index_of_neighbor(beyond, cell);
            // Seen from beyond, the edge runs from `l` to `r`: the edge that keeps `l` lies
            // opposite `r`, and vice versa.
            i = if side(self.tds.vertex(beyond, j)) == Sign::Negative { cw(j) } else { ccw(j) };
            cell = beyond;
        }
    }
}
