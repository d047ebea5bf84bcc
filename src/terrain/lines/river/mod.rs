//! Rivers: two banks, level from one to the other, never rising downstream.
//!
//! A height of a river is found in these stages:
//!
//! 1. [`River::between`] finds the level lines between two banks, [`River::along`] those across a
//!    line along the middle. In the code, the ends of a level line are a *station*.
//! 2. Each level line has the lower height of its two ends, but no more than the one upstream.
//!    Where level lines meet, all have the lowest height (`River::leveled`).
//! 3. [`River::join`] lowers rivers to those that they flow into.
//! 4. `lines/overlap` marks the steps where waters overlap.
//! 5. On the finished triangulation, each vertex in a river gets its height (`lines/areas.rs`): its
//!    own if it is on a bank or an outer level line, else that of the even slope between two level
//!    lines ([`RiverWater::height`]). A lake counts first, then the lowest of several rivers.

mod confluence;
mod divided;
mod ends;
mod network;
mod segments;
mod sites;
mod stations;
mod water;

use std::collections::BTreeSet;

use super::offset::{offset, unfolded};
use crate::data::orientation;
use crate::error::{Error, Result, Setting, wording};
use crate::terrain::boxes::{Boxed, Boxes};
use crate::triangulation::num::Sign;
use segments::{BankSegment, meeting_of, sides};
use sites::{Key, distance, flat, key, middle};
use stations::stations;

pub use network::RiverLowering;
pub(crate) use segments::{contains, cross};
pub(crate) use water::{RiverWater, height_near};

/// A river between two banks.
///
/// ```text
///   left bank    +-----+--------+-------+      downstream ->
///                |     |        |       |      level lines, one for each vertex of a bank
///   right bank   +-----+--------+-------+
/// ```
///
/// The vertices of each bank are joined by level lines to points of the other one, which become
/// vertices. Along each level line the water has one height: the lower one of the two banks, but no
/// more than upstream. Between two level lines it slopes evenly. Points inside are left out.
///
/// This is the hydro-flattening of the USGS Lidar Base Specification (2.1, 2020).
#[derive(Debug, Clone, PartialEq)]
pub struct River {
    /// The ends of the level lines, in order downstream: left, right. Both have one height.
    stations: Vec<[[f64; 3]; 2]>,
    /// The vertices of the line along the middle, one for each station; none if there is no such
    /// line.
    middles: Vec<[f64; 2]>,
    /// The middles of the first and the last level line: where other rivers may continue it.
    ends: [[f64; 2]; 2],
    /// The vertices of the first and the last level line between their ends, from left to right:
    /// those of the bank of another river that they follow. There the heights are those of that
    /// river.
    along_banks: [Option<Vec<[f64; 3]>>; 2],
    /// The triangles of the first and the last stretch, if they have more than four corners.
    end_triangles: [Option<Vec<[[f64; 3]; 3]>>; 2],
    heights: RiverHeights,
}

/// How far the heights of the banks were from those of water.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RiverHeights {
    /// The number of level lines at which the banks rise downstream.
    pub rising: usize,
    /// How far the banks rise, at most, above the lowest height upstream.
    pub largest_rise: f64,
    /// Where that is.
    pub rise_at: [f64; 2],
    /// The largest difference between the two banks along a level line.
    pub largest_difference: f64,
    /// Where that is.
    pub difference_at: [f64; 2],
}

impl RiverHeights {
    fn add_rise(&mut self, rise: f64, at: [f64; 2]) {
        self.rising += 1;
        if rise > self.largest_rise {
            (self.largest_rise, self.rise_at) = (rise, at);
        }
    }
}

impl River {
    /// Returns a river from its banks, which may be drawn in opposite directions. The end with the
    /// lower water is downstream.
    ///
    /// # Errors
    /// If a bank has fewer than two distinct vertices or a vertex without a height.
    ///
    /// # Complexity
    /// O(n log n) for n vertices.
    pub fn between(left: &[[f64; 3]], right: &[[f64; 3]]) -> Result<Self> {
        let left = clean(left)?;
        let mut right = clean(right)?;
        let [a, b, c, d] = [
            left[0],
            left[left.len() - 1],
            right[0],
            right[right.len() - 1],
        ];
        if distance(a, d) + distance(b, c) < distance(a, c) + distance(b, d) {
            right.reverse();
        }
        let stations = stations(&left, &right);
        let ends = [stations[0], stations[stations.len() - 1]].map(|ends| middle(&ends));
        Ok(Self::leveled(stations, Vec::new(), ends))
    }

    /// Returns a river from the line along its middle, with heights, and its width.
    ///
    /// Where the line bends so sharply that level lines would cross on the inner bank, they meet
    /// there in one point, and the water is level around the bend.
    ///
    /// # Errors
    /// If the line has fewer than two distinct vertices or a vertex without a height, or if the
    /// width is not above zero.
    pub fn along(middle: &[[f64; 3]], width: f64) -> Result<Self> {
        if !(width > 0.0 && width.is_finite()) {
            return Err(Error::format(format!(
                "a river of width {width}, expected a width above zero"
            ))
            .cure(wording![
                "fill the attribute of ",
                Setting::RiverWidth,
                ", or give a number"
            ]));
        }
        let middle = clean(middle)?;
        let sites: Vec<[f64; 2]> = middle.iter().copied().map(flat).collect();
        let [left, right] =
            [width / 2.0, -width / 2.0].map(|distance| unfolded(&offset(&sites, distance), &sites));
        let at = |([l, r], p): ([[f64; 2]; 2], &[f64; 3])| [[l[0], l[1], p[2]], [r[0], r[1], p[2]]];
        let opposite = left.into_iter().zip(right).map(|(l, r)| [l, r]);
        let ends = [sites[0], sites[sites.len() - 1]];
        Ok(Self::leveled(
            opposite.zip(&middle).map(at).collect(),
            sites,
            ends,
        ))
    }

    /// Returns how far the heights of the banks were from those of water.
    pub fn heights(&self) -> RiverHeights {
        self.heights
    }

    /// Gives each station the lower height of its ends, but no more than upstream.
    fn leveled(stations: Vec<[[f64; 3]; 2]>, middles: Vec<[f64; 2]>, ends: [[f64; 2]; 2]) -> Self {
        let lower = |[left, right]: &[[f64; 3]; 2]| left[2].min(right[2]);
        let (along_banks, end_triangles, heights) =
            ([None, None], [None, None], RiverHeights::default());
        let mut river = River {
            stations,
            middles,
            ends,
            along_banks,
            end_triangles,
            heights,
        };
        if let (Some(first), Some(last)) = (river.stations.first(), river.stations.last())
            && lower(first) < lower(last)
        {
            river.reverse();
        }
        let mut level = f64::INFINITY;
        for ends in &mut river.stations {
            let at = middle(ends);
            let (water, difference) = (lower(ends), (ends[0][2] - ends[1][2]).abs());
            if water > level {
                river.heights.add_rise(water - level, at);
            }
            if difference > river.heights.largest_difference {
                (
                    river.heights.largest_difference,
                    river.heights.difference_at,
                ) = (difference, at);
            }
            level = level.min(water);
            ends.iter_mut().for_each(|end| end[2] = level);
        }
        river.level_meetings();
        river
    }

    /// Gives level lines that meet one height, the lowest.
    fn level_meetings(&mut self) {
        for k in (1..self.stations.len()).rev() {
            if self.meeting_side(k - 1, k).is_some() {
                let level = self.stations[k][0][2];
                self.stations[k - 1]
                    .iter_mut()
                    .for_each(|end| end[2] = level);
            }
        }
    }

    /// The number of stretches between level lines.
    pub(crate) fn stretch_count(&self) -> usize {
        self.stations.len() - 1
    }

    /// The ends of the level lines before and after a stretch: left, right, left, right.
    pub(crate) fn corners(&self, stretch: usize) -> [[f64; 3]; 4] {
        let [[a, b], [c, d]] = [self.stations[stretch], self.stations[stretch + 1]];
        [a, b, c, d]
    }

    /// The triangles on which the water between a level line and the next is linear.
    pub(crate) fn triangles(&self, stretch: usize) -> Vec<[[f64; 3]; 3]> {
        let [a, b, c, d] = self.corners(stretch);
        let end = (0..2).find(|end| stretch == self.stretch_of_end(*end));
        let of_outline = end.and_then(|end| self.end_triangles[end].clone());
        of_outline.unwrap_or_else(|| vec![[a, b, c], [b, d, c]])
    }

    /// The edges between the triangles of a stretch, if they are within it.
    pub(crate) fn diagonals(&self, stretch: usize) -> Vec<[[f64; 3]; 2]> {
        let [a, b, c, d] = self.corners(stretch);
        let outline = self.outline(stretch);
        if outline.len() == 4 {
            let is_within = orientation([b, c, a]) * orientation([b, c, d]) == Sign::Negative;
            return if is_within { vec![[b, c]] } else { Vec::new() };
        }
        let keys = |[p, q]: [[f64; 3]; 2]| [key(flat(p)), key(flat(q))];
        let around = outline.iter().zip(outline.iter().cycle().skip(1));
        let mut drawn: BTreeSet<[Key; 2]> = around
            .flat_map(|(from, to)| [[*from, *to], [*to, *from]])
            .map(keys)
            .collect();
        let edges = self
            .triangles(stretch)
            .into_iter()
            .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
        edges
            .filter(|&[p, q]| drawn.insert(keys([p, q])) && drawn.insert(keys([q, p])))
            .collect()
    }

    /// Exchanges upstream and downstream.
    fn reverse(&mut self) {
        self.stations.reverse();
        self.stations.iter_mut().for_each(|ends| ends.swap(0, 1));
        self.middles.reverse();
        self.ends.reverse();
        self.along_banks.reverse();
        self.along_banks
            .iter_mut()
            .flatten()
            .for_each(|line| line.reverse());
        self.end_triangles.reverse();
    }

    /// The heights at both ends.
    fn levels(&self) -> [f64; 2] {
        let level = |ends: Option<&[[f64; 3]; 2]>| ends.map_or(f64::NAN, |ends| ends[0][2]);
        [level(self.stations.first()), level(self.stations.last())]
    }

    /// The banks, in order downstream.
    pub(crate) fn banks(&self) -> [Vec<[f64; 3]>; 2] {
        [0, 1].map(|side| {
            let mut bank: Vec<[f64; 3]> = self.stations.iter().map(|ends| ends[side]).collect();
            bank.dedup_by(|p, q| flat(*p) == flat(*q));
            bank
        })
    }

    /// The level lines: the first, the last, and those between that cross neither bank nor the one
    /// before. Those of a river along a line pass through its vertices.
    ///
    /// # Complexity
    /// O(n log n) for n stations, if few segments of banks are close to each other.
    pub(crate) fn level_lines(&self) -> Vec<Vec<[f64; 3]>> {
        let sides = self.banks().into_iter().flat_map(|bank| sides(&bank));
        let sides = Boxes::new(sides.collect());
        let count = self.stations.len();
        let mut lines: Vec<Vec<[f64; 3]>> = Vec::with_capacity(count);
        let mut before: Option<[[f64; 3]; 2]> = None;
        for (number, line) in self.stations.iter().enumerate() {
            let crosses = |side: &BankSegment| cross(line, &side.0).then_some(());
            let is_end = number == 0 || number + 1 == count;
            let is_free = || {
                !before.is_some_and(|before| cross(line, &before))
                    && !self.stations.last().is_some_and(|last| cross(line, last))
                    && sides
                        .find_in(BankSegment(*line).extent(), crosses)
                        .is_none()
            };
            if is_end || is_free() {
                let [left, right] = *line;
                lines.push(
                    std::iter::once(left)
                        .chain(self.inner(number))
                        .chain([right])
                        .collect(),
                );
                before = Some(*line);
            }
        }
        lines
    }

    /// The vertices of a level line between its ends, from left to right.
    fn inner(&self, number: usize) -> Vec<[f64; 3]> {
        let end = [0, self.stations.len() - 1]
            .iter()
            .position(|end| *end == number);
        match end.and_then(|end| self.along_banks[end].clone()) {
            Some(along) => along,
            None => self
                .middles
                .get(number)
                .map(|&[x, y]| [x, y, self.stations[number][0][2]])
                .into_iter()
                .collect(),
        }
    }

    /// Returns a position at which the ring around the water meets itself; `None` if it does not.
    /// Areas that it encloses twice are not water.
    ///
    /// # Complexity
    /// O(n log n) for n stations, if few segments of banks are close to each other.
    pub fn overlap(&self) -> Option<[f64; 2]> {
        meeting_of(self.ring_with_heights())
    }

    /// The ring around the water: the banks, and the level lines at both ends with all their
    /// vertices. A line along the middle is beside the straight line from bank to bank where a bank
    /// has become one point.
    pub(crate) fn ring(&self) -> Vec<[f64; 2]> {
        self.ring_with_heights().into_iter().map(flat).collect()
    }

    fn ring_with_heights(&self) -> Vec<[f64; 3]> {
        let [left, right] = self.banks();
        let [first, last] =
            [0, self.stations.len() - 1].map(|number| self.inner(number).into_iter());
        left.into_iter()
            .chain(last)
            .chain(right.into_iter().rev())
            .chain(first.rev())
            .collect()
    }
}

/// The vertices of a bank without repetitions.
fn clean(bank: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
    if let Some([x, y, z]) = bank.iter().find(|p| !p[2].is_finite()) {
        return Err(
            Error::format(format!("the vertex at {x} {y} has the height {z}")).cure(wording![
                "name the attribute with the heights: ",
                Setting::Rivers.text("FILE:FIELD")
            ]),
        );
    }
    let mut clean = bank.to_vec();
    clean.dedup_by(|p, q| flat(*p) == flat(*q));
    match clean.len() {
        0 | 1 => Err(Error::format("a bank has fewer than two distinct vertices")),
        _ => Ok(clean),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::inside::Inside;

    #[test]
    fn a_straight_river_is_level_from_bank_to_bank() {
        let left = [[0.0, 2.0, 5.0], [10.0, 2.0, 4.0]];
        let right = [[10.0, 0.0, 4.5], [4.0, 0.0, 6.0], [0.0, 0.0, 5.5]]; // drawn upstream
        let river = River::between(&left, &right).unwrap();
        assert_eq!(river.stations.len(), 3);
        for [l, r] in &river.stations {
            assert_eq!(l[2], r[2]);
        }
        assert!(
            river
                .stations
                .windows(2)
                .all(|pair| pair[0][0][2] >= pair[1][0][2])
        );
        assert_eq!(river.stations[0][0], [0.0, 2.0, 5.0]);
        assert_eq!(river.stations[2], [[10.0, 2.0, 4.0], [10.0, 0.0, 4.0]]);
        assert_eq!(river.level_lines().len(), 3);
        assert_eq!(RiverWater::new(&river).height([0.0, 1.0]), 5.0);
        assert_eq!(river.heights().rising, 0);
        assert!((river.heights().largest_difference - 1.4).abs() < 1e-12);
    }

    #[test]
    fn water_that_would_rise_stays_level_and_is_reported() {
        let middle = [
            [0.0, 0.0, 5.0],
            [10.0, 0.0, 3.0],
            [20.0, 0.0, 3.5],
            [30.0, 0.0, 2.0],
        ];
        let river = River::along(&middle, 4.0).unwrap();
        assert_eq!(
            river
                .stations
                .iter()
                .map(|ends| ends[0][2])
                .collect::<Vec<_>>(),
            [5.0, 3.0, 3.0, 2.0]
        );
        let heights = river.heights();
        assert_eq!(
            (heights.rising, heights.largest_rise, heights.rise_at),
            (1, 0.5, [20.0, 0.0])
        );
        assert_eq!(river.stations[1], [[10.0, 2.0, 3.0], [10.0, -2.0, 3.0]]);
        assert_eq!(RiverWater::new(&river).height([15.0, 0.5]), 3.0);
        assert_eq!(RiverWater::new(&river).height([5.0, -1.0]), 4.0);
        let mut upstream = middle.to_vec();
        upstream.reverse();
        let other = River::along(&upstream, 4.0).unwrap();
        assert_eq!(other.stations, river.stations);
    }

    /// Beside a bank, the height is that of the bank there, and not that of a level line.
    #[test]
    fn a_position_beside_the_water_has_the_nearest_height() {
        let river =
            River::along(&[[0.0, 0.0, 5.0], [10.0, 0.0, 3.0], [20.0, 0.0, 3.0]], 4.0).unwrap();
        let water = RiverWater::new(&river);
        for (q, expected) in [
            ([2.5, 2.0_f64.next_up()], 4.5),
            ([7.5, (-2.0_f64).next_down()], 3.5),
            ([5.0, 9.0], 4.0),
            ([-3.0, 1.0], 5.0),
            ([15.0, 2.5], 3.0),
            ([23.0, -4.0], 3.0),
        ] {
            assert_eq!(water.height(q), expected, "{q:?}");
            assert_eq!(water.height_within(q), None);
        }
        assert_eq!(water.height_within([5.0, 2.0]), Some(4.0));
    }

    /// On random banks, stations advance on both and every vertex has one.
    #[test]
    fn stations_advance_on_both_banks() {
        let mut state = 7_u64;
        let mut next = |n: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % n) as f64
        };
        for round in 0..500 {
            let mut bank = |y: f64| {
                let mut x = 0.0;
                let count = 2 + next(9) as usize;
                (0..count)
                    .map(|_| {
                        x += 1.0 + next(6);
                        [x, y + next(5), next(9)]
                    })
                    .collect::<Vec<_>>()
            };
            let (left, right) = (bank(8.0), bank(0.0));
            let river = River::between(&left, &right).unwrap();
            for side in 0..2 {
                let sites: Vec<f64> = river.banks()[side].iter().map(|p| p[0]).collect();
                assert!(
                    sites.windows(2).all(|pair| pair[0] != pair[1]),
                    "round {round}"
                );
                let is_sorted = sites.is_sorted() || sites.iter().rev().is_sorted();
                assert!(is_sorted, "round {round}: {sites:?}");
            }
            for p in left.iter().chain(&right) {
                let is_there = |ends: &[[f64; 3]; 2]| ends.iter().any(|end| end[..2] == p[..2]);
                assert!(
                    river.stations.iter().any(is_there),
                    "round {round}: {p:?} of {left:?} {right:?}"
                );
            }
            assert!(
                river
                    .stations
                    .windows(2)
                    .all(|pair| pair[0][0][2] >= pair[1][0][2])
            );
        }
    }

    #[test]
    fn water_does_not_rise_from_one_river_to_the_next() {
        let reach = |xs: [f64; 2], zs: [f64; 2]| {
            River::along(&[[xs[0], 0.0, zs[0]], [xs[1], 0.0, zs[1]]], 2.0).unwrap()
        };
        // Out of order; the level one is drawn upstream.
        let mut rivers = [
            reach([20.0, 30.0], [4.5, 3.0]),
            reach([20.0, 10.0], [4.2, 4.2]),
            reach([0.0, 10.0], [5.0, 4.0]),
            reach([50.0, 60.0], [9.0, 8.0]),
        ];
        let lowered = River::join(&mut rivers, 0.01);
        let levels = rivers.each_ref().map(River::levels);
        assert_eq!(levels, [[4.0, 3.0], [4.0, 4.0], [5.0, 4.0], [9.0, 8.0]]);
        assert_eq!(
            lowered
                .iter()
                .map(|lowering| [lowering.river, lowering.to])
                .collect::<Vec<_>>(),
            [[0, 1], [1, 2]]
        );
        assert_eq!((lowered[0].by, lowered[0].from), (0.5, [20.0, 0.0]));
        // A level one that need not be lowered is turned, too, and what follows is lowered to it;
        // in any order.
        let set = || {
            [
                reach([0.0, 10.0], [5.0, 4.0]),
                reach([20.0, 10.0], [3.9, 3.9]),
                reach([20.0, 30.0], [4.5, 3.0]),
                reach([30.0, 40.0], [9.0, 2.0]),
                reach([50.0, 40.0], [2.5, 2.5]),
            ]
        };
        let joined = |order: [usize; 5]| {
            let all = set();
            let mut rivers: Vec<River> = order.map(|k| all[k].clone()).to_vec();
            let lowered = River::join(&mut rivers, 0.01);
            let mut found: Vec<String> = rivers.iter().map(|river| format!("{river:?}")).collect();
            found.sort();
            (rivers, lowered, found)
        };
        let (rivers, lowered, expected) = joined([0, 1, 2, 3, 4]);
        let levels: Vec<[f64; 2]> = rivers.iter().map(River::levels).collect();
        assert_eq!(
            levels,
            [[5.0, 3.9], [3.9, 3.9], [3.9, 3.0], [3.0, 2.0], [2.0, 2.0]]
        );
        assert!(lowered[0].river == 2 && lowered[0].to == 1 && (lowered[0].by - 0.6).abs() < 1e-12);
        for order in [
            [4, 3, 2, 1, 0],
            [2, 0, 4, 1, 3],
            [1, 4, 0, 3, 2],
            [3, 2, 1, 0, 4],
        ] {
            assert_eq!(joined(order).2, expected, "{order:?}");
        }
        // A ring of rivers, each of which begins above the end of the one before.
        let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 0.0]];
        let side = |pair: &[[f64; 2]]| {
            River::along(
                &[[pair[0][0], pair[0][1], 5.0], [pair[1][0], pair[1][1], 4.0]],
                1.0,
            )
            .unwrap()
        };
        let mut ring: Vec<River> = corners.windows(2).map(side).collect();
        River::join(&mut ring, 0.01);
        assert!(ring.iter().all(|river| river.levels() == [4.0, 4.0]));
    }

    #[test]
    fn a_tight_bend_is_water_all_around_and_level() {
        let bend = [
            [0.0, 0.0, 9.0],
            [9.0, 0.0, 8.0],
            [9.7, 0.3, 7.0],
            [10.0, 1.0, 6.0],
            [10.0, 10.0, 5.0],
        ];
        let river = River::along(&bend, 6.0).unwrap();
        assert_eq!(river.overlap(), None);
        let [left, right] = river.banks();
        assert_eq!((left.len(), right.len()), (3, 5));
        assert!(
            (left[1][0] - 7.0).hypot(left[1][1] - 3.0) < 1e-9,
            "{left:?}"
        );
        assert_eq!(
            river
                .stations
                .iter()
                .map(|ends| ends[0][2])
                .collect::<Vec<_>>(),
            [9.0, 6.0, 6.0, 6.0, 5.0]
        );
        let hairpin =
            River::along(&[[0.0, 0.0, 2.0], [9.0, 0.0, 1.0], [0.0, 1.0, 0.0]], 4.0).unwrap();
        assert!(hairpin.overlap().is_some());
    }

    /// The banks and the level lines at both ends are what the triangulation takes for the border,
    /// also where a bank becomes one point, and its ends bend.
    #[test]
    fn the_ring_is_the_border_of_the_water() {
        let zigzag = [
            [0.3, 0.2, 2.0],
            [0.65, 0.65, 2.0],
            [-0.1, 0.4, 2.0],
            [0.1, 0.3, 2.0],
        ];
        let river = River::along(&zigzag, 1.0).unwrap();
        assert_eq!(river.banks()[0].len(), 1);
        let ring = river.ring();
        let has = |a: [f64; 2], b: [f64; 2]| {
            let sides = ring.iter().zip(ring.iter().cycle().skip(1));
            a == b
                || sides
                    .into_iter()
                    .any(|(&p, &q)| [p, q] == [a, b] || [q, p] == [a, b])
        };
        let lines = river.level_lines();
        for line in river
            .banks()
            .iter()
            .chain([&lines[0], &lines[lines.len() - 1]])
        {
            assert!(
                line.windows(2)
                    .all(|ends| has(flat(ends[0]), flat(ends[1]))),
                "{line:?} {ring:?}"
            );
        }
        // Beside the straight line from bank to bank.
        assert!(Inside::new(&[vec![ring]]).contains([0.4, 0.2]));
    }

    #[test]
    fn what_is_no_river_is_refused() {
        let line = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        assert!(River::along(&line, 0.0).is_err() && River::along(&line, f64::NAN).is_err());
        assert!(River::along(&line[..1], 1.0).is_err());
        assert!(River::between(&line, &[[0.0, 1.0, f64::NAN], [1.0, 1.0, 1.0]]).is_err());
    }
}
