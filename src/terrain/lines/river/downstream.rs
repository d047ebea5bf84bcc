//! Rivers that continue each other.

use rustc_hash::FxHashMap;

use super::River;
use crate::triangulation::num::unsigned_zero;

/// A position, compared bit by bit.
type Key = [u64; 2];

fn key(end: [f64; 2]) -> Key {
    end.map(|c| unsigned_zero(c).to_bits())
}

impl River {
    /// Lowers rivers that begin where others end, so that the water never rises from one to the
    /// next. Of a river without slope, the end at which another arrives becomes its beginning. The
    /// order of the rivers makes no difference.
    ///
    /// Rivers meet if the middles of their ends have the same coordinates. How far a river was
    /// lowered there is added to its [`heights`](River::heights).
    ///
    /// # Complexity
    /// Linear in the number of rivers, times the number of rivers upstream at most.
    pub fn join(rivers: &mut [River]) {
        let mut at: FxHashMap<Key, Vec<usize>> = FxHashMap::default();
        for (number, river) in rivers.iter().enumerate() {
            river.ends.iter().for_each(|end| at.entry(key(*end)).or_default().push(number));
        }
        turn_level_ones(rivers, &at);
        let before: Vec<f64> = rivers.iter().map(|river| river.levels()[0]).collect();
        // Each visit lowers a river to the level of another: it ends, also around a ring.
        let mut changed: Vec<usize> = (0..rivers.len()).collect();
        while let Some(upstream) = changed.pop() {
            let (mouth, level) = (key(rivers[upstream].ends[1]), rivers[upstream].levels()[1]);
            for &next in at.get(&mouth).into_iter().flatten() {
                let river = &mut rivers[next];
                if key(river.ends[0]) == mouth && river.levels()[0] > level {
                    river.lower_to(level);
                    changed.push(next);
                }
            }
        }
        for (river, before) in rivers.iter_mut().zip(before) {
            let [first, _] = river.levels();
            if first < before {
                river.heights.add_rise(before - first, river.ends[0]);
            }
        }
    }
}

/// Turns rivers without slope, so that they begin where others end: first where rivers with a slope
/// do, then where those do that are known by then.
fn turn_level_ones(rivers: &mut [River], at: &FxHashMap<Key, Vec<usize>>) {
    let is_level = |river: &River| river.levels()[0] == river.levels()[1];
    let mut is_known: Vec<bool> = rivers.iter().map(|river| !is_level(river)).collect();
    let mut arriving: Vec<usize> = (0..rivers.len()).filter(|&number| is_known[number]).collect();
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
