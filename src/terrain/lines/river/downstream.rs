//! Rivers that continue each other.

use rustc_hash::FxHashMap;

use super::River;

impl River {
    /// Lowers rivers that begin where others end, so that the water never rises from one to the
    /// next. Of a river without slope, the end at which another arrives becomes its beginning.
    ///
    /// Rivers meet if the middles of their ends have the same coordinates. How far a river rose
    /// there is added to its [`heights`](River::heights).
    ///
    /// # Complexity
    /// Linear in the number of rivers, times the number of rivers upstream at most.
    pub fn join(rivers: &mut [River]) {
        let mut at: FxHashMap<[u64; 2], Vec<usize>> = FxHashMap::default();
        for (number, river) in rivers.iter().enumerate() {
            river.ends.iter().for_each(|end| at.entry(end.map(f64::to_bits)).or_default().push(number));
        }
        // Each visit lowers a river to the level of another: it ends, also around a ring.
        let mut changed: Vec<usize> = (0..rivers.len()).rev().collect();
        while let Some(upstream) = changed.pop() {
            let (mouth, level) = (rivers[upstream].ends[1], rivers[upstream].levels()[1]);
            for &next in at.get(&mouth.map(f64::to_bits)).into_iter().flatten().filter(|next| **next != upstream) {
                let river = &mut rivers[next];
                let [first, last] = river.levels();
                if first == last && first > level && river.ends[0] != mouth {
                    river.reverse();
                }
                if river.ends[0] == mouth && first > level {
                    river.lower_to(level);
                    changed.push(next);
                }
            }
        }
    }
}
