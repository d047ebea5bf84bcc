use std::convert::identity;
use std::ops::Deref;
use std::sync::atomic::AtomicBool;

use crate::bulk;
use crate::engine::Inserted;
use crate::engine::insert::{insert_each, move_vertex};
use crate::engine::kind_methods::{
    construction_methods, from_points_with_method, insert_method, insertion_methods,
    payload_methods, remove_all_method, remove_by_method,
};
use crate::engine::removal::Removal;
use crate::error::{InputError, MoveError, RemovalError};
use crate::flaw::{Flaw, Level};
use crate::geometry::{Coordinates, Geometry};
use crate::locate::{Locate, Location};
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

/// A Delaunay triangulation, of triangles in the plane or of tetrahedra in space. `N`, the number
/// of vertices of a cell, follows from the geometry.
///
/// Ties between cospherical points are broken by a rule that depends only on the points, so that
/// equal sets of points have equal triangulations.
///
/// Vertices have payloads `V`. Cells, the infinite ones included, have payloads `C`. Each cell
/// around a new vertex inherits the payload of the destroyed cell that had the facet opposite the
/// vertex. Cells created by a removal, or by a change of dimension, have the default payload.
///
/// ```
/// use breakline_triangulation::{geometry::Plane, Delaunay, Location};
///
/// let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]];
/// let (square, _) = Delaunay::from_points(Plane::new(), &corners)?;
/// let is_finite: Vec<bool> = square.tds().cells().map(|cell| !square.tds().is_infinite(cell)).collect();
/// let mut land = square.with_cell_data(|cell| if is_finite[cell.index()] { "land" } else { "sea" });
/// let middle = land.insert([5.0, 4.0])?;
/// assert!(land.tds().around(middle).all(|cell| *land.tds().cell_data(cell) == "land"));
///
/// let Location::Cell { cell, .. } = land.locate(&[1.0, 4.0], None) else { panic!() };
/// *land.cell_data_mut(cell) = "lake";
/// land.insert([1.0, 4.0])?;
/// assert_eq!(land.finite_cells().filter(|&cell| *land.tds().cell_data(cell) == "lake").count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Payloads can be changed at any time:
///
/// ```
/// use breakline_triangulation::{geometry::Plane, Delaunay};
///
/// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0]];
/// let (mut t, v) = Delaunay::from_points_with(Plane::new(), &points, |k| k)?;
/// t.remove(v[1])?;
/// for (vertex, data) in t.vertex_data_iter_mut() {
///     *data = 10 * *data + usize::from(vertex == v[3]);
/// }
/// assert_eq!([0, 2, 3].map(|k| *t.tds().vertex_data(v[k])), [0, 20, 31]);
/// assert!(t.vertex_data_iter_mut().all(|(vertex, _)| vertex != v[1]));
///
/// let mut t = t.with_cell_data(|_| 0);
/// t.cell_data_iter_mut().for_each(|(cell, data)| *data = cell.index() + 1);
/// assert!(t.tds().cells().all(|cell| *t.tds().cell_data(cell) == cell.index() + 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Delaunay<G: Geometry<N>, const N: usize, V = (), C = ()> {
    pub(crate) inner: Triangulation<G, N, V, C>,
}

impl<G: Geometry<N>, const N: usize, V, C> Deref for Delaunay<G, N, V, C> {
    type Target = Triangulation<G, N, V, C>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<N> + Clone, const N: usize, V: Clone, C: Clone> Clone for Delaunay<G, N, V, C> {
    fn clone(&self) -> Self {
        Delaunay {
            inner: self.inner.duplicate(),
        }
    }
}

impl<G: Geometry<N>, const N: usize, V> Delaunay<G, N, V> {
    construction_methods!();
}

impl<G: Coordinates<N>, const N: usize> Delaunay<G, N> {
    /// Triangulates many points; also returns the vertex of each. Vertices are numbered in [spatial
    /// order](crate::spatial_order). Points on one site share a vertex, which keeps the
    /// first of them.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one.
    ///
    /// # Complexity
    /// In the plane by divide and conquer (Guibas and Stolfi 1985, Dwyer 1987), on all threads: O(n
    /// log n) at worst, linear for points that are spread evenly. Peak memory is 60 bytes for each
    /// point, besides two copies of the points. In space by insertion in rounds (Amenta, Choi and
    /// Rote 2003), of many points on all threads in blocks of space, unless they lie along
    /// surfaces: linear in practice, quadratic at worst, as is the result. Peak memory is about 380
    /// bytes for each point, if they are spread evenly.
    pub fn from_points(
        geometry: G,
        points: &[G::Point],
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        Self::from_points_in_grains(geometry, points, bulk::Grain::default())
    }

    /// Like [`from_points`](Self::from_points), but set to true by any thread, `cancel` ends the
    /// work early. It is not polled while the points are sorted.
    ///
    /// # Errors
    /// Those of [`from_points`](Self::from_points), and [`InputError::Canceled`].
    pub fn from_points_unless(
        geometry: G,
        points: &[G::Point],
        cancel: &AtomicBool,
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        let stop = bulk::Stop::new(cancel);
        Self::from_points_in_grains(geometry, points, bulk::Grain::until(&stop))
    }

    fn from_points_in_grains(
        geometry: G,
        points: &[G::Point],
        grain: bulk::Grain,
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        let (sites, vertices) = bulk::Sites::of(&geometry, points, grain)?;
        if grain.stops() {
            return Err(InputError::Canceled);
        }
        let mut triangulation = Self::new(geometry);
        let (points, tds) = bulk::build(&triangulation.inner.geometry, sites, grain);
        if grain.is_stopped() {
            return Err(InputError::Canceled);
        }
        let count = points.len();
        triangulation.inner.points = points;
        // A vertex without a cell: the predicates contradict each other.
        if let Some(tds) = tds.filter(|tds| tds.vertex_count() == count) {
            triangulation.inner.tds = tds;
            return Ok((triangulation, vertices));
        }
        triangulation.inner.tds.reserve(count);
        for index in 0..count {
            let p = triangulation.inner.points[index];
            triangulation.insert(p).map_err(|error| error.at(index))?;
        }
        Ok((triangulation, vertices))
    }

    from_points_with_method!(Delaunay<G, N, V>);
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Delaunay<G, N, V, C> {
    pub(crate) fn over(inner: Triangulation<G, N, V, C>) -> Self {
        Delaunay { inner }
    }

    /// Converts the triangulation below; its law stays.
    fn with_inner<W, D>(
        self,
        convert: impl FnOnce(Triangulation<G, N, V, C>) -> Triangulation<G, N, W, D>,
    ) -> Delaunay<G, N, W, D>
    where
        D: Copy + Default,
    {
        Delaunay {
            inner: convert(self.inner),
        }
    }

    payload_methods! {
        vertices: <W> Delaunay<G, N, W, C>,
        cells: <D> Delaunay<G, N, V, D>, with_cell_data, identity,
    }

    insertion_methods! {
        /// Inserts a point with a payload and returns its vertex. If the site is taken, returns the
        /// vertex that is there already, which keeps its payload, together with the unused payload.
        ///
        /// # Errors
        /// If a coordinate is not finite or out of range; nothing has changed then.
        ///
        /// # Complexity
        /// A [walk](Triangulation::locate) from the last insertion, then linear in the number of
        /// cells replaced: constant on average for points in spatial order. For points in no order
        /// use [`insert_by`](Self::insert_by) with a [`Hierarchy`](crate::Hierarchy); for all
        /// points at once [`from_points_with`](Delaunay::from_points_with).
        by Locate<G, N>
    }

    fn has_point(&self, vertex: VertexId) -> bool {
        self.tds().is_vertex(vertex)
    }

    fn insert_at(&mut self, p: G::Point, data: V, location: Location) -> Inserted<V> {
        self.inner
            .insert_at(p, location, data, takes(&p), |data, _| *data)
    }

    /// Returns the flaws found by a check up to the given level, with exact predicates. If there
    /// are none, the triangulation is what it claims to be.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        self.flaws(level, |_, _| true)
    }
}

impl<G: Geometry<N>, const N: usize, C: Copy + Default> Delaunay<G, N, (), C> {
    insert_method!();
}

impl<G: Coordinates<N>, const N: usize, C: Copy + Default> Delaunay<G, N, (), C> {
    /// Inserts many points, in [spatial order](crate::spatial_order), and returns the vertex of
    /// each.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one. Nothing has changed
    /// then.
    ///
    /// # Complexity
    /// Linear in the number of points if they are spread evenly. For an empty triangulation of the
    /// plane [`from_points`](Delaunay::from_points) is faster.
    pub fn insert_all(&mut self, points: &[G::Point]) -> Result<Vec<VertexId>, InputError> {
        let order = self.inner.order_of_all(points)?;
        insert_each(points, order, |p| self.insert(p))
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Delaunay<G, N, V, C>
where
    Triangulation<G, N, V, C>: Removal,
{
    /// Removes a vertex and returns its point. The result is the triangulation of the other points,
    /// whose vertices keep their numbers; the next point inserted takes the freed one.
    ///
    /// # Errors
    /// If there is no such vertex.
    ///
    /// # Complexity
    /// In the plane linear in the degree of the vertex in practice, quadratic in the worst case. In
    /// space the number of its neighbors times that of the cells that take its place; on the hull
    /// that of triangulating the neighbors.
    pub fn remove(&mut self, vertex: VertexId) -> Result<G::Point, RemovalError> {
        if !self.tds().is_vertex(vertex) {
            return Err(RemovalError::NoVertex);
        }
        self.inner.remove_and_restore(vertex);
        Ok(*self.point(vertex))
    }

    remove_by_method!(Locate<G, N>);

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
}

/// Returns the test for the cells that a new point destroys: those whose circumscribed sphere
/// contains it.
fn takes<G: Geometry<N>, const N: usize, V, C: Copy + Default>(
    p: &G::Point,
) -> impl Fn(&Triangulation<G, N, V, C>, CellId, usize, CellId) -> bool {
    |t, _, _, beyond| t.in_conflict(beyond, p)
}
