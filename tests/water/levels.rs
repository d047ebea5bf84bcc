//! The level lines of rivers, and their heights.

use super::plane::{Site, distance, nearest};
use super::scene::Drawn;

/// A level line: its ends, and their heights, which differ only along the bank of another river.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Station {
    pub(crate) ends: [Site; 2],
    pub(crate) heights: [f64; 2],
}

/// An end of a river within a segment of a bank of another one.
struct Joint {
    branch: usize,
    is_end: bool,
    main: usize,
    side: usize,
}

/// Returns the level lines of rivers, downstream.
pub(crate) fn of(drawn: &[Drawn], rounding: f64) -> Vec<Vec<Station>> {
    let mut rivers: Vec<Vec<Station>> = drawn.iter().map(of_banks).collect();
    let joints = join(&mut rivers, rounding);
    loop {
        let before = rivers
            .iter()
            .flatten()
            .map(|station| station.heights[0])
            .sum::<f64>();
        for joint in &joints {
            let [first, last] = along(&rivers, joint, rounding);
            if joint.is_end {
                let level = rivers[joint.branch]
                    .last()
                    .expect("a river has an end")
                    .heights[0];
                lower(&mut rivers[joint.main][first..], level);
            } else {
                let level = rivers[joint.main][last].heights[0];
                lower(&mut rivers[joint.branch], level);
            }
        }
        if rivers
            .iter()
            .flatten()
            .map(|station| station.heights[0])
            .sum::<f64>()
            == before
        {
            break;
        }
    }
    for joint in &joints {
        let end = if joint.is_end {
            rivers[joint.branch].len() - 1
        } else {
            0
        };
        let corners = rivers[joint.branch][end].ends;
        rivers[joint.branch][end].heights = corners.map(|corner| {
            let station = station_at(&rivers[joint.main], joint.side, corner, rounding);
            rivers[joint.main][station].heights[0]
        });
    }
    rivers
}

/// The levels are those of the lower bank, but no higher than upstream.
fn of_banks(drawn: &Drawn) -> Vec<Station> {
    let [left, right] = &drawn.banks;
    let flat = |p: &[f64; 3]| [p[0], p[1]];
    let station = |(l, r): (&[f64; 3], &[f64; 3])| Station {
        ends: [flat(l), flat(r)],
        heights: [l[2].min(r[2]); 2],
    };
    let mut stations: Vec<Station> = left.iter().zip(right).map(station).collect();
    if stations[0].heights[0] < stations[stations.len() - 1].heights[0] {
        stations.reverse();
    }
    let mut level = f64::INFINITY;
    for station in &mut stations {
        level = level.min(station.heights[0]);
        station.heights = [level; 2];
    }
    stations
}

fn lower(stations: &mut [Station], level: f64) {
    stations
        .iter_mut()
        .for_each(|station| station.heights = station.heights.map(|height| height.min(level)));
}

/// Finds ends of rivers on banks of others, and gives these level lines there.
fn join(rivers: &mut [Vec<Station>], rounding: f64) -> Vec<Joint> {
    let mut joints = Vec::new();
    let count = rivers.len();
    let pairs = (0..count).flat_map(|branch| (0..count).map(move |main| (branch, main)));
    for (branch, main) in pairs.filter(|(branch, main)| branch != main) {
        for is_end in [false, true] {
            let corners = rivers[branch][if is_end { rivers[branch].len() - 1 } else { 0 }].ends;
            for side in [0, 1] {
                let is_on = |segment: [Site; 2]| {
                    corners
                        .iter()
                        .all(|p| distance(nearest(segment, *p), *p) <= rounding)
                };
                let segments = rivers[main]
                    .windows(2)
                    .map(|pair| [pair[0].ends[side], pair[1].ends[side]]);
                let Some(stretch) = segments.into_iter().position(is_on) else {
                    continue;
                };
                // The farther one first, so that the other one is still in this stretch.
                let from = rivers[main][stretch].ends[side];
                let mut sorted = corners;
                sorted.sort_by(|p, q| distance(from, *q).total_cmp(&distance(from, *p)));
                sorted
                    .into_iter()
                    .for_each(|corner| insert(&mut rivers[main], stretch, side, corner, rounding));
                joints.push(Joint {
                    branch,
                    is_end,
                    main,
                    side,
                });
            }
        }
    }
    joints
}

/// Inserts a level line in a stretch at a position on a bank, unless one is there.
fn insert(stations: &mut Vec<Station>, stretch: usize, side: usize, p: Site, rounding: f64) {
    let [from, to] = [stations[stretch], stations[stretch + 1]];
    let [before, after] = [from, to].map(|station| distance(station.ends[side], p));
    if before <= rounding || after <= rounding {
        return;
    }
    let between = |a: f64, b: f64| a + before / (before + after) * (b - a);
    let ends =
        [0, 1].map(|side| [0, 1].map(|axis| between(from.ends[side][axis], to.ends[side][axis])));
    let heights = [0, 1].map(|side| between(from.heights[side], to.heights[side]));
    stations.insert(stretch + 1, Station { ends, heights });
}

fn station_at(stations: &[Station], side: usize, p: Site, rounding: f64) -> usize {
    let is_there = |station: &Station| distance(station.ends[side], p) <= 2.0 * rounding;
    stations
        .iter()
        .position(is_there)
        .expect("a level line at each joint")
}

/// The first and the last station of the main river at a joint.
fn along(rivers: &[Vec<Station>], joint: &Joint, rounding: f64) -> [usize; 2] {
    let branch = &rivers[joint.branch];
    let corners = branch[if joint.is_end { branch.len() - 1 } else { 0 }].ends;
    let [p, q] =
        corners.map(|corner| station_at(&rivers[joint.main], joint.side, corner, rounding));
    [p.min(q), p.max(q)]
}
