//! Forcing a segment into a constrained Delaunay triangulation.
//!
//! 1. *Trace*: walk along the segment from its start and collect the triangles it crosses, until it
//!    meets a vertex or a constraint.
//! 2. At a vertex: the triangles crossed so far are taken out, the new edge is put in, and the polygons
//!    on its two sides are triangulated again, each triangle with the vertex that makes the empty
//!    circle (Anglada 1997), from a stack, not by recursion. Go on from the vertex.
//! 3. At a constraint: it is lifted, the place of the crossing becomes a vertex, and four pieces are
//!    put in.

use rustc_hash::FxHashMap;

use crate::geometry::{Crossing, in_sphere};
use crate::num::Sign;
use crate::tds::{CellId, VertexId, ccw, cw};

use super::lines::undirected;
use super::{ConstrainedDelaunay, Walls};

/// Buffers of the segment insertion, kept from one to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    /// Triangles that the segment crosses, in order.
    corridor: Vec<CellId>,
    /// Vertices to the left of the segment, with its two ends, in order; and to the right.
    left: Vec<VertexId>,
    right: Vec<VertexId>,
    /// Directed edges that wait for the triangle on their other side.
    open: FxHashMap<[VertexId; 2], (CellId, usize)>,
    /// Constraints that stick into the corridor without being crossed.
    spikes: Vec<[VertexId; 2]>,
    /// Triangles whose edges may have to be flipped.
    pub(super) unsettled: Vec<CellId>,
}

/// How a trace ended.
enum Met {
    /// At this vertex, which may be the segment's end.
    Vertex(VertexId),
    /// At the constraint opposite corner `i` of the cell.
    Wall(CellId, usize),
}

impl<G: Crossing, V: Default> ConstrainedDelaunay<G, V> {
    /// Puts in the piece of a line between two vertices, in a triangulation that spans the plane. Says whether all of
    /// it is there: pieces that were arranged meet no constraint between their ends, but off the grid; behind one,
    /// nothing is put in.
    pub(super) fn join(&mut self, a: VertexId, b: VertexId) -> bool {
        let mut is_whole = true;
        self.force_until(a, b, |_, _, _, _| {
            is_whole = false;
            Vec::new()
        });
        is_whole
    }

    /// Puts in the segment between two vertices, in a triangulation that spans the plane, across constraints.
    ///
    /// A crossing may move both lines by a rounding, and so make them cross others, pieces of which wait
    /// here. [`Crossing`] sees to it that this comes to an end; how soon cannot be told, so that there is a
    /// limit, far beyond what a segment can cross: every constraint once. Beyond it pieces are left out,
    /// and the check names them.
    pub(super) fn force(&mut self, a: VertexId, b: VertexId) {
        let mut crossings_left = 1000 + 4 * self.vertex_count();
        self.force_until(a, b, |this, ends, cell, i| {
            if crossings_left == 0 {
                this.left_out.push(ends);
                return Vec::new();
            }
            crossings_left -= 1;
            this.cross(ends, cell, i)
        });
    }

    /// Puts in a segment piece by piece; where one meets a constraint, `at_wall` says what to go on with, given the
    /// ends of the piece and the wall.
    fn force_until(
        &mut self,
        a: VertexId,
        b: VertexId,
        mut at_wall: impl FnMut(&mut Self, [VertexId; 2], CellId, usize) -> Vec<(VertexId, VertexId)>,
    ) {
        let mut pieces = vec![(a, b)];
        while let Some((a, b)) = pieces.pop() {
            if a == b || self.wall_up(a, b) {
                continue;
            }
            if let Some(&between) = self.lines.splits.get(&undirected(a, b)) {
                pieces.extend([(between, b), (a, between)]);
                continue;
            }
            match self.trace(a, b) {
                Met::Vertex(v) => {
                    self.retriangulate(a, v);
                    self.set_wall(a, v, true);
                    self.settle();
                    if v != b {
                        self.lines.split(a, b, v);
                        pieces.push((v, b));
                    }
                }
                Met::Wall(cell, i) => pieces.extend(at_wall(self, [a, b], cell, i)),
            }
        }
    }

    /// Adds a vertex where a segment crosses a constraint, which is lifted; returns the pieces of both.
    fn cross(&mut self, [a, b]: [VertexId; 2], cell: CellId, i: usize) -> Vec<(VertexId, VertexId)> {
        let [c, d] = self.tds().edge_ends(cell, i);
        let x = self.inner.geometry.crossing([self.point(a), self.point(b)], [self.point(c), self.point(d)]);
        self.set_wall(c, d, false);
        self.scratch.unsettled.extend([cell, self.tds().neighbor(cell, i)]);
        self.settle();
        let before = self.vertex_count();
        let near = self.tds().cell_of(c);
        let v = self.insert_near(x, near);
        if self.vertex_count() > before {
            self.crossings.push(v);
        }
        for [p, q] in [[a, b], [c, d]] {
            if v != p && v != q {
                self.lines.split(p, q, v);
            }
        }
        vec![(v, b), (a, v), (v, d), (c, v)]
    }

    /// Makes an edge a constraint, if it is there.
    fn wall_up(&mut self, a: VertexId, b: VertexId) -> bool {
        let Some((cell, i)) = self.inner.tds.edge(a, b) else { return false };
        let beside = self.inner.tds.neighbor(cell, i);
        let j = self.inner.tds.index_of_neighbor(beside, cell);
        for (cell, i) in [(cell, i), (beside, j)] {
            let data = self.inner.tds.cell_data_mut(cell);
            *data = data.with(i, true);
        }
        true
    }

    #[inline]
    fn turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Sign {
        self.inner.geometry.orientation([a, b, c].map(|v| self.point(v)))
    }

    /// Whether `p` lies ahead of `a` on the way to `b`, all three being collinear.
    fn is_ahead(&self, a: VertexId, b: VertexId, p: VertexId) -> bool {
        let compare = |p: VertexId, q: VertexId| self.inner.geometry.compare(self.point(p), self.point(q));
        compare(a, p) == compare(a, b)
    }

    /// Walks from `a` towards `b` and fills the corridor and its two sides.
    fn trace(&mut self, a: VertexId, b: VertexId) -> Met {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.corridor.clear();
        scratch.left.clear();
        scratch.right.clear();
        scratch.left.push(a);
        scratch.right.push(a);
        let met = self.trace_into(a, b, &mut scratch);
        self.scratch = scratch;
        met
    }

    fn trace_into(&self, a: VertexId, b: VertexId, scratch: &mut Scratch) -> Met {
        let tds = self.tds();
        // The triangle at `a` through which the segment leaves, or a neighbor right on the way.
        let mut leaves = None;
        for cell in tds.around(a) {
            let Some(i) = tds.index_of(cell, a) else { continue };
            let (u, w) = (tds.vertex(cell, ccw(i)), tds.vertex(cell, cw(i)));
            if u == VertexId::INFINITE {
                continue;
            }
            match self.turn(a, u, b) {
                Sign::Zero if self.is_ahead(a, b, u) => return Met::Vertex(u),
                Sign::Positive if w != VertexId::INFINITE && self.turn(a, w, b) == Sign::Negative => {
                    leaves = Some((cell, i, u, w));
                    break;
                }
                _ => {}
            }
        }
        let Some((mut cell, mut i, mut right, mut left)) = leaves else {
            // Unreachable: the triangles around a vertex of a convex region leave no gap.
            return Met::Vertex(b);
        };
        loop {
            scratch.corridor.push(cell);
            scratch.left.extend((scratch.left.last() != Some(&left)).then_some(left));
            scratch.right.extend((scratch.right.last() != Some(&right)).then_some(right));
            if tds.cell_data(cell).has(i) {
                return Met::Wall(cell, i);
            }
            let beyond = tds.neighbor(cell, i);
            let j = tds.index_of_neighbor(beyond, cell);
            let p = tds.vertex(beyond, j);
            match self.turn(a, b, p) {
                Sign::Zero => {
                    scratch.corridor.push(beyond);
                    scratch.left.push(p);
                    scratch.right.push(p);
                    return Met::Vertex(p);
                }
                // `beyond` is (p, left, right) counter-clockwise: drop the one on p's side.
                Sign::Positive => {
                    i = ccw(j);
                    left = p;
                }
                Sign::Negative => {
                    i = cw(j);
                    right = p;
                }
            }
            cell = beyond;
        }
    }

    /// Replaces the corridor by triangles on both sides of the edge `a b`.
    fn retriangulate(&mut self, a: VertexId, b: VertexId) {
        if self.scratch.corridor.is_empty() {
            return; // the edge is there
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        self.open_border(&mut scratch);
        // Left: the polygon runs from a over the chain to b, the base a b has it on its left. Right: the
        // base is b a, the chain runs from b back to a.
        scratch.right.reverse();
        let mut reuse = std::mem::take(&mut scratch.corridor);
        let left = std::mem::take(&mut scratch.left);
        let right = std::mem::take(&mut scratch.right);
        self.fill(&left, &mut reuse, &mut scratch);
        self.fill(&right, &mut reuse, &mut scratch);
        debug_assert!(reuse.is_empty() && scratch.open.is_empty(), "the corridor was not filled");
        debug_assert!(self.inner.tds.edge(a, b).is_some());
        (scratch.left, scratch.right, scratch.corridor) = (left, right, reuse);
        let spikes = std::mem::take(&mut scratch.spikes);
        self.scratch = scratch;
        for &[u, v] in &spikes {
            self.set_wall(u, v, true);
        }
        self.scratch.spikes = spikes;
        self.scratch.spikes.clear();
    }

    /// Lists the edges around the corridor, with the cell on their outer side.
    fn open_border(&self, scratch: &mut Scratch) {
        let tds = self.tds();
        scratch.open.clear();
        let corridor = &scratch.corridor;
        for (at, &cell) in corridor.iter().enumerate() {
            let crossed = [at.checked_sub(1), Some(at + 1)].map(|k| k.and_then(|k| corridor.get(k)).copied());
            for i in 0..3 {
                let outside = tds.neighbor(cell, i);
                if crossed.contains(&Some(outside)) {
                    continue; // the corridor goes on there
                }
                let edge = tds.edge_ends(cell, i);
                let j = tds.index_of_neighbor(outside, cell);
                // The corridor may touch itself around the tip of a spike; both sides are then ours.
                let own = scratch.open.remove(&[edge[1], edge[0]]).is_some();
                if own {
                    scratch.spikes.extend(tds.cell_data(cell).has(i).then_some(edge));
                } else {
                    scratch.open.insert(edge, (outside, j));
                }
            }
        }
    }

    /// Triangulates the polygon `chain` whose base runs from its first to its last vertex, with cells
    /// from `reuse`.
    fn fill(&mut self, chain: &[VertexId], reuse: &mut Vec<CellId>, scratch: &mut Scratch) {
        let mut bases = vec![(0, chain.len() - 1)];
        while let Some((first, last)) = bases.pop() {
            if last - first < 2 {
                continue;
            }
            let (a, b) = (chain[first], chain[last]);
            let mut best = None;
            for k in first + 1..last {
                let p = chain[k];
                if self.turn(a, b, p) != Sign::Positive {
                    continue; // behind the base, or an end of it met again at a spike
                }
                let closer = |c: usize| {
                    chain[c] != p
                        && in_sphere(&self.inner.geometry, [a, b, chain[c]].map(|v| self.point(v)), self.point(p))
                };
                if best.is_none_or(closer) {
                    best = Some(k);
                }
            }
            let (Some(apex), Some(cell)) = (best, reuse.pop()) else {
                debug_assert!(false, "a polygon without a triangle on its base");
                continue;
            };
            self.inner.tds.set_corners(cell, [a, b, chain[apex]]);
            *self.inner.tds.cell_data_mut(cell) = Walls::default();
            for (i, edge) in [[b, chain[apex]], [chain[apex], a], [a, b]].into_iter().enumerate() {
                match scratch.open.remove(&edge) {
                    Some((beside, j)) => {
                        self.inner.tds.link(cell, i, beside, j);
                        let wall = self.is_constrained(beside, j);
                        let data = self.inner.tds.cell_data_mut(cell);
                        *data = data.with(i, wall);
                    }
                    None => {
                        scratch.open.insert([edge[1], edge[0]], (cell, i));
                    }
                }
            }
            scratch.unsettled.push(cell);
            bases.push((first, apex));
            bases.push((apex, last));
        }
    }

    /// Restores the law, starting from the cells in `unsettled`.
    pub(super) fn settle(&mut self) {
        self.inner.settle(&mut self.scratch.unsettled);
    }
}
