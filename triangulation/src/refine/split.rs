//! Splits constrained edges.

use crate::geometry::Crossing;
use crate::kernel::{DotProduct, Kernel, Wide};
use crate::num::{Sign, unsigned_zero};
use crate::tds::{CellId, VertexId, Zone, cw};

use super::draft::{Draft, Encroachment, VertexOrigin};
use super::shape::{length, minus};

impl<G: Crossing, V: Default> Draft<G, V> {
    /// Splits constrained edges until none remains that is encroached upon and can be split.
    /// Returns true if any was split; otherwise vertices near one may have been removed all the
    /// same, and cells are [fresh](Self::fresh).
    pub(super) fn split_encroached(&mut self) -> bool {
        let before = self.budget;
        while self.budget > 0
            && let Some(ends) = self.encroached.pop_front()
        {
            let edge = self
                .t
                .tds()
                .edge(ends[0], ends[1])
                .filter(|&(cell, i)| self.t.is_constrained(cell, i));
            if edge.is_some_and(|edge| self.split(edge, ends)) {
                self.budget -= 1;
            }
        }
        self.budget < before
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
        // replaced if something is nearer to the edge than the rounding.
        let (cell, beside) = (edge.0, self.beyond(edge).0);
        let sides = [cell, beside].map(|side| self.regions[side.index()]);
        self.t.inner.set_constrained(edge, false);
        let mut zone = std::mem::take(&mut self.t.inner.zone);
        if let Some(start) = [cell, beside]
            .into_iter()
            .find(|&side| self.t.inner.in_conflict(side, &p))
        {
            self.grow(&mut zone, start, &p, |_, _| false);
        }
        let Some([after_a, after_b]) = self.rim(&zone, &p, [a, b]) else {
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
        for k in 0..self.t.inner.zone.star.len() {
            let cell = self.t.inner.zone.star[k];
            let Some(i) = self.t.tds().index_of(cell, vertex) else {
                continue;
            };
            if self.is_encroached_by_apex(cell, i) {
                self.encroached.push_back(self.t.tds().edge_ends(cell, i));
            }
            if k == after_a || k == after_b {
                self.t.inner.set_constrained((cell, cw(i)), true);
                if self.is_encroached(cell, cw(i)) {
                    self.encroached
                        .push_back(self.t.tds().edge_ends(cell, cw(i)));
                }
            }
        }
        true
    }

    /// Returns the positions on the border of a zone of the edges that begin at two vertices;
    /// `None` if one of them is not on it, or if a point does not see all of it from within.
    fn rim(&self, zone: &Zone, p: &G::Point, ends: [VertexId; 2]) -> Option<[usize; 2]> {
        let mut at = [None; 2];
        for (k, (cell, i)) in zone.border().enumerate() {
            let [start, end] = self.t.tds().edge_ends(cell, i);
            let is_finite = start != VertexId::INFINITE && end != VertexId::INFINITE;
            if is_finite && self.t.inner.side_of_facet(cell, i, p) != Sign::Positive {
                return None;
            }
            for (at, v) in at.iter_mut().zip(ends) {
                if start == v {
                    *at = Some(k);
                }
            }
        }
        let [Some(first), Some(second)] = at else {
            return None;
        };
        Some([first, second])
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
