//! Queries of a compact triangulation that are the same in the plane and in space: those of the
//! other kinds, each of which may end with an error where bytes are damaged.

use crate::geometry::{Geometry, Metric};
use crate::locate::Location;
use crate::query::{self, ConflictZone};
use crate::tds::{CellId, Neighbors, VertexId};

use super::{Compact, CompactError, Law};

impl<G: Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize>
    Compact<G, B, N>
{
    /// Returns where a point lies; see
    /// [`Triangulation::locate`](crate::Triangulation::locate). A long walk
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
    pub fn conflict_zone(
        &self,
        q: &[f64; D],
        near: Option<CellId>,
    ) -> Result<Option<ConflictZone>, CompactError> {
        match self.law() {
            Law::Delaunay | Law::ConstrainedDelaunay => {
                let passes = |cell, i| Ok(!self.is_constrained(cell, i)?);
                query::conflict_zone(self, q, near, passes)
            }
            law => Err(CompactError::Unanswerable(law)),
        }
    }
}

impl<G: Metric<N> + Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize>
    Compact<G, B, N>
where
    Self: Neighbors<N, Error = CompactError>,
{
    /// Returns the vertex nearest to a point; see
    /// [`Delaunay::nearest`](crate::Delaunay::nearest).
    ///
    /// # Errors
    /// If a cell or vertex that is met is damaged, or if the law is not that of a Delaunay
    /// triangulation.
    pub fn nearest(
        &self,
        q: &[f64; D],
        near: Option<CellId>,
    ) -> Result<Option<VertexId>, CompactError> {
        self.demand_delaunay()?;
        query::nearest(self, q, near)
    }

    /// Returns all vertices, nearest first; see
    /// [`Delaunay::nearest_first`](crate::Delaunay::nearest_first). Ends at the
    /// first error.
    ///
    /// # Errors
    /// Those of [`nearest`](Self::nearest).
    pub fn nearest_first(
        &self,
        q: &[f64; D],
        near: Option<CellId>,
    ) -> Result<
        impl Iterator<Item = Result<VertexId, CompactError>> + use<'_, G, B, N, D>,
        CompactError,
    > {
        self.demand_delaunay()?;
        query::nearest_first(self, q, near)
    }

    /// Returns the vertices in a circle, nearest first; see
    /// [`Delaunay::within`](crate::Delaunay::within). Ends at the first error.
    ///
    /// # Errors
    /// Those of [`nearest`](Self::nearest).
    pub fn within(
        &self,
        center: &[f64; D],
        rim: &[f64; D],
    ) -> Result<
        impl Iterator<Item = Result<VertexId, CompactError>> + use<'_, G, B, N, D>,
        CompactError,
    > {
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
