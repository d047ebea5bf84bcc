//! The basic kind: no law.

use std::ops::Deref;

use crate::geometry::{Coordinates, Geometry};
use crate::tds::{CellId, VertexId};

use super::super::engine::flip::NoConstraints;
use super::super::{
    Flaw, InputError, Inserted, Level, Locate, Location, MoveError, Near, PointError, RemovalError, Triangulation,
};

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
/// let mut t = Basic::new(Plane::new());
/// for p in [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [9.0, 9.0], [1.0, 8.0]] {
///     t.insert(p)?;
/// }
/// let edge = t.finite_cells().find_map(|cell| (0..3).find(|&i| t.is_flippable(cell, i)).map(|i| (cell, i)));
/// assert!(edge.is_some_and(|(cell, i)| t.flip(cell, i)));
/// assert!(t.check(Level::Orientation).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
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

impl<G: Geometry<N>, const N: usize, V> Basic<G, N, V> {
    /// Returns a triangulation without points, and without payloads of cells: these come with
    /// [`with_cell_data`](Self::with_cell_data).
    pub fn new(geometry: G) -> Self {
        Self::over(Triangulation::new(geometry))
    }

    /// Like [`new`](Self::new), with room for that many vertices.
    pub fn with_capacity(geometry: G, vertices: usize) -> Self {
        Self::over(Triangulation::with_capacity(geometry, vertices))
    }
}

impl<G: Coordinates<N>, const N: usize> Basic<G, N> {
    /// Triangulates many points, put in in [spatial order](crate::spatial_order). Returns the vertex of each point beside.
    ///
    /// # Errors
    /// The first point that cannot come in, by its position.
    ///
    /// # Complexity
    /// For points that are spread evenly, time proportional to their number.
    pub fn from_points(geometry: G, points: &[G::Point]) -> Result<(Self, Vec<VertexId>), InputError> {
        let mut triangulation = Self::with_capacity(geometry, points.len());
        let vertices = triangulation.insert_all(points)?;
        Ok((triangulation, vertices))
    }

    /// Like [`from_points`](Self::from_points), with payloads: `data` is asked for that of each vertex once, by the
    /// position of the first point that has it, in order.
    ///
    /// # Errors
    /// See [`from_points`](Self::from_points).
    pub fn from_points_with<V>(
        geometry: G,
        points: &[G::Point],
        data: impl FnMut(usize) -> V,
    ) -> Result<(Basic<G, N, V>, Vec<VertexId>), InputError> {
        let (triangulation, vertices) = Self::from_points(geometry, points)?;
        Ok((Basic::over(triangulation.inner.with_data_of_points(&vertices, data)), vertices))
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Basic<G, N, V, C> {
    fn over(inner: Triangulation<G, N, V, C>) -> Self {
        Basic { inner }
    }

    /// Returns the same triangulation with other payloads of vertices; `data` is asked for them in order of the
    /// vertices' numbers, those of removed ones included. Linear in their number; nothing but payloads is copied.
    pub fn with_vertex_data<W>(self, data: impl FnMut(VertexId) -> W) -> Basic<G, N, W, C> {
        Basic::over(self.inner.with_vertex_data(data))
    }

    /// Returns the same triangulation with other payloads of cells, the infinite ones included; `data` is asked for
    /// them in order of the cells' numbers. Linear in their number; nothing but payloads is copied.
    pub fn with_cell_data<D: Copy + Default>(self, data: impl FnMut(CellId) -> D) -> Basic<G, N, V, D> {
        Basic::over(self.inner.with_cell_data(data))
    }

    /// Adds a point with a payload. Returns its vertex; or, if the site is taken, the one that is there already, which
    /// keeps its payload, and the payload that was given.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// A [walk](Triangulation::locate) from the last insertion; constant time in the hull, outside of it time
    /// proportional to the number of its facets that are seen.
    pub fn insert_with(&mut self, p: G::Point, data: V) -> Result<Inserted<V>, PointError> {
        self.insert_by(&mut Near(None), p, data)
    }

    /// Like [`insert_with`](Self::insert_with), but looks for the point from a cell on. Of a vertex nearby, that is
    /// [`cell_of`](crate::tds::Tds::cell_of); `None`, or a cell that does not exist, stands for the last insertion.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert_near(&mut self, p: G::Point, data: V, near: Option<CellId>) -> Result<Inserted<V>, PointError> {
        self.insert_by(&mut Near(near), p, data)
    }

    /// Like [`insert_with`](Self::insert_with), but locates the point by a [strategy](Locate), which learns of the new
    /// vertex.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert_by(
        &mut self,
        strategy: &mut impl Locate<G, N>,
        p: G::Point,
        data: V,
    ) -> Result<Inserted<V>, PointError> {
        self.inner.admit(&p)?;
        let location = strategy.locate(&self.inner, &p);
        let inserted = self.insert_at(p, data, location);
        if inserted.is_new() {
            strategy.inserted(&self.inner.geometry, inserted.vertex, &p);
        }
        Ok(inserted)
    }

    fn insert_at(&mut self, p: G::Point, data: V, location: Location) -> Inserted<V> {
        let takes = |t: &Triangulation<G, N, V, C>, _, _, beyond| t.is_split_by(beyond, &p);
        self.inner.insert_at(p, location, data, takes, |data, _| *data)
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
    /// Adds a point. Returns its vertex; the one that is there already, if the site is taken.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert(&mut self, p: G::Point) -> Result<VertexId, PointError> {
        Ok(self.insert_with(p, ())?.vertex)
    }
}

impl<G: Coordinates<N>, const N: usize, C: Copy + Default> Basic<G, N, (), C> {
    /// Adds many points, in [spatial order](crate::spatial_order). Returns the vertex of each.
    ///
    /// # Errors
    /// The first point that cannot come in, by its position; nothing has changed then.
    ///
    /// # Complexity
    /// For points that are spread evenly, time proportional to their number.
    pub fn insert_all(&mut self, points: &[G::Point]) -> Result<Vec<VertexId>, InputError> {
        let mut vertices = vec![VertexId::INFINITE; points.len()];
        for position in self.inner.order_of_all(points)? {
            let i = position as usize;
            vertices[i] = self.insert(points[i]).map_err(|error| error.at(i))?;
        }
        Ok(vertices)
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Basic<G, 3, V, C> {
    /// Removes a vertex and returns its point. The others keep their numbers; the next point that is added gets the
    /// number that is now free. Cells without the vertex stay.
    ///
    /// # Errors
    /// If there is no such vertex.
    ///
    /// # Complexity
    /// Linear in the degree of the vertex.
    pub fn remove(&mut self, vertex: VertexId) -> Result<G::Point, RemovalError> {
        if !self.tds().is_vertex(vertex) {
            return Err(RemovalError::NoVertex);
        }
        self.inner.remove_lawless(NoConstraints, vertex);
        Ok(*self.point(vertex))
    }

    /// Like [`remove`](Self::remove), and tells a [strategy](Locate) of location.
    ///
    /// # Errors
    /// See [`remove`](Self::remove).
    pub fn remove_by(&mut self, strategy: &mut impl Locate<G, 3>, vertex: VertexId) -> Result<G::Point, RemovalError> {
        let point = self.remove(vertex)?;
        strategy.removed(vertex);
        Ok(point)
    }

    /// Moves a vertex, which keeps its number and payload, and returns it. If another one is on the site already, that
    /// one is returned, and the one that was moved is gone.
    ///
    /// # Errors
    /// If there is no such vertex, or a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// That of a removal, and of an insertion that looks for its point from there.
    pub fn move_to(&mut self, vertex: VertexId, p: G::Point) -> Result<VertexId, MoveError> {
        self.inner.admit(&p)?;
        if self.tds().is_vertex(vertex) && self.inner.replace_on_site(vertex, &p) {
            return Ok(vertex);
        }
        let beside = self.inner.beside(vertex);
        self.remove(vertex)?;
        let location = self.inner.locate(&p, beside.and_then(|v| self.tds().cell_of(v)));
        let takes = |t: &Triangulation<G, 3, V, C>, _, _, beyond| t.is_split_by(beyond, &p);
        let moved = self.inner.insert_again(p, location, takes, |data, _| *data);
        Ok(moved.unwrap_or(vertex))
    }

    /// Exchanges the edge opposite vertex `i` of a cell for the other diagonal of the quadrilateral around it; returns
    /// false, and changes nothing, unless it is [flippable](Triangulation::is_flippable).
    pub fn flip(&mut self, cell: CellId, i: usize) -> bool {
        let is_flippable = self.is_flippable(cell, i);
        if is_flippable {
            self.inner.exchange_diagonal(NoConstraints, cell, i);
        }
        is_flippable
    }
}
