//! Triangles with constrained edges, and what triangulations of them have in common.

use crate::flaw::Flaw;
use crate::geometry::Geometry;
use crate::locate::Location;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, cw};
use crate::triangulation::Triangulation;

/// Which edges of a triangle are constrained, and the triangle's payload. Bit `i` is set for the
/// edge opposite vertex `i`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstrainedEdges<C = ()>(u8, C);

impl<C> ConstrainedEdges<C> {
    /// Returns true if the edge opposite vertex `i` is constrained.
    #[inline(always)]
    pub fn has(&self, i: usize) -> bool {
        self.0 >> i & 1 == 1
    }

    /// The payload.
    pub(crate) fn data(&self) -> &C {
        &self.1
    }

    /// The payload, mutable.
    pub(crate) fn data_mut(&mut self) -> &mut C {
        &mut self.1
    }

    /// Returns a copy in which the edge opposite vertex `i` is constrained or not.
    #[inline]
    pub(crate) fn with(self, i: usize, is_constrained: bool) -> Self {
        ConstrainedEdges(self.0 & !(1 << i) | u8::from(is_constrained) << i, self.1)
    }

    /// Returns a copy in which all edges are free, except the one opposite vertex `i`, which stays
    /// as it was.
    #[inline(always)]
    pub(crate) fn only(self, i: usize) -> Self {
        ConstrainedEdges(self.0 & 1 << i, self.1)
    }

    /// Returns a copy with another payload.
    pub(crate) fn with_data<D>(&self, data: D) -> ConstrainedEdges<D> {
        ConstrainedEdges(self.0, data)
    }

    /// Returns true for the mark of a triangle that is being replaced.
    pub(crate) fn is_being_replaced(&self) -> bool {
        self.0 == u8::MAX
    }
}

impl<C: Default> ConstrainedEdges<C> {
    /// Returns the mark of a triangle that is being replaced.
    pub(crate) fn being_replaced() -> Self {
        ConstrainedEdges(u8::MAX, C::default())
    }
}

/// What triangulations with constraints have in common.
impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, ConstrainedEdges<C>> {
    /// Returns the payload of a triangle. O(1).
    pub fn cell_data(&self, cell: CellId) -> &C {
        self.tds.cell_data(cell).data()
    }

    /// Returns the triangulation with the same constraints and new payloads.
    pub(crate) fn with_data_of_cells<D: Copy + Default>(
        self,
        mut data: impl FnMut(CellId) -> D,
    ) -> Triangulation<G, 3, V, ConstrainedEdges<D>> {
        self.map_cell_data(|cell, edges| edges.with_data(data(cell)))
    }

    /// Returns true if the edge opposite vertex `i` of a cell is constrained.
    #[inline]
    pub fn is_constrained(&self, cell: CellId, i: usize) -> bool {
        self.tds.cell_data(cell).has(i)
    }

    /// The constrained edges, each once, as pairs of vertices with the smaller first.
    pub fn constrained_edges(&self) -> impl Iterator<Item = [VertexId; 2]> + '_ {
        self.tds
            .cells()
            .filter(|_| self.dimension() == 2)
            .flat_map(move |cell| {
                (0..3)
                    .filter(move |&i| self.is_constrained(cell, i))
                    .filter_map(move |i| {
                        let [a, b] = self.tds.edge_ends(cell, i);
                        (a < b).then_some([a, b]) // the cell on the other side has it as `b a`
                    })
            })
    }

    /// The other ends of the constrained edges at a vertex, counter-clockwise; none below dimension
    /// 2. Linear in its degree.
    pub fn constrained_around(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let constrained = self
            .tds
            .edges_around(vertex)
            .filter(|&(cell, i)| self.is_constrained(cell, i));
        constrained.map(|(cell, i)| self.tds.vertex(cell, cw(i)))
    }

    /// Returns true if the edge between two vertices exists and is constrained.
    pub(crate) fn has_constraint(&self, a: VertexId, b: VertexId) -> bool {
        self.tds
            .edge(a, b)
            .is_some_and(|(cell, i)| self.is_constrained(cell, i))
    }

    /// Constrains the edge between two vertices; returns false if there is no such edge.
    pub(crate) fn constrain_edge(&mut self, a: VertexId, b: VertexId) -> bool {
        let edge = self.tds.edge(a, b);
        edge.map(|edge| self.set_constrained(edge, true)).is_some()
    }

    /// Constrains the edges from a vertex to both ends of the constraint that it split, if any.
    pub(crate) fn constrain_halves(&mut self, split: Option<[VertexId; 2]>, vertex: VertexId) {
        for end in split.into_iter().flatten() {
            self.constrain_edge(vertex, end);
        }
    }

    /// Releases the constrained edge between two vertices and returns the cells on both sides;
    /// `None` if there is no such constraint.
    pub(crate) fn release_edge(&mut self, a: VertexId, b: VertexId) -> Option<[CellId; 2]> {
        let constraint = self
            .tds
            .edge(a, b)
            .filter(|&(cell, i)| self.is_constrained(cell, i))?;
        Some(self.set_constrained(constraint, false))
    }

    /// Marks an edge as constrained or not, in the cells on both sides; returns these cells.
    pub(crate) fn set_constrained(
        &mut self,
        (cell, i): (CellId, usize),
        is_constrained: bool,
    ) -> [CellId; 2] {
        let neighbor = self.tds.neighbor(cell, i);
        let j = self.tds.index_of_neighbor(neighbor, cell);
        self.set_sides_constrained([(cell, i), (neighbor, j)], is_constrained);
        [cell, neighbor]
    }

    /// Like [`set_constrained`](Self::set_constrained), given the edge as the cells on both sides
    /// have it.
    #[inline]
    pub(crate) fn set_sides_constrained(
        &mut self,
        sides: [(CellId, usize); 2],
        is_constrained: bool,
    ) {
        for (cell, i) in sides {
            let data = self.tds.cell_data_mut(cell);
            *data = data.with(i, is_constrained);
        }
    }

    /// Returns the ends of the constraint that a location lies on, between the ends.
    pub(crate) fn constraint_at(&self, location: Location) -> Option<[VertexId; 2]> {
        match location {
            Location::Cell { cell, facets } if self.dimension() == 2 => {
                let constrained = facets.iter().find(|&i| self.is_constrained(cell, i));
                constrained.map(|i| self.tds.edge_ends(cell, i))
            }
            _ => None,
        }
    }

    /// Returns true if a constraint ends at a vertex or runs through it.
    pub(crate) fn is_on_constraint(&self, vertex: VertexId) -> bool {
        self.constrained_around(vertex).next().is_some()
    }

    /// Returns true if a point is in a counter-clockwise triangle or on its border.
    pub(crate) fn is_within(&self, [a, b, c]: [VertexId; 3], p: VertexId) -> bool {
        let [a, b, c, p] = [a, b, c, p].map(|v| self.point(v));
        let sides = [[a, b, p], [b, c, p], [c, a, p]];
        sides
            .into_iter()
            .all(|side| self.geometry.orientation(side) != Sign::Negative)
    }

    /// Returns a flaw for each edge that is constrained on one side only.
    pub(crate) fn one_sided_constraints(&self) -> Vec<Flaw> {
        let edges = self
            .tds
            .cells()
            .filter(|_| self.dimension() == 2)
            .flat_map(|cell| (0..3).map(move |i| (cell, i)));
        let is_one_sided = |&(cell, i): &(CellId, usize)| {
            let neighbor = self.tds.neighbor(cell, i);
            self.is_constrained(cell, i)
                != self.is_constrained(neighbor, self.tds.index_of_neighbor(neighbor, cell))
        };
        edges
            .filter(is_one_sided)
            .map(|(cell, i)| Flaw::OneSided(cell, i))
            .collect()
    }
}
