mod build;
mod rim;
#[cfg(test)]
mod rim_tests;
mod sites;

use std::ops::Range;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::clip::Clip;
use super::lines::areas::{Replaced, Water, WaterLevel};
use super::lines::kinds::Precedence;
use super::lines::narrowest;
use super::lines::overlap::{self, Marks};
use super::{CrossingRule, DuplicateRule, Flat, ReadWindow, RimRule, River, Wall, WaterOverlap};
use crate::crs::Crs;
use crate::data::{AT_ONCE, Bounds, EdgeKind};
use crate::triangulation::OnCrossing;
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::num::unsigned_zero;

/// Builds a [`Tin`](super::Tin) from points and breaklines.
///
/// A point that lies on a breakline between two of its vertices stays a vertex, with its own
/// height: the surface follows the line in plan and the point in height. [`take_replaced_points`
/// ](Self::take_replaced_points) is for water and walls only.
///
/// The result depends on the set of points and lines only, not on the order in which they are
/// added. The exceptions are [`DuplicateRule::First`] and [`Last`](DuplicateRule::Last), for
/// duplicates and crossings.
///
/// ```
/// use breakline::data::Surface;
/// use breakline::terrain::TinBuilder;
///
/// let mut builder = TinBuilder::default();
/// builder.add_points(&[0.0, 9.0, 9.0, 0.0], &[0.0, 0.0, 9.0, 9.0], &[1.0, 1.0, 2.0, 2.0]);
/// builder.add_breakline(&[[2.0, 5.0, 0.0], [7.0, 5.0, 0.0]]);
/// let tin = builder.build()?;
/// assert_eq!(tin.report().triangles, 6);
/// assert_eq!(tin.elevation(4.0, 5.0), Some(0.0));
/// # Ok::<(), breakline::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct TinBuilder {
    /// Which height is used where several points share a site.
    pub duplicates: DuplicateRule,
    /// What happens when breaklines cross between their vertices.
    pub on_crossing: OnCrossing,
    /// Which height a vertex gets where breaklines cross between their vertices.
    ///
    /// A vertex that several breaklines were given with gets its height by
    /// [`duplicates`](Self::duplicates).
    pub crossing_heights: CrossingRule,
    /// The largest difference of heights at a crossing of breaklines, or of waters that overlap
    /// or touch, that is not reported, in units of height.
    pub crossing_tolerance: f64,
    /// The longest edge (in plan, in the units of the data) at the rim of the surface.
    ///
    /// Faces that can be reached from outside over longer unconstrained edges are left out. `None`
    /// keeps the whole convex hull.
    pub max_edge: Option<f64>,
    /// The longest edge (in plan, in the units of the data) anywhere: faces with a longer
    /// unconstrained edge are left out, except in water. `None` keeps them.
    pub max_edge_inside: Option<f64>,
    /// True to leave out caps at the rim, too: faces with an angle over 165 degrees that can be
    /// reached from outside over their longest edge, see [`RimRule`]. They follow the hull of the
    /// points, however long or short they are, and not the ground.
    pub leave_out_caps: bool,
    /// True to add vertices on ridges and valleys, where triangles between contours would be flat.
    /// Their heights follow from the contours around them.
    pub add_ridges: bool,
    /// The distance in plan, in the units of the data, within which heights change where waters of
    /// different heights overlap: outside of the overlap, a river has its own heights from there
    /// on. `None` is 0.01. At least 1000 units in the last place of the largest coordinate are
    /// used.
    pub step_width: Option<f64>,
    /// Clips the surface to this box in plan.
    pub bounds: Option<Bounds>,
    /// What was read, if not all points are added but those needed for [`bounds`](Self::bounds).
    ///
    /// [`TinReport::uncertain`](super::TinReport::uncertain) then says whether they suffice.
    pub window: Option<ReadWindow>,
    /// The box in plan within which crossings and walls are judged, if the surface is clipped to
    /// it later, by somebody else; with [`bounds`](Self::bounds), these count.
    pub(crate) judged: Option<Bounds>,
    /// The coordinate system of all points and lines.
    pub crs: Option<Crs>,
    points: Vec<[f64; 3]>,
    /// The vertices of all breaklines, one after the other.
    line_points: Vec<[f64; 3]>,
    /// For each breakline, where its vertices end.
    line_ends: Vec<usize>,
    /// For each line, the kind of its edges.
    line_kinds: Vec<EdgeKind>,
    /// For each line, which others it counts before.
    precedences: Vec<Precedence>,
    /// Areas with heights of their own, and the points that they replace.
    waters: Vec<Water>,
    /// What waters that overlap need; `None` as long as that is not known.
    overlaps: Option<Overlaps>,
    /// What became of waters at the rim; `None` as long as they are not cut there.
    ended: Option<EndedWaters>,
    replaced: Replaced,
    replaced_points: Vec<[f64; 3]>,
    /// Lines in plan that the finished surface is cut along.
    draped: Vec<Vec<[f64; 2]>>,
    /// The areas to leave out, as rings in plan.
    holes: Vec<Vec<Vec<[f64; 2]>>>,
    /// The polygons to clip to, as rings in plan.
    boundaries: Vec<Vec<Vec<[f64; 2]>>>,
}

/// What waters that overlap have added to the lines.
#[derive(Debug, Clone, Default)]
struct Overlaps {
    /// The number of lines before.
    given: usize,
    /// For each line that was added, one of the same water that was given.
    named: Vec<usize>,
    /// The pairs of waters that overlap, by their positions in the list of all.
    pairs: Vec<[usize; 2]>,
    found: Vec<WaterOverlap>,
}

impl Overlaps {
    /// The line that names a line.
    fn named(&self, line: usize) -> usize {
        line.checked_sub(self.given)
            .and_then(|added| self.named.get(added).copied())
            .unwrap_or(line)
    }
}

/// What became of waters at the rim.
#[derive(Debug, Clone, Default)]
struct EndedWaters {
    /// The first line of each water that reached beyond the rim, within what is judged.
    first_lines: Vec<usize>,
    /// The triangles at the rim that points outside of the window may change.
    uncertain: usize,
}

/// The default of [`TinBuilder::step_width`].
const STEP_WIDTH: f64 = 0.01;

/// Replaces -0 by 0: sites are compared bit by bit when sorted, and neither zero is the lower one.
fn positive_zero([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, y, z].map(unsigned_zero)
}

impl TinBuilder {
    /// Adds points given as columns of equal length.
    ///
    /// # Panics
    /// If the columns differ in length.
    pub fn add_points(&mut self, x: &[f64], y: &[f64], z: &[f64]) {
        assert!(
            x.len() == y.len() && y.len() == z.len(),
            "columns of different lengths"
        );
        self.points.reserve(x.len());
        self.points.extend(
            x.iter()
                .zip(y)
                .zip(z)
                .map(|((&x, &y), &z)| positive_zero([x, y, z])),
        );
    }

    /// Adds points from a vector; the first vector is taken over without a copy.
    pub fn add_owned_points(&mut self, mut points: Vec<[f64; 3]>) {
        points
            .par_iter_mut()
            .with_min_len(AT_ONCE)
            .for_each(|point| *point = positive_zero(*point));
        if self.points.is_empty() {
            self.points = points;
        } else {
            self.points.append(&mut points);
        }
    }

    /// Reserves memory for exactly that many more points.
    pub fn reserve(&mut self, points: usize) {
        self.points.reserve_exact(points);
    }

    /// Adds a breakline: the surface contains its vertices and the segments between them.
    ///
    /// At a site that a point and a breakline share, the breakline's height is used.
    ///
    /// Lines of all kinds are numbered in the order in which they are added, from 0; draped lines
    /// are not.
    pub fn add_breakline(&mut self, line: &[[f64; 3]]) {
        self.add_line(line, EdgeKind::Breakline);
    }

    /// Adds a soft line: like a breakline, but smooth methods of interpolation pass over it.
    pub fn add_soft_line(&mut self, line: &[[f64; 3]]) {
        self.add_line(line, EdgeKind::Soft);
    }

    /// Adds the upper and the lower edge of a wall, and leaves out the points between them. Returns
    /// the numbers of these lines.
    pub fn add_wall(&mut self, wall: &Wall) -> Range<usize> {
        self.replaced.add_wall(wall);
        let first = self.line_count();
        self.add_line(&wall.upper, EdgeKind::Wall);
        self.add_line_as(&wall.lower, EdgeKind::Wall, Precedence::of_lower_edge());
        first..self.line_count()
    }

    /// Adds a lake: its shore and all vertices inside have its height, and no point inside is used.
    /// Returns the numbers of its rings among the lines.
    pub fn add_flat(&mut self, flat: Flat) -> Range<usize> {
        self.replaced.add_flat(&flat);
        let first = self.line_count();
        flat.rings
            .iter()
            .for_each(|ring| self.add_line(ring, EdgeKind::Shore));
        let lines = first..self.line_count();
        self.waters.push(Water {
            lines: lines.clone(),
            rim: lines.clone().collect(),
            level: WaterLevel::Flat(flat),
        });
        lines
    }

    /// Adds a river: its banks, and level lines between them. No point inside is used. Returns the
    /// numbers of these lines.
    pub fn add_river(&mut self, river: River) -> Range<usize> {
        self.replaced.add_river(&river);
        let first = self.line_count();
        river
            .banks()
            .iter()
            .for_each(|bank| self.add_line(bank, EdgeKind::Bank));
        river
            .level_lines()
            .iter()
            .for_each(|line| self.add_line(line, EdgeKind::Bank));
        let lines = first..self.line_count();
        // The banks, and the level lines at both ends.
        let rim = vec![first, first + 1, first + 2, lines.end - 1];
        self.waters.push(Water {
            lines: lines.clone(),
            rim,
            level: WaterLevel::River(river),
        });
        lines
    }

    /// Drapes a line over the finished surface: it gets the heights of the surface, and a vertex
    /// wherever it crosses an edge. The surface stays as it is.
    pub fn add_draped_line(&mut self, line: &[[f64; 2]]) {
        self.draped.push(line.to_vec());
    }

    /// Leaves out an area of the finished surface, given as its rings in plan.
    ///
    /// The even-odd rule applies: a ring within a ring is an island.
    pub fn add_hole(&mut self, rings: &[Vec<[f64; 2]>]) {
        self.holes.push(rings.to_vec());
    }

    /// Removes the points in water and between the edges of walls, which are not part of the
    /// surface, and returns them in order.
    pub fn take_replaced_points(&mut self) -> Vec<[f64; 3]> {
        let points = if self.replaced.is_empty() {
            Vec::new()
        } else {
            self.replaced.split_off(&mut self.points)
        };
        // They count where the surface ends.
        self.replaced_points.extend_from_slice(&points);
        points
    }

    /// Removes the points that this builder's water and walls replace from a list, and returns
    /// their number.
    pub(crate) fn take_replaced(&self, points: &mut Vec<[f64; 3]>) -> usize {
        if self.replaced.is_empty() {
            return 0;
        }
        self.replaced.split_off(points).len()
    }

    /// Returns true if there are lakes or rivers.
    pub(crate) fn has_waters(&self) -> bool {
        !self.waters.is_empty()
    }

    /// Returns the lines of all kinds in plan.
    pub(crate) fn lines_in_plan(&self) -> Vec<Vec<[f64; 2]>> {
        (0..self.line_count())
            .map(|number| self.line(number).iter().map(|p| [p[0], p[1]]).collect())
            .collect()
    }

    /// Adds the lines that waters need where they overlap, once all of them are known. Building
    /// does that, too.
    pub(crate) fn mark_overlaps(&mut self) {
        let geometry: Terrain = Terrain::default();
        let is_admitted = |p: &[f64; 3]| geometry.admits(p) && p[2].is_finite();
        // What is not admitted is refused when the surface is built.
        if self.overlaps.is_some()
            || self.waters.len() < 2
            || !self.line_points.iter().all(is_admitted)
        {
            return;
        }
        let line = |line: usize| self.line(line).to_vec();
        let Marks {
            replaced,
            added,
            pairs,
            overlaps,
        } = overlap::mark(&self.waters, &line, self.step(), self.bounds);
        self.replace_lines(replaced);
        let given = self.line_count();
        let named = added.iter().map(|(line, _)| *line).collect();
        added
            .iter()
            .for_each(|(_, line)| self.add_line(line, EdgeKind::Bank));
        self.overlaps = Some(Overlaps {
            given,
            named,
            pairs,
            found: overlaps,
        });
    }

    /// The distance within which heights change where waters overlap.
    fn step(&self) -> f64 {
        let wanted = self.step_width.unwrap_or(STEP_WIDTH);
        let largest = self
            .line_points
            .iter()
            .flat_map(|p| [p[0].abs(), p[1].abs()])
            .fold(0.0, f64::max);
        let narrowest = narrowest(largest);
        if wanted.is_finite() {
            wanted.max(narrowest)
        } else {
            narrowest
        }
    }

    /// The vertices of a line.
    fn line(&self, number: usize) -> &[[f64; 3]] {
        let start = if number == 0 {
            0
        } else {
            self.line_ends[number - 1]
        };
        &self.line_points[start..self.line_ends[number]]
    }

    /// Gives some lines other vertices.
    fn replace_lines(&mut self, replaced: Vec<(usize, Vec<[f64; 3]>)>) {
        if replaced.is_empty() {
            return;
        }
        let mut replaced: FxHashMap<usize, Vec<[f64; 3]>> = replaced.into_iter().collect();
        let lines: Vec<Vec<[f64; 3]>> = (0..self.line_count())
            .map(|number| {
                replaced
                    .remove(&number)
                    .unwrap_or_else(|| self.line(number).to_vec())
            })
            .collect();
        self.line_points.clear();
        self.line_ends.clear();
        for line in lines {
            self.line_points.extend(line.into_iter().map(positive_zero));
            self.line_ends.push(self.line_points.len());
        }
    }

    fn add_line(&mut self, line: &[[f64; 3]], kind: EdgeKind) {
        self.add_line_as(line, kind, Precedence::of(kind));
    }

    fn add_line_as(&mut self, line: &[[f64; 3]], kind: EdgeKind, precedence: Precedence) {
        self.line_points
            .extend(line.iter().copied().map(positive_zero));
        self.line_ends.push(self.line_points.len());
        self.line_kinds.push(kind);
        self.precedences.push(precedence);
    }

    /// The number of lines so far.
    fn line_count(&self) -> usize {
        self.line_ends.len()
    }

    /// Clips the surface to a polygon, given as its rings.
    ///
    /// The even-odd rule applies: a ring within a ring is a hole. The finished surface is cut along
    /// the rings, so no height changes. With several polygons, the surface is kept inside any of
    /// them.
    pub fn add_boundary(&mut self, rings: &[Vec<[f64; 2]>]) {
        self.boundaries.push(rings.to_vec());
    }

    /// The rule of the rim of the surface.
    pub(crate) fn rim_rule(&self) -> RimRule {
        RimRule {
            max_edge: self.max_edge,
            opens_caps: self.leave_out_caps,
        }
    }

    /// Takes what the surface is cut along; the bounds stay.
    pub(super) fn take_clip(&mut self) -> Clip {
        Clip::new(
            std::mem::take(&mut self.boundaries),
            self.bounds,
            std::mem::take(&mut self.holes),
            std::mem::take(&mut self.draped),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{self, Surface};

    fn square() -> TinBuilder {
        let mut builder = TinBuilder::default();
        builder.add_points(
            &[-8.0, 8.0, 8.0, -8.0],
            &[-8.0, -8.0, 8.0, 8.0],
            &[1.0, 1.0, 3.0, 3.0],
        );
        builder
    }

    #[test]
    fn points_that_are_refused_are_named_as_they_came() {
        for (x, message) in [
            (
                1e80,
                "point 4: [1e80, 0.0, 2.0] has a coordinate that is neither 0 nor between 7e-49 and 2e60",
            ),
            (
                1e-80,
                "point 4: [1e-80, 0.0, 2.0] has a coordinate that is neither 0 nor between 7e-49 and 2e60",
            ),
            (f64::NAN, "point 4: [NaN, 0.0, 2.0] is not a finite point"),
        ] {
            let mut builder = square();
            builder.add_points(&[x, 1.0], &[0.0, 1.0], &[2.0, 2.0]);
            assert_eq!(builder.build().unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn any_place_can_be_asked_for_its_height() {
        let tin = square().build().unwrap();
        for tiny in [0.0, -0.0, 1e-80, -1e-300, f64::MIN_POSITIVE] {
            assert_eq!(tin.elevation(tiny, tiny), Some(2.0));
            assert_eq!(tin.elevation(8.0, tiny), Some(2.0));
        }
        for huge in [1e80, -1e300, f64::MAX, f64::INFINITY, f64::NAN] {
            assert_eq!(tin.elevation(huge, 0.0), None);
            assert_eq!(tin.elevation(huge, huge), None);
            assert_eq!(tin.elevation(0.0, -huge), None);
        }
    }

    #[test]
    fn a_tin_answers_many_threads() {
        fn is_shared<T: Send + Sync>(_: &T) {}
        let tin = square().build().unwrap();
        is_shared(&tin);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    assert_eq!(
                        (tin.elevation(0.0, 8.0), tin.face_count()),
                        (Some(3.0), tin.face_count())
                    )
                });
            }
        });
    }

    /// Batches yield the same faces as single calls, also with unused numbers and a partial last
    /// batch.
    #[test]
    fn many_faces_are_those_that_one_asks_for() {
        let mut builder = TinBuilder {
            max_edge: Some(1.5),
            ..TinBuilder::default()
        };
        let sites: Vec<[f64; 2]> = (0..2500)
            .map(|k| [f64::from(k % 50), f64::from(k / 50)])
            .collect();
        let [x, y] = [0, 1].map(|axis| sites.iter().map(|p| p[axis]).collect::<Vec<_>>());
        builder.add_points(&x, &y, &x);
        builder.add_points(&[90.0], &[20.0], &[0.0]);
        builder.add_breakline(&[[3.0, 3.0, 1.0], [40.0, 3.0, 2.0]]);
        let tin = builder.build().unwrap();
        let surface: &dyn Surface = &tin;
        let numbers: Vec<u32> = (0..surface.face_count() as u32)
            .filter(|&face| surface.face(face).is_some())
            .collect();
        assert!(numbers.len() > 4000 && numbers.len() < surface.face_count());
        assert!(
            data::corners(surface).eq(numbers
                .iter()
                .map(|&face| (face, surface.face(face).unwrap())))
        );
        assert!(
            data::faces(surface)
                .map(|face| face.number)
                .eq(numbers.iter().copied())
        );
        let mut sides = 0;
        for face in data::faces(surface) {
            assert_eq!(Some(face.corners), surface.face(face.number));
            let corners = face.corners.map(|v| surface.position(v));
            assert_eq!(surface.triangle(face.number), Some(corners));
            for i in 0..3 {
                assert_eq!(face.edges[i], surface.edge_kind(face.number, i));
                assert_eq!(
                    face.edges[i].is_constrained(),
                    surface.is_constrained(face.number, i)
                );
                sides += usize::from(face.edges[i].is_constrained());
            }
        }
        assert!(sides > 60 && sides == 2 * tin.report().edges.total());
    }
}
