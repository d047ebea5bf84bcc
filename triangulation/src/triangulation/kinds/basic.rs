//! The basic kind: [`Triangulation`] itself, without a law.

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, Tds, VertexId, Zone, ccw, cw};

use super::super::engine::flip::Free;
use super::super::{Flaw, Level, Locate, Location, Refused, Triangulation};

/// A point splits the cell, facet or edge that it lies on, or is joined to the part of the hull that it sees. Nothing
/// is done for the shape of cells; what is there stays but for that. ("Lazy" insertion in Boissonnat, Devillers, Pion,
/// Teillaud and Yvinec 2002.)
///
/// *Payloads.* Cells around a new vertex inherit the payload of the cell that had the facet opposite the vertex: where
/// one is split, its parts have what it had. Cells that a removal or a flip makes, or that come with another dimension,
/// have the default one.
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{Level, Triangulation};
///
/// let mut t: Triangulation<Plane, 3> = Triangulation::new(Plane::default());
/// for p in [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [9.0, 9.0], [1.0, 8.0]] {
///     t.insert(p)?;
/// }
/// let edge = t.finite_cells().find_map(|cell| (0..3).find(|&i| t.is_flippable(cell, i)).map(|i| (cell, i)));
/// assert!(edge.is_some_and(|(cell, i)| t.flip(cell, i)));
/// assert!(t.check(Level::Orientation).is_empty());
/// # Ok::<(), breakline_triangulation::Refused>(())
/// ```
impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Without points.
    pub fn new(geometry: G) -> Self {
        Triangulation { geometry, tds: Tds::new(), points: Vec::new(), zone: Zone::default(), last: None }
    }

    /// Adds a point with a payload; the vertex that is there already, with the payload it has, if the site is taken.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// A [walk](Self::locate) from the last insertion; constant time in the hull, outside of it time proportional to
    /// the number of its facets that are seen.
    pub fn insert_with(&mut self, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.insert_by(&mut super::super::Near(None), p, data)
    }

    /// The same, looking for the place by a [strategy](Locate), which learns of the new vertex.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert_by(&mut self, strategy: &mut impl Locate<G, N>, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.admit(&p)?;
        let location = strategy.locate(self, &p);
        let vertex = self.insert_at(p, location, data, |t, _, _, beyond| t.is_split_by(beyond, &p), |data, _| *data);
        if !matches!(location, Location::Vertex(_)) {
            strategy.inserted(&self.geometry, vertex, &p);
        }
        Ok(vertex)
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

    /// The same triangulation with these payloads of cells, the infinite ones included; asked for in order of their
    /// numbers. Linear in the number of cells; nothing but payloads is copied.
    pub fn with_cell_data<D: Copy + Default>(self, mut data: impl FnMut(CellId) -> D) -> Triangulation<G, N, V, D> {
        self.map_cell_data(|cell, _| data(cell))
    }

    /// The same with payloads that follow from those that were there.
    pub(in super::super) fn map_cell_data<D: Copy + Default>(
        self,
        data: impl FnMut(CellId, &C) -> D,
    ) -> Triangulation<G, N, V, D> {
        let Triangulation { geometry, tds, points, zone, last } = self;
        Triangulation { geometry, tds: tds.map_cell_data(data), points, zone, last }
    }

    /// The payload of a cell, to change. O(1).
    pub fn cell_data_mut(&mut self, cell: CellId) -> &mut C {
        self.tds.cell_data_mut(cell)
    }

    /// The payload of a finite vertex, to change.
    pub fn vertex_data_mut(&mut self, vertex: VertexId) -> &mut V {
        self.tds.vertex_data_mut(vertex)
    }

    /// Checks up to the level, with exact predicates. There is no law to [check](Level::Law).
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        self.flaws(level.min(Level::Orientation), |_, _| false)
    }
}

impl<G: Geometry<N>, const N: usize, C: Copy + Default> Triangulation<G, N, (), C> {
    /// Adds a point; the vertex that is there already, if the site is taken.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert(&mut self, p: G::Point) -> Result<VertexId, Refused> {
        self.insert_with(p, ())
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Takes a vertex out and returns its point; `None` if there is no such vertex. The others keep their numbers; the
    /// next point that is added gets the number that is now free. Cells without the vertex stay.
    ///
    /// # Complexity
    /// Linear in the degree of the vertex.
    pub fn remove(&mut self, vertex: VertexId) -> Option<G::Point> {
        if !self.tds.is_vertex(vertex) {
            return None;
        }
        self.remove_lawless(Free, vertex);
        Some(*self.point(vertex))
    }

    /// Whether the two triangles at the edge opposite vertex `i` of a cell form a strictly convex quadrilateral.
    pub fn is_flippable(&self, cell: CellId, i: usize) -> bool {
        if self.dimension() < 2 || i > 2 || !self.tds.is_used(cell) {
            return false;
        }
        let beside = self.tds.neighbor(cell, i);
        if self.tds.is_infinite(cell) || self.tds.is_infinite(beside) {
            return false;
        }
        let [a, b, c] = [i, ccw(i), cw(i)].map(|k| self.point(self.tds.vertex(cell, k)));
        let d = self.point(self.tds.vertex(beside, self.tds.index_of_neighbor(beside, cell)));
        [[a, b, d], [a, d, c]].into_iter().all(|turn| self.geometry.orientation(turn) == Sign::Positive)
    }

    /// Exchanges the edge opposite vertex `i` of a cell for the other diagonal of the quadrilateral around it, if it is
    /// [flippable](Self::is_flippable); says whether.
    pub fn flip(&mut self, cell: CellId, i: usize) -> bool {
        let is_flippable = self.is_flippable(cell, i);
        if is_flippable {
            self.exchange_diagonal(Free, cell, i);
        }
        is_flippable
    }
}
