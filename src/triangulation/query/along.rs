//! What a segment meets on its way.

use std::cmp::Ordering;

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};

use super::super::{Location, Triangulation};

/// A face, edge or vertex whose inside a segment meets: the faces are open, and so are the edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    /// Through a face.
    Face(CellId),
    /// Over an edge from one side to the other, or ending on it: the edge opposite this vertex of the cell that it is
    /// left by. That is an infinite cell where a segment comes in over the hull.
    Edge(CellId, usize),
    /// Along an edge from the first vertex towards the second. The faces beside it are those of [`Tds::edge`] for both
    /// directions.
    ///
    /// [`Tds::edge`]: crate::tds::Tds::edge
    Along([VertexId; 2]),
    /// Through a vertex.
    Vertex(VertexId),
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// All that a segment meets, in order from `a` to `b`, which may be any points that the geometry admits, equal ones
    /// too. What meets two parts only at their border is told by the border: a segment through a vertex meets the
    /// vertex and perhaps two faces, none of the edges there. Nothing is told of the way outside of the hull, nor below
    /// dimension 2. Exact.
    ///
    /// # Complexity
    /// A [walk](Self::locate) to `a` from a cell nearby; then constant time for a face or an edge, and the degree of each
    /// vertex. If `a` lies outside of the hull, its vertices are all looked at.
    ///
    /// ```
    /// use breakline::{geometry::Plane, triangulation::{Delaunay, Passage}};
    ///
    /// // Two faces, with the edge from the lower right to the upper left between them.
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 5.0], [0.0, 4.0]];
    /// let (t, v) = Delaunay::from_points(Plane::<breakline::kernel::Adaptive>::default(), &points)?;
    /// let met: Vec<Passage> = t.along([&[-1.0, -1.0], &[3.0, 3.0]], None).collect();
    /// assert!(matches!(met[..], [Passage::Vertex(w), Passage::Face(_), Passage::Edge(..), Passage::Face(_)] if w == v[0]));
    /// let met: Vec<Passage> = t.along([&[1.0, 0.0], &[4.0, 0.0]], None).collect();
    /// assert_eq!(met, [Passage::Along([v[0], v[1]]), Passage::Vertex(v[1])]);
    /// # Ok::<(), breakline::triangulation::Refused>(())
    /// ```
    pub fn along<'t>(
        &'t self,
        [a, b]: [&G::Point; 2],
        near: Option<CellId>,
    ) -> impl Iterator<Item = Passage> + use<'t, G, V, C> {
        let way = Way { triangulation: self, a: *a, b: *b };
        let first = if self.is_full() { way.first(near) } else { None };
        std::iter::successors(first, move |passage| way.after(passage))
    }
}

/// A segment on its way.
struct Way<'a, G: Geometry<3>, V, C> {
    triangulation: &'a Triangulation<G, 3, V, C>,
    a: G::Point,
    b: G::Point,
}

impl<G: Geometry<3>, V, C: Copy + Default> Way<'_, G, V, C> {
    /// On which side of the line a vertex lies: positive on the left.
    fn side(&self, vertex: VertexId) -> Sign {
        let t = self.triangulation;
        t.geometry.orientation([&self.a, &self.b, t.point(vertex)])
    }

    /// On which side of an edge the segment ends.
    fn end_side(&self, [from, to]: [VertexId; 2]) -> Sign {
        let t = self.triangulation;
        t.geometry.orientation([t.point(from), t.point(to), &self.b])
    }

    /// Of points on the line: `Greater` if `q` comes after `p` on the way.
    fn order(&self, p: &G::Point, q: &G::Point) -> Ordering {
        let g = &self.triangulation.geometry;
        let order = g.compare(q, p);
        if g.compare(&self.b, &self.a).is_lt() { order.reverse() } else { order }
    }

    /// A vertex on the line, as what comes next, if the segment goes that far.
    fn up_to(&self, vertex: VertexId) -> Option<Passage> {
        self.order(self.triangulation.point(vertex), &self.b).is_ge().then_some(Passage::Vertex(vertex))
    }

    fn first(&self, near: Option<CellId>) -> Option<Passage> {
        let t = self.triangulation;
        match t.locate(&self.a, near) {
            Location::Vertex(vertex) => Some(Passage::Vertex(vertex)),
            Location::Cell { cell, touching: 0 } => Some(Passage::Face(cell)),
            Location::Cell { cell, touching } => {
                let i = touching.trailing_zeros() as usize;
                let ends @ [from, to] = t.tds.edge_ends(cell, i);
                let beyond = t.tds.neighbor(cell, i);
                match self.end_side(ends) {
                    Sign::Negative => Some(Passage::Edge(cell, i)),
                    Sign::Positive => Some(Passage::Edge(beyond, t.tds.index_of_neighbor(beyond, cell))),
                    Sign::Zero if self.order(&self.a, &self.b).is_eq() => Some(Passage::Edge(cell, i)),
                    Sign::Zero if self.order(t.point(from), t.point(to)).is_gt() => Some(Passage::Along([from, to])),
                    Sign::Zero => Some(Passage::Along([to, from])),
                }
            }
            Location::OutsideHull { .. } => self.entry(),
            Location::OutsideAffineHull => None,
        }
    }

    /// Where a segment from outside comes upon the hull: over an edge that runs from its left to its right, or, if the
    /// line has none such, at the first vertex that it goes through.
    fn entry(&self) -> Option<Passage> {
        let t = self.triangulation;
        let g = &t.geometry;
        let mut touched: Option<VertexId> = None;
        for (cell, i) in
            t.tds.around(VertexId::INFINITE).filter_map(|c| Some((c, t.tds.index_of(c, VertexId::INFINITE)?)))
        {
            // Of the infinite face: the hull runs from `to` to `from`.
            let ends @ [to, from] = t.tds.edge_ends(cell, i);
            let sides = [from, to].map(|v| self.side(v));
            if sides == [Sign::Positive, Sign::Negative] {
                let starts_outside = g.orientation([t.point(to), t.point(from), &self.a]) == Sign::Positive;
                let arrives = self.end_side(ends) != Sign::Positive;
                return (starts_outside && arrives).then_some(Passage::Edge(cell, i));
            }
            let is_first = |v| touched.is_none_or(|first| self.order(t.point(v), t.point(first)).is_gt());
            if sides[0] == Sign::Zero && is_first(from) {
                touched = Some(from);
            }
        }
        let vertex = touched.filter(|&v| self.order(&self.a, t.point(v)).is_gt())?;
        self.up_to(vertex)
    }

    fn after(&self, passage: &Passage) -> Option<Passage> {
        let t = self.triangulation;
        match *passage {
            Passage::Vertex(vertex) => self.after_vertex(vertex),
            Passage::Along([_, to]) => self.up_to(to),
            Passage::Edge(cell, i) => {
                let beyond = t.tds.neighbor(cell, i);
                let goes_on = self.end_side(t.tds.edge_ends(cell, i)) == Sign::Negative;
                (goes_on && !t.tds.is_infinite(beyond)).then_some(Passage::Face(beyond))
            }
            Passage::Face(cell) => self.after_face(cell),
        }
    }

    /// A line leaves a triangle where, counter-clockwise, its border comes over from the right.
    fn after_face(&self, cell: CellId) -> Option<Passage> {
        let t = self.triangulation;
        let corners = *t.tds.corners(cell);
        let sides = corners.map(|v| self.side(v));
        let last = (0..3).find(|&i| sides[i] == Sign::Negative && sides[ccw(i)] != Sign::Negative)?;
        if sides[ccw(last)] == Sign::Zero {
            return self.up_to(corners[ccw(last)]);
        }
        let i = cw(last);
        (self.end_side(t.tds.edge_ends(cell, i)) != Sign::Positive).then_some(Passage::Edge(cell, i))
    }

    fn after_vertex(&self, vertex: VertexId) -> Option<Passage> {
        let t = self.triangulation;
        if self.order(t.point(vertex), &self.b).is_le() {
            return None;
        }
        t.tds.edges_around(vertex).find_map(|(cell, i)| {
            // The next edge of the cell is opposite the vertex.
            let [right, left] = [t.tds.vertex(cell, cw(i)), t.tds.vertex(cell, i)];
            if right == VertexId::INFINITE {
                return None;
            }
            match self.side(right) {
                Sign::Zero if self.order(t.point(vertex), t.point(right)).is_gt() => {
                    Some(Passage::Along([vertex, right]))
                }
                Sign::Negative if left != VertexId::INFINITE && self.side(left) == Sign::Positive => {
                    Some(Passage::Face(cell))
                }
                _ => None,
            }
        })
    }
}
