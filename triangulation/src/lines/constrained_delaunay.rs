use std::ops::Deref;

use crate::bulk::{self, Sites};
use crate::engine::ConstrainedEdges;
use crate::engine::kind_methods::{construction_methods, from_points_with_method, payload_methods};
use crate::error::InputError;
use crate::flaw::{Flaw, Level};
use crate::geometry::{Coordinates, Crossing, Plane};
use crate::tds::VertexId;
use crate::triangulation::Triangulation;

use super::tables::Lines;

/// A constrained Delaunay triangulation of the plane. Each given segment is a chain of its
/// edges, and no vertex lies inside of a triangle's circumscribed circle unless a constraint
/// separates them (Lee and Lin 1986; Chew 1989).
///
/// Constraints come as *lines*: sequences of points, which may touch, overlap, repeat, cross and
/// close. Each line keeps an [id](crate::LineId), which gives its [chain](Self::chain) of vertices.
/// A line that passes through a vertex is split there. Where two lines cross, a vertex is added at
/// the crossing, rounded; [`Crossing`] makes its point. Lines bend no further than the
/// [rounding](crate::Rounding) requires: the [arrangement](crate::arrangement) describes how, and
/// what is proven.
///
/// Vertices have payloads `V`; those of crossings, and those that come with
/// [lines](Self::insert_lines), begin with the default payload. Triangles, the infinite ones
/// included, have payloads `C`, read with [`cell_data`](Triangulation::cell_data). Each triangle
/// around a new vertex inherits the payload of the destroyed triangle that had the edge opposite
/// the vertex. Triangles created by a removal or a constraint, or by a change of dimension, have
/// the default payload.
///
/// The triangulation is a function of the set of points and the set of segments: it does not matter
/// whether these were given at once ([`from_lines`](Self::from_lines)) or one by one, or what has
/// been removed since.
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{ConstrainedDelaunay, Level, OnCrossing};
///
/// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
/// let lines = [vec![0, 2], vec![1, 3, 0]];
/// let (mut t, v) = ConstrainedDelaunay::from_lines(Plane::new(), &points, &lines, OnCrossing::Split)?;
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
    pub(crate) inner: Triangulation<G, 3, V, ConstrainedEdges<C>>,
    pub(crate) lines: Lines,
}

/// A constrained Delaunay triangulation of points `[x, y]`.
pub type ConstrainedDelaunay2<V = (), C = ()> = ConstrainedDelaunay<Plane, V, C>;

impl<G: Crossing, V, C> Deref for ConstrainedDelaunay<G, V, C> {
    type Target = Triangulation<G, 3, V, ConstrainedEdges<C>>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Crossing + Clone, V: Clone, C: Clone> Clone for ConstrainedDelaunay<G, V, C> {
    fn clone(&self) -> Self {
        ConstrainedDelaunay {
            inner: self.inner.duplicate(),
            lines: self.lines.clone(),
        }
    }
}

impl<G: Crossing, V: Default> ConstrainedDelaunay<G, V> {
    construction_methods!();
}

impl<G: Crossing, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    fn over(inner: Triangulation<G, 3, V, ConstrainedEdges<C>>) -> Self {
        ConstrainedDelaunay {
            inner,
            lines: Lines::default(),
        }
    }

    /// Converts the triangulation below; its law stays.
    fn with_inner<W, D>(
        self,
        convert: impl FnOnce(
            Triangulation<G, 3, V, ConstrainedEdges<C>>,
        ) -> Triangulation<G, 3, W, ConstrainedEdges<D>>,
    ) -> ConstrainedDelaunay<G, W, D>
    where
        D: Copy + Default,
    {
        ConstrainedDelaunay {
            inner: convert(self.inner),
            lines: self.lines,
        }
    }

    payload_methods! {
        vertices: <W: Default> ConstrainedDelaunay<G, W, C>,
        cells: <D> ConstrainedDelaunay<G, V, D>, with_data_of_cells, ConstrainedEdges::data_mut,
    }

    /// The vertices that were added where constraints cross.
    pub fn crossings(&self) -> &[VertexId] {
        self.lines.added()
    }

    /// Replaces the point of a finite vertex by another one on the same site, for example to change
    /// its height; returns the old one. Returns `None`, and changes nothing, if the site differs.
    pub fn replace_point(&mut self, vertex: VertexId, p: G::Point) -> Option<G::Point> {
        let old = self.inner.points.get_mut(vertex.index())?;
        self.inner
            .geometry
            .compare(&p, old)
            .is_eq()
            .then(|| std::mem::replace(old, p))
    }

    /// Returns the flaws found by a check up to the given level, with exact predicates. If there
    /// are none, the triangulation is what it claims to be.
    ///
    /// # Complexity
    /// Linear in the cells and the vertices of all lines. Up to [`Level::Manifold`] no predicate is
    /// evaluated.
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
    /// Triangulates sites. Vertices are numbered as the sites are, whose points are not copied.
    ///
    /// # Errors
    /// [`InputError::Canceled`] if the flag of the grain is set.
    pub(crate) fn from_sites(
        geometry: G,
        sites: Sites<G::Point>,
        grain: bulk::Grain,
    ) -> Result<Self, InputError> {
        let mut triangulation = Self::new(geometry);
        let (points, tds) = bulk::build(&triangulation.inner.geometry, sites, grain);
        let count = points.len();
        triangulation.inner.points = points;
        if let Some(tds) = tds {
            triangulation.inner.tds = tds;
            return Ok(triangulation);
        }
        if grain.is_stopped() {
            return Err(InputError::Canceled);
        }
        for index in 0..count {
            let ConstrainedDelaunay { inner, lines } = &mut triangulation;
            lines.insert_point(inner, inner.points[index], None);
        }
        debug_assert_eq!(
            triangulation.vertex_count(),
            count,
            "two points on one site"
        );
        Ok(triangulation)
    }
}

impl<G: Crossing + Coordinates<3>> ConstrainedDelaunay<G> {
    /// Triangulates many points; also returns the vertex of each. Vertices are numbered in [spatial
    /// order](crate::spatial_order). Points on one site share a vertex, which keeps the first of
    /// them.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one.
    ///
    /// # Complexity
    /// That of [`Delaunay::from_points`](crate::Delaunay::from_points) in the plane.
    pub fn from_points(
        geometry: G,
        points: &[G::Point],
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        let (sites, vertices) = Sites::of(&geometry, points, bulk::Grain::default())?;
        Ok((
            Self::from_sites(geometry, sites, bulk::Grain::default())?,
            vertices,
        ))
    }

    from_points_with_method!(ConstrainedDelaunay<G, V>);
}
