//! Edges, facets, and what is around a vertex or an edge, in space.
//!
//! Orders are functions of the cells' numbers, so triangulations that were built alike are iterated
//! alike.
//!
//! | dimension | facets | edges | around an edge |
//! |---|---|---|---|
//! | 3 | triangles between two cells | sides of triangles | cells in a ring |
//! | 2 | sides of triangles | sides of triangles | nothing |
//! | 1 | the vertices | the cells | nothing |
//! | 0, -1 | none | none | nothing |

use std::iter::FusedIterator;

use crate::tds::space::{self, Edge};
use crate::tds::{CellId, Tds, VertexId};

impl<V, C: Copy + Default> Tds<4, V, C> {
    /// Returns the start and the end of an edge.
    #[inline]
    pub fn edge_ends(&self, edge: Edge) -> [VertexId; 2] {
        let Ok(ends) = space::edge_ends(self, edge);
        ends
    }

    /// All facets, each once, as a cell and the index of the vertex opposite: of the two cells that
    /// have a facet, the one with the smaller number. In order of these pairs.
    pub fn facets(&self) -> impl Iterator<Item = (CellId, usize)> + '_ {
        let width = if self.dimension < 1 {
            0
        } else {
            self.dimension as usize + 1
        };
        let sides = self
            .cells()
            .flat_map(move |cell| (0..width).map(move |i| (cell, i)));
        sides.filter(|&(cell, i)| cell < self.neighbor(cell, i))
    }

    /// The facets without the infinite vertex, each once. The cell may be an infinite one.
    pub fn finite_facets(&self) -> impl Iterator<Item = (CellId, usize)> + '_ {
        self.facets().filter(|&(cell, i)| {
            self.cell_vertices(cell)
                .iter()
                .enumerate()
                .all(|(k, &vertex)| k == i || vertex != VertexId::INFINITE)
        })
    }

    /// All edges, each once, as the cell with the smallest number that has the edge, and the
    /// indices of its ends. In order of these triples.
    ///
    /// # Complexity
    /// Linear in the number of cells. In dimension 3 the iterator holds two bytes for each
    /// [slot](Self::cell_slots) of a cell.
    pub fn edges(&self) -> impl Iterator<Item = Edge> + '_ {
        let pairs: &[(usize, usize)] = match self.dimension {
            3 => &[(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)],
            2 => &[(0, 1), (0, 2), (1, 2)],
            1 => &[(0, 1)],
            _ => &[],
        };
        let edges = self
            .cells()
            .flat_map(move |cell| pairs.iter().map(move |&(i, j)| (cell, i, j)));
        // For each cell a bit for each of its edges that was returned from another cell.
        let mut returned = vec![
            0u16;
            if self.dimension == 3 {
                self.cell_slots()
            } else {
                0
            }
        ];
        let bit_of = |i: usize, j: usize| 1u16 << (4 * i.min(j) + i.max(j));
        edges.filter(move |&(cell, i, j)| match self.dimension {
            3 if returned[cell.index()] & bit_of(i, j) != 0 => false,
            3 => {
                for (other, k, l) in self.cells_around_edge((cell, i, j)).skip(1) {
                    returned[other.index()] |= bit_of(k, l);
                }
                true
            }
            2 => cell < self.neighbor(cell, 3 - i - j),
            _ => true,
        })
    }

    /// The edges without the infinite vertex, each once, in the order of [`edges`](Self::edges).
    /// The cell may be an infinite one.
    pub fn finite_edges(&self) -> impl Iterator<Item = Edge> + '_ {
        self.edges()
            .filter(|&edge| !self.edge_ends(edge).contains(&VertexId::INFINITE))
    }

    /// The cells around an edge, the infinite ones included, counter-clockwise seen from its end,
    /// each with the indices of the edge in it. The given cell is the first. Empty below dimension
    /// 3.
    pub fn cells_around_edge(
        &self,
        edge: Edge,
    ) -> impl DoubleEndedIterator<Item = Edge> + FusedIterator + '_ {
        let Ok(cells) = space::cells_around_edge(self, edge);
        cells.map(|Ok(edge)| edge)
    }

    /// The facets around an edge, counter-clockwise seen from its end, each as a cell and the index
    /// of the vertex opposite: the facet between that cell and the next. Empty below dimension 3.
    pub fn facets_around_edge(
        &self,
        edge: Edge,
    ) -> impl DoubleEndedIterator<Item = (CellId, usize)> + FusedIterator + '_ {
        self.cells_around_edge(edge)
            .map(|(cell, i, j)| (cell, space::beside(i, j)[0]))
    }

    /// The vertices that form a facet with an edge, the infinite one included: the link of the
    /// edge. In dimension 3 they are counter-clockwise seen from its end, in dimension 2 there are
    /// two, below that none.
    pub fn vertices_around_edge(&self, edge: Edge) -> impl Iterator<Item = VertexId> + '_ {
        let (cell, i, j) = edge;
        let sides = (self.dimension == 2 && i != j).then(|| {
            let side = 3 - i - j;
            let beyond = self.neighbor(cell, side);
            [
                self.vertex(cell, side),
                self.vertex(beyond, self.index_of_neighbor(beyond, cell)),
            ]
        });
        let ring = self
            .cells_around_edge(edge)
            .map(|(cell, i, j)| self.vertex(cell, space::beside(i, j)[0]));
        ring.chain(sides.into_iter().flatten())
    }

    /// Returns the cells that have a vertex, the infinite ones included, each with the index of the
    /// vertex in it: its star. The facets opposite the vertex are its link.
    ///
    /// # Complexity
    /// Linear in the number of these cells.
    pub fn cells_around(&self, vertex: VertexId) -> Vec<(CellId, usize)> {
        let Ok(cells) = space::cells_around(self, vertex);
        cells
    }

    /// Returns the vertices that a vertex is joined to by an edge, the infinite one included, in
    /// order of their numbers. O(k log k) for the k cells around the vertex.
    pub fn vertices_around(&self, vertex: VertexId) -> Vec<VertexId> {
        let Ok(vertices) = space::vertices_around(self, vertex);
        vertices
    }

    /// The number of edges at a vertex, including that to the infinite vertex. O(k log k) for the k
    /// cells around the vertex.
    pub fn degree(&self, vertex: VertexId) -> usize {
        self.vertices_around(vertex).len()
    }

    /// Returns a cell that has these vertices, two to four different ones in any order, one of
    /// which may be the infinite one. Linear in the number of cells around the first.
    pub fn cell_with(&self, vertices: &[VertexId]) -> Option<CellId> {
        let Ok(cell) = space::cell_with(self, vertices);
        cell
    }

    /// The facets of the convex hull, each as the infinite cell beyond it and the index of the
    /// infinite vertex. Empty below dimension 3.
    pub fn hull_facets(&self) -> impl Iterator<Item = (CellId, usize)> + '_ {
        let star = if self.dimension < 3 {
            Vec::new()
        } else {
            self.cells_around(VertexId::INFINITE)
        };
        star.into_iter()
    }
}
