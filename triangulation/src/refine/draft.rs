//! A mesh under construction: adds vertices between constrained edges.

use std::collections::VecDeque;

use crate::geometry::Crossing;
use crate::kernel::{DotProduct, Kernel, Wide};
use crate::lines::ConstrainedDelaunay;
use crate::num::Sign;
use crate::tds::{CellId, VertexId, Zone, ccw, cw};

use super::quality::OUTSIDE;
use super::shape::{area, is_in_lens, minus};
use super::shells::Shells;

/// The number of vertices for which there is room from the start, however few are given.
const ROOM: usize = 256;

/// The number of cells, or of constrained edges, for which lists have room from the start.
const FEW: usize = 64;

/// The region around a constrained edge in which a vertex encroaches upon it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Encroachment {
    /// The circle through its ends and a vertex on the other side, without its border.
    Delaunay,
    /// The circle that has it as its diameter, with its border.
    Gabriel,
    /// The lens from which it is seen under an angle whose cosine is less than the negative of this
    /// (Chew 1993).
    Lens(f64),
}

/// The reason why a vertex exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum VertexOrigin {
    /// It was there before.
    Given,
    /// It splits a constrained edge, which had these ends.
    OnConstraint([VertexId; 2]),
    /// It destroyed a triangle.
    Free,
}

/// A constrained edge that is to be split.
#[derive(Debug, Clone, Copy)]
pub(super) struct Encroached {
    pub(super) ends: [VertexId; 2],
    /// The cell on its left when it was queued, and its index there: it is looked up only if the
    /// cell has changed.
    pub(super) edge: (CellId, usize),
}

/// The outcome of an attempt to add a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Attempt {
    /// The vertex was added.
    Added,
    /// It would encroach upon a constrained edge, which is queued.
    Encroaches,
    /// The coordinates are too coarse for it.
    TooFine,
}

pub(super) struct Draft<G: Crossing, V> {
    pub(super) t: ConstrainedDelaunay<G, V>,
    /// The region of each cell, or [`OUTSIDE`], by cell number.
    pub(super) regions: Vec<u32>,
    /// Cells that have changed; some may no longer exist.
    pub(super) fresh: Vec<CellId>,
    /// The number of vertices that may still be added.
    pub(super) budget: usize,
    /// Constrained edges that are to be split.
    pub(super) encroached: VecDeque<Encroached>,
    origins: Vec<VertexOrigin>,
    pub(super) shells: Shells,
    pub(super) encroachment: Encroachment,
}

impl<G: Crossing, V: Default> Draft<G, V> {
    pub(super) fn new(
        mut t: ConstrainedDelaunay<G, V>,
        mut regions: Vec<u32>,
        encroachment: Encroachment,
        budget: usize,
    ) -> Self {
        // Lists that are full would grow as much, but each on its own, and small ones repeatedly.
        let count = t.tds().vertex_slots();
        let room = count.max(ROOM).min(budget);
        t.inner.reserve(room);
        t.lines.reserve_splits(ROOM.min(budget));
        regions.reserve(2 * room);
        let mut origins = Vec::with_capacity(count + room);
        origins.resize(count, VertexOrigin::Given);
        let mut draft = Draft {
            regions,
            fresh: Vec::with_capacity(FEW),
            budget,
            encroached: VecDeque::with_capacity(FEW),
            origins,
            shells: Shells::new(count),
            encroachment,
            t,
        };
        for k in 0..draft.t.tds().cell_slots() {
            let cell = CellId::new(k);
            for i in 0..3 {
                if draft.t.is_constrained(cell, i)
                    && cell < draft.t.tds().neighbor(cell, i)
                    && draft.t.tds().is_used(cell)
                    && draft.is_encroached(cell, i)
                {
                    draft.queue_edge((cell, i));
                }
            }
        }
        draft
    }

    pub(super) fn origin(&self, vertex: VertexId) -> VertexOrigin {
        self.origins[vertex.index()]
    }

    pub(super) fn is_inside(&self, cell: CellId) -> bool {
        self.regions[cell.index()] != OUTSIDE
    }

    /// Returns true if an edge is constrained and a vertex encroaches upon it.
    pub(super) fn is_encroached(&self, cell: CellId, i: usize) -> bool {
        self.t.is_constrained(cell, i) && {
            let beside = self.t.tds().neighbor(cell, i);
            let j = self.t.tds().index_of_neighbor(beside, cell);
            self.is_any_apex_near([(cell, i), (beside, j)])
        }
    }

    /// Returns true if one of the vertices opposite an edge, given as the cells on both sides have
    /// it, is too near to it.
    pub(super) fn is_any_apex_near(&self, [left, right]: [(CellId, usize); 2]) -> bool {
        // Of four points in circles one test is enough.
        let is_symmetric = matches!(self.encroachment, Encroachment::Delaunay);
        self.is_apex_near(left.0, left.1) || !is_symmetric && self.is_apex_near(right.0, right.1)
    }

    /// Like [`is_encroached`](Self::is_encroached), but tests the vertex of this cell only: if the
    /// cell is new, the one on the other side has been tested before.
    pub(super) fn is_encroached_by_apex(&self, cell: CellId, i: usize) -> bool {
        self.t.is_constrained(cell, i) && self.is_apex_near(cell, i)
    }

    /// Returns true if the vertex of a cell in the domain is too near to the edge opposite it.
    #[inline]
    fn is_apex_near(&self, cell: CellId, i: usize) -> bool {
        let tds = self.t.tds();
        let corners = tds.corners(cell);
        let [apex, a, b] = [i, ccw(i), cw(i)].map(|k| corners[k]);
        if apex == VertexId::INFINITE || !self.is_inside(cell) {
            return false;
        }
        if let Encroachment::Delaunay = self.encroachment {
            return self.is_in_circle_of(tds.neighbor(cell, i), apex);
        }
        self.encroaches([a, b].map(|v| self.t.point(v)), self.t.point(apex))
    }

    /// Returns true if a vertex is in the circle of a cell, and that one is finite.
    #[inline(never)]
    fn is_in_circle_of(&self, cell: CellId, vertex: VertexId) -> bool {
        !self.t.tds().is_infinite(cell) && {
            let corners = self.t.tds().corners(cell).map(|v| self.t.point(v));
            let side = self
                .t
                .geometry()
                .side_of_sphere(corners, self.t.point(vertex));
            side == Sign::Positive
        }
    }

    /// Returns true if a point is too near to an edge with these ends.
    #[inline(always)]
    fn encroaches(&self, ends: [&G::Point; 2], p: &G::Point) -> bool {
        let geometry = self.t.geometry();
        match self.encroachment {
            Encroachment::Delaunay => false,
            Encroachment::Gabriel => !is_acute(geometry, ends, p),
            Encroachment::Lens(cosine) => {
                let [u, v] = ends.map(|end| minus(geometry.plan(end), geometry.plan(p)));
                is_in_lens(u, v, cosine)
            }
        }
    }

    /// Returns true if a point encroaches upon an edge of a cell or is not strictly on its inner
    /// side.
    fn is_near(&self, cell: CellId, i: usize, p: &G::Point) -> bool {
        let ends = self.points_of_edge(cell, i);
        self.encroaches(ends, p) || is_not_left(self.t.geometry(), ends, p)
    }

    /// Returns the points at the ends of a finite edge.
    #[inline(always)]
    fn points_of_edge(&self, cell: CellId, i: usize) -> [&G::Point; 2] {
        let corners = self.t.tds().corners(cell);
        [ccw(i), cw(i)].map(|k| self.t.point(corners[k]))
    }

    /// Returns true if a point is on a finite edge of a cell or beyond it.
    #[inline(always)]
    pub(super) fn is_beyond(&self, cell: CellId, i: usize, p: &G::Point) -> bool {
        is_not_left(self.t.geometry(), self.points_of_edge(cell, i), p)
    }

    /// Grows the zone of a point that is in conflict with a cell, up to constraints, or to the
    /// first constraint for which `stops` returns true, given as an edge of a cell in the zone.
    /// Returns that one.
    ///
    /// `PERF:` out of line, with the registers to itself.
    #[inline(never)]
    pub(super) fn grow(
        &self,
        zone: &mut Zone,
        start: CellId,
        p: &G::Point,
        stops: impl Fn(CellId, usize) -> bool,
    ) -> Option<(CellId, usize)> {
        let inner = &self.t.inner;
        let mut stopped = None;
        zone.grow(&inner.tds, start, |from, i, beyond| {
            if stopped.is_none() && inner.is_constrained(from, i) {
                stopped = stops(from, i).then_some((from, i));
                false
            } else {
                stopped.is_none() && inner.in_conflict(beyond, p)
            }
        });
        stopped
    }

    /// Replaces a zone by the star of a new vertex, the cells of which are then
    /// [fresh](Self::fresh). `region` returns the region of a cell, given its position on the
    /// border.
    pub(super) fn star(
        &mut self,
        zone: &mut Zone,
        p: G::Point,
        origin: VertexOrigin,
        region: impl Fn(usize) -> u32,
    ) -> VertexId {
        let vertex = self.t.inner.add_vertex(p, V::default());
        let star = self.t.inner.tds.star(zone, vertex, |mask, i| mask.only(i));
        self.t.inner.last = star.last().map(|&(cell, _)| cell);
        self.fresh.reserve(star.len());
        for (k, &(cell, _)) in star.iter().enumerate() {
            let region = region(k);
            match self.regions.get_mut(cell.index()) {
                Some(slot) => *slot = region,
                None => {
                    self.regions.resize(cell.index(), OUTSIDE);
                    self.regions.push(region);
                }
            }
            self.fresh.push(cell);
        }
        self.origins.resize(self.t.tds().vertex_slots(), origin);
        self.origins[vertex.index()] = origin;
        vertex
    }

    /// Adds a vertex that destroys the triangle in whose circle it lies, unless it is too near to
    /// constrained edges or beyond them.
    ///
    /// No walk is needed. Across an edge that is not constrained, the power of a point to the
    /// circles of the triangles falls toward the point. So all triangles between the one in
    /// question and the point have the point in their circles, and the zone that grows from that
    /// one contains them. If the point cannot be seen, the zone ends at a constrained edge that has
    /// the point on its other side.
    pub(super) fn add_in(&mut self, cell: CellId, site: [f64; 2]) -> Attempt {
        let [a, b, _] = self.t.tds().corners(cell).map(|v| self.t.point(v));
        let site = self.t.geometry().on_step(site);
        let p = self.t.geometry().meet(site, &[[a, b]]);
        if self.t.inner.admit(&p).is_err() {
            return Attempt::TooFine;
        }
        // The first of several is enough: once it is split, most of the others need not be.
        // Often it is an edge of the triangle itself.
        let constrained = *self.t.tds().cell_data(cell);
        let is_near = |&i: &usize| constrained.has(i) && self.is_near(cell, i, &p);
        if let Some(i) = (0..3).find(is_near) {
            self.queue_edge((cell, i));
            return Attempt::Encroaches;
        }
        if !self.t.inner.in_conflict(cell, &p) {
            return Attempt::TooFine;
        }
        let mut zone = self.t.inner.take_zone();
        let is_near = |from, i| self.is_near(from, i, &p);
        if let Some((from, i)) = self.grow(&mut zone, cell, &p, is_near) {
            zone.finish();
            self.t.inner.zone = Some(zone);
            self.queue_edge((from, i));
            return Attempt::Encroaches;
        }
        let region = self.regions[cell.index()];
        let p = if self.t.geometry().is_of_sites() {
            p
        } else {
            self.interpolate(zone.cells(), site)
        };
        self.star(&mut zone, p, VertexOrigin::Free, |_| region);
        self.t.inner.zone = Some(zone);
        self.budget -= 1;
        Attempt::Added
    }

    /// Returns the point at a site in one of some triangles. It lies on a line from a corner to the
    /// opposite side, whose foot on that side is interpolated first.
    fn interpolate(&self, cells: &[CellId], site: [f64; 2]) -> G::Point {
        let weights = |&cell: &CellId| {
            let [a, b, c] = self.t.tds().corners(cell).map(|v| self.t.plan_of(v));
            [area([b, c, site]), area([c, a, site]), area([a, b, site])]
        };
        // As near to the inside of one as rounded areas can show.
        let least = |weights: [f64; 3]| weights.into_iter().fold(f64::INFINITY, f64::min);
        let mut host = (cells[0], weights(&cells[0]));
        for cell in &cells[1..] {
            if least(host.1) >= 0.0 {
                break;
            }
            let weights = weights(cell);
            if least(weights) > least(host.1) {
                host = (*cell, weights);
            }
        }
        let (cell, weights) = (host.0, host.1.map(|weight| weight.max(0.0)));
        let corners = self.t.tds().corners(cell).map(|v| self.t.point(v));
        // From the furthest corner the line meets the other side at the best angle.
        let lesser = |i: usize, j: usize| if weights[j] < weights[i] { j } else { i };
        let apex = lesser(lesser(0, 1), 2);
        let [j, k] = [ccw(apex), cw(apex)];
        let part = weights[k] / (weights[j] + weights[k]);
        let [from, to] = [j, k].map(|k| self.t.geometry().plan(corners[k]));
        let foot = [0, 1].map(|axis| from[axis] * (1.0 - part) + to[axis] * part);
        let foot = self.t.geometry().meet(foot, &[[corners[j], corners[k]]]);
        self.t.geometry().meet(site, &[[corners[apex], &foot]])
    }
}

/// Returns true if a point is on a line, which has a direction, or to the right of it.
#[inline(always)]
fn is_not_left<G: Crossing>(geometry: &G, [a, b]: [&G::Point; 2], p: &G::Point) -> bool {
    geometry.orientation([a, b, p]) != Sign::Positive
}

/// Returns true if an edge is seen from a point under an acute angle.
#[inline(never)]
fn is_acute<G: Crossing>(geometry: &G, [a, b]: [&G::Point; 2], p: &G::Point) -> bool {
    Wide::sign(&DotProduct([a, p, b].map(|p| geometry.plan(p)))) == Sign::Positive
}
