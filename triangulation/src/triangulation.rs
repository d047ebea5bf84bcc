//! What all kinds of triangulations share: points, cells, and how to read them.

use std::convert::Infallible;

use crate::embedded::{Embedded, sides};
use crate::geometry::{Geometry, in_sphere};
use crate::num::Sign;
use crate::tds::{CellId, FiniteCells, Tds, VertexId, Zone};

/// Points and cells, for reading: the part that all kinds share.
///
/// Each kind dereferences to it. Only the kind itself creates, changes or copies it, because only
/// the kind knows the law and what else must follow a change. For the same reason it has no check
/// of a law; the kinds have one, see [`Delaunay::check`](crate::Delaunay::check). A copy of it
/// would let points into cells that hold constraints, and does not compile:
///
/// ```compile_fail
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{ConstrainedDelaunay, Triangulation, ConstrainedEdges};
///
/// let constrained: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
/// let copy: Triangulation<Plane, 3, (), ConstrainedEdges> = (*constrained).clone();
/// ```
///
/// Only what all kinds promise can be checked through this view:
///
/// ```compile_fail
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{Delaunay, Level, Triangulation};
///
/// let delaunay: Delaunay<Plane, 3> = Delaunay::new(Plane::new());
/// let view: &Triangulation<Plane, 3> = &delaunay;
/// assert!(view.check(Level::Law).is_empty());
/// ```
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{Delaunay, Level, Triangulation};
///
/// let delaunay: Delaunay<Plane, 3> = Delaunay::new(Plane::new());
/// let view: &Triangulation<Plane, 3> = &delaunay;
/// assert!(view.check_tiling().is_empty());
/// assert!(delaunay.check(Level::Law).is_empty());
/// ```
#[derive(Debug)]
pub struct Triangulation<G: Geometry<N>, const N: usize, V = (), C = ()> {
    pub(crate) geometry: G,
    pub(crate) tds: Tds<N, V, C>,
    pub(crate) points: Vec<G::Point>,
    /// Scratch memory of insertions; `None` before the first one, and during each.
    pub(crate) zone: Option<Box<Zone>>,
    /// The cell where the last insertion ended; the next search starts there.
    pub(crate) last: Option<CellId>,
}

impl<G: Geometry<N>, const N: usize, V, C> Triangulation<G, N, V, C> {
    pub(crate) fn duplicate(&self) -> Self
    where
        G: Clone,
        V: Clone,
        C: Clone,
    {
        let Triangulation {
            geometry,
            tds,
            points,
            zone: _,
            last,
        } = self;
        Triangulation {
            geometry: geometry.clone(),
            tds: tds.clone(),
            points: points.clone(),
            zone: None,
            last: *last,
        }
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    pub(crate) fn new(geometry: G) -> Self {
        Triangulation {
            geometry,
            tds: Tds::new(),
            points: Vec::new(),
            zone: None,
            last: None,
        }
    }

    pub(crate) fn with_capacity(geometry: G, vertices: usize) -> Self {
        let mut triangulation = Triangulation::new(geometry);
        triangulation.reserve(vertices);
        triangulation
    }

    /// Takes the zone that insertions keep for its memory. It is empty, and should be put back.
    ///
    /// `PERF:` boxed, because each insertion moves it to and fro.
    #[inline]
    pub(crate) fn take_zone(&mut self) -> Box<Zone> {
        self.zone.take().unwrap_or_default()
    }

    /// Returns the geometry.
    pub fn geometry(&self) -> &G {
        &self.geometry
    }

    /// Returns the combinatorial structure: cells, vertices and their neighbors.
    pub fn tds(&self) -> &Tds<N, V, C> {
        &self.tds
    }

    /// Returns the dimension: -1 without a point, 0 with one, 1 if all points are collinear, and so
    /// on.
    pub fn dimension(&self) -> i32 {
        self.tds.dimension()
    }

    /// Returns the number of finite vertices.
    pub fn vertex_count(&self) -> usize {
        self.tds.vertex_count()
    }

    /// Returns the point of a finite vertex. The point of a removed vertex is still there, see
    /// [`points`](Self::points).
    ///
    /// # Panics
    /// If no vertex ever had this number, and for the infinite vertex.
    #[inline(always)]
    pub fn point(&self, vertex: VertexId) -> &G::Point {
        &self.points[vertex.index()]
    }

    /// Returns all points, in order of the vertex numbers. The point of a removed
    /// [vertex](Tds::is_vertex) is still there.
    pub fn points(&self) -> &[G::Point] {
        &self.points
    }

    /// The cells without the infinite vertex, in order of their numbers. Below full dimension they
    /// have fewer vertices: they are segments, or triangles in space.
    pub fn finite_cells(&self) -> FiniteCells<'_, N, V, C> {
        self.tds.finite_cells()
    }

    /// The points of a finite cell of full dimension.
    #[inline(always)]
    pub(crate) fn simplex(&self, cell: CellId) -> [&G::Point; N] {
        self.tds.corners(cell).map(|v| &self.points[v.index()])
    }

    /// Returns the points of a finite cell, in the order of its vertices: three of a triangle, four
    /// of a tetrahedron. Returns `None` for an infinite cell, for a number without a cell, and
    /// below full dimension.
    #[inline]
    pub fn cell_points(&self, cell: CellId) -> Option<[&G::Point; N]> {
        (self.is_full() && self.tds.is_used(cell) && !self.tds.is_infinite(cell))
            .then(|| self.simplex(cell))
    }

    /// Returns true if the complex has full dimension.
    #[inline(always)]
    pub(crate) fn is_full(&self) -> bool {
        self.tds.dimension() as usize == N - 1
    }

    #[inline(always)]
    pub(crate) fn side_of_facet(&self, cell: CellId, replaced: usize, q: &G::Point) -> Sign {
        let Ok(sign) = sides::side_of_facet(self, cell, replaced, q);
        sign
    }

    /// Returns true if a new point destroys a cell.
    ///
    /// `PERF:` the infinite vertex has no point, and nor have the unused corners of a cell below
    /// full dimension, so that one look at each point tells the usual case.
    #[inline(always)]
    pub(crate) fn in_conflict(&self, cell: CellId, q: &G::Point) -> bool {
        let corners = self.tds.corners(cell);
        let mut simplex = [q; N];
        for (corner, vertex) in simplex.iter_mut().zip(corners) {
            match self.points.get(vertex.index()) {
                Some(point) => *corner = point,
                None => return self.in_conflict_with_infinite(cell, q),
            }
        }
        in_sphere(&self.geometry, simplex, q)
    }

    /// Like [`in_conflict`](Self::in_conflict), for any cell.
    #[inline(never)]
    fn in_conflict_with_infinite(&self, cell: CellId, q: &G::Point) -> bool {
        let Ok(is_in_conflict) = sides::in_conflict(self, cell, q);
        is_in_conflict
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns the two points of the edge opposite vertex `i` of a cell, which lies to the left of
    /// the edge. Returns `None` for an edge with an infinite vertex, for one that does not exist,
    /// and below dimension 2.
    pub fn edge_points(&self, cell: CellId, i: usize) -> Option<[&G::Point; 2]> {
        if self.dimension() < 2 || i > 2 || !self.tds.is_used(cell) {
            return None;
        }
        let ends = self.tds.edge_ends(cell, i);
        (!ends.contains(&VertexId::INFINITE)).then(|| ends.map(|v| self.point(v)))
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Embedded<N>
    for Triangulation<G, N, V, C>
{
    type Geometry = G;
    type Complex = Tds<N, V, C>;
    type Error = Infallible;
    type PointRef<'a>
        = &'a G::Point
    where
        Self: 'a;

    #[inline(always)]
    fn geometry(&self) -> &G {
        &self.geometry
    }

    #[inline(always)]
    fn complex(&self) -> &Tds<N, V, C> {
        &self.tds
    }

    #[inline(always)]
    fn point(&self, vertex: VertexId) -> Result<&G::Point, Infallible> {
        Ok(&self.points[vertex.index()])
    }

    #[inline(always)]
    fn point_ref<'a>(point: &'a G::Point) -> &'a G::Point
    where
        Self: 'a,
    {
        point
    }
}
