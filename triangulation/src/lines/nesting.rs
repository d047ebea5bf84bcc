//! Nesting: what the constraints enclose.

use std::collections::HashMap;

use crate::error::GapError;
use crate::geometry::Crossing;
use crate::line_id::LineId;
use crate::tds::{CellId, VertexId};

use super::chains::undirected;
use super::constrained_delaunay::ConstrainedDelaunay;

impl<G: Crossing, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Returns the nesting depth of each cell: the least number of constraints on a path to it from
    /// outside of the hull. In polygons with holes and islands, odd depths are inside. Indexed by
    /// cell number; 0 for infinite cells and for numbers without a cell.
    ///
    /// # Complexity
    /// Linear in the number of cells. If only some lines count, use
    /// [`nesting_of`](Self::nesting_of).
    pub fn nesting(&self) -> Vec<u32> {
        self.nest(|cell, i| self.is_constrained(cell, i))
    }

    /// Like [`nesting`](Self::nesting), but only the given lines count, which together must bound
    /// an area. A ring may consist of any number of lines. Edges along which an even number of the
    /// lines run do not count.
    ///
    /// # Errors
    /// If the lines leave a gap.
    ///
    /// # Complexity
    /// O(n log n) for n edges of the lines' chains, and linear in the number of cells.
    pub fn nesting_of(
        &self,
        lines: impl IntoIterator<Item = LineId>,
    ) -> Result<Vec<u32>, GapError> {
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
        let mut loose: Vec<(VertexId, LineId)> = ends
            .into_iter()
            .filter(|(_, (is_odd, _))| *is_odd)
            .map(|(end, (_, line))| (end, line))
            .collect();
        loose.sort_unstable();
        if let Some(&(end, line)) = loose.first() {
            let at = |v: VertexId| self.geometry().plan(self.point(v));
            let [x, y] = at(end);
            let far = |v: VertexId| (at(v)[0] - x).hypot(at(v)[1] - y);
            let others = loose[1..].iter().map(|&(other, _)| other);
            let other = others
                .min_by(|&u, &v| far(u).total_cmp(&far(v)))
                .unwrap_or(end);
            return Err(GapError {
                line,
                ends: [at(end), at(other)],
            });
        }
        Ok(self.nest(|cell, i| {
            self.is_constrained(cell, i) && {
                let [a, b] = self.tds().edge_ends(cell, i);
                counts.get(&undirected(a, b)).is_some_and(|&is_odd| is_odd)
            }
        }))
    }

    /// Assigns depths in order: each constraint crossed adds one.
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
                for (i, &neighbor) in tds.cell_neighbors(cell).iter().enumerate() {
                    if levels[neighbor.index()] != UNKNOWN {
                        continue;
                    }
                    // A cell beyond several constraints may also be reached around them.
                    if is_constrained(cell, i) {
                        beyond.push(neighbor);
                    } else {
                        levels[neighbor.index()] = level;
                        here.push(neighbor);
                    }
                }
            }
            here = beyond;
            level += 1;
        }
        levels
    }
}
