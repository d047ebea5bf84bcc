//! Rivers that continue or join each other.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};

use rustc_hash::FxHashMap;

use super::River;
use super::confluence::{self, LevelStations, StationId};
use super::sites::{Key, key, middle};

/// A river that was lowered because another one, which joins it or which it continues, is lower.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RiverLowering {
    /// The position of the river among all.
    pub river: usize,
    /// The position of the other one.
    pub to: usize,
    /// How far it was lowered, at most.
    pub by: f64,
    /// Where that is: from there on downstream.
    pub from: [f64; 2],
}

/// The rivers that end or begin at each position.
type Meeting = FxHashMap<Key, Vec<usize>>;

impl River {
    /// Lowers rivers that go on where others end, so that the water never rises from one to the
    /// next, and gives rivers that end or begin at the bank of another one its height there. The
    /// order of the rivers makes no difference.
    ///
    /// ```text
    ///    ----------------+-----+----------   bank
    ///                   /     /              vertices of both: the end of the tributary follows
    ///                  /     /               the bank of the main river between them
    /// ```
    ///
    /// - A river continues another one if the middles of their ends have the same coordinates: it
    ///   begins no higher than that ends.
    /// - A river joins another one if the first or the last of its level lines has a bank vertex of
    ///   that one, or if both of its ends are no farther than `reach` from the same bank; the bank
    ///   then gets vertices there. A tributary that is lower lowers the main river from there on. A
    ///   branch begins no higher than the main river is there.
    /// - An end with corners on two rivers is level, and both have its height there.
    /// - A river that ends where another one begins falls to it, if they share a corner. Ends side
    ///   by side, and beginnings, are not joined.
    ///
    /// A river without slope is turned so that it begins where another one arrives. Returns
    /// the rivers that were lowered, except those that only fall to others in their last stretch.
    ///
    /// # Complexity
    /// O(n log n) for n level lines, if few of them are close to each other.
    pub fn join(rivers: &mut [River], reach: f64) -> Vec<RiverLowering> {
        let mut at: Meeting = FxHashMap::default();
        for (number, river) in rivers.iter().enumerate() {
            river
                .ends
                .iter()
                .for_each(|end| at.entry(key(*end)).or_default().push(number));
        }
        turn_level_ones(rivers, &at, reach);
        let ends: Vec<[Key; 2]> = rivers.iter().map(|river| river.ends.map(key)).collect();
        let mut joints = confluence::join_banks(rivers, reach, &|branch, end, main| {
            ends[main].contains(&ends[branch][end])
        });
        for (river, [_, mouth]) in ends.iter().enumerate() {
            let following = at
                .get(mouth)
                .into_iter()
                .flatten()
                .filter(|next| ends[**next][0] == *mouth);
            for &next in following {
                let levels = [0, 1].map(|corner| joints.height_of_end(rivers, [river, 1], corner));
                joints
                    .bounds
                    .extend(levels.map(|station| [station, [next, 0]]));
            }
        }
        let lowered = lower(rivers, &joints.equal, &joints.bounds);
        joints.fit_ends(rivers);
        lowered
    }

    /// The height at each station.
    pub(super) fn station_levels(&self) -> Vec<f64> {
        self.stations.iter().map(|ends| ends[0][2]).collect()
    }

    /// The first of the stations whose level lines meet the last one.
    fn first_at_mouth(&self) -> usize {
        self.met_at_end(1)
            .last()
            .map_or(self.stations.len() - 1, |[station, _]| station)
    }

    /// Lowers what is above a level, from a station on to another one, and the level lines that
    /// meet the first. Returns the number of the first station that may have been lowered.
    fn lower_between(&mut self, station: usize, end: usize, level: f64) -> usize {
        let mut first = station;
        while first > 0 && self.meeting_side(first - 1, first).is_some() {
            first -= 1;
        }
        self.stations[first..end]
            .iter_mut()
            .flatten()
            .for_each(|corner| corner[2] = corner[2].min(level));
        first
    }
}

/// A height, in the order of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Height(f64);

impl Eq for Height {}

impl PartialOrd for Height {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Height {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// What the height of a station decides.
#[derive(Debug, Default)]
struct Bound {
    /// The numbers of the groups of one height that the station is in.
    groups: Vec<usize>,
    /// The stations that are no higher.
    below: Vec<StationId>,
}

/// Lowers rivers until the stations of each group have one height, and the second of each pair is
/// no higher than the first. Returns the rivers that were lowered, except those that were at their
/// mouths alone.
///
/// The lowest height comes first, and goes on to all that must not be higher: no station is lowered
/// twice.
///
/// # Complexity
/// O(n log n) for n stations.
fn lower(
    rivers: &mut [River],
    equal: &[LevelStations],
    bounds: &[[StationId; 2]],
) -> Vec<RiverLowering> {
    let mut bound: BTreeMap<StationId, Bound> = BTreeMap::new();
    for (group, LevelStations { stations, .. }) in equal.iter().enumerate() {
        stations
            .iter()
            .for_each(|station| bound.entry(*station).or_default().groups.push(group));
    }
    for [from, to] in bounds {
        bound.entry(*from).or_default().below.push(*to);
    }
    let level =
        |rivers: &[River], [river, station]: StationId| rivers[river].stations[station][0][2];
    let mouths: Vec<usize> = rivers.iter().map(River::first_at_mouth).collect();
    // From here on, a river is low enough.
    let mut done: Vec<usize> = rivers.iter().map(|river| river.stations.len()).collect();
    let mut is_done = vec![false; equal.len()];
    let mut lowered: BTreeMap<usize, RiverLowering> = BTreeMap::new();
    let own = bound
        .keys()
        .map(|&station| Reverse((Height(level(rivers, station)), station, station[0])));
    let mut next: BinaryHeap<Reverse<(Height, StationId, usize)>> = own.collect();
    let mut targets: Vec<(StationId, usize)> = Vec::new();
    while let Some(Reverse((Height(height), [river, station], to))) = next.pop() {
        let end = done[river];
        if station >= end {
            continue;
        }
        let by = level(rivers, [river, station]) - height;
        let first = rivers[river].lower_between(station, end, height);
        done[river] = first;
        let most = lowered.get(&river).map_or(0.0, |lowering| lowering.by);
        if by > most && first < mouths[river] {
            let from = if first == 0 {
                rivers[river].ends[0]
            } else {
                middle(&rivers[river].stations[first])
            };
            lowered.insert(
                river,
                RiverLowering {
                    river,
                    to,
                    by,
                    from,
                },
            );
        }
        for (_, Bound { groups, below }) in bound.range([river, first]..[river, end]) {
            for &group in groups {
                if !std::mem::replace(&mut is_done[group], true) {
                    let LevelStations { stations, end } = &equal[group];
                    let cause =
                        |target: StationId| end.filter(|end| *end != target[0]).unwrap_or(river);
                    targets.extend(stations.iter().map(|target| (*target, cause(*target))));
                }
            }
            targets.extend(below.iter().map(|target| (*target, river)));
        }
        let higher = targets
            .drain(..)
            .filter(|(target, _)| level(rivers, *target) > height);
        next.extend(higher.map(|(target, to)| Reverse((Height(height), target, to))));
    }
    lowered.into_values().collect()
}

/// Turns rivers without slope, so that they begin where others end: first where rivers with a slope
/// do, then where those do that are known by then. The others begin at the bank of a river that is
/// higher, or end at that of one that is lower.
fn turn_level_ones(rivers: &mut [River], at: &Meeting, reach: f64) {
    let is_level = |river: &River| river.levels()[0] == river.levels()[1];
    let mut is_known: Vec<bool> = rivers.iter().map(|river| !is_level(river)).collect();
    let sloping: Vec<usize> = (0..rivers.len())
        .filter(|&number| is_known[number])
        .collect();
    turn_reached(rivers, at, sloping, &mut is_known);
    if is_known.iter().all(|is_known| *is_known) {
        return;
    }
    let ends: Vec<[Key; 2]> = rivers.iter().map(|river| river.ends.map(key)).collect();
    let banks = confluence::heights_at_banks(rivers, reach, &|branch, end, main| {
        ends[main].contains(&ends[branch][end])
    });
    let mut votes: Vec<[usize; 2]> = vec![[0, 0]; rivers.len()];
    for (number, end, height) in banks {
        let level = rivers[number].levels()[0];
        if height != level {
            let is_right = (height > level) == (end == 0);
            votes[number][usize::from(!is_right)] += 1;
        }
    }
    let mut turned = Vec::new();
    for (number, [right, wrong]) in votes.into_iter().enumerate() {
        if wrong > right && !is_known[number] {
            rivers[number].reverse();
        }
        if wrong != right && !is_known[number] {
            is_known[number] = true;
            turned.push(number);
        }
    }
    turn_reached(rivers, at, turned, &mut is_known);
}

/// Turns rivers without slope that begin where others end, and those where they end, and so on.
fn turn_reached(
    rivers: &mut [River],
    at: &Meeting,
    mut arriving: Vec<usize>,
    is_known: &mut [bool],
) {
    while !arriving.is_empty() {
        let mouths: Vec<Key> = arriving
            .iter()
            .map(|&number| key(rivers[number].ends[1]))
            .collect();
        let mut reached: Vec<(usize, Key)> = Vec::new();
        for mouth in mouths {
            let here = at
                .get(&mouth)
                .into_iter()
                .flatten()
                .filter(|next| !is_known[**next]);
            reached.extend(here.map(|&next| (next, mouth)));
        }
        reached.sort_unstable();
        reached.dedup();
        arriving.clear();
        for same in reached.chunk_by(|p, q| p.0 == q.0) {
            let next = same[0].0;
            // One that is reached at both ends stays as it is drawn.
            if same
                .iter()
                .all(|(_, mouth)| key(rivers[next].ends[0]) != *mouth)
            {
                rivers[next].reverse();
            }
            is_known[next] = true;
            arriving.push(next);
        }
    }
}
