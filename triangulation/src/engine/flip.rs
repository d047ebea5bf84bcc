use crate::geometry::{Geometry, in_sphere};
use crate::num::Sign;
use crate::tds::{CellId, Tds, VertexId, ccw, cw};
use crate::triangulation::Triangulation;

use super::constrained_edges::ConstrainedEdges;

/// The constraints on the edges of triangles, as stored in payloads, and what remains of payloads
/// when triangles change.
pub(crate) trait Edges<C>: Copy {
    /// Returns true if the edge opposite vertex `i` must stay.
    fn is_constrained(self, data: &C, i: usize) -> bool;

    /// Returns the payload with the edge opposite vertex `i` constrained or not.
    fn with_constraint(self, data: C, i: usize, is_constrained: bool) -> C;
}

/// The policy of triangulations without constraints, with any payload.
#[derive(Clone, Copy)]
pub(crate) struct NoConstraints;

impl<C> Edges<C> for NoConstraints {
    #[inline(always)]
    fn is_constrained(self, _: &C, _: usize) -> bool {
        false
    }

    #[inline(always)]
    fn with_constraint(self, data: C, _: usize, _: bool) -> C {
        data
    }
}

/// The policy of triangulations with constraints, which are stored in the payload.
#[derive(Clone, Copy)]
pub(crate) struct WithConstraints;

impl<C: Copy> Edges<ConstrainedEdges<C>> for WithConstraints {
    #[inline(always)]
    fn is_constrained(self, data: &ConstrainedEdges<C>, i: usize) -> bool {
        data.has(i)
    }

    #[inline(always)]
    fn with_constraint(
        self,
        data: ConstrainedEdges<C>,
        i: usize,
        is_constrained: bool,
    ) -> ConstrainedEdges<C> {
        data.with(i, is_constrained)
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Flips unconstrained edges until no vertex lies in the circle of its neighbor's triangle
    /// (Lawson 1977). Starts at the given cells, and empties the list.
    ///
    /// ```text
    ///      r                  r
    ///    / | \              /   \
    ///   p  |  s    ==>     p-----s      if s lies in the circle of p q r
    ///    \ | /              \   /
    ///      q                  q
    /// ```
    pub(crate) fn legalize(&mut self, edges: impl Edges<C>, to_legalize: &mut Vec<CellId>) {
        while let Some(cell) = to_legalize.pop() {
            if self.tds.is_infinite(cell) {
                continue;
            }
            let flippable = (0..3).find(|&i| {
                let neighbor = self.tds.neighbor(cell, i);
                if edges.is_constrained(self.tds.cell_data(cell), i)
                    || self.tds.is_infinite(neighbor)
                {
                    return false;
                }
                let far = self
                    .tds
                    .vertex(neighbor, self.tds.index_of_neighbor(neighbor, cell));
                in_sphere(&self.geometry, self.simplex(cell), self.point(far))
            });
            if let Some(i) = flippable {
                let neighbor = self.tds.neighbor(cell, i);
                self.exchange_diagonal(edges, cell, i);
                to_legalize.extend([cell, neighbor]);
            }
        }
    }

    /// Returns true if the two triangles at the edge opposite vertex `i` of a cell form a strictly
    /// convex quadrilateral.
    pub fn is_flippable(&self, cell: CellId, i: usize) -> bool {
        let tds = &self.tds;
        if self.dimension() < 2 || i > 2 || !tds.is_used(cell) {
            return false;
        }
        let neighbor = tds.neighbor(cell, i);
        if tds.is_infinite(cell) || tds.is_infinite(neighbor) {
            return false;
        }
        let [a, b, c] = [i, ccw(i), cw(i)].map(|k| self.point(tds.vertex(cell, k)));
        let d = self.point(tds.vertex(neighbor, tds.index_of_neighbor(neighbor, cell)));
        [[a, b, d], [a, d, c]]
            .into_iter()
            .all(|turn| self.geometry.orientation(turn) == Sign::Positive)
    }

    /// Flips the edge opposite vertex `i` of a cell: exchanges the diagonal of the quadrilateral
    /// around it, which must be convex.
    pub(crate) fn exchange_diagonal(&mut self, edges: impl Edges<C>, cell: CellId, i: usize) {
        let tds = &mut self.tds;
        let neighbor = tds.neighbor(cell, i);
        let j = tds.index_of_neighbor(neighbor, cell);
        // cell = (p, q, r), neighbor = (s, r, q), the edge q r becomes p s.
        let (p, q, r) = (
            tds.vertex(cell, i),
            tds.vertex(cell, ccw(i)),
            tds.vertex(cell, cw(i)),
        );
        let s = tds.vertex(neighbor, j);
        let side = |tds: &Tds<3, V, C>, of: CellId, k: usize| {
            let outside = tds.neighbor(of, k);
            (outside, tds.index_of_neighbor(outside, of))
        };
        let pq = side(tds, cell, cw(i));
        let rp = side(tds, cell, ccw(i));
        let sr = side(tds, neighbor, cw(j));
        let qs = side(tds, neighbor, ccw(j));
        tds.set_corners(cell, [p, q, s]);
        tds.set_corners(neighbor, [p, s, r]);
        tds.link(cell, 1, neighbor, 2);
        self.renew_edges(edges, cell, [(2, pq), (0, qs)]);
        self.renew_edges(edges, neighbor, [(0, sr), (1, rp)]);
    }

    /// Resets a cell's payload and links some of its edges to neighbors, each given with the index
    /// of the edge there. The cell takes over the neighbors' constraints.
    #[inline]
    pub(crate) fn renew_edges<const K: usize>(
        &mut self,
        edges: impl Edges<C>,
        cell: CellId,
        sides: [(usize, (CellId, usize)); K],
    ) {
        *self.tds.cell_data_mut(cell) = C::default();
        for (i, beyond) in sides {
            self.renew_edge(edges, (cell, i), beyond);
        }
    }

    /// Links a cell to a neighbor, and takes over the constraint of their edge from it.
    #[inline]
    pub(crate) fn renew_edge(
        &mut self,
        edges: impl Edges<C>,
        (cell, i): (CellId, usize),
        (neighbor, j): (CellId, usize),
    ) {
        self.tds.link(cell, i, neighbor, j);
        let is_constrained = edges.is_constrained(self.tds.cell_data(neighbor), j);
        let data = self.tds.cell_data_mut(cell);
        *data = edges.with_constraint(*data, i, is_constrained);
    }
}

impl<G: Geometry<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Returns true if the facet opposite vertex `i` of a cell is crossed in its interior by the
    /// line between the vertices on both sides of it: the two tetrahedra then form a convex body
    /// that three others fill, too.
    pub fn is_facet_flippable(&self, cell: CellId, i: usize) -> bool {
        let tds = &self.tds;
        if self.dimension() < 3 || i > 3 || !tds.is_used(cell) {
            return false;
        }
        let neighbor = tds.neighbor(cell, i);
        if tds.is_infinite(cell) || tds.is_infinite(neighbor) {
            return false;
        }
        let far = self.point(tds.vertex(neighbor, tds.index_of_neighbor(neighbor, cell)));
        // Each new cell is the old one with the far vertex in place of a corner of the facet.
        (0..4).filter(|&k| k != i).all(|k| {
            let mut corners = self.simplex(cell);
            corners[k] = far;
            self.geometry.orientation(corners) == Sign::Positive
        })
    }

    /// Returns true if exactly three tetrahedra, all finite, have an edge, and it crosses the
    /// interior of the triangle between the three other vertices: two tetrahedra fill the same
    /// body.
    pub fn is_edge_flippable(&self, ends: [VertexId; 2]) -> bool {
        let tds = &self.tds;
        let Some(cell) = tds.cell_with(&ends).filter(|_| self.dimension() == 3) else {
            return false;
        };
        let [Some(i), Some(j)] = ends.map(|end| tds.index_of(cell, end)) else {
            return false;
        };
        let around: Vec<CellId> = tds
            .cells_around_edge((cell, i, j))
            .take(4)
            .map(|(cell, ..)| cell)
            .collect();
        if around.len() != 3 || around.iter().any(|&cell| tds.is_infinite(cell)) {
            return false;
        }
        // The vertex that the first cell lacks takes the place of either end.
        let lacking = tds
            .corners(around[1])
            .iter()
            .find(|&&v| tds.index_of(cell, v).is_none());
        lacking.is_some_and(|&vertex| {
            [i, j].into_iter().all(|k| {
                let mut corners = self.simplex(cell);
                corners[k] = self.point(vertex);
                self.geometry.orientation(corners) == Sign::Positive
            })
        })
    }
}
