//! Domains: what the constraints enclose.

use std::collections::HashMap;

use crate::geometry::Crossing;
use crate::tds::{CellId, VertexId};

use super::super::{ConstrainedDelaunay, GapError, LineId};
use super::paths::undirected;

impl<G: Crossing, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// How deep each cell is nested: the number of constraints that one has to cross, at least, to come there
    /// from outside of the hull. In polygons with holes and islands, odd is inside. By cell number; 0 for
    /// infinite cells and numbers without a cell.
    ///
    /// # Complexity
    /// Linear.
    pub fn nesting(&self) -> Vec<u32> {
        self.nest(|cell, i| self.is_constrained(cell, i))
    }

    /// The same when only some lines count, which together must bound an area: it does not matter how many lines a
    /// ring is made of, and a piece that an even number of them run along counts for nothing.
    ///
    /// # Errors
    /// If they leave a gap.
    ///
    /// # Complexity
    /// O(n log n) for n pieces of lines, and linear in the number of cells.
    pub fn nesting_of(&self, lines: impl IntoIterator<Item = LineId>) -> Result<Vec<u32>, GapError> {
        let mut counts: HashMap<[VertexId; 2], bool> = HashMap::new();
        let mut ends: HashMap<VertexId, (bool, LineId)> = HashMap::new();
        for line in lines {
            let chain = self.chain(line);
            for pair in chain.windows(2) {
                *counts.entry(undirected(pair[0], pair[1])).or_default() ^= true;
            }
            for &end in chain.first().into_iter().chain(chain.last()) {
                ends.entry(end).or_insert((false, line)).0 ^= true;
            }
        }
        let mut loose: Vec<(VertexId, LineId)> =
            ends.into_iter().filter(|(_, (is_odd, _))| *is_odd).map(|(end, (_, line))| (end, line)).collect();
        loose.sort_unstable();
        if let Some(&(end, line)) = loose.first() {
            let at = |v: VertexId| self.geometry().plan(self.point(v));
            let [x, y] = at(end);
            let far = |v: VertexId| (at(v)[0] - x).hypot(at(v)[1] - y);
            let others = loose[1..].iter().map(|&(other, _)| other);
            let other = others.min_by(|&u, &v| far(u).total_cmp(&far(v))).unwrap_or(end);
            return Err(GapError { line, ends: [at(end), at(other)] });
        }
        Ok(self.nest(|cell, i| {
            self.is_constrained(cell, i) && {
                let [a, b] = self.tds().edge_ends(cell, i);
                counts.get(&undirected(a, b)).is_some_and(|&is_odd| is_odd)
            }
        }))
    }

    /// Levels grow by one over each wall.
    fn nest(&self, is_constrained: impl Fn(CellId, usize) -> bool) -> Vec<u32> {
        const UNKNOWN: u32 = u32::MAX;
        let tds = self.tds();
        let mut levels = vec![0; tds.cell_slots()];
        if self.dimension() < 2 {
            return levels;
        }
        tds.cells().for_each(|cell| levels[cell.index()] = UNKNOWN);
        let mut here: Vec<CellId> = tds.around(VertexId::INFINITE).collect();
        let mut level = 0;
        while !here.is_empty() {
            let mut beyond = Vec::new();
            here.retain(|cell| levels[cell.index()] == UNKNOWN);
            here.iter().for_each(|cell| levels[cell.index()] = level);
            while let Some(cell) = here.pop() {
                for (i, &beside) in tds.cell_neighbors(cell).iter().enumerate() {
                    if levels[beside.index()] != UNKNOWN {
                        continue;
                    }
                    // What several walls lead to may also be reached around them.
                    if is_constrained(cell, i) {
                        beyond.push(beside);
                    } else {
                        levels[beside.index()] = level;
                        here.push(beside);
                    }
                }
            }
            here = beyond;
            level += 1;
        }
        levels
    }
}
