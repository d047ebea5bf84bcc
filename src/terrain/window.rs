//! A test whether the triangulation of some of the points equals that of all of them, within a box.
//!
//! A triangle of the points that were read is also a triangle of all points if no unread point lies
//! in its circumdisk, as far as the disk is visible from the triangle past constraints. Unread
//! points lie outside of the box that was read; so boxes around all points are all that has to be
//! known of them. Arithmetic is rounded, and disks are enlarged by more than all rounding errors: a
//! triangle that is reported as certain is certain. The opposite need not hold: the work is
//! bounded, and what would take more is reported as not certain.

use super::rim_rule::RimRule;
use crate::data::Bounds;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::num::Sign;
use crate::triangulation::tds::{CellId, VertexId};

/// The boxes, in plan, of the points that were read and of all points.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadWindow {
    /// All points in this box were read, including those on its border.
    pub read: Bounds,
    /// Each point lies in one of these boxes, whether read or not: those around its files, say.
    pub all: Vec<Bounds>,
}

/// A box in plan: the smallest and the largest corner.
type Box2 = [[f64; 2]; 2];

impl ReadWindow {
    /// Returns true if there may be unread points.
    pub(super) fn is_partial(&self) -> bool {
        !self.unread().parts.is_empty()
    }

    /// The boxes that may contain unread points. They overlap at the corners.
    fn unread(&self) -> Unread {
        let read = in_plan(&self.read);
        let mut parts: Vec<Box2> = Vec::new();
        for all in self.all.iter().filter(|all| !all.is_empty()) {
            for axis in 0..2 {
                let (mut below, mut above) = (in_plan(all), in_plan(all));
                below[1][axis] = below[1][axis].min(read[0][axis].next_down());
                above[0][axis] = above[0][axis].max(read[1][axis].next_up());
                parts.extend(
                    [below, above]
                        .into_iter()
                        .filter(|[min, max]| min[axis] <= max[axis]),
                );
            }
        }
        Unread { read, parts }
    }
}

fn in_plan(Bounds { min, max }: &Bounds) -> Box2 {
    [[min[0], min[1]], [max[0], max[1]]]
}

/// Where unread points may be.
struct Unread {
    /// Not in here.
    read: Box2,
    /// In these only.
    parts: Vec<Box2>,
}

impl Unread {
    /// Returns true if an unread point may lie in a box.
    fn meets(&self, part: Box2) -> bool {
        let is_read =
            (0..2).all(|k| self.read[0][k] <= part[0][k] && part[1][k] <= self.read[1][k]);
        !is_read
            && self
                .parts
                .iter()
                .any(|&unread| overlap(part, unread).is_some())
    }

    /// Returns true if an unread point may lie in a disk.
    fn meets_disk(&self, disk: &Disk) -> bool {
        self.meets(disk.bounds()) && self.parts.iter().any(|&unread| disk.meets(unread))
    }
}

/// Counts the triangles that meet a box, or were cut along it, and that unread points may change.
///
/// Also counted are triangles that connect triangles in the box to the rim over unconstrained edges
/// that are open to them, and edges of the hull that unread points may change.
///
/// # Complexity
/// Linear in the number of triangles. Triangles near the border of what was read are counted as
/// changeable, without a search, once the circles of those before have met as many triangles as
/// there are.
pub(super) fn uncertain(
    triangulation: &ConstrainedDelaunay<Terrain>,
    bounds: &Bounds,
    window: &ReadWindow,
    rule: RimRule,
    cut: &[CellId],
) -> usize {
    let unread = window.unread();
    if unread.parts.is_empty() {
        return 0;
    }
    let tds = triangulation.tds();
    let mut judge = Judge {
        triangulation,
        unread,
        visits_left: tds.cell_slots(),
    };
    let within = in_plan(bounds);
    let mut is_seen = vec![false; tds.cell_slots()];
    let mut ahead: Vec<CellId> = tds
        .cells()
        .filter(|&cell| match judge.hull_edge(cell) {
            None => overlap(judge.box_of(cell), within).is_some(),
            // A triangle beyond an edge along the box counts, because a cut along the box meets it.
            Some(edge) => judge.is_beyond(edge, within, Sign::Zero),
        })
        .collect();
    ahead.extend(cut);
    let beside = cut.iter().flat_map(|&cell| tds.cell_neighbors(cell));
    ahead.extend(beside.filter(|&&cell| tds.is_infinite(cell)));
    ahead.retain(|cell| !std::mem::replace(&mut is_seen[cell.index()], true));
    let mut uncertain = 0;
    while let Some(cell) = ahead.pop() {
        if let Some(edge) = judge.hull_edge(cell) {
            uncertain += usize::from(
                judge
                    .unread
                    .parts
                    .iter()
                    .any(|&unread| judge.is_beyond(edge, unread, Sign::Positive)),
            );
            continue;
        }
        uncertain += usize::from(!judge.is_certain(cell));
        let corners = tds.corners(cell).map(|vertex| *triangulation.point(vertex));
        for i in (0..3).filter(|&i| !triangulation.is_constrained(cell, i)) {
            let beyond = tds.neighbor(cell, i);
            if rule.is_open(&corners, i) && !std::mem::replace(&mut is_seen[beyond.index()], true) {
                ahead.push(beyond);
            }
        }
    }
    uncertain
}

struct Judge<'a> {
    triangulation: &'a ConstrainedDelaunay<Terrain>,
    unread: Unread,
    /// How many more triangles may be looked at for the disks of others.
    visits_left: usize,
}

impl Judge<'_> {
    fn site(&self, vertex: VertexId) -> [f64; 2] {
        let [x, y, _] = *self.triangulation.point(vertex);
        [x, y]
    }

    fn ends(&self, cell: CellId, i: usize) -> [[f64; 2]; 2] {
        self.triangulation
            .tds()
            .edge_ends(cell, i)
            .map(|vertex| self.site(vertex))
    }

    fn corners(&self, cell: CellId) -> [[f64; 2]; 3] {
        self.triangulation
            .tds()
            .corners(cell)
            .map(|vertex| self.site(vertex))
    }

    fn box_of(&self, cell: CellId) -> Box2 {
        let [a, b, c] = self.corners(cell);
        [
            [0, 1].map(|k| a[k].min(b[k]).min(c[k])),
            [0, 1].map(|k| a[k].max(b[k]).max(c[k])),
        ]
    }

    /// The hull edge of an infinite cell, with the outside on its left.
    fn hull_edge(&self, cell: CellId) -> Option<[[f64; 2]; 2]> {
        let infinite = self
            .triangulation
            .tds()
            .index_of(cell, VertexId::INFINITE)?;
        Some(self.ends(cell, infinite))
    }

    /// Returns true if a box reaches beyond the line of a hull edge, or to it if `least` is zero.
    fn is_beyond(&self, [p, q]: [[f64; 2]; 2], [min, max]: Box2, least: Sign) -> bool {
        let space = |[x, y]: [f64; 2]| [x, y, 0.0];
        let corners = [min, [max[0], min[1]], max, [min[0], max[1]]].map(space);
        let geometry = self.triangulation.geometry();
        corners.iter().any(|corner| {
            !geometry.admits(corner)
                || geometry.orientation([&space(p), &space(q), corner]) >= least
        })
    }

    /// Returns true if the longest side of a sliver is a constraint.
    ///
    /// The circumdisk of a sliver is nearly a half plane, which lies beyond that side except for a
    /// cap no wider than the sliver.
    fn is_hidden(&self, cell: CellId) -> bool {
        let length = |&i: &usize| {
            let [p, q] = self.ends(cell, i);
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        let longest = (0..3).max_by(|i, j| length(i).total_cmp(&length(j)));
        let [min, max] = self.box_of(cell);
        let width = THIN
            * (0..2)
                .map(|k| min[k].abs().max(max[k].abs()))
                .fold(0.0, f64::max);
        let around = [min.map(|c| c - width), max.map(|c| c + width)];
        longest.is_some_and(|i| self.triangulation.is_constrained(cell, i))
            && !self.unread.meets(around)
    }

    /// Returns true if no unread point can lie in the part of the circumdisk that is visible from
    /// the triangle, and this is found with the visits that are left.
    fn is_certain(&mut self, cell: CellId) -> bool {
        let Some(disk) = Disk::around(self.corners(cell)) else {
            return self.is_hidden(cell);
        };
        if !self.unread.meets_disk(&disk) {
            return true;
        }
        let is_open = |judge: &Self, part: Box2| {
            overlap(part, disk.bounds()).is_some_and(|part| judge.unread.meets(part))
        };
        let tds = self.triangulation.tds();
        // The triangles that are visible, each with the neighbor from which it was entered; it is
        // left by its other edges. Constraints hide what is behind them, so that cycles exist
        // around vertices only.
        let mut ahead: Vec<(CellId, Option<CellId>)> = Vec::new();
        let mut seen = rustc_hash::FxHashSet::default();
        let mut here = Some((cell, None));
        while let Some((cell, from)) = here {
            let Some(left) = self.visits_left.checked_sub(1) else {
                return false;
            };
            self.visits_left = left;
            if tds.is_infinite(cell) || is_open(self, self.box_of(cell)) {
                return false;
            }
            for i in 0..3 {
                let beyond = tds.neighbor(cell, i);
                let is_open_edge =
                    Some(beyond) != from && !self.triangulation.is_constrained(cell, i);
                if is_open_edge && disk.meets_segment(self.ends(cell, i)) && seen.insert(beyond) {
                    ahead.push((beyond, Some(cell)));
                }
            }
            here = ahead.pop();
        }
        true
    }
}

/// The ratio of width to size below which rounding hides how large a triangle's circle is.
const THIN: f64 = 1.0 / (1u64 << 40) as f64;

/// The intersection of two boxes, if there is one.
fn overlap([a, b]: Box2, [c, d]: Box2) -> Option<Box2> {
    let common = [
        [0, 1].map(|k| a[k].max(c[k])),
        [0, 1].map(|k| b[k].min(d[k])),
    ];
    (0..2)
        .all(|k| common[0][k] <= common[1][k])
        .then_some(common)
}

/// A disk that contains the closed circumdisk of a triangle, and is about a hundredth larger.
#[derive(Debug, Clone, Copy)]
struct Disk {
    center: [f64; 2],
    radius: f64,
}

impl Disk {
    /// The disk of a triangle; `None` if it is so thin that rounding hides how large its circle is.
    fn around([a, b, c]: [[f64; 2]; 3]) -> Option<Self> {
        // Computed relative to a corner. The relative error of the area is at most 2^-50 / THIN
        // here, which the hundredth covers; `lost` is what the differences below lose by
        // cancellation.
        const LOST: f64 = 1.0 / (1u64 << 48) as f64;
        let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
        let (p, q) = (u[0] * v[1], u[1] * v[0]);
        let area = p - q;
        if area.is_nan() || area <= THIN * (p.abs() + q.abs()) {
            return None;
        }
        let [uu, vv] = [u, v].map(|w| w[0] * w[0] + w[1] * w[1]);
        let terms = [uu * v[1], vv * u[1], vv * u[0], uu * v[0]];
        let to_center = [
            (terms[0] - terms[1]) / (2.0 * area),
            (terms[2] - terms[3]) / (2.0 * area),
        ];
        let lost = LOST * terms.iter().map(|term| term.abs()).sum::<f64>() / area;
        let center = [a[0] + to_center[0], a[1] + to_center[1]];
        let far = a[0].abs() + a[1].abs();
        let radius = 1.01 * (to_center[0].hypot(to_center[1]) + lost) + LOST * far;
        radius.is_finite().then_some(Disk { center, radius })
    }

    fn bounds(&self) -> Box2 {
        [
            self.center.map(|c| c - self.radius),
            self.center.map(|c| c + self.radius),
        ]
    }

    fn meets(&self, [min, max]: Box2) -> bool {
        let gap = |k: usize| {
            (min[k] - self.center[k])
                .max(self.center[k] - max[k])
                .max(0.0)
        };
        gap(0).hypot(gap(1)) <= self.radius
    }

    fn meets_segment(&self, [a, b]: [[f64; 2]; 2]) -> bool {
        let [u, v] = [
            [b[0] - a[0], b[1] - a[1]],
            [self.center[0] - a[0], self.center[1] - a[1]],
        ];
        let along = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
        (v[0] - along * u[0]).hypot(v[1] - along * u[1]) <= self.radius
    }
}
