//! Insertion, written once: the zone that a point is in conflict with is replaced by the point's star. The kinds say
//! how far the zone goes.

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, Zone};

use super::super::{Location, MAX_VERTICES, Refused, Triangulation};

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Checks that a point may come in.
    pub(in super::super) fn admit(&self, p: &G::Point) -> Result<(), Refused> {
        if !self.geometry.admits(p) {
            return Err(Refused::Coordinate(self.vertex_count()));
        }
        if self.tds.vertex_slots() >= MAX_VERTICES {
            return Err(Refused::TooMany);
        }
        Ok(())
    }

    /// A vertex that is in no cell yet.
    pub(in super::super) fn add_vertex(&mut self, p: G::Point, data: V) -> VertexId {
        let vertex = self.tds.add_vertex(data);
        match self.points.get_mut(vertex.index()) {
            Some(place) => *place = p, // the hole of a removed one; or a bulk construction has put it there
            None => self.points.push(p),
        }
        vertex
    }

    /// The vertex that was removed last, with its payload and another point; in no cell yet.
    pub(in super::super) fn restore_vertex(&mut self, p: G::Point) -> Option<VertexId> {
        let vertex = self.tds.restore_vertex()?;
        self.points[vertex.index()] = p;
        Some(vertex)
    }

    /// Adds a point unless its site is taken, given where it is; see [`connect`](Self::connect).
    pub(in super::super) fn insert_at(
        &mut self,
        p: G::Point,
        location: Location,
        vertex_data: V,
        takes: impl Fn(&Self, CellId, usize, CellId) -> bool,
        data: impl Fn(&C, usize) -> C,
    ) -> VertexId {
        if let Location::Vertex(vertex) = location {
            return vertex;
        }
        let vertex = self.add_vertex(p, vertex_data);
        self.connect(vertex, location, takes, data);
        vertex
    }

    /// Whether a finite cell has the point inside or on its border, or an infinite one has its facet in the point's
    /// sight or under it.
    pub(in super::super) fn is_split_by(&self, cell: CellId, p: &G::Point) -> bool {
        let vertices = self.tds.cell_vertices(cell);
        match vertices.iter().position(|&v| v == VertexId::INFINITE) {
            None => (0..vertices.len()).all(|i| self.side_of_facet(cell, i, p) != Sign::Negative),
            Some(_) if vertices.len() == 2 => self.in_conflict(cell, p), // the end of a line
            Some(infinite) => match self.side_of_facet(cell, infinite, p) {
                Sign::Positive => true,
                Sign::Zero => self.is_split_by(self.tds.neighbor(cell, infinite), p), // in the facet or beside it
                Sign::Negative => false,
            },
        }
    }

    /// Makes an added vertex part of the complex, given where its point is. The zone that its star replaces grows from
    /// there over the facets that `takes` accepts (asked with the cell within, the index of the facet, and the cell
    /// beyond); `data` says what the cells of the star inherit, from the cell that had a facet and the facet's index.
    ///
    /// Expected time proportional to the number of cells replaced.
    pub(in super::super) fn connect(
        &mut self,
        vertex: VertexId,
        location: Location,
        takes: impl Fn(&Self, CellId, usize, CellId) -> bool,
        data: impl Fn(&C, usize) -> C,
    ) {
        let Some(mut zone) = self.collect(location, takes) else {
            return self.raise_dimension(vertex);
        };
        self.last = self.tds.star(&mut zone, vertex, data).last().copied();
        self.zone = zone;
    }

    /// The zone of a point, given where it is; `None` if it is outside of the flat that all others span. To be given
    /// back for the next time.
    pub(in super::super) fn collect(
        &mut self,
        location: Location,
        takes: impl Fn(&Self, CellId, usize, CellId) -> bool,
    ) -> Option<Zone> {
        let (cell, touching) = match location {
            Location::OutsideAffineHull | Location::Nowhere => return None,
            Location::Vertex(vertex) => (self.tds.cell_of(vertex)?, 0),
            Location::Cell { cell, touching } => (cell, touching),
            Location::OutsideHull { cell } => (cell, 0),
        };
        let mut zone = std::mem::take(&mut self.zone);
        zone.grow(&self.tds, cell, |from, i, beyond| {
            // A point on a facet destroys the cells on both sides, wall or not.
            from == cell && touching >> i & 1 == 1 || takes(self, from, i, beyond)
        });
        Some(zone)
    }

    /// Joins an added vertex outside of what the others span.
    pub(in super::super) fn raise_dimension(&mut self, vertex: VertexId) {
        self.tds.raise_dimension(vertex);
        let finite = self.finite_cells().next();
        if let Some(cell) = finite.filter(|_| self.dimension() > 0) {
            let positive = if self.is_full() {
                self.geometry.orientation(self.simplex(cell)) == Sign::Positive
            } else {
                let simplex: Vec<_> = self.tds.cell_vertices(cell).iter().map(|&v| self.point(v)).collect();
                self.geometry.orientation_in_flat(&simplex) == Sign::Positive
            };
            if !positive {
                self.tds.mirror_all();
            }
        }
        self.last = finite;
    }
}
