//! Delaunay refinement: destroys triangles that are too thin or too large by a vertex in their
//! circles.

use std::sync::atomic::Ordering;

use crate::geometry::Crossing;
use crate::tds::{CellId, VertexId, ccw};

use super::draft::{Attempt, Draft, VertexOrigin};
use super::quality::{Quality, Shortfall};
use super::queue::{BadTriangle, Queue};
use super::shape::{Shape, length, minus};

/// Two lengths that differ by less than this fraction are radii of the same circle, rounded.
const SAME_CIRCLE: f64 = 1e-3;

/// A triangle gets no vertex if its shortest edge is shorter than this many units in the last place
/// of a coordinate.
const SHORTEST_IN_UNITS: f64 = 64.0;

/// The flag that cancels is read once per so many triangles.
const LOOK_EVERY: u32 = 256;

/// Off-centers go this fraction of the distance at which the smallest angle is just the requested
/// one: a little nearer, so that the rounded angle is not missed.
const REACH: f64 = 0.95;

pub(super) struct Refiner<'a, G: Crossing, V> {
    pub(super) draft: Draft<G, V>,
    quality: &'a Quality<'a>,
    queue: Queue,
    /// Triangles that do not satisfy the bounds but remain as they are; some may no longer exist.
    left: Vec<BadTriangle>,
    /// The square of the cosine of the requested smallest angle.
    cosine: f64,
    reach: f64,
    /// True if there is any bound on areas: every new triangle is tested, and mostly there is none.
    bounds_areas: bool,
}

impl<'a, G: Crossing, V: Default> Refiner<'a, G, V> {
    pub(super) fn new(draft: Draft<G, V>, quality: &'a Quality<'a>) -> Self {
        let angle = quality.angle().to_radians();
        let reach = REACH / 2.0 / (angle / 2.0).tan();
        // The rounded cosine of a sliver may be larger than one.
        let cosine = if angle > 0.0 {
            angle.cos().powi(2)
        } else {
            f64::INFINITY
        };
        let bounds_areas = quality.bounds_areas();
        Refiner {
            draft,
            quality,
            queue: Queue::default(),
            left: Vec::new(),
            cosine,
            reach,
            bounds_areas,
        }
    }

    pub(super) fn run(&mut self) {
        self.draft.split_encroached();
        self.draft.fresh.clear();
        let cells: Vec<CellId> = self.draft.t.tds().cells().collect();
        cells.into_iter().for_each(|cell| self.test(cell));
        let mut tried = 0;
        while self.draft.budget > 0
            && let Some(bad) = self.queue.pop()
        {
            tried += 1;
            if tried % LOOK_EVERY == 0
                && self
                    .quality
                    .cancel
                    .is_some_and(|cancel| cancel.load(Ordering::Relaxed))
            {
                self.draft.budget = 0;
                break;
            }
            let Some(shape) = self.still_bad(&bad) else {
                continue;
            };
            if self.is_to_stay(bad.cell, &shape) {
                self.left.push(bad);
                continue;
            }
            match self.draft.add_in(bad.cell, shape.off_center(self.reach)) {
                Attempt::Added => {}
                Attempt::Encroaches if self.draft.split_encroached() => self.queue.push(bad),
                Attempt::Encroaches | Attempt::TooFine => self.left.push(bad),
            }
            // Vertices may have been removed even if a split failed.
            let mut fresh = std::mem::take(&mut self.draft.fresh);
            fresh.drain(..).for_each(|cell| self.test(cell));
            self.draft.fresh = fresh;
        }
    }

    /// Returns the shape of a triangle; `None` for a cell that has the infinite vertex or is no
    /// longer in use.
    #[inline(always)]
    fn shape(&self, cell: CellId) -> Option<Shape> {
        let t = &self.draft.t;
        // Only vertices have points.
        let point = |v: VertexId| t.points().get(v.index()).map(|p| t.geometry().plan(p));
        let [a, b, c] = *t.tds().corners(cell);
        Some(Shape::of([point(a)?, point(b)?, point(c)?]))
    }

    /// Queues a cell if it is a triangle of the domain that does not satisfy the bounds.
    ///
    /// `PERF:` most of these are gone before their turn, so that nothing else is computed for them.
    #[inline]
    fn test(&mut self, cell: CellId) {
        if let Some(shape) = self.bad(cell) {
            self.queue.push(BadTriangle {
                cell,
                corners: *self.draft.t.tds().corners(cell),
                shortest: shape.shortest(),
            });
        }
    }

    /// Returns the shape of a cell if it is a triangle of the domain that does not satisfy the
    /// bounds.
    #[inline(always)]
    fn bad(&self, cell: CellId) -> Option<Shape> {
        let shape = self.draft.is_inside(cell).then(|| self.shape(cell))??;
        (self.is_too_large(cell, &shape) || self.is_too_thin(&shape)).then_some(shape)
    }

    /// Returns true if a triangle that does not satisfy the bounds remains as it is.
    fn is_to_stay(&self, cell: CellId, shape: &Shape) -> bool {
        !self.is_too_large(cell, shape) && self.why_thin(cell, shape).is_some()
    }

    /// Returns the shape of a recorded triangle if it still exists and still does not satisfy the
    /// bounds. Vertices are removed, so that both its number and those of its corners may have been
    /// reused.
    fn still_bad(&self, bad: &BadTriangle) -> Option<Shape> {
        if *self.draft.t.tds().corners(bad.cell) == bad.corners {
            self.bad(bad.cell)
        } else {
            None
        }
    }

    #[inline]
    fn is_too_large(&self, cell: CellId, shape: &Shape) -> bool {
        self.bounds_areas && self.exceeds_bounds(cell, *shape)
    }

    /// `PERF:` given a copy, so that the shape of most triangles is never in memory.
    #[inline(never)]
    fn exceeds_bounds(&self, cell: CellId, shape: Shape) -> bool {
        let quality = self.quality;
        let region = (self.draft.regions[cell.index()] as usize).checked_sub(1);
        let of_region = region
            .and_then(|k| quality.regions.get(k))
            .map_or(f64::INFINITY, |region| region.max_area);
        let bound = quality.max_area.min(of_region);
        let area = shape.area();
        area > bound
            || quality
                .area_at
                .is_some_and(|area_at| area > area_at(shape.center()))
    }

    #[inline(always)]
    fn is_too_thin(&self, shape: &Shape) -> bool {
        shape.is_thinner(self.cosine)
    }

    /// Returns why a triangle that is too thin remains as it is; `None` if it is to be destroyed.
    fn why_thin(&self, cell: CellId, shape: &Shape) -> Option<Shortfall> {
        let corners = self.draft.t.tds().corners(cell);
        let ends = [corners[shape.first()], corners[ccw(shape.first())]];
        if self.spans_small_angle(ends) {
            return Some(Shortfall::SmallAngle);
        }
        let largest = ends
            .map(|v| self.draft.t.plan_of(v).map(f64::abs))
            .as_flattened()
            .iter()
            .copied()
            .fold(0.0, f64::max);
        (shape.shortest().sqrt() < SHORTEST_IN_UNITS * f64::EPSILON * largest)
            .then_some(Shortfall::Coordinates)
    }

    /// Returns true if an edge spans a small angle between two constraints, from one to the other,
    /// on a circle around the apex. A triangle over it can be no better than that angle, and
    /// splitting it would make the next one as thin (Miller, Pav and Walkington 2003).
    fn spans_small_angle(&self, [a, b]: [VertexId; 2]) -> bool {
        let (VertexOrigin::OnConstraint(ab), VertexOrigin::OnConstraint(cd)) =
            (self.draft.origin(a), self.draft.origin(b))
        else {
            return false;
        };
        let apex = ab.into_iter().find(|v| cd.contains(v));
        ab != cd
            && apex.is_some_and(|apex| {
                let [to_a, to_b] = [a, b]
                    .map(|v| length(minus(self.draft.t.plan_of(v), self.draft.t.plan_of(apex))));
                (to_a - to_b).abs() < SAME_CIRCLE * to_a
            })
    }

    /// Returns the triangles that do not satisfy the bounds, in order of their numbers, each with
    /// the reason. All others have been tested since they were created.
    pub(super) fn shortfall(&mut self) -> Vec<(CellId, Shortfall)> {
        let mut bad = std::mem::take(&mut self.left);
        bad.extend(std::iter::from_fn(|| self.queue.pop()));
        let mut cells: Vec<CellId> = bad
            .iter()
            .filter(|bad| self.still_bad(bad).is_some())
            .map(|bad| bad.cell)
            .collect();
        cells.sort_unstable();
        cells.dedup();
        let rest = if self.draft.budget == 0 {
            Shortfall::Limit
        } else {
            Shortfall::Coordinates
        };
        let why = |cell: CellId| {
            let shape = self.shape(cell).filter(|shape| self.is_too_thin(shape));
            let reason = shape.and_then(|shape| self.why_thin(cell, &shape));
            (cell, reason.unwrap_or(rest))
        };
        cells.into_iter().map(why).collect()
    }
}
