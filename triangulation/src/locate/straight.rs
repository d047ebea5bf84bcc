use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::Triangulation;

use super::{Locate, Location, line};

/// Walks along the straight line from a vertex, through the cells that it meets; without a vertex,
/// from one near the last insertion.
///
/// In the plane, visits `O(sqrt n)` triangles on uniformly distributed points (Devroye, Lemaire and
/// Moreau 2004), with one orientation each and one for the edge through which the line leaves.
///
/// In space, visits `O(n^(1/3))` tetrahedra on such points, with three orientations each and one
/// for the facet through which the line leaves. Where the line meets an edge or a vertex, exact
/// orientations find the cell around it, or the face of one, in which the line continues.
#[derive(Debug, Clone, Copy, Default)]
pub struct StraightLine(pub Option<VertexId>);

impl StraightLine {
    /// Returns the vertex where the line starts.
    fn start<G: Geometry<N>, const N: usize, V, C: Copy + Default>(
        self,
        triangulation: &Triangulation<G, N, V, C>,
    ) -> Option<VertexId> {
        let last = || {
            let finite = triangulation
                .last
                .filter(|&cell| triangulation.tds.is_used(cell))?;
            triangulation
                .tds
                .cell_vertices(finite)
                .iter()
                .copied()
                .find(|&v| v != VertexId::INFINITE)
        };
        let start = self.0.filter(|&v| triangulation.tds.is_vertex(v));
        start
            .or_else(last)
            .or_else(|| triangulation.tds.vertices().next())
    }
}

impl<G: Geometry<3>> Locate<G, 3> for StraightLine {
    fn locate<V, C: Copy + Default>(
        &self,
        triangulation: &Triangulation<G, 3, V, C>,
        q: &G::Point,
    ) -> Location {
        let start = self
            .start(triangulation)
            .filter(|_| triangulation.geometry.admits(q));
        let cell = start.and_then(|from| triangulation.walk_straight(from, q));
        triangulation.locate(q, cell)
    }
}

impl<G: Geometry<4>> Locate<G, 4> for StraightLine {
    fn locate<V, C: Copy + Default>(
        &self,
        triangulation: &Triangulation<G, 4, V, C>,
        q: &G::Point,
    ) -> Location {
        let is_full = triangulation.is_full() && triangulation.geometry.admits(q);
        let start = self.start(triangulation).filter(|_| is_full);
        let cell = start.and_then(|from| {
            let Ok(cell) = line::last_cell(triangulation, from, q);
            cell
        });
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
        // The line meets no triangle twice, unless predicates contradict each other.
        for _ in 0..self.tds.cell_slots() {
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
            i = if side(self.tds.vertex(beyond, j)) == Sign::Negative {
                cw(j)
            } else {
                ccw(j)
            };
            cell = beyond;
        }
        Some(cell)
    }
}
