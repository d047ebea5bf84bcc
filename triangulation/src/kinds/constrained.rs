use std::fmt;
use std::ops::Deref;

use crate::engine::flip::WithConstraints;
use crate::engine::insert::{insert_each, move_vertex};
use crate::engine::kind_methods::{
    construction_methods, from_points_with_method, insert_method, insertion_methods,
    payload_methods, remove_by_method,
};
use crate::engine::trace::{CorridorSide, TraceBuffers, TraceEnd};
use crate::engine::{ConstrainedEdges, Inserted};
use crate::error::{InputError, MoveError, RemovalError};
use crate::flaw::{Flaw, Level};
use crate::geometry::{Coordinates, Geometry};
use crate::locate::{Locate, Location};
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

/// A triangulation of the plane with constrained edges and no other law. Points are inserted as in
/// the [`Basic`](crate::Basic) kind; a point on a constraint splits it.
///
/// Payloads are inherited as in [`ConstrainedDelaunay`](crate::ConstrainedDelaunay).
///
/// Here a constraint joins two vertices, and constraints must not cross. For lines that may cross,
/// have ids and can be removed again, and for well-shaped triangles, use
/// [`ConstrainedDelaunay`](crate::ConstrainedDelaunay).
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{ConstraintError, Constrained};
///
/// let mut t = Constrained::new(Plane::new());
/// let v = [[0.0, 0.0], [9.0, 1.0], [4.0, 5.0], [4.0, -5.0]].map(|p| t.insert(p).unwrap());
/// assert_eq!(t.constrain(v[0], v[1]), Ok(()));
/// assert_eq!(t.constrain(v[2], v[3]), Err(ConstraintError::Crosses([v[0], v[1]])));
/// t.release(v[0], v[1]);
/// assert_eq!(t.constrain(v[2], v[3]), Ok(()));
/// assert!(t.constrained_edges().eq([[v[2], v[3]]]));
/// ```
#[derive(Debug)]
pub struct Constrained<G: Geometry<3>, V = (), C = ()> {
    pub(crate) inner: Triangulation<G, 3, V, ConstrainedEdges<C>>,
    pub(crate) buffers: TraceBuffers,
}

/// Why a constraint was refused. Nothing has changed then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConstraintError {
    /// The constraint between these vertices, the smaller first, would be crossed.
    Crosses([VertexId; 2]),
    /// There is no such vertex.
    NoVertex(VertexId),
    /// All points are collinear, so no triangles can hold the constraint.
    NoTriangles,
}

impl fmt::Display for ConstraintError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ConstraintError::Crosses([a, b]) => {
                write!(
                    f,
                    "the constraint between vertices {} and {} is crossed",
                    a.index(),
                    b.index()
                )
            }
            ConstraintError::NoVertex(vertex) => write!(f, "there is no vertex {vertex:?}"),
            ConstraintError::NoTriangles => {
                f.write_str("there are no triangles to hold a constraint")
            }
        }
    }
}

impl std::error::Error for ConstraintError {}

impl<G: Geometry<3>, V, C> Deref for Constrained<G, V, C> {
    type Target = Triangulation<G, 3, V, ConstrainedEdges<C>>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<3> + Clone, V: Clone, C: Clone> Clone for Constrained<G, V, C> {
    fn clone(&self) -> Self {
        Constrained {
            inner: self.inner.duplicate(),
            buffers: TraceBuffers::default(),
        }
    }
}

impl<G: Geometry<3>, V> Constrained<G, V> {
    construction_methods!();
}

impl<G: Coordinates<3>> Constrained<G> {
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

    from_points_with_method!(Constrained<G, V>);
}

impl<G: Geometry<3>, V, C: Copy + Default> Constrained<G, V, C> {
    pub(crate) fn over(inner: Triangulation<G, 3, V, ConstrainedEdges<C>>) -> Self {
        Constrained {
            inner,
            buffers: TraceBuffers::default(),
        }
    }

    /// Converts the triangulation below; its law stays.
    fn with_inner<W, D>(
        self,
        convert: impl FnOnce(
            Triangulation<G, 3, V, ConstrainedEdges<C>>,
        ) -> Triangulation<G, 3, W, ConstrainedEdges<D>>,
    ) -> Constrained<G, W, D>
    where
        D: Copy + Default,
    {
        Constrained {
            inner: convert(self.inner),
            buffers: self.buffers,
        }
    }

    payload_methods! {
        vertices: <W> Constrained<G, W, C>,
        cells: <D> Constrained<G, V, D>, with_data_of_cells, ConstrainedEdges::data_mut,
    }

    insertion_methods! {
        /// Inserts a point with a payload and returns its vertex. If the site is taken, returns the
        /// vertex that is there already, which keeps its payload, together with the unused payload.
        /// A point on a constraint splits it.
        ///
        /// # Errors
        /// If a coordinate is not finite or out of range; nothing has changed then.
        ///
        /// # Complexity
        /// A [walk](Triangulation::locate) from the last insertion. Then constant time inside of
        /// the hull, and outside of it linear in the number of hull edges that the point sees.
        by Locate<G, 3>
    }

    fn insert_at(&mut self, p: G::Point, data: V, location: Location) -> Inserted<V> {
        let split = self.inner.constraint_at(location);
        let inserted = self
            .inner
            .insert_at(p, location, data, takes(&p), |constrained, i| {
                constrained.only(i)
            });
        self.inner.constrain_halves(split, inserted.vertex);
        inserted
    }

    /// Inserts a constraint between two vertices. Triangles that it crosses are replaced; vertices
    /// that it passes through split it.
    ///
    /// # Errors
    /// If it crosses a constraint, a vertex does not exist, or all points are collinear; nothing
    /// has changed then.
    ///
    /// # Complexity
    /// At worst quadratic in the number of triangles crossed between two vertices on the
    /// constraint, in practice linear.
    pub fn constrain(&mut self, a: VertexId, b: VertexId) -> Result<(), ConstraintError> {
        if let Some(absent) = [a, b].into_iter().find(|&v| !self.tds().is_vertex(v)) {
            return Err(ConstraintError::NoVertex(absent));
        }
        if self.dimension() < 2 {
            return Err(ConstraintError::NoTriangles);
        }
        // The first pass only reads, so that nothing has changed if the constraint is refused.
        let mut from = a;
        while from != b {
            match self.inner.trace(from, b, &mut self.buffers) {
                TraceEnd::Vertex(v) => from = v,
                TraceEnd::Constraint(cell, i) => {
                    let mut ends = self.tds().edge_ends(cell, i);
                    ends.sort_unstable();
                    return Err(ConstraintError::Crosses(ends));
                }
            }
        }
        let mut from = a;
        while from != b {
            let TraceEnd::Vertex(v) = self.inner.trace(from, b, &mut self.buffers) else {
                break;
            };
            let triangulate = |t: &Triangulation<G, 3, V, ConstrainedEdges<C>>,
                               side: &CorridorSide,
                               apexes: &mut Vec<u32>| {
                t.wrap(side, Triangulation::is_within, apexes);
            };
            self.inner
                .insert_traced(from, v, &mut self.buffers, triangulate);
            from = v;
        }
        Ok(())
    }

    /// Releases the constrained edge between two vertices, which stays an edge. Returns false if
    /// there is no such constraint.
    pub fn release(&mut self, a: VertexId, b: VertexId) -> bool {
        self.inner.release_edge(a, b).is_some()
    }

    /// Removes a vertex and returns its point. The hole is triangulated again; other triangles
    /// stay. The other vertices keep their numbers; the next point inserted takes the freed one.
    ///
    /// # Errors
    /// If there is no such vertex; if a constraint ends at it or runs through it; or if no
    /// triangles would be left to hold the constraints.
    ///
    /// # Complexity
    /// Linear in the degree of the vertex; on the hull, in the number of triangles.
    pub fn remove(&mut self, vertex: VertexId) -> Result<G::Point, RemovalError> {
        if !self.tds().is_vertex(vertex) {
            return Err(RemovalError::NoVertex);
        }
        let leaves_no_triangles =
            || self.inner.is_flat_without(vertex) && self.constrained_edges().next().is_some();
        if self.inner.is_on_constraint(vertex) || leaves_no_triangles() {
            return Err(RemovalError::Constraint);
        }
        self.inner.remove_lawless(WithConstraints, vertex);
        Ok(*self.point(vertex))
    }

    remove_by_method!(Locate<G, 3>);

    /// Moves a vertex to another point and returns it; it keeps its number and payload. If the site
    /// is taken, the vertex is removed, and the one that is there already is returned.
    ///
    /// # Errors
    /// If the vertex cannot be [removed](Self::remove), or a coordinate is not finite or out of
    /// range; nothing has changed then.
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
                let split = t.inner.constraint_at(location);
                let moved = t
                    .inner
                    .insert_again(p, location, takes(&p), |constrained, i| constrained.only(i))?;
                t.inner.constrain_halves(split, moved);
                Some(moved)
            },
        )
    }

    /// Returns the flaws found by a check up to the given level. The law checked is that each edge
    /// is constrained in both of its triangles or in none.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        let mut flaws = self.flaws(level.min(Level::Orientation), |_, _| false);
        if flaws.is_empty() && level == Level::Law {
            flaws.extend(self.one_sided_constraints());
        }
        flaws
    }
}

impl<G: Geometry<3>, C: Copy + Default> Constrained<G, (), C> {
    insert_method!();
}

impl<G: Coordinates<3>, C: Copy + Default> Constrained<G, (), C> {
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

/// Returns the test for the cells that a new point splits: it grows across facets that are not
/// constrained, to cells that contain the point or see it.
fn takes<G: Geometry<3>, V, C: Copy + Default>(
    p: &G::Point,
) -> impl Fn(&Triangulation<G, 3, V, ConstrainedEdges<C>>, CellId, usize, CellId) -> bool {
    |t, from, i, beyond| !t.tds.cell_data(from).has(i) && t.is_split_by(beyond, p)
}
