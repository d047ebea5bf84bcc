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
        let room = count.max(FEW).min(budget);
        t.inner.reserve(room);
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
        let is_far_apex_near = || {
            let beside = self.t.tds().neighbor(cell, i);
            self.is_apex_near(beside, self.t.tds().index_of_neighbor(beside, cell))
        };
        // Of four points in circles one test is enough.
        let is_symmetric = matches!(self.encroachment, Encroachment::Delaunay);
        self.t.is_constrained(cell, i)
            && (self.is_apex_near(cell, i) || !is_symmetric && is_far_apex_near())
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
        let apex = tds.vertex(cell, i);
        if apex == VertexId::INFINITE || !self.is_inside(cell) {
            return false;
        }
        if let Encroachment::Delaunay = self.encroachment {
            let beside = tds.neighbor(cell, i);
            return !tds.is_infinite(beside) && {
                let corners = tds.corners(beside).map(|v| self.t.point(v));
                self.t
                    .geometry()
                    .side_of_sphere(corners, self.t.point(apex))
                    == Sign::Positive
            };
        }
        self.encroaches(tds.edge_ends(cell, i), self.t.plan_of(apex))
    }

    /// Returns true if a point is too near to an edge with these ends.
    #[inline]
    fn encroaches(&self, ends: [VertexId; 2], site: [f64; 2]) -> bool {
        let [a, b] = ends.map(|v| self.t.plan_of(v));
        let angle = || Wide::sign(&DotProduct([a, site, b]));
        match self.encroachment {
            Encroachment::Delaunay => false,
            Encroachment::Gabriel => angle() != Sign::Positive,
            Encroachment::Lens(cosine) => is_in_lens(minus(a, site), minus(b, site), cosine),
        }
    }

    /// Returns true if a point encroaches upon an edge of a cell or is not strictly on its inner
    /// side.
    fn is_near(&self, cell: CellId, i: usize, p: &G::Point) -> bool {
        self.encroaches(self.t.tds().edge_ends(cell, i), self.t.geometry().plan(p))
            || self.t.inner.side_of_facet(cell, i, p) != Sign::Positive
    }

    /// Grows the zone of a point that is in conflict with a cell, up to constraints, or to the
    /// first constraint for which `stops` returns true, given as an edge of a cell in the zone.
    /// Returns that one.
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
        mut zone: Zone,
        p: G::Point,
        origin: VertexOrigin,
        region: impl Fn(usize) -> u32,
    ) -> VertexId {
        let vertex = self.t.inner.add_vertex(p, V::default());
        let star = self
            .t
            .inner
            .tds
            .star(&mut zone, vertex, |mask, i| mask.only(i));
        self.t.inner.last = star.last().copied();
        self.regions.resize(self.t.inner.tds.cell_slots(), OUTSIDE);
        for (k, &cell) in star.iter().enumerate() {
            self.regions[cell.index()] = region(k);
        }
        self.fresh.extend(star);
        self.t.inner.zone = zone;
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
        let is_near = |&i: &usize| self.t.is_constrained(cell, i) && self.is_near(cell, i, &p);
        if let Some(i) = (0..3).find(is_near) {
            self.queue_edge((cell, i));
            return Attempt::Encroaches;
        }
        if !self.t.inner.in_conflict(cell, &p) {
            return Attempt::TooFine;
        }
        let mut zone = std::mem::take(&mut self.t.inner.zone);
        let is_near = |from, i| self.is_near(from, i, &p);
        if let Some((from, i)) = self.grow(&mut zone, cell, &p, is_near) {
            zone.finish();
            self.t.inner.zone = zone;
            self.queue_edge((from, i));
            return Attempt::Encroaches;
        }
        let region = self.regions[cell.index()];
        let p = if self.t.geometry().is_of_sites() {
            p
        } else {
            self.interpolate(zone.cells(), site)
        };
        self.star(zone, p, VertexOrigin::Free, |_| region);
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
