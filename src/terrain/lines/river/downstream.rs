//! Rivers that continue or join each other.

use rustc_hash::FxHashMap;

use super::confluence::{self, Joint};
use super::{Key, River, flat, key, middle};

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
    ///
    /// Of a river without slope, the end at which another arrives becomes its beginning. How far a
    /// river was lowered is added to its [`heights`](River::heights).
    ///
    /// # Complexity
    /// O(n log n) for n level lines, times the number of rivers upstream at most.
    pub fn join(rivers: &mut [River], reach: f64) {
        let mut at: Meeting = FxHashMap::default();
        for (number, river) in rivers.iter().enumerate() {
            river.ends.iter().for_each(|end| at.entry(key(*end)).or_default().push(number));
        }
        turn_level_ones(rivers, &at, reach);
        let ends: Vec<[Key; 2]> = rivers.iter().map(|river| river.ends.map(key)).collect();
        let joints =
            confluence::join_banks(rivers, reach, &|branch, end, main| ends[main].contains(&ends[branch][end]));
        let before: Vec<Vec<f64>> = rivers.iter().map(River::station_levels).collect();
        lower(rivers, &at, &joints);
        for (river, before) in rivers.iter_mut().zip(before) {
            river.add_lowering(&before);
        }
        confluence::fit_ends(rivers, &joints);
    }

    /// The height at each station.
    fn station_levels(&self) -> Vec<f64> {
        self.stations.iter().map(|ends| ends[0][2]).collect()
    }

    /// Adds how far the river was lowered to what was wrong with its heights.
    fn add_lowering(&mut self, before: &[f64]) {
        let mut largest = (0.0, None);
        for (ends, before) in self.stations.iter().zip(before) {
            if before - ends[0][2] > largest.0 {
                largest = (before - ends[0][2], Some(*ends));
            }
        }
        if let (lowered, Some(ends)) = largest {
            let is_first = self.stations.first() == Some(&ends);
            self.heights.add_rise(lowered, if is_first { self.ends[0] } else { middle(&ends) });
        }
    }

    /// Lowers what is above a level, from a station on downstream, and the level lines that meet
    /// that one.
    fn lower_from(&mut self, station: usize, level: f64) {
        let meets = |k: usize| (0..2).any(|side| flat(self.stations[k - 1][side]) == flat(self.stations[k][side]));
        let mut first = station;
        while first > 0 && meets(first) {
            first -= 1;
        }
        self.stations[first..].iter_mut().flatten().for_each(|end| end[2] = end[2].min(level));
    }
}

/// Lowers rivers to those upstream.
fn lower(rivers: &mut [River], at: &Meeting, joints: &[Joint]) {
    let mut tributaries: FxHashMap<usize, Vec<&Joint>> = FxHashMap::default();
    let mut branches: FxHashMap<usize, Vec<&Joint>> = FxHashMap::default();
    for joint in joints {
        if joint.end == 1 {
            tributaries.entry(joint.branch).or_default().push(joint);
        } else {
            branches.entry(joint.main).or_default().push(joint);
        }
    }
    // Each visit lowers a river to the level of another: it ends, also around a ring.
    let mut changed: Vec<usize> = (0..rivers.len()).collect();
    while let Some(upstream) = changed.pop() {
        let (mouth, level) = (key(rivers[upstream].ends[1]), rivers[upstream].levels()[1]);
        let following = at.get(&mouth).into_iter().flatten().filter(|next| key(rivers[**next].ends[0]) == mouth);
        let following = following.map(|&next| (next, 0, level));
        let joined = tributaries.get(&upstream).into_iter().flatten();
        let joined = joined.map(|joint| (joint.main, joint.range()[0], level));
        let leaving = branches.get(&upstream).into_iter().flatten();
        let leaving = leaving.map(|joint| (joint.branch, 0, rivers[upstream].stations[joint.range()[1]][0][2]));
        let bounds: Vec<(usize, usize, f64)> = following.chain(joined).chain(leaving).collect();
        for (next, station, level) in bounds {
            if rivers[next].stations[station][0][2] > level {
                rivers[next].lower_from(station, level);
                changed.push(next);
            }
        }
    }
}

/// Turns rivers without slope, so that they begin where others end: first where rivers with a slope
/// do, then where those do that are known by then. The others begin at the bank of a river that is
/// higher, or end at that of one that is lower.
fn turn_level_ones(rivers: &mut [River], at: &Meeting, reach: f64) {
    let is_level = |river: &River| river.levels()[0] == river.levels()[1];
    let mut is_known: Vec<bool> = rivers.iter().map(|river| !is_level(river)).collect();
    let sloping: Vec<usize> = (0..rivers.len()).filter(|&number| is_known[number]).collect();
    turn_reached(rivers, at, sloping, &mut is_known);
    if is_known.iter().all(|is_known| *is_known) {
        return;
    }
    let ends: Vec<[Key; 2]> = rivers.iter().map(|river| river.ends.map(key)).collect();
    let banks =
        confluence::heights_at_banks(rivers, reach, &|branch, end, main| ends[main].contains(&ends[branch][end]));
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
fn turn_reached(rivers: &mut [River], at: &Meeting, mut arriving: Vec<usize>, is_known: &mut [bool]) {
    while !arriving.is_empty() {
        let mouths: Vec<Key> = arriving.iter().map(|&number| key(rivers[number].ends[1])).collect();
        let mut reached: Vec<(usize, Key)> = Vec::new();
        for mouth in mouths {
            let here = at.get(&mouth).into_iter().flatten().filter(|next| !is_known[**next]);
            reached.extend(here.map(|&next| (next, mouth)));
        }
        reached.sort_unstable();
        reached.dedup();
        arriving.clear();
        for same in reached.chunk_by(|p, q| p.0 == q.0) {
            let next = same[0].0;
            // One that is reached at both ends stays as it is drawn.
            if same.iter().all(|(_, mouth)| key(rivers[next].ends[0]) != *mouth) {
                rivers[next].reverse();
            }
            is_known[next] = true;
            arriving.push(next);
        }
    }
}
