//! The questions of the other kinds, which damage may answer.

use crate::geometry::{Coordinates, Geometry, Metric};
use crate::tds::{self, CellId, VertexId};

use super::super::query::{self, Along, ConflictZone, Faces, NearestFirst, Passage};
use super::super::{Location, locate};
use super::{Compact, Damaged, Law};

impl<G: Geometry<3, Point = [f64; D]>, B: AsRef<[u8]>, const D: usize> Compact<G, B> {
    /// Where a point lies: see [`Triangulation::locate`](crate::triangulation::Triangulation::locate). Without a cell
    /// nearby, a long walk goes on from the nearest of `n^(1/3)` of the `n` vertices.
    ///
    /// # Errors
    /// If what it meets is damaged.
    pub fn locate(&self, q: &[f64; D], near: Option<CellId>) -> Result<Location, Damaged> {
        locate::walk(self, q, near)
    }

    /// All that a segment meets: see [`Triangulation::along`](crate::triangulation::Triangulation::along). Ends at
    /// the first error.
    ///
    /// # Errors
    /// If what it meets is damaged.
    pub fn along(
        &self,
        [a, b]: [&[f64; D]; 2],
        near: Option<CellId>,
    ) -> Result<impl Iterator<Item = Result<Passage, Damaged>> + use<'_, G, B, D>, Damaged> {
        let location = if self.dimension() == 2 { self.locate(a, near)? } else { Location::OutsideAffineHull };
        Ok(Along::new(self, [a, b], location))
    }

    /// The vertices in a rectangle: see
    /// [`Triangulation::within_rectangle`](crate::triangulation::Triangulation::within_rectangle).
    ///
    /// # Errors
    /// If what it meets is damaged.
    pub fn within_rectangle(&self, corners: [&[f64; D]; 2]) -> Result<Vec<VertexId>, Damaged>
    where
        G: Coordinates<3>,
    {
        query::within_rectangle(self, corners, self.locate(corners[0], None)?)
    }

    /// All finite faces in constant memory: see
    /// [`Triangulation::faces_from`](crate::triangulation::Triangulation::faces_from). Ends at the first error.
    ///
    /// # Errors
    /// If there is no such vertex, or its cell or its point cannot be.
    pub fn faces_from(
        &self,
        start: VertexId,
    ) -> Result<impl Iterator<Item = Result<CellId, Damaged>> + use<'_, G, B, D>, Damaged>
    where
        G: Coordinates<3>,
    {
        Faces::new(self, start)
    }

    /// The vertices that a vertex has an edge to, counter-clockwise, the infinite one included; of
    /// [`INFINITE`](VertexId::INFINITE) those on the hull, clockwise. Ends at the first error.
    ///
    /// # Errors
    /// If there is no such vertex, or its cell cannot be.
    pub fn vertices_around(
        &self,
        vertex: VertexId,
    ) -> Result<impl DoubleEndedIterator<Item = Result<VertexId, Damaged>> + '_, Damaged> {
        tds::vertices_around(self, vertex)
    }

    /// The cell to the left of an edge: see [`Tds::edge`](crate::tds::Tds::edge).
    ///
    /// # Errors
    /// If what is around the first vertex is damaged.
    pub fn edge(&self, a: VertexId, b: VertexId) -> Result<Option<(CellId, usize)>, Damaged> {
        tds::edge(self, a, b)
    }

    /// The face with these vertices: see [`Tds::face`](crate::tds::Tds::face).
    ///
    /// # Errors
    /// If what is around the first vertex is damaged.
    pub fn face(&self, corners: [VertexId; 3]) -> Result<Option<CellId>, Damaged> {
        tds::face(self, corners)
    }

    /// What a new point would destroy: see [`Delaunay::conflict_zone`](crate::triangulation::Delaunay::conflict_zone)
    /// and [`ConstrainedDelaunay::conflict_zone`](crate::triangulation::ConstrainedDelaunay::conflict_zone).
    ///
    /// # Errors
    /// If what it meets is damaged, and on other kinds.
    pub fn conflict_zone(&self, q: &[f64; D], near: Option<CellId>) -> Result<Option<ConflictZone>, Damaged> {
        match self.law() {
            Law::Delaunay | Law::ConstrainedDelaunay => {
                let passes = |cell, i| Ok(!self.is_constrained(cell, i)?);
                query::zone_at(self, q, self.locate(q, near)?, passes)
            }
            law => Err(Damaged::Unanswerable(law)),
        }
    }
}

impl<G: Metric + Geometry<3, Point = [f64; D]>, B: AsRef<[u8]>, const D: usize> Compact<G, B> {
    /// The vertex nearest to a place: see [`Delaunay::nearest`](crate::triangulation::Delaunay::nearest).
    ///
    /// # Errors
    /// If what it meets is damaged, and on other kinds than Delaunay triangulations.
    pub fn nearest(&self, q: &[f64; D], near: Option<CellId>) -> Result<Option<VertexId>, Damaged> {
        self.demand_delaunay()?;
        query::nearest(self, q, self.locate(q, near)?)
    }

    /// All vertices from the nearest on: see
    /// [`Delaunay::nearest_first`](crate::triangulation::Delaunay::nearest_first). Ends at the first error.
    ///
    /// # Errors
    /// See [`nearest`](Self::nearest).
    pub fn nearest_first(
        &self,
        q: &[f64; D],
        near: Option<CellId>,
    ) -> Result<impl Iterator<Item = Result<VertexId, Damaged>> + use<'_, G, B, D>, Damaged> {
        self.demand_delaunay()?;
        let nearest = NearestFirst::new(self, q, self.locate(q, near)?)?;
        Ok(nearest.map(|candidate| Ok(candidate?.vertex)))
    }

    /// The vertices in a circle: see [`Delaunay::within`](crate::triangulation::Delaunay::within). Ends at the first
    /// error.
    ///
    /// # Errors
    /// See [`nearest`](Self::nearest).
    pub fn within(
        &self,
        center: &[f64; D],
        rim: &[f64; D],
    ) -> Result<impl Iterator<Item = Result<VertexId, Damaged>> + use<'_, G, B, D>, Damaged> {
        self.demand_delaunay()?;
        let location = if self.geometry.admits(rim) { self.locate(center, None)? } else { Location::Nowhere };
        let nearest = NearestFirst::new(self, center, location)?;
        let rim = *rim;
        let is_within = move |candidate: &Result<_, Damaged>| {
            candidate.as_ref().map_or(true, |candidate: &query::Candidate<'_, Self>| candidate.is_within(&rim))
        };
        Ok(nearest.take_while(is_within).map(|candidate| Ok(candidate?.vertex)))
    }

    fn demand_delaunay(&self) -> Result<(), Damaged> {
        match self.law() {
            Law::Delaunay => Ok(()),
            law => Err(Damaged::Unanswerable(law)),
        }
    }
}
