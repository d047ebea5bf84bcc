//! Which part of a solid a simplex is. All of it follows from the cells that have the simplex.

use super::AlphaShape;
use crate::tds::space::Edge;
use crate::tds::{CellId, VertexId};

/// The part of a solid that a cell, a facet, an edge or a vertex is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AlphaState {
    /// None: no cell of the solid has it.
    Exterior,
    /// A part of the surface.
    Regular,
    /// Inside: all cells that have it are in the solid.
    Interior,
}

impl<V, C: Copy + Default> AlphaShape<'_, V, C> {
    /// Returns the part of the solid that a cell is: [`Exterior`](AlphaState::Exterior) or
    /// [`Interior`](AlphaState::Interior).
    pub fn classify_cell(&self, cell: CellId) -> AlphaState {
        self.classify([cell].into_iter())
    }

    /// Returns the part of the solid that a facet is, given as in
    /// [`Tds::facets`](crate::tds::Tds::facets).
    ///
    /// # Panics
    /// If the cell does not exist or the index is 4 or more.
    pub fn classify_facet(&self, (cell, i): (CellId, usize)) -> AlphaState {
        self.classify([cell, self.shapes.tds.neighbor(cell, i)].into_iter())
    }

    /// Returns the part of the solid that an edge is, given as in
    /// [`Tds::edges`](crate::tds::Tds::edges). Linear in the number of cells around it.
    ///
    /// # Panics
    /// If the cell does not exist or an index is 4 or more.
    pub fn classify_edge(&self, edge: Edge) -> AlphaState {
        self.classify(
            self.shapes
                .tds
                .cells_around_edge(edge)
                .map(|(cell, ..)| cell),
        )
    }

    /// Returns the part of the solid that a vertex is; a hidden one is
    /// [`Exterior`](AlphaState::Exterior). Linear in the number of cells around it.
    ///
    /// # Panics
    /// If the vertex does not exist.
    pub fn classify_vertex(&self, vertex: VertexId) -> AlphaState {
        self.classify(
            self.shapes
                .tds
                .cells_around(vertex)
                .into_iter()
                .map(|(cell, _)| cell),
        )
    }

    /// Returns the part of the solid that a simplex is, from the cells that have it.
    fn classify(&self, cells: impl Iterator<Item = CellId>) -> AlphaState {
        let (mut any, mut all) = (false, true);
        for cell in cells {
            // In dimension 2 a triangle has no fourth neighbor.
            let is_contained = self.contains(cell);
            any |= is_contained;
            all &= is_contained;
        }
        match (any, all) {
            (true, true) => AlphaState::Interior,
            (true, false) => AlphaState::Regular,
            (false, _) => AlphaState::Exterior,
        }
    }
}
