use rustc_hash::FxHashMap;

use super::Place;
use super::pixel::Grid;

/// Vertices by the square of pixels that they lie in.
pub(super) struct Cells {
    grid: Grid,
    first: FxHashMap<[i64; 2], u32>,
    /// Vertices, each with the position of the next in its cell.
    chained: Vec<(u32, u32)>,
}

impl Cells {
    /// 2^10 pixels on a side: nearly always a neighborhood of one pixel lies in one of them.
    const SHIFT: u32 = 10;
    const LAST: u32 = u32::MAX;

    pub(super) fn new(grid: Grid, vertices: &[u32], place: impl Fn(u32) -> Place) -> Self {
        let mut first = FxHashMap::with_capacity_and_hasher(vertices.len(), Default::default());
        let mut chained = Vec::with_capacity(vertices.len());
        for (at, &vertex) in vertices.iter().enumerate() {
            let cell = grid.pixel(place(vertex)).map(|steps| steps >> Self::SHIFT);
            let next = first.insert(cell, at as u32).unwrap_or(Self::LAST);
            chained.push((vertex, next));
        }
        Cells { grid, first, chained }
    }

    /// All vertices within a unit of a place, and more.
    pub(super) fn near(&self, place: Place) -> impl Iterator<Item = u32> + '_ {
        let [i, j] = self.grid.pixel(place);
        let range = |steps: i64| (steps - 2) >> Self::SHIFT..=(steps + 2) >> Self::SHIFT;
        let cells = range(i).flat_map(move |x| range(j).map(move |y| [x, y]));
        cells.flat_map(|cell| {
            let next = |&at: &u32| Some(self.chained[at as usize].1).filter(|&next| next != Self::LAST);
            std::iter::successors(self.first.get(&cell).copied(), next).map(|at| self.chained[at as usize].0)
        })
    }
}
