//! Queries of a compact triangulation of space that have another form in the plane.

use crate::compact::{Compact, CompactError};
use crate::geometry::{Coordinates, Geometry};
use crate::query::{self, SpacePassage};
use crate::tds::space::{self, Edge};
use crate::tds::{CellId, VertexId};

impl<G: Geometry<4, Point = [f64; D]>, B: AsRef<[u8]>, const D: usize> Compact<G, B, 4> {
    /// Returns all that a segment meets, in order; see
    /// [`Triangulation::along`](crate::Triangulation::along). Ends at the first
    /// error.
    ///
    /// # Errors
    /// If a cell or vertex that is met is damaged.
    pub fn along(
        &self,
        ends: [&[f64; D]; 2],
        near: Option<CellId>,
    ) -> Result<
        impl Iterator<Item = Result<SpacePassage, CompactError>> + use<'_, G, B, D>,
        CompactError,
    > {
        query::along_in_space(self, ends, near)
    }

    /// Returns the vertices in a box; see
    /// [`Triangulation::within_box`](crate::Triangulation::within_box).
    ///
    /// # Errors
    /// If a cell or vertex that is met is damaged.
    pub fn within_box(&self, corners: [&[f64; D]; 2]) -> Result<Vec<VertexId>, CompactError>
    where
        G: Coordinates<4>,
    {
        query::within_box(self, corners, None)
    }

    /// Returns the cells that have a vertex, each with the index of the vertex in it; see
    /// [`Tds::cells_around`](crate::tds::Tds::cells_around).
    ///
    /// # Errors
    /// If the vertex does not exist, or a cell around it is damaged.
    pub fn cells_around(&self, vertex: VertexId) -> Result<Vec<(CellId, usize)>, CompactError> {
        space::cells_around(self, vertex)
    }

    /// Returns the vertices that a vertex is joined to by an edge, the infinite one included, in
    /// order of their numbers.
    ///
    /// # Errors
    /// If the vertex does not exist, or a cell around it is damaged.
    pub fn vertices_around(&self, vertex: VertexId) -> Result<Vec<VertexId>, CompactError> {
        space::vertices_around(self, vertex)
    }

    /// Returns the cells around an edge; see
    /// [`Tds::cells_around_edge`](crate::tds::Tds::cells_around_edge). Ends at the first error.
    ///
    /// # Errors
    /// If the cell does not exist or is damaged.
    pub fn cells_around_edge(
        &self,
        edge: Edge,
    ) -> Result<impl DoubleEndedIterator<Item = Result<Edge, CompactError>> + '_, CompactError>
    {
        space::cells_around_edge(self, edge)
    }

    /// Returns a cell that has these vertices, two to four different ones; `None` if there is none.
    ///
    /// # Errors
    /// If a cell around the first vertex is damaged.
    pub fn cell_with(&self, vertices: &[VertexId]) -> Result<Option<CellId>, CompactError> {
        space::cell_with(self, vertices)
    }
}
