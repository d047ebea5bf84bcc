//! What keeps lines of several levels from crossing where ground is narrower than the steps of an
//! `f64`.
//!
//! On each edge, crossings are in the order of their levels. In a face that is wider than some
//! steps, the arcs between them are, too. In a narrower one, rounded arcs may cross those of other
//! levels, of its own and of faces next to it. So all arcs with an end in such a face are
//! [arranged](crate::triangulation::arrangement), by snap rounding: those that cross are routed
//! through the same points. Arcs that cross nothing stay.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::cut::{ContourArc, Direction, LevelCut, Node};
use super::index::LevelIndex;
use crate::data::{ContourLine, Surface, lowest_and_highest};
use crate::terrain::Levels;
use crate::terrain::in_order::in_order;
use crate::terrain::linear::sorted;
use crate::terrain::thin::{STEPS, is_thin};
use crate::triangulation::arrangement::Arrangement;

/// Finds the faces that are too narrow for arcs that are rounded.
#[derive(Clone, Copy)]
pub(super) struct Narrowness<'a> {
    levels: &'a Levels,
    smallest_step: f64,
}

impl<'a> Narrowness<'a> {
    /// Returns that of faces between these levels.
    pub(super) fn of(levels: &'a Levels) -> Self {
        Narrowness {
            levels,
            smallest_step: levels.smallest_step(),
        }
    }

    /// Returns that of the faces of a surface with this lowest and highest height; `None` if it is
    /// known that none of them is narrow.
    pub(super) fn on<S: Surface + ?Sized>(
        levels: &'a Levels,
        surface: &S,
        [low, high]: [f64; 2],
    ) -> Option<Self> {
        let narrowness = Self::of(levels);
        let share = share_between(narrowness.smallest_step, [low, high]);
        let is_wide = surface.least_width() * share >= STEPS;
        (!is_wide).then_some(narrowness)
    }

    /// Returns true if the face, or the ground between two levels in it, may be narrower than some
    /// steps of its coordinates. Faces of which [`sites_of`](Self::sites_of) then returns no sites
    /// may be among these.
    #[inline]
    pub(super) fn includes(self, corners: [[f64; 3]; 3]) -> bool {
        let heights = lowest_and_highest(corners.map(|[.., z]| z));
        is_thin(corners, share_between(self.smallest_step, heights))
    }

    /// Returns the ends of the arcs of a narrow face and its corners, for each of its levels at
    /// which it is narrow: where it, or the ground up to the next level above or below, may be
    /// narrower than some steps.
    pub(super) fn sites_of<S: Surface + ?Sized>(
        self,
        surface: &S,
        index: &LevelIndex,
        face: u32,
    ) -> Vec<(usize, [f64; 2])> {
        let mut sites = Vec::new();
        let Some(corners) = surface.triangle(face) else {
            return sites;
        };
        let heights = lowest_and_highest(corners.map(|[.., z]| z));
        for number in levels_between(heights, index) {
            let level = index.levels()[number];
            let share = share_between(self.levels.step_around(level), heights);
            let cut = LevelCut { surface, level };
            let Some(face) = cut.face(face).filter(|_| is_thin(corners, share)) else {
                continue;
            };
            let mut nodes = vec![Node::Corner(0), Node::Corner(1), Node::Corner(2)];
            if face.is_crossed() {
                let across = ContourArc::Across(face.id);
                nodes.extend(
                    [Direction::Forward, Direction::Backward].map(|d| face.node(across, d)),
                );
            }
            sites.extend(
                nodes
                    .into_iter()
                    .map(|node| (number, cut.point(&face, node))),
            );
        }
        sites
    }
}

/// Returns the share of a face, given its lowest and its highest height, that lies between two
/// levels.
#[inline]
fn share_between(step: f64, [low, high]: [f64; 2]) -> f64 {
    (step / (high - low)).min(1.0)
}

/// Returns the indices of the levels from the lowest corner of a face to the highest; none if it is
/// horizontal.
fn levels_between([low, high]: [f64; 2], index: &LevelIndex) -> Range<usize> {
    let first = index.first_from(low);
    let is_met = |level: &&f64| low < high && **level <= high;
    first..first + index.levels()[first..].iter().take_while(is_met).count()
}

/// Returns the same sites, each once, grouped by level.
pub(super) fn by_level(mut sites: Vec<(usize, [f64; 2])>) -> Vec<(usize, Vec<[f64; 2]>)> {
    sites.sort_unstable_by(in_order);
    sites.dedup();
    let of_level = |group: &[(usize, [f64; 2])]| {
        let sites = group.iter().map(|(_, site)| *site).collect();
        (group[0].0, sites)
    };
    sites.chunk_by(|a, b| a.0 == b.0).map(of_level).collect()
}

/// The two ends of an arc, the smaller one first.
type Ends = [[f64; 2]; 2];

/// The bits of a site: equal for equal sites, since contours have no negative zeros.
fn bits(site: [f64; 2]) -> [u64; 2] {
    site.map(f64::to_bits)
}

/// The arcs of all levels that end at a narrow face.
#[derive(Default)]
pub(super) struct NarrowArcs(Vec<Ends>);

impl NarrowArcs {
    /// Adds those of the lines of a level, given the sites at its narrow faces.
    pub(super) fn add(&mut self, lines: &[ContourLine], sites: &[[f64; 2]]) {
        let sites: FxHashMap<[u64; 2], ()> = sites.iter().map(|&site| (bits(site), ())).collect();
        let arcs = lines.iter().flat_map(|line| line.points.windows(2));
        self.0.extend(
            arcs.map(|ends| sorted([ends[0], ends[1]]))
                .filter(|ends| ends.iter().any(|&end| sites.contains_key(&bits(end)))),
        );
    }

    /// Returns how the arcs that cross are bent.
    pub(super) fn bends(self) -> Bends {
        let mut arcs = self.0;
        arcs.sort_unstable_by(in_order);
        arcs.dedup();
        let mut sites = arcs.concat();
        sites.sort_unstable_by(in_order);
        sites.dedup();
        let numbers: FxHashMap<[u64; 2], u32> =
            (0..).zip(&sites).map(|(i, &p)| (bits(p), i)).collect();
        let segments: Vec<[u32; 2]> = arcs
            .iter()
            .map(|ends| ends.map(|end| numbers[&bits(end)]))
            .collect();
        let site_of = |number: u32| sites[number as usize];
        let arrangement = Arrangement::new(sites.len(), site_of, &segments, 0.0)
            .crossing_free(site_of, &segments, 0.0);
        let position = |number: u32| match (number as usize).checked_sub(sites.len()) {
            None => site_of(number),
            Some(added) => arrangement.added()[added],
        };
        let bent = (0..).zip(&arcs).filter_map(|(segment, &[a, b])| {
            let chain = arrangement.chain(segment);
            let between = chain.iter().map(|&site| position(site)).collect();
            (!chain.is_empty()).then_some(([bits(a), bits(b)], between))
        });
        Bends(bent.collect())
    }
}

/// The points between the ends of arcs that are bent, from the smaller end to the larger one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bends(FxHashMap<[[u64; 2]; 2], Vec<[f64; 2]>>);

impl Bends {
    /// Bends arcs of a line; returns false if it has none of them.
    pub(super) fn bend(&self, points: &mut Vec<[f64; 2]>) -> bool {
        if self.0.is_empty() {
            return false;
        }
        let mut bent = Vec::with_capacity(points.len());
        for ends in points.windows(2) {
            bent.push(ends[0]);
            let [a, b] = sorted([ends[0], ends[1]]);
            let between = self
                .0
                .get(&[bits(a), bits(b)])
                .map_or(&[][..], Vec::as_slice);
            if a == ends[0] {
                bent.extend(between);
            } else {
                bent.extend(between.iter().rev());
            }
        }
        bent.extend(points.last());
        let is_bent = bent.len() > points.len();
        *points = bent;
        is_bent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Mesh;
    use crate::terrain::contour::bands::Bands;

    #[test]
    fn levels_next_to_each_other_make_faces_narrow_for_no_others() {
        let corners = vec![[0.0, 0.0, 0.5], [8.0, 0.0, 3.5], [0.0, 8.0, 1.5]];
        let mesh = Mesh::new(corners, vec![[0, 1, 2]], &[], None).unwrap();
        let levels = Levels::listed(&[1.0, 2.0, 2.0_f64.next_up(), 3.0]).unwrap();
        let sites = Bands::new(&mesh, &levels).unwrap().narrow_sites();
        let of_levels: Vec<usize> = sites.iter().map(|(level, _)| *level).collect();
        assert_eq!(of_levels, [1, 2]);
    }
}
