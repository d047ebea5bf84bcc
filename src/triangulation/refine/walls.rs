//! Constrained edges, split.

use crate::geometry::Crossing;
use crate::kernel::{DotProduct, Kernel, Wide};
use crate::num::Sign;
use crate::tds::{CellId, VertexId, Zone, ccw, cw};

use super::draft::{Draft, Law, Origin};
use super::shape::{length, minus};

impl<G: Crossing, V: Default> Draft<G, V> {
    /// Splits constrained edges until none is encroached upon that could be split. Says whether there was any change.
    pub(super) fn settle(&mut self) -> bool {
        let before = self.budget;
        while self.budget > 0
            && let Some(ends) = self.encroached.pop_front()
        {
            let edge = self.t.tds().edge(ends[0], ends[1]).filter(|&(cell, i)| self.t.is_constrained(cell, i));
            if edge.is_some_and(|edge| self.split(edge, ends)) {
                self.budget -= 1;
            }
        }
        self.budget < before
    }

    /// Splits a constrained edge, given by the cell on its left, and its ends. Says whether the coordinates are fine
    /// enough.
    fn split(&mut self, mut edge: (CellId, usize), [a, b]: [VertexId; 2]) -> bool {
        let ends_of = |v: VertexId| match self.origin(v) {
            Origin::Wall(ends) => Some(ends),
            _ => None,
        };
        let constraint = ends_of(a).or(ends_of(b)).unwrap_or([a, b]);
        if let Law::Lens(_) = self.law
            && !self.shells.is_in_cluster(constraint)
        {
            edge = self.clear_circle(edge);
            let beyond = self.clear_circle(self.beyond(edge));
            edge = self.beyond(beyond);
        }

        // Phase 1: where.
        let [from, to] = [a, b].map(|v| self.t.plan_of(v));
        let fraction = self.shells.fraction([a, b], constraint, length(minus(to, from)));
        let place = [0, 1].map(|axis| from[axis] * (1.0 - fraction) + to[axis] * fraction + 0.0); // one zero
        let place = self.t.geometry().on_step(place);
        let p = self.t.geometry().meet(place, &[[self.t.point(a), self.t.point(b)]]);
        if self.t.inner.admit(&p).is_err() {
            return false;
        }

        // Phase 2: the triangles on both sides that see the new vertex, which may lie beside the edge by a rounding,
        // and have it in their circles, are replaced by its star; unless something is nearer to the edge than the
        // rounding.
        let (cell, beside) = (edge.0, self.beyond(edge).0);
        let sides = [(a, b, self.regions[cell.index()]), (b, a, self.regions[beside.index()])];
        self.t.inner.set_wall(edge, false);
        let mut zone = std::mem::take(&mut self.t.inner.zone);
        zone.start(self.t.tds().cell_slots());
        for side in [cell, beside] {
            if self.t.inner.in_conflict(side, &p) {
                zone.add(side);
            }
        }
        let inner = &self.t.inner;
        zone.grow(&inner.tds, |from, i, beyond| !inner.tds.cell_data(from).has(i) && inner.in_conflict(beyond, &p));
        if ![a, b].iter().all(|&end| self.is_rim(&zone, end)) || !self.sees_rim(&zone, &p) {
            zone.finish();
            self.t.inner.zone = zone;
            self.t.inner.set_wall(edge, true);
            return false;
        }
        let vertex = self.star(zone, p, Origin::Wall(constraint));
        for end in [a, b] {
            self.t.inner.wall_up(vertex, end);
        }
        self.t.lines.split(a, b, vertex);

        // Phase 3: what is new.
        for (from, to, region) in sides {
            self.mark_side(from, vertex, to, region);
        }
        self.look_around(vertex);
        true
    }

    /// Whether a vertex is on the border of a zone.
    fn is_rim(&self, zone: &Zone, vertex: VertexId) -> bool {
        zone.border().any(|(cell, i)| self.t.tds().edge_ends(cell, i).contains(&vertex))
    }

    /// Whether a point sees every edge around a zone from within.
    fn sees_rim(&self, zone: &Zone, p: &G::Point) -> bool {
        let is_finite = |&(cell, i): &(CellId, usize)| !self.t.tds().edge_ends(cell, i).contains(&VertexId::INFINITE);
        zone.border().filter(is_finite).all(|(cell, i)| self.t.inner.side_of_facet(cell, i, p) == Sign::Positive)
    }

    /// Puts down the region of the cells to the left of the way from one neighbor of a vertex to another.
    fn mark_side(&mut self, from: VertexId, vertex: VertexId, to: VertexId, region: u32) {
        let Some(edge) = self.t.tds().edge(vertex, from) else { return };
        let (mut cell, _) = self.beyond(edge);
        while let Some(i) = self.t.tds().index_of(cell, vertex) {
            self.regions[cell.index()] = region;
            self.fresh.push(cell);
            if self.t.tds().vertex(cell, ccw(i)) == to {
                return;
            }
            cell = self.t.tds().neighbor(cell, cw(i));
        }
    }

    /// Queues what is encroached upon of the constrained edges around a vertex, and at it.
    fn look_around(&mut self, vertex: VertexId) {
        let mut queue = std::mem::take(&mut self.encroached);
        for cell in self.t.tds().around(vertex) {
            let Some(i) = self.t.tds().index_of(cell, vertex) else { continue };
            let encroached = [i, cw(i)].into_iter().filter(|&i| self.is_encroached(cell, i));
            queue.extend(encroached.map(|i| self.t.tds().edge_ends(cell, i)));
        }
        self.encroached = queue;
    }

    /// The same edge as the cell on its other side has it.
    fn beyond(&self, (cell, i): (CellId, usize)) -> (CellId, usize) {
        let beside = self.t.tds().neighbor(cell, i);
        (beside, self.t.tds().index_of_neighbor(beside, cell))
    }

    /// Takes out vertices that were added between constraints and now are in the circle with a constrained edge as its
    /// diameter, on the side of the cell, in sight (Chew 1993). Returns the edge, which may have another cell now.
    fn clear_circle(&mut self, mut edge: (CellId, usize)) -> (CellId, usize) {
        let [a, b] = self.t.tds().edge_ends(edge.0, edge.1);
        loop {
            let apex = self.t.tds().vertex(edge.0, edge.1);
            if apex == VertexId::INFINITE || self.origin(apex) != Origin::Free {
                return edge;
            }
            let angle = DotProduct([a, apex, b].map(|v| self.t.plan_of(v)));
            if Wide::sign(&angle) != Sign::Negative {
                return edge;
            }
            let around: Vec<CellId> = self.t.tds().around(apex).collect();
            let outside = self.beyond(edge);
            if self.t.remove_free(apex).is_none() {
                return edge;
            }
            self.fresh.extend(around.into_iter().filter(|&cell| self.t.tds().is_used(cell)));
            edge = self.beyond(outside);
        }
    }
}
