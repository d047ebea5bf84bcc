//! Queries of a compact triangulation: those of the other kinds, each of which may end with an
//! error where bytes are damaged.

use crate::geometry::{Coordinates, Geometry, Metric};
use crate::tds::{CellId, Neighbors, VertexId, plane};

use super::super::Location;
use super::super::query::{self, ConflictZone, Passage};
use super::{Compact, CompactError, Law};

impl<G: Geometry<3, Point = [f64; D]>, B: AsRef<[u8]>, const D: usize> Compact<G, B> {
    /// Returns all that a segment meets, in order; see
    /// [`Triangulation::along`](crate::triangulation::Triangulation::along). Ends at the first
    /// error.
    ///
    /// # Errors
    /// If a cell or vertex that is met is damaged.
    pub fn along(
        &self,
        ends: [&[f64; D]; 2],
        near: Option<CellId>,
    ) -> Result<impl Iterator<Item = Result<Passage, CompactError>> + use<'_, G, B, D>, CompactError> {
        query::along(self, ends, near)
    }

    /// Returns the vertices in a rectangle; see
    /// [`Triangulation::within_rectangle`](crate::triangulation::Triangulation::within_rectangle).
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
    /// [`Triangulation::faces_from`](crate::triangulation::Triangulation::faces_from). Ends at the
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
    ) -> Result<impl DoubleEndedIterator<Item = Result<VertexId, CompactError>> + '_, CompactError> {
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

impl<G: Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize> Compact<G, B, N> {
    /// Returns where a point lies; see
    /// [`Triangulation::locate`](crate::triangulation::Triangulation::locate). A long walk
    /// continues from the nearest of `n^(1/3)` of the `n` vertices.
    ///
    /// # Errors
    /// If a cell or vertex that the walk meets is damaged.
    pub fn locate(&self, q: &[f64; D], near: Option<CellId>) -> Result<Location, CompactError> {
        query::locate(self, q, near)
    }

    /// Returns what the insertion of a point would destroy; see
    /// [`Delaunay::conflict_zone`](crate::Delaunay::conflict_zone) and
    /// [`ConstrainedDelaunay::conflict_zone`](crate::ConstrainedDelaunay::conflict_zone).
    ///
    /// # Errors
    /// If a cell or vertex that is met is damaged, or if the law is not one of these two.
    pub fn conflict_zone(&self, q: &[f64; D], near: Option<CellId>) -> Result<Option<ConflictZone>, CompactError> {
        match self.law() {
            Law::Delaunay | Law::ConstrainedDelaunay => {
                let passes = |cell, i| Ok(!self.is_constrained(cell, i)?);
                query::conflict_zone(self, q, near, passes)
            }
            law => Err(CompactError::Unanswerable(law)),
        }
    }
}

impl<G: Metric<N> + Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize> Compact<G, B, N>
where
    Self: Neighbors<N, Error = CompactError>,
{
    /// Returns the vertex nearest to a point; see
    /// [`Delaunay::nearest`](crate::triangulation::Delaunay::nearest).
    ///
    /// # Errors
    /// If a cell or vertex that is met is damaged, or if the law is not that of a Delaunay
    /// triangulation.
    pub fn nearest(&self, q: &[f64; D], near: Option<CellId>) -> Result<Option<VertexId>, CompactError> {
        self.demand_delaunay()?;
        query::nearest(self, q, near)
    }

    /// Returns all vertices, nearest first; see
    /// [`Delaunay::nearest_first`](crate::triangulation::Delaunay::nearest_first). Ends at the
    /// first error.
    ///
    /// # Errors
    /// Those of [`nearest`](Self::nearest).
    pub fn nearest_first(
        &self,
        q: &[f64; D],
        near: Option<CellId>,
    ) -> Result<impl Iterator<Item = Result<VertexId, CompactError>> + use<'_, G, B, N, D>, CompactError> {
        self.demand_delaunay()?;
        query::nearest_first(self, q, near)
    }

    /// Returns the vertices in a circle, nearest first; see
    /// [`Delaunay::within`](crate::triangulation::Delaunay::within). Ends at the first error.
    ///
    /// # Errors
    /// Those of [`nearest`](Self::nearest).
    pub fn within(
        &self,
        center: &[f64; D],
        rim: &[f64; D],
    ) -> Result<impl Iterator<Item = Result<VertexId, CompactError>> + use<'_, G, B, N, D>, CompactError> {
        self.demand_delaunay()?;
        query::within(self, center, rim, None)
    }

    fn demand_delaunay(&self) -> Result<(), CompactError> {
        match self.law() {
            Law::Delaunay => Ok(()),
            law => Err(CompactError::Unanswerable(law)),
        }
    }
}
