//! Inserts a segment into a constrained triangulation, as an edge.
//!
//! 1. *Trace*: walk along the segment from its start and collect the triangles that it crosses,
//!    until it meets a vertex or a constraint.
//! 2. At a vertex: remove the triangles crossed so far, insert the new edge, and triangulate the
//!    polygons on both of its sides again. Each triangle gets the vertex that makes its circle
//!    empty (Anglada 1997). Long polygons are triangulated in random order (Shewchuk and Brown
//!    2015).
//!
//! The triangles that the segment from `a` to `b` crosses are the *corridor*. Its borders are the
//! two *sides*:
//!
//! ```text
//!      c-----d                 c-----d
//!    / | \   | \             /   ' .  \       the left side is a c d b
//!   a  |   \ |  b    ==>    a===========b
//!    \ |     \ /             \   . '   /      the right side is a e f b
//!      e-----f                 e-----f
//! ```

use rustc_hash::FxHashMap;

use crate::geometry::{Geometry, in_sphere};
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::Triangulation;

use super::constrained_edges::ConstrainedEdges;

/// Buffers of the insertion of segments, kept for the next one.
#[derive(Debug, Clone, Default)]
pub(crate) struct TraceBuffers {
    /// The triangles that the segment crosses, in order.
    corridor: Vec<CellId>,
    pub(crate) left: CorridorSide,
    pub(crate) right: CorridorSide,
    /// Parts of a side that must still be triangulated.
    parts: Vec<PartOfSide>,
    /// The triangulation of a side, as apexes of its parts.
    apexes: Vec<u32>,
    /// The number of triangles met by all traces.
    pub(crate) met: usize,
    /// Triangles whose edges may have to be flipped.
    pub(crate) to_legalize: Vec<CellId>,
}

/// One side of a segment: the border of the triangles that it crosses, from its start to its end.
#[derive(Debug, Clone, Default)]
pub(crate) struct CorridorSide {
    pub(crate) chain: Vec<VertexId>,
    /// For each vertex of the chain except its ends, a vertex to which an edge led across the
    /// segment. These edges do not cross each other.
    pub(crate) across: Vec<VertexId>,
    /// The edges between consecutive vertices of the chain.
    edges: Vec<BorderEdge>,
}

/// An edge of the border: the triangle on its outer side, and the edge's index there.
#[derive(Debug, Clone, Copy)]
struct BorderEdge {
    cell: CellId,
    i: usize,
    is_constrained: bool,
    /// True if the triangle on the outer side is crossed, too: the corridor touches itself, around
    /// the edge's end.
    is_spike: bool,
}

/// The positions in a chain between which a triangle is to be inserted, and the edge that it shares
/// with the one before.
type PartOfSide = (usize, usize, Option<(CellId, usize)>);

impl CorridorSide {
    fn clear(&mut self, start: VertexId) {
        self.chain.clear();
        self.chain.push(start);
        self.across.clear();
        self.across.push(start);
        self.edges.clear();
    }

    fn push(&mut self, vertex: VertexId, across: VertexId, edge: BorderEdge) {
        self.chain.push(vertex);
        self.across.push(across);
        self.edges.push(edge);
    }

    /// Returns the vertex that was pushed last.
    fn last(&self) -> VertexId {
        self.chain[self.chain.len() - 1]
    }

    pub(crate) fn reverse(&mut self) {
        self.chain.reverse();
        self.across.reverse();
        self.edges.reverse();
    }

    /// Returns the pairs of edges that are the same edge, with both of its sides on the border.
    fn spikes(&self) -> Vec<[usize; 2]> {
        let mut seen: FxHashMap<[VertexId; 2], usize> = FxHashMap::default();
        let mut spikes = Vec::new();
        for (k, ends) in self
            .chain
            .windows(2)
            .enumerate()
            .filter(|&(k, _)| self.edges[k].is_spike)
        {
            match seen.get(&[ends[1], ends[0]]) {
                Some(&other) => spikes.push([other, k]),
                None => _ = seen.insert([ends[0], ends[1]], k),
            }
        }
        spikes
    }
}

/// Sides with chains of at least this length are triangulated in random order, which is faster
/// then.
const LONG: usize = 32;

/// The base of a triangle that [`fill`](Triangulation::fill) creates is opposite this corner.
const BASE: usize = 2;

/// Where a trace ended.
pub(crate) enum TraceEnd {
    /// At this vertex, which may be the segment's end.
    Vertex(VertexId),
    /// At the constraint opposite corner `i` of the cell.
    Constraint(CellId, usize),
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, ConstrainedEdges<C>> {
    /// Returns true if a vertex is in the circle of a counter-clockwise triangle.
    #[inline(always)]
    pub(crate) fn is_in_circle(&self, triangle: [VertexId; 3], p: VertexId) -> bool {
        in_sphere(
            &self.geometry,
            triangle.map(|v| self.point(v)),
            self.point(p),
        )
    }

    #[inline]
    pub(crate) fn turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Sign {
        self.geometry.orientation([a, b, c].map(|v| self.point(v)))
    }

    /// Returns true if `p` lies ahead of `a` in the direction of `b`; all three are collinear.
    fn is_ahead(&self, a: VertexId, b: VertexId, p: VertexId) -> bool {
        let compare =
            |p: VertexId, q: VertexId| self.geometry.compare(self.point(p), self.point(q));
        compare(a, p) == compare(a, b)
    }

    /// Walks from `a` towards `b`, and fills the corridor and its two sides.
    pub(crate) fn trace(&self, a: VertexId, b: VertexId, buffers: &mut TraceBuffers) -> TraceEnd {
        buffers.corridor.clear();
        buffers.left.clear(a);
        buffers.right.clear(a);
        let met = self.trace_into(a, b, buffers);
        buffers.met += buffers.corridor.len();
        met
    }

    fn trace_into(
        &self,
        a: VertexId,
        b: VertexId,
        TraceBuffers {
            corridor,
            left,
            right,
            ..
        }: &mut TraceBuffers,
    ) -> TraceEnd {
        let tds = &self.tds;
        let edge = |cell: CellId, i: usize| {
            let outside = tds.neighbor(cell, i);
            let j = tds.index_of_neighbor(outside, cell);
            BorderEdge {
                cell: outside,
                i: j,
                is_constrained: tds.cell_data(cell).has(i),
                is_spike: false,
            }
        };
        // The triangle at `a` through which the segment leaves, or a neighbor on the segment.
        let mut leaves = None;
        for (cell, i) in tds.corners_around(a) {
            let (u, w) = (tds.vertex(cell, ccw(i)), tds.vertex(cell, cw(i)));
            if u == VertexId::INFINITE {
                continue;
            }
            match self.turn(a, u, b) {
                Sign::Zero if self.is_ahead(a, b, u) => return TraceEnd::Vertex(u),
                Sign::Positive
                    if w != VertexId::INFINITE && self.turn(a, w, b) == Sign::Negative =>
                {
                    right.push(u, w, edge(cell, cw(i)));
                    left.push(w, u, edge(cell, ccw(i)));
                    leaves = Some((cell, i));
                    break;
                }
                _ => {}
            }
        }
        let Some((mut cell, mut i)) = leaves else {
            // Unreachable: the triangles around a vertex of a convex region leave no gap.
            return TraceEnd::Vertex(b);
        };
        loop {
            corridor.push(cell);
            if tds.cell_data(cell).has(i) {
                return TraceEnd::Constraint(cell, i);
            }
            let beyond = tds.neighbor(cell, i);
            let j = tds.index_of_neighbor(beyond, cell);
            let p = tds.vertex(beyond, j);
            // `beyond` is (p, left, right) counter-clockwise. Of `left` and `right`, `p` replaces
            // the one on its own side.
            let turn = self.turn(a, b, p);
            let [on_left, on_right] = [left.last(), right.last()];
            if turn != Sign::Negative {
                left.push(p, on_right, edge(beyond, cw(j)));
            }
            if turn != Sign::Positive {
                right.push(p, on_left, edge(beyond, ccw(j)));
            }
            i = match turn {
                Sign::Zero => {
                    corridor.push(beyond);
                    return TraceEnd::Vertex(p);
                }
                Sign::Positive => ccw(j),
                Sign::Negative => cw(j),
            };
            cell = beyond;
        }
    }

    /// Makes a segment that was traced to a vertex a constrained edge. `triangulate` triangulates a
    /// side: it appends the apexes of the side's parts, as positions in its chain, each part before
    /// its first and its second half.
    pub(crate) fn insert_traced(
        &mut self,
        a: VertexId,
        v: VertexId,
        buffers: &mut TraceBuffers,
        triangulate: impl Fn(&Self, &CorridorSide, &mut Vec<u32>),
    ) {
        if buffers.corridor.is_empty() {
            self.constrain_edge(a, v); // the edge is there
        } else {
            self.retriangulate(buffers, triangulate);
        }
    }

    /// Replaces the corridor by triangles on both sides of the segment, which becomes a constraint.
    /// A constrained Delaunay triangulation remains one: triangles that the segment does not cross
    /// see no more vertices than before.
    ///
    /// The triangles also fit the polygon in any other triangulation: from each vertex of the
    /// border an edge led across the segment, so no edge of the border can hide the vertex from the
    /// base.
    fn retriangulate(
        &mut self,
        TraceBuffers {
            corridor,
            left,
            right,
            parts,
            apexes,
            ..
        }: &mut TraceBuffers,
        triangulate: impl Fn(&Self, &CorridorSide, &mut Vec<u32>),
    ) {
        for &cell in corridor.iter() {
            *self.tds.cell_data_mut(cell) = ConstrainedEdges::being_replaced();
        }
        for edge in left.edges.iter_mut().chain(&mut right.edges) {
            edge.is_spike = self.tds.cell_data(edge.cell).is_being_replaced();
        }
        // On the left, the polygon runs from the start along the chain to the end, so the base,
        // from start to end, has it on its left. On the right, it is reversed.
        right.reverse();
        let sides = [left, right].map(|side| {
            apexes.clear();
            triangulate(self, side, apexes);
            self.fill(side, corridor, parts, apexes)
        });
        if let [Some(left), Some(right)] = sides {
            self.tds.link(left, BASE, right, BASE);
            for cell in [left, right] {
                let data = self.tds.cell_data_mut(cell);
                *data = data.with(BASE, true);
            }
        }
        debug_assert!(corridor.is_empty(), "the corridor was not filled");
    }

    /// Creates the triangles of a side, given by their apexes, over the base from the chain's first
    /// to its last vertex. Uses cells from `free`. Returns the triangle on the base.
    fn fill(
        &mut self,
        side: &mut CorridorSide,
        free: &mut Vec<CellId>,
        parts: &mut Vec<PartOfSide>,
        apexes: &[u32],
    ) -> Option<CellId> {
        let mut on_base = None;
        let mut apexes = apexes.iter();
        parts.push((0, side.chain.len() - 1, None));
        while let Some((first, last, above)) = parts.pop() {
            let (Some(&apex), Some(cell)) = (apexes.next(), free.pop()) else {
                debug_assert!(false, "a polygon without a triangle on its base");
                continue;
            };
            let apex = apex as usize;
            self.tds
                .set_corners(cell, [first, last, apex].map(|k| side.chain[k]));
            match above {
                Some((other, i)) => self.tds.link(cell, BASE, other, i),
                None => on_base = Some(cell),
            }
            let mut constrained = ConstrainedEdges::default();
            for (i, from, to) in [(0, apex, last), (1, first, apex)] {
                if to - from > 1 {
                    parts.push((from, to, Some((cell, i))));
                    continue;
                }
                let edge = &mut side.edges[from];
                constrained = constrained.with(i, edge.is_constrained);
                if edge.is_spike {
                    (edge.cell, edge.i) = (cell, i);
                } else {
                    self.tds.link(cell, i, edge.cell, edge.i);
                }
            }
            *self.tds.cell_data_mut(cell) = constrained;
        }
        if side.edges.iter().any(|edge| edge.is_spike) {
            for [p, q] in side
                .spikes()
                .into_iter()
                .map(|pair| pair.map(|k| side.edges[k]))
            {
                self.tds.link(p.cell, p.i, q.cell, q.i);
            }
        }
        on_base
    }

    /// Triangulates a side by the Delaunay law.
    pub(crate) fn triangulate(&self, side: &CorridorSide, apexes: &mut Vec<u32>) {
        if side.chain.len() < LONG || self.triangulate_long(side, apexes).is_none() {
            self.wrap(side, Self::is_in_circle, apexes);
        }
    }

    /// Triangulates a side by gift wrapping. `is_closer` tests whether a vertex is a better apex
    /// than the third vertex of a triangle, over the same base.
    ///
    /// At worst quadratic in the length of the chain.
    pub(crate) fn wrap(
        &self,
        side: &CorridorSide,
        is_closer: impl Fn(&Self, [VertexId; 3], VertexId) -> bool,
        apexes: &mut Vec<u32>,
    ) {
        let (mut from, mut to) = (0, side.chain.len() - 1);
        let mut open = Vec::new();
        loop {
            let Some(apex) = self.apex(&side.chain[from..=to], &is_closer) else {
                return;
            };
            let apex = from + apex;
            apexes.push(apex as u32);
            if to - apex > 1 {
                open.push((apex, to));
            }
            (from, to) = match (apex - from > 1)
                .then_some((from, apex))
                .or_else(|| open.pop())
            {
                Some(part) => part,
                None => return,
            };
        }
    }

    /// Returns the position of the vertex of a chain that is the best apex over the base from its
    /// first to its last vertex.
    pub(crate) fn apex(
        &self,
        chain: &[VertexId],
        is_closer: &impl Fn(&Self, [VertexId; 3], VertexId) -> bool,
    ) -> Option<usize> {
        if chain.len() == 3 {
            return Some(1);
        }
        let (a, b) = (chain[0], chain[chain.len() - 1]);
        let mut best = None;
        for k in 1..chain.len() - 1 {
            let p = chain[k];
            if self.turn(a, b, p) != Sign::Positive {
                continue; // behind the base, or an end of it met again at a spike
            }
            let closer = |c: usize| chain[c] != p && is_closer(self, [a, b, chain[c]], p);
            if best.is_none_or(closer) {
                best = Some(k);
            }
        }
        best
    }
}
