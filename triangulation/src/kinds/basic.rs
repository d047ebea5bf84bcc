//! The basic kind: a triangulation without a law.

use std::convert::identity;
use std::ops::Deref;

use crate::engine::Inserted;
use crate::engine::flip::NoConstraints;
use crate::engine::insert::{insert_each, move_vertex};
use crate::engine::kind_methods::{
    construction_methods, from_points_with_method, insert_method, insertion_methods,
    payload_methods, remove_all_method, remove_by_method,
};
use crate::error::{InputError, MoveError, RemovalError};
use crate::flaw::{Flaw, Level};
use crate::geometry::{Coordinates, Geometry};
use crate::locate::{Locate, Location};
use crate::tds::{CellId, EditError, Tds, VertexId};
use crate::triangulation::Triangulation;

/// A triangulation of the plane or of space, without a law.
///
/// A new point splits the cell, facet or edge that it lies on. Outside of the hull, it is joined to
/// the facets that it sees. The shape of cells is not improved; all other cells stay as they are.
/// ("Lazy" insertion in Boissonnat, Devillers, Pion, Teillaud and Yvinec 2002.)
///
/// *Payloads.* Each cell around a new vertex inherits the payload of the cell that had the facet
/// opposite the vertex: the parts of a split cell have the payload of the whole. Cells created by a
/// removal or a flip, or by a change of dimension, have the default payload.
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
    pub(crate) inner: Triangulation<G, N, V, C>,
}

impl<G: Geometry<N>, const N: usize, V, C> Deref for Basic<G, N, V, C> {
    type Target = Triangulation<G, N, V, C>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<N> + Clone, const N: usize, V: Clone, C: Clone> Clone for Basic<G, N, V, C> {
    fn clone(&self) -> Self {
        Basic {
            inner: self.inner.duplicate(),
        }
    }
}

impl<G: Geometry<N>, const N: usize, V> Basic<G, N, V> {
    construction_methods!();
}

impl<G: Coordinates<N>, const N: usize> Basic<G, N> {
    /// Triangulates many points, inserted in [spatial order](crate::spatial_order); also returns
    /// the vertex of each.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one.
    ///
    /// # Complexity
    /// Linear in the number of points if they are spread evenly.
    pub fn from_points(
        geometry: G,
        points: &[G::Point],
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        let mut triangulation = Self::with_capacity(geometry, points.len());
        let vertices = triangulation.insert_all(points)?;
        Ok((triangulation, vertices))
    }

    from_points_with_method!(Basic<G, N, V>);
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Basic<G, N, V, C> {
    fn over(inner: Triangulation<G, N, V, C>) -> Self {
        Basic { inner }
    }

    /// Converts the triangulation below; its law stays.
    fn with_inner<W, D>(
        self,
        convert: impl FnOnce(Triangulation<G, N, V, C>) -> Triangulation<G, N, W, D>,
    ) -> Basic<G, N, W, D>
    where
        D: Copy + Default,
    {
        Basic {
            inner: convert(self.inner),
        }
    }

    payload_methods! {
        vertices: <W> Basic<G, N, W, C>,
        cells: <D> Basic<G, N, V, D>, with_cell_data, identity,
    }

    insertion_methods! {
        /// Inserts a point with a payload and returns its vertex. If the site is taken, returns the
        /// vertex that is there already, which keeps its payload, together with the unused payload.
        ///
        /// # Errors
        /// If a coordinate is not finite or out of range; nothing has changed then.
        ///
        /// # Complexity
        /// A [walk](Triangulation::locate) from the last insertion. Then constant time inside of
        /// the hull, and outside of it linear in the number of hull facets that the point sees.
        by Locate<G, N>
    }

    fn has_point(&self, vertex: VertexId) -> bool {
        self.tds().is_vertex(vertex)
    }

    fn insert_at(&mut self, p: G::Point, data: V, location: Location) -> Inserted<V> {
        self.inner
            .insert_at(p, location, data, takes(&p), |data, _| *data)
    }

    /// Returns the flaws found by a check up to the given level, with exact predicates. There is no
    /// law to [check](Level::Law).
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        self.flaws(level.min(Level::Orientation), |_, _| false)
    }
}

impl<G: Geometry<N>, const N: usize, C: Copy + Default> Basic<G, N, (), C> {
    insert_method!();
}

impl<G: Coordinates<N>, const N: usize, C: Copy + Default> Basic<G, N, (), C> {
    /// Inserts many points, in [spatial order](crate::spatial_order), and returns the vertex of
    /// each.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one. Nothing has changed
    /// then.
    ///
    /// # Complexity
    /// Linear in the number of points if they are spread evenly.
    pub fn insert_all(&mut self, points: &[G::Point]) -> Result<Vec<VertexId>, InputError> {
        let order = self.inner.order_of_all(points)?;
        insert_each(points, order, |p| self.insert(p))
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Basic<G, 3, V, C> {
    /// Removes a vertex and returns its point. The hole is triangulated again; other cells stay.
    /// The other vertices keep their numbers; the next point inserted takes the freed one.
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

    remove_by_method!(Locate<G, 3>);

    remove_all_method!();

    /// Moves a vertex to another point and returns it; it keeps its number and payload. If the site
    /// is taken, the vertex is removed, and the one that is there already is returned.
    ///
    /// # Errors
    /// If there is no such vertex, or a coordinate is not finite or out of range; nothing has
    /// changed then.
    ///
    /// # Complexity
    /// That of a removal and an insertion; the search starts at the old site.
    pub fn move_to(&mut self, vertex: VertexId, p: G::Point) -> Result<VertexId, MoveError> {
        move_vertex(
            self,
            |t| &mut t.inner,
            (vertex, p),
            Self::remove,
            |t, p, location, _| {
                t.inner
                    .insert_again(p, location, takes(&p), |data, _| *data)
            },
        )
    }

    /// Exchanges the edge opposite vertex `i` of a cell for the other diagonal of the quadrilateral
    /// around it. Returns false, and changes nothing, unless the edge is
    /// [flippable](Triangulation::is_flippable).
    pub fn flip(&mut self, cell: CellId, i: usize) -> bool {
        let is_flippable = self.is_flippable(cell, i);
        if is_flippable {
            self.inner.exchange_diagonal(NoConstraints, cell, i);
        }
        is_flippable
    }
}

impl<G: Geometry<4>, V, C: Copy + Default> Basic<G, 4, V, C> {
    /// Replaces the two tetrahedra at the facet opposite vertex `i` of a cell by three around the
    /// edge between the vertices on both sides. Returns false, and changes nothing, unless the
    /// facet is [flippable](Triangulation::is_facet_flippable).
    ///
    /// ```
    /// use breakline_triangulation::geometry::Space;
    /// use breakline_triangulation::{Basic, Level};
    ///
    /// let mut t = Basic::new(Space::new());
    /// let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 3.0], [1.0, 1.0, -3.0]];
    /// let v = corners.map(|p| t.insert(p));
    /// let facet = t.tds().finite_facets().find(|&(cell, i)| t.is_facet_flippable(cell, i));
    /// let (cell, i) = facet.expect("that between the last two");
    /// assert!(t.flip(cell, i) && t.finite_cells().count() == 3);
    /// assert!(t.flip_edge([v[3]?, v[4]?]) && t.finite_cells().count() == 2);
    /// assert!(t.check(Level::Orientation).is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn flip(&mut self, cell: CellId, i: usize) -> bool {
        self.is_facet_flippable(cell, i) && self.adopt(|tds| tds.flip(cell, i))
    }

    /// Replaces the three tetrahedra around an edge by two on both sides of the triangle between
    /// the three other vertices: the inverse of [`flip`](Self::flip). Returns false, and changes
    /// nothing, unless the edge is [flippable](Triangulation::is_edge_flippable).
    pub fn flip_edge(&mut self, ends: [VertexId; 2]) -> bool {
        self.is_edge_flippable(ends) && self.adopt(|tds| tds.flip_edge(ends))
    }

    /// Performs an edit that returns the new cells; returns false if it is refused.
    fn adopt(
        &mut self,
        edit: impl FnOnce(&mut Tds<4, V, C>) -> Result<Vec<CellId>, EditError>,
    ) -> bool {
        let new_cells = edit(&mut self.inner.tds);
        if let Ok(cells) = &new_cells {
            self.inner.last = cells.first().copied();
        }
        new_cells.is_ok()
    }
}

/// Returns the test for the cells that a new point splits: those that contain the point or see it.
fn takes<G: Geometry<N>, const N: usize, V, C: Copy + Default>(
    p: &G::Point,
) -> impl Fn(&Triangulation<G, N, V, C>, CellId, usize, CellId) -> bool {
    |t, _, _, beyond| t.is_split_by(beyond, p)
}
