use std::ops::Deref;

use crate::geometry::{Coordinates, Geometry};
use crate::tds::{CellId, VertexId};

use super::super::{Locate, Location, MAX_VERTICES, Refused, Triangulation, bulk, spatial_order};

/// A Delaunay triangulation, of triangles in the plane or of tetrahedra in space: `N` follows from the
/// geometry.
///
/// Ties between cospherical points are broken by a rule on the points alone, so that equal sets of
/// points have equal triangulations.
///
/// Vertices have payloads `V`, and cells, the infinite ones included, payloads `C`. Cells around a new vertex inherit
/// the payload of the destroyed cell that had the facet opposite the vertex; those that a removal makes, or that come
/// with another dimension, have the default one.
///
/// ```
/// use breakline_triangulation::{geometry::Plane, Delaunay, Location};
///
/// let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]];
/// let (square, _) = Delaunay::from_points(Plane::<breakline_triangulation::kernel::Adaptive>::default(), &corners)?;
/// let is_finite: Vec<bool> = square.tds().cells().map(|cell| !square.tds().is_infinite(cell)).collect();
/// let mut land = square.with_cell_data(|cell| if is_finite[cell.index()] { "land" } else { "sea" });
/// let middle = land.insert([5.0, 4.0])?;
/// assert!(land.tds().around(middle).all(|cell| *land.tds().cell_data(cell) == "land"));
///
/// let Location::Cell { cell, .. } = land.locate(&[1.0, 4.0], None) else { panic!() };
/// *land.cell_data_mut(cell) = "lake";
/// land.insert([1.0, 4.0])?;
/// assert_eq!(land.finite_cells().filter(|&cell| *land.tds().cell_data(cell) == "lake").count(), 3);
/// # Ok::<(), breakline_triangulation::Refused>(())
/// ```
#[derive(Debug)]
pub struct Delaunay<G: Geometry<N>, const N: usize, V = (), C = ()> {
    pub(in super::super) inner: Triangulation<G, N, V, C>,
}

impl<G: Geometry<N>, const N: usize, V, C> Deref for Delaunay<G, N, V, C> {
    type Target = Triangulation<G, N, V, C>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<N> + Clone, const N: usize, V: Clone, C: Clone> Clone for Delaunay<G, N, V, C> {
    fn clone(&self) -> Self {
        Delaunay { inner: self.inner.duplicate() }
    }
}

impl<G: Geometry<N>, const N: usize, V> Delaunay<G, N, V> {
    /// Without points, and without payloads of cells: these come with [`with_cell_data`](Self::with_cell_data).
    pub fn new(geometry: G) -> Self {
        Delaunay { inner: Triangulation::new(geometry) }
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Delaunay<G, N, V, C> {
    /// The same triangulation with these payloads of cells, the infinite ones included; asked for in order of their
    /// numbers. Linear in the number of cells; nothing but payloads is copied.
    pub fn with_cell_data<D: Copy + Default>(self, data: impl FnMut(CellId) -> D) -> Delaunay<G, N, V, D> {
        Delaunay { inner: self.inner.with_cell_data(data) }
    }

    /// Adds a point with a payload; the vertex that is there already, with the payload it has, if the
    /// site is taken.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// A [walk](Triangulation::locate) from the last insertion, and time proportional to the number of cells replaced:
    /// constant on average for points in spatial order.
    pub fn insert_with(&mut self, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.insert_near(p, data, None)
    }

    /// The same, looking for the place from a cell on. Of a vertex nearby, that is
    /// [`cell_of`](crate::tds::Tds::cell_of); `None`, or a cell that is there no more, for the last insertion.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert_near(&mut self, p: G::Point, data: V, near: Option<CellId>) -> Result<VertexId, Refused> {
        self.inner.admit(&p)?;
        let location = self.inner.locate(&p, near);
        Ok(self.insert_at(p, data, location))
    }

    /// The same, looking for the place by a [strategy](crate::Locate), which learns of the new vertex.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert_by(&mut self, strategy: &mut impl Locate<G, N>, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.inner.admit(&p)?;
        let location = strategy.locate(&self.inner, &p);
        let vertex = self.insert_at(p, data, location);
        if !matches!(location, Location::Vertex(_)) {
            strategy.inserted(&self.inner.geometry, vertex, &p);
        }
        Ok(vertex)
    }

    fn insert_at(&mut self, p: G::Point, data: V, location: Location) -> VertexId {
        self.inner.insert_at(p, location, data, |t, _, _, beyond| t.in_conflict(beyond, &p), |data, _| *data)
    }

    /// The payload of a finite vertex, to change.
    pub fn vertex_data_mut(&mut self, vertex: VertexId) -> &mut V {
        self.inner.tds.vertex_data_mut(vertex)
    }

    /// The payload of a cell, to change. O(1).
    pub fn cell_data_mut(&mut self, cell: CellId) -> &mut C {
        self.inner.tds.cell_data_mut(cell)
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Delaunay<G, 3, V, C> {
    /// Moves a vertex, which keeps its number and payload, and returns it; `None` if there is no such vertex. If
    /// another one is at the place already, that one is returned, and the one that was moved is gone.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// That of a removal, and of an insertion that looks for its place from there.
    pub fn move_to(&mut self, vertex: VertexId, p: G::Point) -> Result<Option<VertexId>, Refused> {
        self.inner.admit(&p)?;
        if !self.tds().is_vertex(vertex) {
            return Ok(None);
        }
        if self.inner.geometry.compare(self.point(vertex), &p).is_eq() {
            self.inner.points[vertex.index()] = p;
            return Ok(Some(vertex));
        }
        // A cell of another vertex, which is still there afterwards.
        let around = self.tds().cell_of(vertex).map(|cell| self.tds().cell_vertices(cell));
        let beside =
            around.and_then(|corners| corners.iter().copied().find(|&v| v != vertex && v != VertexId::INFINITE));
        self.remove(vertex);
        let location = self.locate(&p, beside.and_then(|v| self.tds().cell_of(v)));
        if let Location::Vertex(other) = location {
            return Ok(Some(other));
        }
        let vertex = self.inner.restore_vertex(p);
        if let Some(vertex) = vertex {
            self.inner.connect(vertex, location, |t, _, _, beyond| t.in_conflict(beyond, &p), |data, _| *data);
        }
        Ok(vertex)
    }
}

impl<G: Geometry<N>, const N: usize, C: Copy + Default> Delaunay<G, N, (), C> {
    /// Adds a point; the vertex that is there already, if the site is taken.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert(&mut self, p: G::Point) -> Result<VertexId, Refused> {
        self.insert_with(p, ())
    }
}

impl<G: Coordinates<N>, const N: usize, V: Default, C: Copy + Default> Delaunay<G, N, V, C> {
    /// Adds many points, in [spatial order](super::super::spatial_order). Returns the vertex of each point.
    ///
    /// # Errors
    /// The first point that is refused, by its position; nothing has changed then.
    ///
    /// # Complexity
    /// For points that are spread evenly, time proportional to their number. For an empty triangulation of the plane
    /// [`from_points`](Self::from_points) is faster.
    pub fn insert_all(&mut self, points: &[G::Point]) -> Result<Vec<VertexId>, Refused> {
        if let Some(bad) = points.iter().position(|p| !self.geometry().admits(p)) {
            return Err(Refused::Coordinate(bad));
        }
        if self.tds().vertex_slots() + points.len() > MAX_VERTICES {
            return Err(Refused::TooMany);
        }
        let geometry = self.geometry();
        let order = spatial_order(points.len(), |i| geometry.coordinates(&points[i]))?;
        let mut vertices = vec![VertexId::INFINITE; points.len()];
        for position in order {
            vertices[position as usize] = self.insert_with(points[position as usize], V::default())?;
        }
        Ok(vertices)
    }
}

impl<G: Coordinates<N>, const N: usize> Delaunay<G, N> {
    /// Triangulates many points. Returns the vertex of each point beside: they are numbered in [spatial
    /// order](super::super::spatial_order), and points on one site share theirs (the first of them stands).
    ///
    /// # Errors
    /// The first point that is refused, by its position.
    ///
    /// # Complexity
    /// In the plane by divide and conquer (Guibas and Stolfi 1985, Dwyer 1987), on all threads: O(n log n) at
    /// worst, linear for points that are spread evenly. Peak memory is 60 bytes a point beside two copies of the
    /// points. In space by insertion, linear in practice.
    pub fn from_points(geometry: G, points: &[G::Point]) -> Result<(Self, Vec<VertexId>), Refused> {
        let grain = bulk::Grain::default();
        let (sites, vertices) = bulk::Sites::of(&geometry, points, grain)?;
        let mut triangulation = Self::new(geometry);
        let (points, tds) = bulk::build(&triangulation.inner.geometry, sites, grain);
        let count = points.len();
        triangulation.inner.points = points;
        if let Some(tds) = tds {
            triangulation.inner.tds = tds;
            return Ok((triangulation, vertices));
        }
        triangulation.inner.tds.reserve(count);
        for index in 0..count {
            triangulation.insert(triangulation.inner.points[index])?;
        }
        Ok((triangulation, vertices))
    }

    /// The same with payloads: `data` is asked for each site once, by the position of the first point on it, in order.
    ///
    /// # Errors
    /// See [`from_points`](Self::from_points).
    pub fn from_points_with<V>(
        geometry: G,
        points: &[G::Point],
        mut data: impl FnMut(usize) -> V,
    ) -> Result<(Delaunay<G, N, V>, Vec<VertexId>), Refused> {
        let (triangulation, vertices) = Self::from_points(geometry, points)?;
        let mut payloads: Vec<Option<V>> = Vec::new();
        payloads.resize_with(triangulation.tds().vertex_slots(), || None);
        for (position, vertex) in vertices.iter().enumerate() {
            payloads[vertex.index()].get_or_insert_with(|| data(position));
        }
        let Triangulation { geometry, tds, points, zone, last } = triangulation.inner;
        let tds = tds.with_vertex_data(payloads.into_iter().flatten().collect());
        Ok((Delaunay { inner: Triangulation { geometry, tds, points, zone, last } }, vertices))
    }
}
