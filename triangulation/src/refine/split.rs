//! Splits constrained edges.

use crate::geometry::Crossing;
use crate::kernel::{DotProduct, Kernel, Wide};
use crate::num::{Sign, unsigned_zero};
use crate::tds::{CellId, VertexId, Zone, cw};

use super::draft::{Draft, Encroached, Encroachment, VertexOrigin};
use super::shape::{length, minus};

impl<G: Crossing, V: Default> Draft<G, V> {
    /// Splits constrained edges until none remains that is encroached upon and can be split.
    /// Returns true if any was split; otherwise vertices near one may have been removed all the
    /// same, and cells are [fresh](Self::fresh).
    pub(super) fn split_encroached(&mut self) -> bool {
        let before = self.budget;
        while self.budget > 0
            && let Some(Encroached { ends, edge }) = self.encroached.pop_front()
        {
            let edge = if self.t.tds().edge_ends(edge.0, edge.1) == ends {
                Some(edge)
            } else {
                self.t.tds().edge(ends[0], ends[1])
            };
            let constrained = edge.filter(|&(cell, i)| self.t.is_constrained(cell, i));
            if constrained.is_some_and(|edge| self.split(edge, ends)) {
                self.budget -= 1;
            }
        }
        self.budget < before
    }

    /// Queues a constrained edge to be split.
    pub(super) fn queue_edge(&mut self, edge: (CellId, usize)) {
        let ends = self.t.tds().edge_ends(edge.0, edge.1);
        self.encroached.push_back(Encroached { ends, edge });
    }

    /// Splits a constrained edge, given by the cell on its left, and its ends. Returns false if the
    /// coordinates are too coarse.
    fn split(&mut self, mut edge: (CellId, usize), [a, b]: [VertexId; 2]) -> bool {
        let ends_of = |v: VertexId| match self.origin(v) {
            VertexOrigin::OnConstraint(ends) => Some(ends),
            _ => None,
        };
        let constraint = ends_of(a).or(ends_of(b)).unwrap_or([a, b]);
        self.shells.learn(&self.t, constraint);
        if let Encroachment::Lens(_) = self.encroachment
            && !self.shells.is_in_cluster(constraint)
        {
            edge = self.clear_circle(edge);
            let beyond = self.clear_circle(self.beyond(edge));
            edge = self.beyond(beyond);
        }

        // Phase 1: the new point.
        let [from, to] = [a, b].map(|v| self.t.plan_of(v));
        let fraction = self
            .shells
            .fraction([a, b], constraint, length(minus(to, from)));
        let site =
            [0, 1].map(|axis| unsigned_zero(from[axis] * (1.0 - fraction) + to[axis] * fraction));
        let site = self.t.geometry().on_step(site);
        let p = self
            .t
            .geometry()
            .meet(site, &[[self.t.point(a), self.t.point(b)]]);
        if self.t.inner.admit(&p).is_err() {
            return false;
        }

        // Phase 2: the star of the new vertex replaces the triangles on both sides that see it and
        // have it in their circles. The vertex may lie off the edge by a rounding. Nothing is
        // replaced if something is nearer to the edge than the rounding: another constraint or an
        // end. Other edges on the border cannot be: the circle within contains the vertex, that
        // beyond does not, and the edge is on their radical axis.
        let (cell, beside) = (edge.0, self.beyond(edge).0);
        let sides = [cell, beside].map(|side| self.regions[side.index()]);
        self.t.inner.set_constrained(edge, false);
        let mut zone = std::mem::take(&mut self.t.inner.zone);
        let mut hidden = None;
        if let Some(start) = [cell, beside]
            .into_iter()
            .find(|&side| self.t.inner.in_conflict(side, &p))
        {
            hidden = self.grow(&mut zone, start, &p, |from, i| {
                self.t.inner.side_of_facet(from, i, &p) != Sign::Positive
            });
        }
        let rim = || self.rim(&zone, &p, [a, b]);
        let Some([after_a, after_b]) = hidden.map_or_else(rim, |_| None) else {
            zone.finish();
            self.t.inner.zone = zone;
            self.t.inner.set_constrained(edge, true);
            return false;
        };
        // The border is counter-clockwise: from `a` to `b` it is on the right.
        let is_right = |k| {
            if after_a < after_b {
                (after_a..after_b).contains(&k)
            } else {
                !(after_b..after_a).contains(&k)
            }
        };
        let vertex = self.star(zone, p, VertexOrigin::OnConstraint(constraint), |k| {
            sides[usize::from(is_right(k))]
        });
        self.t.lines.split_edge(a, b, vertex);
        self.constrain_halves(vertex, [after_a, after_b]);
        true
    }

    /// Constrains the halves of an edge that a new vertex has split, given the positions of their
    /// cells in its star, and queues the edges upon which something encroaches now.
    fn constrain_halves(&mut self, vertex: VertexId, halves: [usize; 2]) {
        for k in 0..self.t.inner.zone.star.len() {
            let cell = self.t.inner.zone.star[k];
            let Some(i) = self.t.tds().index_of(cell, vertex) else {
                continue;
            };
            if self.is_encroached_by_apex(cell, i) {
                self.queue_edge((cell, i));
            }
            if halves.contains(&k) {
                self.t.inner.set_constrained((cell, cw(i)), true);
                if self.is_encroached(cell, cw(i)) {
                    self.queue_edge((cell, cw(i)));
                }
            }
        }
    }

    /// Returns the positions on the border of a zone of the edges that begin at two vertices;
    /// `None` if one of them is not on it, or if the edge between them is on it and a point is not
    /// strictly within.
    fn rim(&self, zone: &Zone, p: &G::Point, [a, b]: [VertexId; 2]) -> Option<[usize; 2]> {
        let [mut first, mut second] = [None; 2];
        for (k, (cell, i)) in zone.border().enumerate() {
            let [start, end] = self.t.tds().edge_ends(cell, i);
            if start != a && start != b {
                continue;
            }
            if (end == a || end == b) && self.t.inner.side_of_facet(cell, i, p) != Sign::Positive {
                return None;
            }
            let position = if start == a { &mut first } else { &mut second };
            *position = Some(k);
        }
        Some([first?, second?])
    }

    /// Returns the same edge as the cell on its other side has it.
    fn beyond(&self, (cell, i): (CellId, usize)) -> (CellId, usize) {
        let beside = self.t.tds().neighbor(cell, i);
        (beside, self.t.tds().index_of_neighbor(beside, cell))
    }

    /// Removes vertices that were added between constraints and now lie in the circle with a
    /// constrained edge as its diameter, on the side of the cell, in sight (Chew 1993). Returns the
    /// edge, whose cell may have changed.
    fn clear_circle(&mut self, mut edge: (CellId, usize)) -> (CellId, usize) {
        let [a, b] = self.t.tds().edge_ends(edge.0, edge.1);
        loop {
            let apex = self.t.tds().vertex(edge.0, edge.1);
            if apex == VertexId::INFINITE || self.origin(apex) != VertexOrigin::Free {
                return edge;
            }
            let angle = DotProduct([a, apex, b].map(|v| self.t.plan_of(v)));
            if Wide::sign(&angle) != Sign::Negative {
                return edge;
            }
            let around: Vec<CellId> = self.t.tds().around(apex).collect();
            let outside = self.beyond(edge);
            if self.t.lines.remove_free(&mut self.t.inner, apex).is_none() {
                return edge;
            }
            self.fresh.extend(
                around
                    .into_iter()
                    .filter(|&cell| self.t.tds().is_used(cell)),
            );
            edge = self.beyond(outside);
        }
    }
}
