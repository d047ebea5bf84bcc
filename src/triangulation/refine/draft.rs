//! A mesh in the making: vertices are put on constrained edges, or between them.

use std::collections::VecDeque;

use crate::geometry::Crossing;
use crate::kernel::{DotProduct, Kernel, Wide};
use crate::num::Sign;
use crate::tds::{CellId, VertexId, Zone, ccw, cw};

use super::super::ConstrainedDelaunay;
use super::OUTSIDE;
use super::shape::{area, dot, length, minus};
use super::shells::Shells;

/// Which vertices a constrained edge must not have near to it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Law {
    /// In the circle through its ends and a vertex on the other side.
    Delaunay,
    /// In or on the circle that has it as its diameter.
    Gabriel,
    /// In the lens from which it is seen under an angle whose cosine is less than the negative of this (Chew 1993).
    Lens(f64),
}

/// Where a vertex comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    /// It was there.
    Given,
    /// It splits a constrained edge, which had these ends.
    Wall([VertexId; 2]),
    /// It destroyed a triangle.
    Free,
}

/// What came of an attempt to add a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Attempt {
    /// It is there.
    Added,
    /// It would encroach upon constrained edges, which are queued.
    Encroaches,
    /// The coordinates are too coarse for it.
    TooFine,
}

pub(super) struct Draft<G: Crossing, V> {
    pub(super) t: ConstrainedDelaunay<G, V>,
    /// By cell number: in which region it is, or [`OUTSIDE`].
    pub(super) regions: Vec<u32>,
    /// Cells that have changed; some may have gone since.
    pub(super) fresh: Vec<CellId>,
    /// How many vertices may still be added.
    pub(super) budget: usize,
    /// Constrained edges that are to be split.
    encroached: VecDeque<[VertexId; 2]>,
    origins: Vec<Origin>,
    shells: Shells,
    law: Law,
}

impl<G: Crossing, V: Default> Draft<G, V> {
    pub(super) fn new(t: ConstrainedDelaunay<G, V>, regions: Vec<u32>, law: Law, budget: usize) -> Self {
        let mut draft = Draft {
            regions,
            fresh: Vec::new(),
            budget,
            encroached: VecDeque::new(),
            origins: vec![Origin::Given; t.tds().vertex_slots()],
            shells: Shells::of(&t),
            law,
            t,
        };
        let edges = draft.t.tds().cells().flat_map(|cell| (0..3).map(move |i| (cell, i)));
        let is_first = |&(cell, i): &(CellId, usize)| cell < draft.t.tds().neighbor(cell, i);
        let encroached = edges.filter(is_first).filter(|&(cell, i)| draft.is_encroached(cell, i));
        let encroached = encroached.map(|(cell, i)| draft.t.tds().edge_ends(cell, i)).collect();
        draft.encroached = encroached;
        draft
    }

    pub(super) fn origin(&self, vertex: VertexId) -> Origin {
        self.origins[vertex.index()]
    }

    pub(super) fn is_inside(&self, cell: CellId) -> bool {
        self.regions[cell.index()] != OUTSIDE
    }

    /// Whether an edge is constrained and has a vertex near to it that the law forbids.
    fn is_encroached(&self, cell: CellId, i: usize) -> bool {
        if !self.t.is_constrained(cell, i) {
            return false;
        }
        let tds = self.t.tds();
        let beside = tds.neighbor(cell, i);
        let far = tds.vertex(beside, tds.index_of_neighbor(beside, cell));
        if let Law::Delaunay = self.law {
            let is_hull = far == VertexId::INFINITE || tds.is_infinite(cell);
            return !is_hull && {
                let corners = tds.corners(cell).map(|v| self.t.point(v));
                self.t.geometry().side_of_sphere(corners, self.t.point(far)) == Sign::Positive
            };
        }
        let ends = tds.edge_ends(cell, i);
        let sides = [(cell, tds.vertex(cell, i)), (beside, far)];
        sides.into_iter().any(|(cell, apex)| {
            self.is_inside(cell) && apex != VertexId::INFINITE && self.encroaches(ends, self.t.plan_of(apex))
        })
    }

    /// Whether a place is too near to an edge with these ends.
    fn encroaches(&self, ends: [VertexId; 2], place: [f64; 2]) -> bool {
        let [a, b] = ends.map(|v| self.t.plan_of(v));
        let angle = || Wide::sign(&DotProduct([a, place, b]));
        match self.law {
            Law::Delaunay => false,
            Law::Gabriel => angle() != Sign::Positive,
            Law::Lens(cosine) => {
                angle() == Sign::Negative && {
                    let [u, v] = [minus(a, place), minus(b, place)];
                    -dot(u, v) >= cosine * length(u) * length(v)
                }
            }
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

    /// Splits constrained edges until none is encroached upon that could be split. Says whether there was any change.
    pub(super) fn settle(&mut self) -> bool {
        let before = self.budget;
        while self.budget > 0
            && let Some(ends) = self.encroached.pop_front()
        {
            if self.t.is_wall(ends[0], ends[1]) && self.split(ends) {
                self.budget -= 1;
            }
        }
        self.budget < before
    }

    /// Splits a constrained edge. Says whether the coordinates are fine enough.
    fn split(&mut self, [a, b]: [VertexId; 2]) -> bool {
        let ends_of = |v: VertexId| match self.origin(v) {
            Origin::Wall(ends) => Some(ends),
            _ => None,
        };
        let constraint = ends_of(a).or(ends_of(b)).unwrap_or([a, b]);
        if let Law::Lens(_) = self.law
            && !self.shells.is_in_cluster(constraint)
        {
            self.clear_circle(a, b);
            self.clear_circle(b, a);
        }

        // Phase 1: where.
        let [from, to] = [a, b].map(|v| self.t.plan_of(v));
        let fraction = self.shells.fraction([a, b], constraint, length(minus(to, from)));
        let place = [0, 1].map(|axis| from[axis] * (1.0 - fraction) + to[axis] * fraction + 0.0); // one zero
        let p = self.t.geometry().meet(place, &[[self.t.point(a), self.t.point(b)]]);
        let Some((cell, i)) = self.t.tds().edge(a, b) else { return false };
        if self.t.inner.admit(&p).is_err() {
            return false;
        }

        // Phase 2: the triangles on both sides that see the new vertex, which may lie beside the edge by a rounding, and
        // have it in their circles, are replaced by its star; unless something is nearer to the edge than the rounding.
        let beside = self.t.tds().neighbor(cell, i);
        let sides = [(a, b, self.regions[cell.index()]), (b, a, self.regions[beside.index()])];
        self.t.set_wall(a, b, false);
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
            self.t.set_wall(a, b, true);
            return false;
        }
        let vertex = self.star(zone, p, Origin::Wall(constraint));
        for end in [a, b] {
            self.t.set_wall(vertex, end, true);
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

    /// Replaces a zone by the star of a new vertex.
    fn star(&mut self, mut zone: Zone, p: G::Point, origin: Origin) -> VertexId {
        let vertex = self.t.inner.add_vertex(p, V::default());
        self.t.inner.last = Some(self.t.inner.tds.star(&mut zone, vertex, |walls, i| walls.only(i)));
        self.t.inner.zone = zone;
        self.regions.resize(self.t.tds().cell_slots(), OUTSIDE);
        self.origins.resize(self.t.tds().vertex_slots(), origin);
        self.origins[vertex.index()] = origin;
        vertex
    }

    /// Puts down the region of the cells to the left of the way from one neighbor of a vertex to another.
    fn mark_side(&mut self, from: VertexId, vertex: VertexId, to: VertexId, region: u32) {
        let Some((mut cell, _)) = self.t.tds().edge(from, vertex) else { return };
        while let Some(i) = self.t.tds().index_of(cell, vertex) {
            self.regions[cell.index()] = region;
            self.fresh.push(cell);
            if self.t.tds().vertex(cell, ccw(i)) == to {
                return;
            }
            cell = self.t.tds().neighbor(cell, cw(i));
        }
    }

    /// Takes out vertices that were added between constraints and now are in the circle with the edge from `a` to `b` as
    /// its diameter, on the left, in sight (Chew 1993).
    fn clear_circle(&mut self, a: VertexId, b: VertexId) {
        while let Some((cell, i)) = self.t.tds().edge(a, b) {
            let apex = self.t.tds().vertex(cell, i);
            if apex == VertexId::INFINITE || self.origin(apex) != Origin::Free {
                return;
            }
            let angle = DotProduct([a, apex, b].map(|v| self.t.plan_of(v)));
            if Wide::sign(&angle) != Sign::Negative {
                return;
            }
            let around: Vec<CellId> = self.t.tds().around(apex).collect();
            if self.t.remove_free(apex).is_none() {
                return;
            }
            self.fresh.extend(around.into_iter().filter(|&cell| self.t.tds().is_used(cell)));
        }
    }

    /// Adds a vertex that destroys the triangle in whose circle it is, unless it is too near to constrained edges, or
    /// beyond them.
    ///
    /// No walk is needed. Across an edge that is not constrained the power of a place to the circles of the triangles
    /// falls on the way there; so all triangles on a way from the one in question have the place in their circles, and
    /// the zone that grows from that one holds them. It ends at a constrained edge that has the place on its other side
    /// if the place cannot be seen.
    pub(super) fn add_in(&mut self, cell: CellId, place: [f64; 2]) -> Attempt {
        let [a, b, _] = self.t.tds().corners(cell).map(|v| self.t.point(v));
        let p = self.t.geometry().meet(place, &[[a, b]]);
        if self.t.inner.admit(&p).is_err() || !self.t.inner.in_conflict(cell, &p) {
            return Attempt::TooFine;
        }
        let mut zone = std::mem::take(&mut self.t.inner.zone);
        zone.start(self.t.tds().cell_slots());
        zone.add(cell);
        let inner = &self.t.inner;
        zone.grow(&inner.tds, |from, i, beyond| !inner.tds.cell_data(from).has(i) && inner.in_conflict(beyond, &p));
        let walls = zone.border().filter(|&(cell, i)| self.t.is_constrained(cell, i));
        let is_near = |&(cell, i): &(CellId, usize)| {
            self.t.inner.side_of_facet(cell, i, &p) != Sign::Positive
                || self.encroaches(self.t.tds().edge_ends(cell, i), place)
        };
        let near: Vec<_> = walls.filter(is_near).map(|(cell, i)| self.t.tds().edge_ends(cell, i)).collect();
        if !near.is_empty() {
            zone.finish();
            self.t.inner.zone = zone;
            self.encroached.extend(near);
            return Attempt::Encroaches;
        }
        let region = self.regions[cell.index()];
        let host = zone
            .cells()
            .iter()
            .find(|&&cell| (0..3).all(|i| self.t.inner.side_of_facet(cell, i, &p) != Sign::Negative));
        let p = host.map_or(p, |&host| self.interpolate(host, place));
        let vertex = self.star(zone, p, Origin::Free);
        for cell in self.t.tds().around(vertex) {
            self.regions[cell.index()] = region;
            self.fresh.push(cell);
        }
        self.budget -= 1;
        Attempt::Added
    }

    /// The point at a place in a triangle: on the way from a corner to the other side, which it meets where the way goes
    /// on.
    fn interpolate(&self, cell: CellId, place: [f64; 2]) -> G::Point {
        let corners = self.t.tds().corners(cell).map(|v| self.t.point(v));
        let plans = corners.map(|p| self.t.geometry().plan(p));
        let weight = |i: usize| area([plans[ccw(i)], plans[cw(i)], place]).abs();
        let weights = [0, 1, 2].map(weight);
        // From the furthest corner the other side is met at the best angle.
        let apex = (0..3).min_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap_or(0);
        let [j, k] = [ccw(apex), cw(apex)];
        let part = weights[k] / (weights[j] + weights[k]);
        let foot = [0, 1].map(|axis| plans[j][axis] * (1.0 - part) + plans[k][axis] * part);
        let foot = self.t.geometry().meet(foot, &[[corners[j], corners[k]]]);
        self.t.geometry().meet(place, &[[corners[apex], &foot]])
    }
}
