//! Flat triangles between contours, and vertices that cure them.
//!
//! Where a contour turns around a ridge, a valley or a summit, triangles have all corners on it,
//! and the surface is flat there, though the ground is not.
//!
//! ```text
//!     ____________________ 20       the chords of the contour 10 are edges of flat triangles;
//!    /     ___________              a vertex at the middle of each gets a height between 10 and 20
//!   /    /  \  |  /    \
//!  |    | ---\-|-/---   | 10
//! ```
//!
//! With a vertex within each chord, no flat triangle is left: a triangle of the corners of contours
//! alone was there before, and an edge of it is such a chord. The height follows from the contours
//! on both sides, see `Band::height`.
//!
//! Sources: Thibault and Gold, *Terrain reconstruction from contours by skeleton construction*
//! (2000), for vertices on the skeleton; the heights are other ones.

use std::cell::RefCell;

use rustc_hash::{FxHashMap, FxHashSet};

use super::boxes::{Boxed, Boxes, Extent, Near};
use super::linear::plan_distance;
use super::nearest::{nearest_part, squared_distance};
use super::thin::is_thin;
use crate::data::EdgeKind;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::num::unsigned_zero;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, LineId};

/// The largest part of the way to the next contour that a vertex may rise.
const MOST: f64 = 0.95;

/// The smallest: a vertex at the height of the contour would cure nothing.
const LEAST: f64 = 0.02;

/// The faces of a surface, and which of its vertices are on contours: on lines with heights, hard
/// or soft.
pub(super) struct Contoured<'a> {
    triangulation: &'a ConstrainedDelaunay<Terrain>,
    /// For each cell number: true if the cell is a face of the surface.
    inside: &'a [bool],
    /// For each vertex: true if it is on a contour.
    is_on_contour: Vec<bool>,
}

impl<'a> Contoured<'a> {
    /// # Complexity
    /// Linear in the length of the lines.
    pub(super) fn new(
        triangulation: &'a ConstrainedDelaunay<Terrain>,
        inside: &'a [bool],
        kind_of: impl Fn(LineId) -> Option<EdgeKind>,
    ) -> Self {
        let mut is_on_contour = vec![false; triangulation.tds().vertex_slots()];
        for line in triangulation.lines() {
            if matches!(kind_of(line), Some(EdgeKind::Breakline | EdgeKind::Soft)) {
                for vertex in triangulation.chain(line) {
                    is_on_contour[vertex.index()] = true;
                }
            }
        }
        Contoured {
            triangulation,
            inside,
            is_on_contour,
        }
    }

    fn point(&self, vertex: VertexId) -> [f64; 3] {
        *self.triangulation.point(vertex)
    }

    fn corners(&self, cell: CellId) -> [[f64; 3]; 3] {
        self.triangulation
            .tds()
            .corners(cell)
            .map(|vertex| self.point(vertex))
    }

    /// Returns true if all corners of a face are on contours of one height.
    fn is_flat(&self, cell: CellId) -> bool {
        let vertices = self.triangulation.tds().corners(cell);
        let height = |vertex: VertexId| self.point(vertex)[2];
        self.inside[cell.index()]
            && vertices
                .iter()
                .all(|vertex| self.is_on_contour[vertex.index()])
            && vertices
                .iter()
                .all(|&vertex| height(vertex) == height(vertices[0]))
    }

    /// Returns the number of flat faces, and their share of the area of all.
    pub(super) fn flat_share(&self) -> (usize, f64) {
        let area = |cell: CellId| {
            let [a, b, c] = self.corners(cell);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let (mut count, mut flat) = (0, 0.0);
        for cell in self.flat_faces() {
            (count, flat) = (count + 1, flat + area(cell));
        }
        if count == 0 {
            return (0, 0.0);
        }
        let faces = self.triangulation.tds().cells();
        let all: f64 = faces
            .filter(|cell| self.inside[cell.index()])
            .map(area)
            .sum();
        (count, flat / all)
    }

    /// Returns the flat faces, without those that are thinner than rounding: these appear where
    /// three vertices of a contour should be on one straight line.
    fn flat_faces(&self) -> impl Iterator<Item = CellId> + '_ {
        let cells = self.triangulation.tds().cells();
        cells.filter(|&cell| self.is_flat(cell) && !is_thin(self.corners(cell), 1.0))
    }

    /// Returns vertices on ridges and valleys: with them no face is flat whose contour has another
    /// one next to it.
    ///
    /// # Complexity
    /// O(n log n).
    pub(super) fn ridge_vertices(&self) -> Vec<[f64; 3]> {
        let flat: Vec<CellId> = self.flat_faces().collect();
        if flat.is_empty() {
            return Vec::new();
        }
        let bands = Bands::new(self);
        let mut candidates: Vec<Candidate> = Vec::new();
        for group in self.groups(&flat) {
            let start = candidates.len();
            for &cell in &group {
                self.add_candidates(cell, &mut candidates);
            }
            let width = candidates[start..]
                .iter()
                .map(|candidate| bands.of(candidate.cell).distance_to_own(candidate.site))
                .fold(0.0, f64::max);
            candidates[start..]
                .iter_mut()
                .for_each(|candidate| candidate.width = width);
        }
        let mut seen = FxHashSet::default();
        candidates.retain(|candidate| seen.insert(candidate.site.map(f64::to_bits)));
        let height = |candidate: &Candidate| {
            let [x, y, _] = candidate.site;
            let height = bands.height(candidate)?;
            Some([x, y, height]).filter(|_| height.is_finite())
        };
        candidates.iter().filter_map(height).collect()
    }

    /// Divides flat faces into groups that are connected over chords.
    fn groups(&self, flat: &[CellId]) -> Vec<Vec<CellId>> {
        let tds = self.triangulation.tds();
        let mut left: FxHashSet<CellId> = flat.iter().copied().collect();
        let mut groups = Vec::new();
        for &start in flat {
            let mut group = Vec::new();
            let mut ahead = vec![start];
            while let Some(cell) = ahead.pop() {
                if left.remove(&cell) {
                    group.push(cell);
                    let open = (0..3).filter(|&i| !self.triangulation.is_constrained(cell, i));
                    ahead.extend(open.map(|i| tds.neighbor(cell, i)));
                }
            }
            if !group.is_empty() {
                groups.push(group);
            }
        }
        groups
    }

    /// Adds the middles of the chords of a flat face, and its own middle if it has none, or three,
    /// or one at the rim.
    fn add_candidates(&self, cell: CellId, candidates: &mut Vec<Candidate>) {
        let tds = self.triangulation.tds();
        let corners = self.corners(cell);
        let mut add = |points: &mut [[f64; 3]]| {
            // In an order that does not depend on the numbering.
            points.sort_unstable_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
            let count = points.len() as f64;
            let [x, y] = [0, 1].map(|k| points.iter().map(|p| p[k] / count).sum::<f64>());
            candidates.push(Candidate {
                cell,
                site: [x, y, corners[0][2]],
                width: 0.0,
            });
        };
        let mut chords = 0;
        for i in (0..3).filter(|&i| !self.triangulation.is_constrained(cell, i)) {
            let beyond = tds.neighbor(cell, i);
            if self.inside[beyond.index()] {
                chords += 1;
                add(&mut [corners[(i + 1) % 3], corners[(i + 2) % 3]]);
            } else {
                chords = 3;
            }
        }
        if chords == 0 || chords >= 3 {
            add(&mut { corners });
        }
    }
}

/// Where a vertex is to be added.
struct Candidate {
    /// A flat face there.
    cell: CellId,
    /// With the height of the contour around it.
    site: [f64; 3],
    /// The largest distance between such a site and the contour, in the same flat area.
    width: f64,
}

/// The faces between contours, and what bounds them.
struct Bands {
    /// For each cell number, the number of its band.
    of_cells: Vec<u32>,
    bands: Vec<Band>,
}

/// What bounds a band: edges on lines, and vertices between them.
struct Band {
    limits: Boxes<Limit>,
    /// For each node of the limits, the heights that each of them has at one end, as bits.
    common: Vec<Common>,
    /// The level limits, by the bits of their height.
    level: FxHashMap<u64, Boxes<Limit>>,
    search: RefCell<Vec<Near>>,
}

/// The heights that each of some limits has at one of its ends.
#[derive(Debug, Clone, Copy)]
enum Common {
    /// There are no limits.
    Any,
    /// These; both may be the same.
    Two([f64; 2]),
    One(f64),
    None,
}

impl Common {
    fn of(limits: &[Limit]) -> Self {
        let ends = |limit: &Limit| Common::Two(limit.ends.map(|end| end[2]));
        limits
            .iter()
            .map(ends)
            .fold(Common::Any, |all, next| all.and(&next))
    }

    fn has(&self, height: f64) -> bool {
        match self {
            Common::Any => true,
            Common::Two(heights) => heights.contains(&height),
            Common::One(one) => *one == height,
            Common::None => false,
        }
    }

    fn and(&self, other: &Self) -> Self {
        match self {
            Common::Any => *other,
            Common::Two([a, b]) => match [a, b].map(|height| other.has(*height)) {
                [true, true] => *self,
                [true, false] => Common::One(*a),
                [false, true] => Common::One(*b),
                [false, false] => Common::None,
            },
            Common::One(one) if other.has(*one) => *self,
            Common::One(_) | Common::None => Common::None,
        }
    }
}

/// An edge on a line, or a vertex.
#[derive(Debug, Clone, Copy)]
struct Limit {
    ends: [[f64; 3]; 2],
    /// The cell across the edge.
    beyond: Option<CellId>,
}

impl Boxed for Limit {
    fn extent(&self) -> Extent {
        Extent::of(self.ends)
    }
}

/// The nearest limit of some kind.
#[derive(Debug, Clone, Copy)]
struct Found {
    distance: f64,
    /// The nearest position, with the height there.
    at: [f64; 3],
    beyond: Option<CellId>,
}

impl Bands {
    fn new(surface: &Contoured) -> Self {
        const NONE: u32 = u32::MAX;
        let tds = surface.triangulation.tds();
        let mut of_cells = vec![NONE; tds.cell_slots()];
        let mut bands = Vec::new();
        let is_face = |cell: CellId| surface.inside[cell.index()];
        for start in tds.cells().filter(|&cell| is_face(cell)) {
            if of_cells[start.index()] != NONE {
                continue;
            }
            let number = bands.len() as u32;
            let mut limits = Vec::new();
            let mut points: FxHashMap<VertexId, [f64; 3]> = FxHashMap::default();
            let mut ahead = vec![start];
            of_cells[start.index()] = number;
            while let Some(cell) = ahead.pop() {
                let corners = surface.corners(cell);
                for (vertex, point) in tds.corners(cell).iter().zip(corners) {
                    if !surface.is_on_contour[vertex.index()] {
                        points.insert(*vertex, point);
                    }
                }
                for i in 0..3 {
                    let beyond = tds.neighbor(cell, i);
                    if surface.triangulation.is_constrained(cell, i) {
                        limits.push(Limit {
                            ends: [corners[(i + 1) % 3], corners[(i + 2) % 3]],
                            beyond: Some(beyond).filter(|&beyond| is_face(beyond)),
                        });
                    } else if is_face(beyond) && of_cells[beyond.index()] == NONE {
                        of_cells[beyond.index()] = number;
                        ahead.push(beyond);
                    }
                }
            }
            limits.extend(points.into_values().map(|p| Limit {
                ends: [p, p],
                beyond: None,
            }));
            bands.push(Band::new(limits));
        }
        Bands { of_cells, bands }
    }

    /// Returns the band of a face.
    fn of(&self, cell: CellId) -> &Band {
        &self.bands[self.of_cells[cell.index()] as usize]
    }

    /// Returns the height of a vertex within a flat area; `None` if its contour has no other one
    /// next to it.
    ///
    /// With d the distance to the contour around it, at height z:
    ///
    /// - If the next contour on this side is at a distance of e, the vertex rises d / (d + e) of
    ///   the way to it.
    /// - If the next contour on the other side is at a distance of b, the ground is a paraboloid
    ///   through both: it rises d (2 r - d) / (b (2 r + b)) of their difference, where r is the
    ///   largest d of the flat area. So summits are round.
    ///
    /// The larger of the two parts is used, but at most [`MOST`].
    fn height(&self, candidate: &Candidate) -> Option<f64> {
        let z = candidate.site[2];
        let band = self.of(candidate.cell);
        let own = band.nearest_at(candidate.site, z)?;
        let next = band.nearest_not_at(candidate.site, z);
        let before = own.beyond.and_then(|beyond| {
            let found = self.of(beyond).nearest_not_at(own.at, z)?;
            let (d, r, b) = (own.distance, candidate.width, found.distance);
            let part = d * (2.0 * r - d) / (b * (2.0 * r + b));
            Some((z - found.at[2], part))
        });
        let (rise, part) = match (next, before) {
            (Some(next), before) => {
                let rise = next.at[2] - z;
                let part = own.distance / (own.distance + next.distance);
                // A slope that goes on.
                let other = before.filter(|(other, _)| (*other > 0.0) == (rise > 0.0));
                (rise, other.map_or(part, |(_, other)| part.max(other)))
            }
            (None, Some(before)) => before,
            (None, None) => return None,
        };
        Some(z + rise * part.clamp(LEAST, MOST))
    }
}

impl Band {
    /// # Complexity
    /// O(n log n).
    fn new(limits: Vec<Limit>) -> Self {
        let mut level: FxHashMap<u64, Vec<Limit>> = FxHashMap::default();
        for limit in &limits {
            let [a, b] = limit.ends.map(|end| end[2]);
            if a == b {
                level.entry(height_key(a)).or_default().push(*limit);
            }
        }
        let limits = Boxes::new(limits);
        Band {
            common: limits.in_common(Common::of, Common::and),
            limits,
            level: level
                .into_iter()
                .map(|(height, limits)| (height, Boxes::new(limits)))
                .collect(),
            search: RefCell::default(),
        }
    }

    /// Returns the nearest limit of a height.
    fn nearest_at(&self, q: [f64; 3], height: f64) -> Option<Found> {
        let level = self.level.get(&height_key(height))?;
        self.nearest(q, level, |_| true, |_| true)
    }

    /// Returns the nearest limit that does not have a height at an end.
    fn nearest_not_at(&self, q: [f64; 3], height: f64) -> Option<Found> {
        // `PERF:` all limits around may have that height.
        let is_wanted = |node: usize| !self.common[node].has(height);
        let is_other = |limit: &Limit| limit.ends.iter().all(|end| end[2] != height);
        self.nearest(q, &self.limits, is_wanted, is_other)
    }

    /// Returns the nearest wanted limit of a tree. Nodes that are not wanted are skipped.
    fn nearest(
        &self,
        q: [f64; 3],
        limits: &Boxes<Limit>,
        is_node_wanted: impl Fn(usize) -> bool,
        is_wanted: impl Fn(&Limit) -> bool,
    ) -> Option<Found> {
        let site = [q[0], q[1]];
        // Of several at one distance always the same.
        let key = |(distance, limit): &(f64, Limit)| {
            let [a, b] = limit.ends;
            if a < b {
                (*distance, a, b)
            } else {
                (*distance, b, a)
            }
        };
        let mut nearest: Option<(f64, Limit)> = None;
        let mut left = self.search.borrow_mut();
        limits.around_in(site, &mut left, is_node_wanted, |limit| {
            if is_wanted(limit) {
                let ends = limit.ends.map(|[x, y, _]| [x, y]);
                let found = (squared_distance(ends, site), *limit);
                if nearest.is_none_or(|nearest| key(&found) < key(&nearest)) {
                    nearest = Some(found);
                }
            }
            nearest.map_or(f64::INFINITY, |(least, _)| least)
        });
        let (
            _,
            Limit {
                ends: [a, b],
                beyond,
            },
        ) = nearest?;
        let part = nearest_part([a, b].map(|[x, y, _]| [x, y]), site);
        let at = [0, 1, 2].map(|k| a[k] + part * (b[k] - a[k]));
        Some(Found {
            distance: plan_distance(at, q),
            at,
            beyond,
        })
    }

    /// Returns the distance to the nearest contour of the height of a site.
    fn distance_to_own(&self, site: [f64; 3]) -> f64 {
        let own = self.nearest_at(site, site[2]);
        own.map_or(0.0, |found| found.distance)
    }
}

/// Returns the same bits for both zeros.
fn height_key(height: f64) -> u64 {
    unsigned_zero(height).to_bits()
}

#[cfg(test)]
mod tests {
    use super::super::{Levels, Tin, TinBuilder, contours};
    use super::{Band, Found, Limit, squared_distance};
    use testkit::random::Random;

    /// The height of a surface at a position.
    type Height = dyn Fn(f64, f64) -> f64;

    /// The contours of a function over a square, from a fine grid, at multiples of an interval.
    fn contours_of(surface: &Height, interval: f64) -> TinBuilder {
        let mut fine = TinBuilder::default();
        let steps = 0..=120;
        for (i, j) in steps
            .clone()
            .flat_map(|i| steps.clone().map(move |j| (i, j)))
        {
            let [x, y] = [f64::from(i), f64::from(j)];
            fine.add_points(&[x], &[y], &[surface(x, y)]);
        }
        let fine = fine.build().unwrap();
        let mut builder = TinBuilder::default();
        for line in contours(&fine, &Levels::every(interval, 0.0).unwrap()).unwrap() {
            let points: Vec<[f64; 3]> = line
                .points
                .iter()
                .map(|&[x, y]| [x, y, line.level])
                .collect();
            builder.add_breakline(&points);
        }
        builder
    }

    /// The root of the mean square of the differences to a function, in parts of the interval.
    fn error(tin: &Tin, surface: &Height, interval: f64) -> f64 {
        let mut random = Random(5);
        let (mut sum, mut count) = (0.0, 0.0);
        for _ in 0..4000 {
            let [x, y] = [0, 1].map(|_| random.below(120_000) as f64 / 1000.0);
            if let Some(z) = tin.elevation(x, y) {
                sum += (z - surface(x, y)).powi(2);
                count += 1.0;
            }
        }
        assert!(count > 3000.0, "{count}");
        f64::sqrt(sum / count) / interval
    }

    #[test]
    fn no_triangle_is_flat_between_the_contours_of_a_known_surface() {
        let hills = |x: f64, y: f64| {
            30.0 * (x / 17.0).sin() * (y / 23.0).cos() + 0.1 * x + 3.0 * ((x + y) / 9.0).sin()
        };
        let cone = |x: f64, y: f64| 40.0 - (x - 60.0).hypot(y - 60.0) / 2.0;
        let dome = |x: f64, y: f64| 80.0 - ((x - 55.0).powi(2) + (y - 62.0).powi(2)) / 60.0;
        let valley = |x: f64, y: f64| (x - 60.0 + 12.0 * (y / 20.0).sin()).abs() / 2.0 + y / 8.0;
        let all: [(&str, &Height); 4] = [
            ("hills", &hills),
            ("cone", &cone),
            ("dome", &dome),
            ("valley", &valley),
        ];
        for (name, surface) in all {
            for interval in [1.7, 5.3] {
                let mut builder = contours_of(surface, interval);
                let plain = builder.clone().build().unwrap();
                let before = plain.report().clone();
                builder.add_ridges = true;
                let cured = builder.build().unwrap();
                let after = cured.report();
                let errors = [&plain, &cured].map(|tin| error(tin, surface, interval));
                assert!(
                    before.flat_triangles > 10 && before.flat_share > 0.0,
                    "{name}"
                );
                assert_eq!((after.flat_triangles, after.flat_share), (0, 0.0), "{name}");
                assert!(after.ridge_vertices > 10 && after.points == 0);
                assert!(
                    errors[1] < 0.1 && errors[1] < 1.05 * errors[0],
                    "{name}: {errors:?}"
                );
            }
        }
    }

    /// Random limits, level and not: what is found is the nearest of those that count.
    #[test]
    fn the_nearest_limits_are_found_among_many_of_one_height() {
        let mut random = Random(11);
        for round in 0..200 {
            let limits: Vec<Limit> = (0..1 + round)
                .map(|_| {
                    let [x, y] = [0, 1].map(|_| random.below(40) as f64);
                    let z = random.pick(&[1.0, 1.0, 1.0, 1.0, 2.0, -0.0, 0.0]);
                    let end = random.pick(&[z, z, z, 1.0]);
                    let [dx, dy] = [0, 1].map(|_| random.below(3) as f64);
                    Limit {
                        ends: [[x, y, z], [x + dx, y + dy, end]],
                        beyond: None,
                    }
                })
                .collect();
            let band = Band::new(limits.clone());
            let expected = |q: [f64; 3], is_wanted: &dyn Fn(f64) -> bool| {
                limits
                    .iter()
                    .filter(|limit| limit.ends.iter().all(|end| is_wanted(end[2])))
                    .map(|limit| squared_distance(limit.ends.map(|[x, y, _]| [x, y]), [q[0], q[1]]))
                    .min_by(f64::total_cmp)
            };
            for _ in 0..20 {
                let q = [0, 1, 2].map(|_| random.below(400) as f64 / 10.0);
                for z in [0.0, 1.0, 2.0, 5.0] {
                    let [own, other] = [band.nearest_at(q, z), band.nearest_not_at(q, z)];
                    let squared = |found: Found| found.distance * found.distance;
                    for (found, expected) in [
                        (own, expected(q, &|height| height == z)),
                        (other, expected(q, &|height| height != z)),
                    ] {
                        assert_eq!(found.is_some(), expected.is_some());
                        let off = found.map_or(0.0, squared) - expected.unwrap_or(0.0);
                        assert!(off.abs() < 1e-9, "round {round}: {found:?}, {expected:?}");
                    }
                }
            }
        }
    }

    /// A search for limits of other heights looks at few of the many that have one height.
    #[test]
    fn limits_of_the_height_itself_are_skipped() {
        let ring = |count: u32, radius: f64, z: f64| {
            let at = move |k: u32| {
                let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
                [radius * angle.cos(), radius * angle.sin(), z]
            };
            (0..count).map(move |k| Limit {
                ends: [at(k), at(k + 1)],
                beyond: None,
            })
        };
        let band = Band::new(ring(4000, 10.0, 5.0).chain(ring(4000, 90.0, 6.0)).collect());
        let looked_at = |z: f64| {
            let mut count = 0;
            let is_wanted = |node: usize| !band.common[node].has(z);
            band.limits
                .around_in([0.0, 9.0], &mut Vec::new(), is_wanted, |_| {
                    count += 1;
                    f64::INFINITY
                });
            count
        };
        assert_eq!(looked_at(7.0), 8000);
        assert!((4000..4100).contains(&looked_at(5.0)), "{}", looked_at(5.0));
    }

    /// A ring alone says neither that the ground rises within it nor that it falls.
    #[test]
    fn what_is_not_known_stays_flat() {
        let ring = |size: f64, z: f64| {
            [
                [-size, -size, z],
                [size, -size, z],
                [size, size, z],
                [-size, size, z],
                [-size, -size, z],
            ]
        };
        let mut builder = TinBuilder::default();
        builder.add_ridges = true;
        builder.add_breakline(&ring(10.0, 5.0));
        let alone = builder.clone().build().unwrap();
        assert_eq!(
            (alone.report().flat_triangles, alone.report().flat_share),
            (2, 1.0)
        );
        assert_eq!(alone.report().ridge_vertices, 0);
        builder.add_breakline(&ring(20.0, 4.0));
        let summit = builder.build().unwrap();
        assert_eq!(summit.report().flat_triangles, 0);
        assert!(
            summit
                .elevation(0.0, 0.0)
                .is_some_and(|z| 5.1 < z && z < 6.0)
        );
    }
}
