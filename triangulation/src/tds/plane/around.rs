//! Edges, the faces and vertices around a vertex, and the hull, in the plane.
//!
//! Orders are functions of the cells' numbers, so triangulations that were built alike are iterated
//! alike. Iterators around a vertex run counter-clockwise, starting from a cell of it
//! ([`Tds::cell_of`]). [`rev`](Iterator::rev) reverses them: clockwise, ending with that cell.
//!
//! | dimension | edges | around a vertex | hull |
//! |---|---|---|---|
//! | 2 | two faces each | faces, edges, vertices, the infinite ones included | the ring of its vertices |
//! | 1 | the cells | no faces, two edges, two vertices (the infinite one next to an end) | both ends |
//! | 0 | none | nothing | the vertex |
//! | -1 | none | nothing | nothing |

use std::iter::FusedIterator;

use crate::tds::counted::counted;
use crate::tds::plane::{self, Star};
use crate::tds::{CellId, Tds, VertexId, ccw, cw};

impl<V, C: Copy + Default> Tds<3, V, C> {
    /// Returns the ends of the edge opposite vertex `i` of a cell. From the first to the second,
    /// the cell is on the left.
    #[inline(always)]
    pub fn edge_ends(&self, cell: CellId, i: usize) -> [VertexId; 2] {
        [self.vertex(cell, ccw(i)), self.vertex(cell, cw(i))]
    }

    /// All edges, each once, as a cell that has the edge and the index of the vertex opposite to
    /// it.
    ///
    /// They are in order of these pairs; of the two faces that have an edge, the one with the
    /// smaller number is returned. On a line an edge is a cell, and the index is 2, which is no
    /// vertex of it; [`edge_ends`](Self::edge_ends) accepts both.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = (CellId, usize)> + '_ {
        let (indices, count) = match self.dimension {
            2 => (0..3, self.cell_count() / 2 * 3),
            1 => (2..3, self.cell_count()),
            _ => (0..0, 0),
        };
        let sides = self
            .cells()
            .flat_map(move |cell| indices.clone().map(move |i| (cell, i)));
        counted(
            sides.filter(|&(cell, i)| self.dimension == 1 || cell < self.neighbor(cell, i)),
            count,
        )
    }

    /// The edges without the infinite vertex, each once, in the order of [`edges`](Self::edges).
    ///
    /// They are fewer than all edges by the [`degree`](Self::degree) of the infinite vertex. The
    /// cell may be an infinite one.
    pub fn finite_edges(&self) -> impl Iterator<Item = (CellId, usize)> + '_ {
        self.edges()
            .filter(|&(cell, i)| !self.edge_ends(cell, i).contains(&VertexId::INFINITE))
    }

    /// The finite and infinite faces around a vertex, counter-clockwise. Empty below dimension 2.
    pub fn around(
        &self,
        vertex: VertexId,
    ) -> impl DoubleEndedIterator<Item = CellId> + FusedIterator + '_ {
        self.corners_around(vertex).map(|(cell, _)| cell)
    }

    /// The finite and infinite faces around a vertex, counter-clockwise, each with the index of the
    /// vertex in it. Empty below dimension 2.
    pub fn corners_around(
        &self,
        vertex: VertexId,
    ) -> impl DoubleEndedIterator<Item = (CellId, usize)> + FusedIterator + '_ {
        let Ok(star) = Star::new(self, vertex, 2);
        star.map(|Ok(corner)| corner)
    }

    /// The edges that start at a vertex, counter-clockwise, each as the face on its left and the
    /// index of the vertex opposite.
    ///
    /// Edges to the infinite vertex are included. On a line, edges are given as in
    /// [`edges`](Self::edges).
    pub fn edges_around(
        &self,
        vertex: VertexId,
    ) -> impl DoubleEndedIterator<Item = (CellId, usize)> + '_ {
        let Ok(edges) = plane::edges_around(self, vertex);
        edges.map(|Ok(edge)| edge)
    }

    /// The vertices that a vertex is joined to by an edge, counter-clockwise, the infinite one
    /// included.
    pub fn vertices_around(
        &self,
        vertex: VertexId,
    ) -> impl DoubleEndedIterator<Item = VertexId> + '_ {
        let Ok(vertices) = plane::vertices_around(self, vertex);
        vertices.map(|Ok(v)| v)
    }

    /// The number of edges at a vertex, including that to the infinite vertex. Time proportional to
    /// it.
    pub fn degree(&self, vertex: VertexId) -> usize {
        self.vertices_around(vertex).count()
    }

    /// The vertices on the convex hull, counter-clockwise, including those in the interior of its
    /// sides. For collinear points these are both ends.
    pub fn hull(&self) -> impl DoubleEndedIterator<Item = VertexId> + '_ {
        let only = if self.dimension == 0 {
            self.vertices().next()
        } else {
            None
        };
        // The infinite vertex sees the plane from behind.
        only.into_iter()
            .chain(self.vertices_around(VertexId::INFINITE).rev())
    }

    /// Returns the cell to the left of the directed edge `a b` and the index of the edge in it
    /// (that of the vertex opposite), or `None` if there is no such edge or the dimension is not 2.
    ///
    /// Time proportional to the degree of `a`; where that is high, to the smaller of both degrees.
    pub fn edge(&self, a: VertexId, b: VertexId) -> Option<(CellId, usize)> {
        let Ok(edge) = plane::edge(self, a, b);
        edge
    }

    /// Returns true if the degree of `a` is high, and higher than that of `b`. Time proportional to
    /// the smaller degree.
    pub(crate) fn is_busier(&self, a: VertexId, b: VertexId) -> bool {
        let Ok(is_busier) = plane::is_busier(self, a, b);
        is_busier
    }

    /// Returns true if two vertices, one of which may be the infinite one, are joined by an edge.
    /// Time proportional to the degree of `a`.
    pub fn has_edge(&self, a: VertexId, b: VertexId) -> bool {
        self.vertices_around(a).any(|v| v == b)
    }

    /// Returns the face with these three vertices, in any order, one of which may be the infinite
    /// one. Time proportional to the degree of the first.
    pub fn face(&self, corners: [VertexId; 3]) -> Option<CellId> {
        let Ok(face) = plane::face(self, corners);
        face
    }

    /// Returns true if three vertices, in any order, are those of a [`face`](Self::face).
    pub fn is_face(&self, corners: [VertexId; 3]) -> bool {
        self.face(corners).is_some()
    }
}
