//! Splits constrained edges.

use crate::engine::flip::WithConstraints;
use crate::geometry::Crossing;
use crate::kernel::{DotProduct, Kernel, Wide};
use crate::num::{Sign, unsigned_zero};
use crate::tds::{CellId, VertexId, Zone, ccw, cw};

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
    fn split(&mut self, edge: (CellId, usize), [a, b]: [VertexId; 2]) -> bool {
        let ends_of = |v: VertexId| match self.origin(v) {
            VertexOrigin::OnConstraint(ends) => Some(ends),
            _ => None,
        };
        let constraint = ends_of(a).or(ends_of(b)).unwrap_or([a, b]);
        self.shells.learn(&self.t, constraint);
        let mut sides = [edge, self.beyond(edge)];
        if let Encroachment::Lens(_) = self.encroachment
            && !self.shells.is_in_cluster(constraint)
        {
            sides = self.clear_circle(sides);
            let [right, left] = self.clear_circle([sides[1], sides[0]]);
            sides = [left, right];
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
        let cells = sides.map(|(cell, _)| cell);
        let regions = cells.map(|cell| self.regions[cell.index()]);
        self.t.inner.set_sides_constrained(sides, false);
        let mut zone = self.t.inner.take_zone();
        let mut hidden = None;
        let mut starts = cells.into_iter();
        if let Some(start) = starts.find(|&cell| self.t.inner.in_conflict(cell, &p)) {
            let is_beyond = |from, i| self.is_beyond(from, i, &p);
            hidden = self.grow(&mut zone, start, &p, is_beyond);
        }
        let rim = || self.rim(&zone, &p, [a, b]);
        let Some([after_a, after_b]) = hidden.map_or_else(rim, |_| None) else {
            zone.finish();
            self.t.inner.zone = Some(zone);
            self.t.inner.set_sides_constrained(sides, true);
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
        let vertex = self.star(&mut zone, p, VertexOrigin::OnConstraint(constraint), |k| {
            regions[usize::from(is_right(k))]
        });
        self.t.lines.split_edge(a, b, vertex);
        self.constrain_halves(&zone.star, [after_a, after_b]);
        self.t.inner.zone = Some(zone);
        true
    }

    /// Constrains the halves of an edge that a new vertex has split, given its star and the
    /// positions of their cells in it, and queues the edges upon which something encroaches now.
    fn constrain_halves(&mut self, star: &[(CellId, u8)], [from, to]: [usize; 2]) {
        for (k, &(cell, i)) in star.iter().enumerate() {
            let i = usize::from(i);
            if self.is_encroached_by_apex(cell, i) {
                self.queue_edge((cell, i));
            }
            if k == from || k == to {
                let (right, j) = star[k.checked_sub(1).unwrap_or(star.len() - 1)];
                let half = [(cell, cw(i)), (right, ccw(usize::from(j)))];
                self.t.inner.set_sides_constrained(half, true);
                if self.is_any_apex_near(half) {
                    self.queue_edge(half[0]);
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
            let corners = self.t.tds().corners(cell);
            let start = corners[ccw(i)];
            if start != a && start != b {
                continue;
            }
            let end = corners[cw(i)];
            if (end == a || end == b) && self.is_beyond(cell, i, p) {
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
    /// constrained edge as its diameter, on the first side, in sight (Chew 1993). The edge is given
    /// as the cells on both sides have it. Returns it so, because the first cell may have changed.
    fn clear_circle(&mut self, [mut edge, outside]: [(CellId, usize); 2]) -> [(CellId, usize); 2] {
        loop {
            let corners = self.t.tds().corners(edge.0);
            let [apex, a, b] = [edge.1, ccw(edge.1), cw(edge.1)].map(|k| corners[k]);
            if apex == VertexId::INFINITE || self.origin(apex) != VertexOrigin::Free {
                return [edge, outside];
            }
            let angle = DotProduct([a, apex, b].map(|v| self.t.plan_of(v)));
            if Wide::sign(&angle) != Sign::Negative {
                return [edge, outside];
            }
            let first = self.fresh.len();
            self.fresh.extend(self.t.inner.tds.around(apex));
            // It is on no constraint, and in a triangle of others.
            self.t.inner.remove_vertex(WithConstraints, apex);
            let mut last = first;
            for k in first..self.fresh.len() {
                if self.t.tds().is_used(self.fresh[k]) {
                    self.fresh[last] = self.fresh[k];
                    last += 1;
                }
            }
            self.fresh.truncate(last);
            edge = self.beyond(outside);
        }
    }
}
