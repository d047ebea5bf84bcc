//! Edges, the faces and vertices around a vertex, and the hull, in the plane.
//!
//! Orders are functions of the cells' numbers, so that a triangulation that was built alike is walked alike. What is
//! around a vertex comes counter-clockwise from a cell of it ([`Tds::cell_of`]); [`rev`](Iterator::rev) turns that
//! around: clockwise, ending with that cell.
//!
//! | dimension | edges | around a vertex | hull |
//! |---|---|---|---|
//! | 2 | two faces each | faces, edges, vertices, the infinite ones included | the ring of its vertices |
//! | 1 | the cells | no faces, two edges, two vertices (the infinite one beside an end) | both ends |
//! | 0 | none | nothing | the vertex |
//! | -1 | none | nothing | nothing |

use std::iter::FusedIterator;

use super::plane::{self, Star};
use super::{CellId, Tds, VertexId, ccw, cw};

/// An iterator that knows how many items are left.
struct Counted<I> {
    items: I,
    left: usize,
}

impl<I: Iterator> Iterator for Counted<I> {
    type Item = I::Item;

    #[inline]
    fn next(&mut self) -> Option<I::Item> {
        let item = self.items.next()?;
        self.left -= 1;
        Some(item)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Iterator> ExactSizeIterator for Counted<I> {}

/// An iterator with a known number of items.
pub(super) fn counted<I: Iterator>(items: I, left: usize) -> impl ExactSizeIterator<Item = I::Item> {
    Counted { items, left }
}

impl<V, C: Copy + Default> Tds<3, V, C> {
    /// Returns the ends of the edge opposite vertex `i` of a cell, which has it on its left from the first to the second.
    #[inline(always)]
    pub fn edge_ends(&self, cell: CellId, i: usize) -> [VertexId; 2] {
        [self.vertex(cell, ccw(i)), self.vertex(cell, cw(i))]
    }

    /// All edges, each once: the cell that has it on its border and the index of the vertex opposite. In order of these
    /// pairs, of the two that a face on each side gives the smaller one.
    ///
    /// On a line an edge is a cell, and the index is 2, of no vertex: [`edge_ends`](Self::edge_ends) takes both.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = (CellId, usize)> + '_ {
        let (indices, count) = match self.dimension {
            2 => (0..3, self.cell_count() / 2 * 3),
            1 => (2..3, self.cell_count()),
            _ => (0..0, 0),
        };
        let sides = self.cells().flat_map(move |cell| indices.clone().map(move |i| (cell, i)));
        counted(sides.filter(|&(cell, i)| self.dimension == 1 || cell < self.neighbor(cell, i)), count)
    }

    /// The edges without the infinite vertex, each once, in the order of [`edges`](Self::edges): of these it leaves out
    /// as many as the infinite vertex has [`degree`](Self::degree). The cell may be an infinite one.
    pub fn finite_edges(&self) -> impl Iterator<Item = (CellId, usize)> + '_ {
        self.edges().filter(|&(cell, i)| !self.edge_ends(cell, i).contains(&VertexId::INFINITE))
    }

    /// The finite and infinite faces around a vertex, counter-clockwise. Empty below dimension 2.
    pub fn around(&self, vertex: VertexId) -> impl DoubleEndedIterator<Item = CellId> + FusedIterator + '_ {
        self.corners_around(vertex).map(|(cell, _)| cell)
    }

    /// Like [`around`](Self::around), each with the index of the vertex in it.
    pub fn corners_around(
        &self,
        vertex: VertexId,
    ) -> impl DoubleEndedIterator<Item = (CellId, usize)> + FusedIterator + '_ {
        let Ok(star) = Star::new(self, vertex, 2);
        star.map(|Ok(corner)| corner)
    }

    /// The edges that start at a vertex, counter-clockwise, each as the face on its left and the index of the vertex
    /// opposite; those to the infinite vertex included. On a line as in [`edges`](Self::edges).
    pub fn edges_around(&self, vertex: VertexId) -> impl DoubleEndedIterator<Item = (CellId, usize)> + '_ {
        let Ok(edges) = plane::edges_around(self, vertex);
        edges.map(|Ok(edge)| edge)
    }

    /// The vertices that a vertex has an edge to, counter-clockwise, the infinite one included.
    pub fn vertices_around(&self, vertex: VertexId) -> impl DoubleEndedIterator<Item = VertexId> + '_ {
        let Ok(vertices) = plane::vertices_around(self, vertex);
        vertices.map(|Ok(v)| v)
    }

    /// The number of edges at a vertex, that to the infinite vertex included. Time proportional to it.
    pub fn degree(&self, vertex: VertexId) -> usize {
        self.vertices_around(vertex).count()
    }

    /// The vertices on the convex hull, those in the middle of its sides included, counter-clockwise from any. Of
    /// collinear points that is both ends.
    pub fn hull(&self) -> impl DoubleEndedIterator<Item = VertexId> + '_ {
        let only = if self.dimension == 0 { self.vertices().next() } else { None };
        // The infinite vertex sees the plane from behind.
        only.into_iter().chain(self.vertices_around(VertexId::INFINITE).rev())
    }

    /// The cell to the left of the directed edge `a b` and the index of the edge in it (that of the
    /// vertex opposite), if there is such an edge and dimension 2. Time proportional to the degree of `a`; where that is
    /// high, to the smaller of both degrees.
    pub fn edge(&self, a: VertexId, b: VertexId) -> Option<(CellId, usize)> {
        let Ok(edge) = plane::edge(self, a, b);
        edge
    }

    /// Whether the degree of a vertex is high, and higher than that of another one. Time proportional to the smaller
    /// degree.
    pub(crate) fn is_busier(&self, a: VertexId, b: VertexId) -> bool {
        let Ok(is_busier) = plane::is_busier(self, a, b);
        is_busier
    }

    /// Whether two vertices, one of which may be the infinite one, are the ends of an edge. Time proportional to the
    /// degree of `a`.
    pub fn has_edge(&self, a: VertexId, b: VertexId) -> bool {
        self.vertices_around(a).any(|v| v == b)
    }

    /// The face with these three vertices, in any order, one of which may be the infinite one. Time proportional to the
    /// degree of the first.
    pub fn face(&self, corners: [VertexId; 3]) -> Option<CellId> {
        let Ok(face) = plane::face(self, corners);
        face
    }

    /// Whether three vertices, in any order, are those of a [`face`](Self::face).
    pub fn is_face(&self, corners: [VertexId; 3]) -> bool {
        self.face(corners).is_some()
    }
}
