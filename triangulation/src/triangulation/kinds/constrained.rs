use std::fmt;
use std::ops::Deref;

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, cw};

use super::super::engine::flip::Forced;
use super::super::lines::constrain::{Met, Scratch, Side};
use super::super::{Flaw, Level, Location, Refused, Triangulation, Walls};

/// A constrained triangulation of the plane: some edges are forced, and there is no law beside. Points go in as in the
/// [`Basic`](crate::Basic) kind; where one lies on a constraint, it splits it.
///
/// Payloads are inherited as those of [`ConstrainedDelaunay`](crate::ConstrainedDelaunay) are.
///
/// Constraints are edges here, between vertices. For lines that cross, are told apart, and are taken out again, and for
/// triangles of good shape there is [`ConstrainedDelaunay`](crate::ConstrainedDelaunay).
///
/// ```
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::{Blocked, Constrained};
///
/// let mut t: Constrained<Plane> = Constrained::new(Plane::default());
/// let v = [[0.0, 0.0], [9.0, 1.0], [4.0, 5.0], [4.0, -5.0]].map(|p| t.insert(p).unwrap());
/// assert_eq!(t.constrain(v[0], v[1]), Ok(()));
/// assert_eq!(t.constrain(v[2], v[3]), Err(Blocked::Wall([v[0], v[1]])));
/// t.release(v[0], v[1]);
/// assert_eq!(t.constrain(v[2], v[3]), Ok(()));
/// assert!(t.constrained_edges().eq([[v[2], v[3]]]));
/// ```
#[derive(Debug)]
pub struct Constrained<G: Geometry<3>, V = (), C = ()> {
    pub(in super::super) inner: Triangulation<G, 3, V, Walls<C>>,
    pub(in super::super) scratch: Scratch,
}

/// Why a constraint cannot be put in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blocked {
    /// It crosses the constraint between these vertices, the smaller first.
    Wall([VertexId; 2]),
    /// All points are collinear, so that there are no triangles to hold it; or one of the vertices does not exist.
    Nowhere,
}

impl fmt::Display for Blocked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Blocked::Wall([a, b]) => {
                write!(f, "the constraint between vertices {} and {} is crossed", a.index(), b.index())
            }
            Blocked::Nowhere => f.write_str("there are no triangles, or not both vertices"),
        }
    }
}

impl std::error::Error for Blocked {}

impl<G: Geometry<3>, V, C> Deref for Constrained<G, V, C> {
    type Target = Triangulation<G, 3, V, Walls<C>>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<3> + Clone, V: Clone, C: Clone> Clone for Constrained<G, V, C> {
    fn clone(&self) -> Self {
        Constrained { inner: self.inner.duplicate(), scratch: Scratch::default() }
    }
}

impl<G: Geometry<3>, V> Constrained<G, V> {
    /// Without points, and without payloads of triangles: these come with [`with_cell_data`](Self::with_cell_data).
    pub fn new(geometry: G) -> Self {
        Constrained { inner: Triangulation::new(geometry), scratch: Scratch::default() }
    }
}

impl<G: Geometry<3>, V, C: Copy + Default> Constrained<G, V, C> {
    /// The same triangulation with these payloads of triangles, the infinite ones included; asked for in order of their
    /// numbers. Linear in the number of triangles; nothing but payloads is copied.
    pub fn with_cell_data<D: Copy + Default>(self, data: impl FnMut(CellId) -> D) -> Constrained<G, V, D> {
        Constrained { inner: self.inner.with_data_of_cells(data), scratch: self.scratch }
    }

    /// The payload of a triangle, to change. O(1).
    pub fn cell_data_mut(&mut self, cell: CellId) -> &mut C {
        self.inner.tds.cell_data_mut(cell).data_mut()
    }

    /// Adds a point with a payload; the vertex that is there already, with the payload it has, if the site is taken.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    pub fn insert_with(&mut self, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.inner.admit(&p)?;
        let location = self.inner.locate(&p, None);
        let split = self.inner.wall_at(location);
        let takes = |t: &Triangulation<G, 3, V, Walls<C>>, from: CellId, i, beyond| {
            !t.tds.cell_data(from).has(i) && t.is_split_by(beyond, &p)
        };
        let vertex = self.inner.insert_at(p, location, data, takes, |walls, i| walls.only(i));
        for end in split.into_iter().flatten() {
            self.inner.wall_up(vertex, end);
        }
        Ok(vertex)
    }

    /// The payload of a finite vertex, to change.
    pub fn vertex_data_mut(&mut self, vertex: VertexId) -> &mut V {
        self.inner.tds.vertex_data_mut(vertex)
    }

    /// Forces the straight way between two vertices to consist of edges. Triangles that it crosses are replaced.
    ///
    /// # Errors
    /// If it is blocked; nothing has changed then.
    ///
    /// # Complexity
    /// Quadratic in the number of triangles between two vertices on the way at worst, in practice linear.
    pub fn constrain(&mut self, a: VertexId, b: VertexId) -> Result<(), Blocked> {
        if self.dimension() < 2 || ![a, b].into_iter().all(|v| self.tds().is_vertex(v)) {
            return Err(Blocked::Nowhere);
        }
        // First without touching anything.
        let mut from = a;
        while from != b {
            match self.inner.trace(from, b, &mut self.scratch) {
                Met::Vertex(v) => from = v,
                Met::Wall(cell, i) => {
                    let mut ends = self.tds().edge_ends(cell, i);
                    ends.sort_unstable();
                    return Err(Blocked::Wall(ends));
                }
            }
        }
        let mut from = a;
        while from != b {
            let Met::Vertex(v) = self.inner.trace(from, b, &mut self.scratch) else { break };
            let triangulate = |t: &Triangulation<G, 3, V, Walls<C>>, side: &Side, apexes: &mut Vec<u32>| {
                t.wrap(side, Triangulation::is_within, apexes);
            };
            self.inner.force_traced(from, v, &mut self.scratch, triangulate);
            from = v;
        }
        Ok(())
    }

    /// Takes the constraint off the edge between two vertices, which stays an edge; says whether there was one.
    pub fn release(&mut self, a: VertexId, b: VertexId) -> bool {
        self.inner.wall_down(a, b).is_some()
    }

    /// Takes a vertex out and returns its point; `None` if there is no such vertex, or a constraint ends in it or runs
    /// through it.
    pub fn remove(&mut self, vertex: VertexId) -> Option<G::Point> {
        if !self.tds().is_vertex(vertex) || self.inner.is_on_wall(vertex) {
            return None;
        }
        // Without triangles there is nothing to hold the constraints.
        if self.constrained_edges().next().is_some() && self.inner.is_flat_without(vertex) {
            return None;
        }
        self.inner.remove_lawless(Forced, vertex);
        Some(*self.point(vertex))
    }

    /// Checks up to the level: that of the law is that each edge is constrained on both sides or on none.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        let mut flaws = self.flaws(level.min(Level::Orientation), |_, _| false);
        if flaws.is_empty() && level == Level::Law {
            flaws.extend(self.one_sided_walls());
        }
        flaws
    }
}

impl<G: Geometry<3>, C: Copy + Default> Constrained<G, (), C> {
    /// Adds a point; the vertex that is there already, if the site is taken.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert(&mut self, p: G::Point) -> Result<VertexId, Refused> {
        self.insert_with(p, ())
    }
}

/// What triangulations with constraints have in common.
impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, Walls<C>> {
    /// The payload of a triangle. O(1).
    pub fn cell_data(&self, cell: CellId) -> &C {
        self.tds.cell_data(cell).data()
    }

    /// The same triangulation and constraints, with these payloads.
    pub(in super::super) fn with_data_of_cells<D: Copy + Default>(
        self,
        mut data: impl FnMut(CellId) -> D,
    ) -> Triangulation<G, 3, V, Walls<D>> {
        self.map_cell_data(|cell, walls| walls.with_data(data(cell)))
    }

    /// Whether the edge of a cell opposite its vertex `i` is a constraint.
    #[inline]
    pub fn is_constrained(&self, cell: CellId, i: usize) -> bool {
        self.tds.cell_data(cell).has(i)
    }

    /// Each constrained edge once, as the pair of its vertices, the smaller first.
    pub fn constrained_edges(&self) -> impl Iterator<Item = [VertexId; 2]> + '_ {
        self.tds.cells().filter(|_| self.dimension() == 2).flat_map(move |cell| {
            (0..3).filter(move |&i| self.is_constrained(cell, i)).filter_map(move |i| {
                let [a, b] = self.tds.edge_ends(cell, i);
                (a < b).then_some([a, b]) // the cell on the other side has it as `b a`
            })
        })
    }

    /// The other ends of the constrained edges at a vertex, counter-clockwise; none below dimension 2. Time proportional to
    /// its degree.
    pub fn constrained_around(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let constrained = self.tds.edges_around(vertex).filter(|&(cell, i)| self.is_constrained(cell, i));
        constrained.map(|(cell, i)| self.tds.vertex(cell, cw(i)))
    }

    /// Makes an edge a constraint; says whether it is there.
    pub(in super::super) fn wall_up(&mut self, a: VertexId, b: VertexId) -> bool {
        let edge = self.tds.edge(a, b);
        edge.map(|edge| self.set_wall(edge, true)).is_some()
    }

    /// Makes a constraint a mere edge, and returns the cells on both sides; `None` if there is none between the two.
    pub(in super::super) fn wall_down(&mut self, a: VertexId, b: VertexId) -> Option<[CellId; 2]> {
        let constraint = self.tds.edge(a, b).filter(|&(cell, i)| self.is_constrained(cell, i))?;
        Some(self.set_wall(constraint, false))
    }

    /// Tells the cells on both sides of an edge whether it is a constraint; returns them.
    pub(in super::super) fn set_wall(&mut self, (cell, i): (CellId, usize), is_wall: bool) -> [CellId; 2] {
        let beside = self.tds.neighbor(cell, i);
        let j = self.tds.index_of_neighbor(beside, cell);
        for (cell, i) in [(cell, i), (beside, j)] {
            let data = self.tds.cell_data_mut(cell);
            *data = data.with(i, is_wall);
        }
        [cell, beside]
    }

    /// The ends of the constraint that a place lies on in its inside.
    pub(in super::super) fn wall_at(&self, location: Location) -> Option<[VertexId; 2]> {
        match location {
            Location::Cell { cell, touching } if self.dimension() == 2 && touching != 0 => {
                let i = touching.trailing_zeros() as usize;
                self.is_constrained(cell, i).then(|| self.tds.edge_ends(cell, i))
            }
            _ => None,
        }
    }

    /// Whether a constraint ends in a vertex or runs through it.
    pub(in super::super) fn is_on_wall(&self, vertex: VertexId) -> bool {
        self.constrained_around(vertex).next().is_some()
    }

    /// Whether a point is in a counter-clockwise triangle or on its border.
    fn is_within(&self, [a, b, c]: [VertexId; 3], p: VertexId) -> bool {
        let [a, b, c, p] = [a, b, c, p].map(|v| self.point(v));
        let sides = [[a, b, p], [b, c, p], [c, a, p]];
        sides.into_iter().all(|side| self.geometry.orientation(side) != Sign::Negative)
    }

    /// Edges that are constrained on one side only.
    pub(in super::super) fn one_sided_walls(&self) -> Vec<Flaw> {
        let edges = self.tds.cells().filter(|_| self.dimension() == 2).flat_map(|cell| (0..3).map(move |i| (cell, i)));
        let is_one_sided = |&(cell, i): &(CellId, usize)| {
            let beside = self.tds.neighbor(cell, i);
            self.is_constrained(cell, i) != self.is_constrained(beside, self.tds.index_of_neighbor(beside, cell))
        };
        edges.filter(is_one_sided).map(|(cell, i)| Flaw::OneSided(cell, i)).collect()
    }
}
