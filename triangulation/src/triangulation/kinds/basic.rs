//! The basic kind: no law.

use std::ops::Deref;

use crate::geometry::Geometry;
use crate::tds::{CellId, VertexId};

use super::super::engine::flip::Free;
use super::super::{Flaw, Level, Locate, Location, Near, Refused, Triangulation};

/// A triangulation without a law, of the plane or of space.
///
/// A point splits the cell, facet or edge that it lies on, or is joined to the part of the hull that it sees. Nothing
/// is done for the shape of cells; all others stay as they are. ("Lazy" insertion in Boissonnat, Devillers, Pion,
/// Teillaud and Yvinec 2002.)
///
/// *Payloads.* Cells around a new vertex inherit the payload of the cell that had the facet opposite the vertex: where
/// one is split, its parts have what it had. Cells that a removal or a flip makes, or that come with another dimension,
/// have the default one.
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{Basic, Level};
///
/// let mut t: Basic<Plane, 3> = Basic::new(Plane::default());
/// for p in [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [9.0, 9.0], [1.0, 8.0]] {
///     t.insert(p)?;
/// }
/// let edge = t.finite_cells().find_map(|cell| (0..3).find(|&i| t.is_flippable(cell, i)).map(|i| (cell, i)));
/// assert!(edge.is_some_and(|(cell, i)| t.flip(cell, i)));
/// assert!(t.check(Level::Orientation).is_empty());
/// # Ok::<(), breakline_triangulation::Refused>(())
/// ```
#[derive(Debug)]
pub struct Basic<G: Geometry<N>, const N: usize, V = (), C = ()> {
    pub(in super::super) inner: Triangulation<G, N, V, C>,
}

impl<G: Geometry<N>, const N: usize, V, C> Deref for Basic<G, N, V, C> {
    type Target = Triangulation<G, N, V, C>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<N> + Clone, const N: usize, V: Clone, C: Clone> Clone for Basic<G, N, V, C> {
    fn clone(&self) -> Self {
        Basic { inner: self.inner.duplicate() }
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Basic<G, N, V, C> {
    /// Returns a triangulation without points.
    pub fn new(geometry: G) -> Self {
        Basic { inner: Triangulation::new(geometry) }
    }

    /// Adds a point with a payload; the vertex that is there already, with the payload it has, if the site is taken.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// A [walk](Triangulation::locate) from the last insertion; constant time in the hull, outside of it time
    /// proportional to the number of its facets that are seen.
    pub fn insert_with(&mut self, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.insert_by(&mut Near(None), p, data)
    }

    /// Like [`insert_with`](Self::insert_with), but locates the point by a [strategy](Locate), which learns of the new
    /// vertex.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert_by(&mut self, strategy: &mut impl Locate<G, N>, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.inner.admit(&p)?;
        let location = strategy.locate(&self.inner, &p);
        let takes = |t: &Triangulation<G, N, V, C>, _, _, beyond| t.is_split_by(beyond, &p);
        let vertex = self.inner.insert_at(p, location, data, takes, |data, _| *data);
        if !matches!(location, Location::Vertex(_)) {
            strategy.inserted(&self.inner.geometry, vertex, &p);
        }
        Ok(vertex)
    }

    /// Returns the same triangulation with other payloads of cells, the infinite ones included; `data` is asked for
    /// them in order of the cells' numbers. Linear in the number of cells; nothing but payloads is copied.
    pub fn with_cell_data<D: Copy + Default>(self, data: impl FnMut(CellId) -> D) -> Basic<G, N, V, D> {
        Basic { inner: self.inner.with_cell_data(data) }
    }

    /// The payload of a cell, to change. O(1).
    pub fn cell_data_mut(&mut self, cell: CellId) -> &mut C {
        self.inner.tds.cell_data_mut(cell)
    }

    /// The payload of a finite vertex, to change.
    pub fn vertex_data_mut(&mut self, vertex: VertexId) -> &mut V {
        self.inner.tds.vertex_data_mut(vertex)
    }

    /// Checks up to the level, with exact predicates. There is no law to [check](Level::Law).
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        self.flaws(level.min(Level::Orientation), |_, _| false)
    }
}

impl<G: Geometry<N>, const N: usize, C: Copy + Default> Basic<G, N, (), C> {
    /// Adds a point; the vertex that is there already, if the site is taken.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert(&mut self, p: G::Point) -> Result<VertexId, Refused> {
        self.insert_with(p, ())
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Basic<G, 3, V, C> {
    /// Takes a vertex out and returns its point; `None` if there is no such vertex. The others keep their numbers; the
    /// next point that is added gets the number that is now free. Cells without the vertex stay.
    ///
    /// # Complexity
    /// Linear in the degree of the vertex.
    pub fn remove(&mut self, vertex: VertexId) -> Option<G::Point> {
        if !self.tds().is_vertex(vertex) {
            return None;
        }
        self.inner.remove_lawless(Free, vertex);
        Some(*self.point(vertex))
    }

    /// Exchanges the edge opposite vertex `i` of a cell for the other diagonal of the quadrilateral around it; returns
    /// false, and changes nothing, unless it is [flippable](Triangulation::is_flippable).
    pub fn flip(&mut self, cell: CellId, i: usize) -> bool {
        let is_flippable = self.is_flippable(cell, i);
        if is_flippable {
            self.inner.exchange_diagonal(Free, cell, i);
        }
        is_flippable
    }
}
