//! Rivers: two banks, level from one to the other, never rising downstream.

use super::offset::offset;
use crate::data::orientation;
use crate::error::{Error, Result};
use crate::triangulation::num::Sign;

/// How much of the even distribution is mixed to the nearest points: many vertices of the outer
/// bank of a bend are nearest to one point of the inner bank, and their level lines must not meet
/// there.
const EVEN: f64 = 0.05;

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
    pub(in crate::terrain) stations: Vec<[[f64; 3]; 2]>,
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

impl River {
    /// Returns a river from its banks, which may be drawn in opposite directions. The end with the
    /// lower water is downstream.
    ///
    /// # Errors
    /// If a bank has fewer than two distinct vertices or a vertex without a height.
    ///
    /// # Complexity
    /// O(n m) for banks of n and m vertices.
    pub fn between(left: &[[f64; 3]], right: &[[f64; 3]]) -> Result<Self> {
        let left = clean(left)?;
        let mut right = clean(right)?;
        let [a, b, c, d] = [left[0], left[left.len() - 1], right[0], right[right.len() - 1]];
        if distance(a, d) + distance(b, c) < distance(a, c) + distance(b, d) {
            right.reverse();
        }
        let stations = stations(&left, &right);
        Ok(Self::leveled(stations))
    }

    /// Returns a river from the line along its middle, with heights, and its width.
    ///
    /// # Errors
    /// If the line has fewer than two distinct vertices or a vertex without a height, or if the
    /// width is not above zero.
    pub fn along(middle: &[[f64; 3]], width: f64) -> Result<Self> {
        if !(width > 0.0 && width.is_finite()) {
            return Err(Error::format(format!("a river of width {width}, expected a width above zero"))
                .cure("fill the attribute of --river-width, or give a number"));
        }
        let middle = clean(middle)?;
        let sites: Vec<[f64; 2]> = middle.iter().map(|p| [p[0], p[1]]).collect();
        let [left, right] = [width / 2.0, -width / 2.0].map(|distance| offset(&sites, distance));
        let at = |([l, r], p): ([[f64; 2]; 2], &[f64; 3])| [[l[0], l[1], p[2]], [r[0], r[1], p[2]]];
        let ends = left.into_iter().zip(right).map(|(l, r)| [l, r]);
        Ok(Self::leveled(ends.zip(&middle).map(at).collect()))
    }

    /// Returns how far the heights of the banks were from those of water.
    pub fn heights(&self) -> RiverHeights {
        self.heights
    }

    /// Gives each station the lower height of its ends, but no more than upstream.
    fn leveled(mut stations: Vec<[[f64; 3]; 2]>) -> Self {
        let lower = |[left, right]: &[[f64; 3]; 2]| left[2].min(right[2]);
        if let (Some(first), Some(last)) = (stations.first(), stations.last())
            && lower(first) < lower(last)
        {
            stations.reverse();
            stations.iter_mut().for_each(|ends| ends.swap(0, 1));
        }
        let mut heights = RiverHeights::default();
        let mut level = f64::INFINITY;
        for ends in &mut stations {
            let at = [(ends[0][0] + ends[1][0]) / 2.0, (ends[0][1] + ends[1][1]) / 2.0];
            let (water, difference) = (lower(ends), (ends[0][2] - ends[1][2]).abs());
            if water > level {
                heights.rising += 1;
                if water - level > heights.largest_rise {
                    (heights.largest_rise, heights.rise_at) = (water - level, at);
                }
            }
            if difference > heights.largest_difference {
                (heights.largest_difference, heights.difference_at) = (difference, at);
            }
            level = level.min(water);
            ends.iter_mut().for_each(|end| end[2] = level);
        }
        River { stations, heights }
    }

    /// The banks, in order downstream.
    pub(in crate::terrain) fn banks(&self) -> [Vec<[f64; 3]>; 2] {
        [0, 1].map(|side| self.stations.iter().map(|ends| ends[side]).collect())
    }

    /// The level lines: the first, the last, and those between that cross neither bank nor the one
    /// before.
    pub(in crate::terrain) fn level_lines(&self) -> Vec<[[f64; 3]; 2]> {
        let banks = self.banks();
        let sides: Vec<[[f64; 3]; 2]> =
            banks.iter().flat_map(|bank| bank.windows(2).map(|pair| [pair[0], pair[1]])).collect();
        let (Some(first), Some(last)) = (self.stations.first(), self.stations.last()) else { return Vec::new() };
        let mut lines: Vec<[[f64; 3]; 2]> = vec![*first];
        for line in self.stations.iter().skip(1).take(self.stations.len().saturating_sub(2)) {
            let before = lines[lines.len() - 1];
            if !cross(line, &before) && !cross(line, last) && !sides.iter().any(|side| cross(line, side)) {
                lines.push(*line);
            }
        }
        lines.push(*last);
        lines
    }

    /// The ring around the water.
    pub(in crate::terrain) fn ring(&self) -> Vec<[f64; 2]> {
        let [left, right] = self.banks();
        left.iter().chain(right.iter().rev()).map(|p| [p[0], p[1]]).collect()
    }

    /// The height of the water at a position; outside of it, that of the nearest level line.
    ///
    /// # Complexity
    /// Linear in the number of level lines.
    pub(in crate::terrain) fn height_at(&self, q: [f64; 2]) -> f64 {
        for pair in self.stations.windows(2) {
            let [[a, b], [c, d]] = [pair[0], pair[1]];
            for corners in [[a, b, c], [b, d, c]] {
                if contains(corners, q) {
                    return super::super::linear::linear(corners, q);
                }
            }
        }
        let nearest = self.stations.iter().min_by(|s, t| squared(s, q).total_cmp(&squared(t, q)));
        nearest.map_or(f64::NAN, |ends| ends[0][2])
    }
}

/// The vertices of a bank without repetitions.
fn clean(bank: &[[f64; 3]]) -> Result<Vec<[f64; 3]>> {
    if let Some([x, y, z]) = bank.iter().find(|p| !p[2].is_finite()) {
        return Err(Error::format(format!("the vertex at {x} {y} has the height {z}"))
            .cure("name the attribute with the heights: --rivers FILE:FIELD"));
    }
    let mut clean = bank.to_vec();
    clean.dedup_by(|p, q| p[..2] == q[..2]);
    match clean.len() {
        0 | 1 => Err(Error::format("a bank has fewer than two distinct vertices")),
        _ => Ok(clean),
    }
}

/// Pairs of points on both banks, strictly advancing on each: one for each vertex of either.
///
/// Positions are fractions of the length of a bank. Each vertex and the nearest point of the other
/// bank are a pair of positions. The pairs are made ascending on both banks, and define a map from
/// one bank to the other, linear in between.
fn stations(left: &[[f64; 3]], right: &[[f64; 3]]) -> Vec<[[f64; 3]; 2]> {
    let [on_left, on_right] = [left, right].map(fractions);
    let mut pairs: Vec<[f64; 2]> =
        left.iter().zip(&on_left).map(|(p, u)| [*u, nearest_on(right, &on_right, *p)]).collect();
    pairs.extend(right.iter().zip(&on_right).map(|(p, v)| [nearest_on(left, &on_left, *p), *v]));
    pairs.sort_by(|p, q| (p[0] + p[1]).total_cmp(&(q[0] + q[1])).then(p[0].total_cmp(&q[0])));
    let [u, v] = [0, 1].map(|bank| ascending(&pairs.iter().map(|pair| pair[bank]).collect::<Vec<f64>>()));
    let even = |(u, v): (&f64, &f64)| [u, v].map(|position| (1.0 - EVEN) * position + EVEN * (u + v) / 2.0);
    let mut map: Vec<[f64; 2]> = u.iter().zip(&v).map(even).collect();
    // The ends of the banks belong together, and to nothing else.
    map.retain(|pair| pair.iter().all(|position| (TIE..=1.0 - TIE).contains(position)));
    map.insert(0, [0.0, 0.0]);
    map.dedup_by(|p, q| p[0] - q[0] < TIE || p[1] - q[1] < TIE);
    map.push([1.0, 1.0]);
    let across = |from: usize, position: f64| {
        let next = map.partition_point(|pair| pair[from] <= position).clamp(1, map.len() - 1);
        let [low, high] = [map[next - 1], map[next]];
        let part = (position - low[from]) / (high[from] - low[from]);
        (low[1 - from] + part * (high[1 - from] - low[1 - from])).clamp(0.0, 1.0)
    };
    // A position that is almost that of a vertex becomes it.
    let at_vertex = |fractions: &[f64], position: f64| {
        let next = fractions.partition_point(|fraction| *fraction < position - TIE);
        fractions.get(next).copied().filter(|fraction| *fraction <= position + TIE).unwrap_or(position)
    };
    let inner = |fractions: &[f64]| fractions[1..fractions.len() - 1].to_vec();
    let mut found: Vec<[f64; 2]> =
        inner(&on_left).into_iter().map(|u| [u, at_vertex(&on_right, across(0, u))]).collect();
    found.extend(inner(&on_right).into_iter().map(|v| [at_vertex(&on_left, across(1, v)), v]));
    found.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    found.dedup();
    found.retain(|[u, v]| *u > 0.0 && *v > 0.0 && *u < 1.0 && *v < 1.0);
    let inner = found.iter().map(|[u, v]| [at(left, &on_left, *u), at(right, &on_right, *v)]);
    let [first, last] = [[left[0], right[0]], [left[left.len() - 1], right[right.len() - 1]]];
    std::iter::once(first).chain(inner).chain([last]).collect()
}

/// Fractions that differ by less are the same position.
const TIE: f64 = 1e-7;

/// The length of a line up to each vertex, as a fraction of its whole length.
fn fractions(line: &[[f64; 3]]) -> Vec<f64> {
    let mut sum = 0.0;
    let lengths = line.windows(2).map(|pair| {
        sum += distance(pair[0], pair[1]);
        sum
    });
    let lengths: Vec<f64> = std::iter::once(0.0).chain(lengths).collect();
    let whole = lengths[lengths.len() - 1];
    lengths.into_iter().map(|length| length / whole).collect()
}

/// The ascending sequence that is nearest to numbers, by least squares (pool adjacent violators).
fn ascending(numbers: &[f64]) -> Vec<f64> {
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    for &number in numbers {
        let mut block = (number, 1);
        while let Some(&(mean, count)) = blocks.last()
            && mean > block.0
        {
            block.0 = (mean * count as f64 + block.0 * block.1 as f64) / (count + block.1) as f64;
            block.1 += count;
            blocks.pop();
        }
        blocks.push(block);
    }
    blocks.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count)).collect()
}

/// The point of a line at a position.
fn at(line: &[[f64; 3]], fractions: &[f64], position: f64) -> [f64; 3] {
    let k = fractions.partition_point(|fraction| *fraction <= position).saturating_sub(1);
    match line.get(k + 1) {
        Some(next) if position > fractions[k] => {
            between([line[k], *next], (position - fractions[k]) / (fractions[k + 1] - fractions[k]))
        }
        _ => line[k],
    }
}

/// The point at a part of a segment.
fn between([a, b]: [[f64; 3]; 2], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] + part * (b[axis] - a[axis]))
}

/// The position on a line that is nearest to a point.
fn nearest_on(line: &[[f64; 3]], fractions: &[f64], p: [f64; 3]) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    for (k, pair) in line.windows(2).enumerate() {
        let ends = [pair[0], pair[1]];
        let part = part_of(ends, [p[0], p[1]]);
        let distance = distance(between(ends, part), p);
        if distance < best.0 {
            best = (distance, fractions[k] + part * (fractions[k + 1] - fractions[k]));
        }
    }
    best.1
}

/// The part of a segment, from 0 to 1, at which it is nearest to a point.
fn part_of([a, b]: [[f64; 3]; 2], [x, y]: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let part = ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / length;
    if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// The squared distance of a point from a segment.
fn squared(ends: &[[f64; 3]; 2], q: [f64; 2]) -> f64 {
    let near = between(*ends, part_of(*ends, q));
    (near[0] - q[0]).powi(2) + (near[1] - q[1]).powi(2)
}

/// Returns true if two segments share a point other than a common end.
fn cross([a, b]: &[[f64; 3]; 2], [c, d]: &[[f64; 3]; 2]) -> bool {
    let is_apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    if is_apart(0) || is_apart(1) {
        return false;
    }
    let same = |p: &[f64; 3], q: &[f64; 3]| p[..2] == q[..2];
    let (ab, cd) = ([a, b], [c, d]);
    let shared = ab.iter().flat_map(|p| cd.iter().map(move |q| same(p, q))).filter(|is_same| *is_same).count();
    let sides = [[a, b, c], [a, b, d], [c, d, a], [c, d, b]].map(|[p, q, r]| orientation([*p, *q, *r]));
    if shared > 0 {
        return false;
    }
    let [s, t, u, v] = sides;
    (s == Sign::Zero || s != t) && (u == Sign::Zero || u != v)
}

/// Returns true if a position lies in a triangle or on its border, in either orientation.
fn contains(corners: [[f64; 3]; 3], [x, y]: [f64; 2]) -> bool {
    let [a, b, c] = corners;
    let q = [x, y, 0.0];
    let turn = orientation(corners);
    turn != Sign::Zero
        && [[a, b], [b, c], [c, a]].iter().all(|[p, r]| turn * orientation([*p, *r, q]) != Sign::Negative)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_river_is_level_from_bank_to_bank() {
        let left = [[0.0, 2.0, 5.0], [10.0, 2.0, 4.0]];
        let right = [[10.0, 0.0, 4.5], [4.0, 0.0, 6.0], [0.0, 0.0, 5.5]]; // drawn upstream
        let river = River::between(&left, &right).unwrap();
        assert_eq!(river.stations.len(), 3);
        for [l, r] in &river.stations {
            assert_eq!(l[2], r[2]);
        }
        assert!(river.stations.windows(2).all(|pair| pair[0][0][2] >= pair[1][0][2]));
        assert_eq!(river.stations[0][0], [0.0, 2.0, 5.0]);
        assert_eq!(river.stations[2], [[10.0, 2.0, 4.0], [10.0, 0.0, 4.0]]);
        assert_eq!(river.level_lines().len(), 3);
        assert_eq!(river.height_at([0.0, 1.0]), 5.0);
        assert_eq!(river.heights().rising, 0);
        assert!((river.heights().largest_difference - 1.4).abs() < 1e-12);
    }

    #[test]
    fn water_that_would_rise_stays_level_and_is_reported() {
        let middle = [[0.0, 0.0, 5.0], [10.0, 0.0, 3.0], [20.0, 0.0, 3.5], [30.0, 0.0, 2.0]];
        let river = River::along(&middle, 4.0).unwrap();
        assert_eq!(river.stations.iter().map(|ends| ends[0][2]).collect::<Vec<_>>(), [5.0, 3.0, 3.0, 2.0]);
        let heights = river.heights();
        assert_eq!((heights.rising, heights.largest_rise, heights.rise_at), (1, 0.5, [20.0, 0.0]));
        assert_eq!(river.stations[1], [[10.0, 2.0, 3.0], [10.0, -2.0, 3.0]]);
        assert_eq!(river.height_at([15.0, 0.5]), 3.0);
        assert_eq!(river.height_at([5.0, -1.0]), 4.0);
        let mut upstream = middle.to_vec();
        upstream.reverse();
        let other = River::along(&upstream, 4.0).unwrap();
        assert_eq!(other.stations, river.stations);
    }

    /// On random banks, stations advance on both and every vertex has one.
    #[test]
    fn stations_advance_on_both_banks() {
        let mut state = 7_u64;
        let mut next = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
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
                assert!(sites.windows(2).all(|pair| pair[0] != pair[1]), "round {round}");
                let is_sorted = sites.is_sorted() || sites.iter().rev().is_sorted();
                assert!(is_sorted, "round {round}: {sites:?}");
            }
            for p in left.iter().chain(&right) {
                let is_there = |ends: &[[f64; 3]; 2]| ends.iter().any(|end| end[..2] == p[..2]);
                assert!(river.stations.iter().any(is_there), "round {round}: {p:?} of {left:?} {right:?}");
            }
            assert!(river.stations.windows(2).all(|pair| pair[0][0][2] >= pair[1][0][2]));
        }
    }

    #[test]
    fn what_is_no_river_is_refused() {
        let line = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        assert!(River::along(&line, 0.0).is_err() && River::along(&line, f64::NAN).is_err());
        assert!(River::along(&line[..1], 1.0).is_err());
        assert!(River::between(&line, &[[0.0, 1.0, f64::NAN], [1.0, 1.0, 1.0]]).is_err());
    }
}
