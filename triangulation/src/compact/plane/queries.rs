//! Queries of a compact triangulation of the plane that have another form in space.

use crate::compact::{Compact, CompactError};
use crate::geometry::{Coordinates, Geometry};
use crate::query::{self, Passage};
use crate::tds::{CellId, VertexId, plane};

impl<G: Geometry<3, Point = [f64; D]>, B: AsRef<[u8]>, const D: usize> Compact<G, B> {
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
    ) -> Result<impl Iterator<Item = Result<Passage, CompactError>> + use<'_, G, B, D>, CompactError>
    {
        query::along(self, ends, near)
    }

    /// Returns the vertices in a rectangle; see
    /// [`Triangulation::within_rectangle`](crate::Triangulation::within_rectangle).
    ///
    /// # Errors
    /// If a cell or vertex that is met is damaged.
    pub fn within_rectangle(&self, corners: [&[f64; D]; 2]) -> Result<Vec<VertexId>, CompactError>
    where
        G: Coordinates<3>,
    {
        query::within_rectangle(self, corners, None)
    }

    /// Returns all finite faces, in constant memory; see
    /// [`Triangulation::faces_from`](crate::Triangulation::faces_from). Ends at the
    /// first error.
    ///
    /// # Errors
    /// If the vertex does not exist, or its cell or point is damaged.
    pub fn faces_from(
        &self,
        start: VertexId,
    ) -> Result<impl Iterator<Item = Result<CellId, CompactError>> + use<'_, G, B, D>, CompactError>
    where
        G: Coordinates<3>,
    {
        if start == VertexId::INFINITE {
            return Err(CompactError::Vertex(start)); // a number that is out of range is found by the query
        }
        query::faces_from(self, start)
    }

    /// Returns the vertices that share an edge with a vertex, counter-clockwise, the infinite one
    /// included; those around [`INFINITE`](VertexId::INFINITE), on the hull, are clockwise. Ends at
    /// the first error.
    ///
    /// # Errors
    /// If the vertex does not exist, or its cell is damaged.
    pub fn vertices_around(
        &self,
        vertex: VertexId,
    ) -> Result<impl DoubleEndedIterator<Item = Result<VertexId, CompactError>> + '_, CompactError>
    {
        plane::vertices_around(self, vertex)
    }

    /// Returns the cell to the left of an edge; see [`Tds::edge`](crate::tds::Tds::edge).
    ///
    /// # Errors
    /// If a cell around the first vertex is damaged.
    pub fn edge(&self, a: VertexId, b: VertexId) -> Result<Option<(CellId, usize)>, CompactError> {
        plane::edge(self, a, b)
    }

    /// Returns the face with three vertices; see [`Tds::face`](crate::tds::Tds::face).
    ///
    /// # Errors
    /// If a cell around the first vertex is damaged.
    pub fn face(&self, corners: [VertexId; 3]) -> Result<Option<CellId>, CompactError> {
        plane::face(self, corners)
    }
}
