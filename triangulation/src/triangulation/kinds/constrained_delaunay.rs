use std::ops::Deref;

use crate::geometry::{Coordinates, Crossing};
use crate::tds::{CellId, VertexId};

use super::super::bulk::{self, Sites};
use super::super::lines::Lines;
use super::super::{Flaw, InputError, Level, Triangulation};

/// Which edges of a triangle are constraints, and its payload: bit `i` is set for the edge opposite vertex `i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename = "Walls"))] // as in saved files
pub struct ConstrainedEdges<C = ()>(u8, C);

impl<C> ConstrainedEdges<C> {
    /// Whether the edge opposite vertex `i` is one.
    #[inline(always)]
    pub fn has(&self, i: usize) -> bool {
        self.0 >> i & 1 == 1
    }

    /// The payload.
    pub(in super::super) fn data(&self) -> &C {
        &self.1
    }

    /// The payload, to change.
    pub(in super::super) fn data_mut(&mut self) -> &mut C {
        &mut self.1
    }

    /// The same with the edge opposite vertex `i` set as told.
    #[inline]
    pub(in super::super) fn with(self, i: usize, is_constrained: bool) -> Self {
        ConstrainedEdges(self.0 & !(1 << i) | u8::from(is_constrained) << i, self.1)
    }

    /// The same with only the edge opposite vertex `i` a constraint, if it was one.
    #[inline(always)]
    pub(in super::super) fn only(self, i: usize) -> Self {
        ConstrainedEdges(self.0 & 1 << i, self.1)
    }

    /// The same with another payload.
    pub(in super::super) fn with_data<D>(&self, data: D) -> ConstrainedEdges<D> {
        ConstrainedEdges(self.0, data)
    }

    /// Whether it marks a triangle that is being replaced.
    pub(in super::super) fn is_taken_out(&self) -> bool {
        self.0 == u8::MAX
    }
}

impl<C: Default> ConstrainedEdges<C> {
    /// Marks a triangle that is being replaced.
    pub(in super::super) fn taken_out() -> Self {
        ConstrainedEdges(u8::MAX, C::default())
    }
}

/// A constrained Delaunay triangulation of the plane: given edges are there, and no vertex lies inside
/// of a triangle's circumscribed circle unless a constraint stands between them (Lee and Lin 1986;
/// Chew 1989).
///
/// What is constrained are *lines*: points in a row, which may touch, overlap, repeat, cross and close. Each keeps an
/// [id](crate::LineId), from which its [chain](Self::chain) of vertices follows. A line that runs through a vertex is
/// split there; where two cross, a vertex is added at the place, rounded, with what [`Crossing`] makes of it, and lines
/// bend no further than the [rounding](Rounding) forces: the [arrangement](crate::arrangement) says how, and what is
/// proven.
///
/// Vertices have payloads `V`, and triangles, the infinite ones included, payloads `C`, read with
/// [`cell_data`](Triangulation::cell_data). Triangles around a new vertex inherit the payload of the destroyed one that
/// had the edge opposite the vertex; those that a removal or a constraint makes, or that come with another dimension,
/// have the default one.
///
/// The triangulation is a function of the set of points and the set of lines' segments, whether they came at once
/// ([`from_lines`](Self::from_lines)), one by one or with others that have been removed since.
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{ConstrainedDelaunay, Level, OnCrossing};
///
/// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
/// let lines = [vec![0, 2], vec![1, 3, 0]];
/// let geometry: Plane = Plane::default();
/// let (mut t, v) = ConstrainedDelaunay::<_, ()>::from_lines(geometry, &points, &lines, OnCrossing::Split)?;
///
/// let ids: Vec<_> = t.lines().collect();
/// let [from, crossing, to] = t.chain(ids[0])[..] else { panic!("they cross once") };
/// assert_eq!((from, to), (v[0], v[2]));
/// assert_eq!((*t.point(crossing), t.is_added(crossing)), ([2.0, 2.0], true));
/// assert!(t.lines_through(crossing, v[3]).eq([ids[1]]));
///
/// t.remove_line(ids[1]);
/// assert_eq!(t.chain(ids[0]), [v[0], v[2]]);
/// assert!(t.check(Level::Law).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct ConstrainedDelaunay<G: Crossing, V = (), C = ()> {
    pub(in super::super) inner: Triangulation<G, 3, V, ConstrainedEdges<C>>,
    pub(in super::super) lines: Lines,
}

impl<G: Crossing, V, C> Deref for ConstrainedDelaunay<G, V, C> {
    type Target = Triangulation<G, 3, V, ConstrainedEdges<C>>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Crossing + Clone, V: Clone, C: Clone> Clone for ConstrainedDelaunay<G, V, C> {
    fn clone(&self) -> Self {
        ConstrainedDelaunay { inner: self.inner.duplicate(), lines: self.lines.clone() }
    }
}

impl<G: Crossing, V: Default> ConstrainedDelaunay<G, V> {
    /// Without points, and without payloads of triangles: these come with [`with_cell_data`](Self::with_cell_data).
    pub fn new(geometry: G) -> Self {
        ConstrainedDelaunay { inner: Triangulation::new(geometry), lines: Lines::default() }
    }
}

impl<G: Crossing, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// The same triangulation with these payloads of triangles, the infinite ones included; asked for in order of their
    /// numbers. Linear in the number of triangles; nothing but payloads is copied.
    pub fn with_cell_data<D: Copy + Default>(self, data: impl FnMut(CellId) -> D) -> ConstrainedDelaunay<G, V, D> {
        ConstrainedDelaunay { inner: self.inner.with_data_of_cells(data), lines: self.lines }
    }

    /// The payload of a triangle, to change. O(1).
    pub fn cell_data_mut(&mut self, cell: CellId) -> &mut C {
        self.inner.tds.cell_data_mut(cell).data_mut()
    }

    /// The payload of a finite vertex, to change.
    pub fn vertex_data_mut(&mut self, vertex: VertexId) -> &mut V {
        self.inner.tds.vertex_data_mut(vertex)
    }

    /// The vertices that were added where constraints cross.
    pub fn crossings(&self) -> &[VertexId] {
        self.lines.added()
    }

    /// Replaces the point of a finite vertex by another one at the same place, at another height, say; returns the old
    /// one. `None` if it is elsewhere: nothing has changed then.
    pub fn replace_point(&mut self, vertex: VertexId, p: G::Point) -> Option<G::Point> {
        let old = self.inner.points.get_mut(vertex.index())?;
        self.inner.geometry.compare(&p, old).is_eq().then(|| std::mem::replace(old, p))
    }

    /// Checks up to the level, with exact predicates. No flaw means that the triangulation is what it
    /// claims to be.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        let flaws = self.flaws(level, |cell, i| !self.is_constrained(cell, i));
        if !flaws.is_empty() || level < Level::Law || self.dimension() < 2 {
            return flaws;
        }
        let one_sided = self.one_sided_constraints().into_iter();
        one_sided.chain(self.lines.check(&self.inner)).collect()
    }
}

impl<G: Crossing + Coordinates<3>, V: Default> ConstrainedDelaunay<G, V> {
    /// Triangulates sites: the vertices are numbered as their points are, and no copy of them is made.
    pub(crate) fn from_sites(geometry: G, sites: Sites<G::Point>) -> Self {
        let mut triangulation = Self::new(geometry);
        let (points, tds) = bulk::build(&triangulation.inner.geometry, sites, bulk::Grain::default());
        let count = points.len();
        triangulation.inner.points = points;
        if let Some(tds) = tds {
            triangulation.inner.tds = tds;
            return triangulation;
        }
        for index in 0..count {
            let ConstrainedDelaunay { inner, lines } = &mut triangulation;
            lines.insert_point(inner, inner.points[index], None);
        }
        debug_assert_eq!(triangulation.vertex_count(), count, "two points on one site");
        triangulation
    }

    /// Triangulates many points. Returns the vertex of each point beside: they are numbered along a space
    /// filling curve, and points on one site share theirs (the first of them stands).
    ///
    /// # Errors
    /// The first point that is refused, by its position.
    ///
    /// # Complexity
    /// O(n log n), on all threads.
    pub fn from_points(geometry: G, points: &[G::Point]) -> Result<(Self, Vec<VertexId>), InputError> {
        let (sites, vertices) = Sites::of(&geometry, points, bulk::Grain::default())?;
        Ok((Self::from_sites(geometry, sites), vertices))
    }
}
