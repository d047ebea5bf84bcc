//! The cells that many positions seem to be in, by rounded numbers.
//!
//! A search waits most of the time: for the links of the next cell, for its corners, and after each
//! branch that nobody can predict. So several searches through a triangulation take turns, in steps
//! without such branches: while one waits for memory, the processor works on the others.
//!
//! ```text
//!     positions   0 1 2 3 4 5 6 7 8 9 ...
//!     searches    |----->|----->|----->   each goes from a position to the next one
//! ```

use std::hint::select_unpredictable;

use breakline::triangulation::Delaunay;
use breakline::triangulation::tds::{CellId, VertexId};

use super::mesh::{Dimension, Mesh};

/// The number of searches that take turns.
const SEARCHES: usize = 4;

/// The fewest positions of a search, whose first one is located exactly.
const LEAST: usize = 16;

/// The number of steps after which a search that has not reached its position is a long one.
const PATIENCE: usize = 16;

/// A search for the cells of some of the positions, one after the other.
#[derive(Clone, Copy)]
struct Search {
    /// The number of the position that is searched for, and that at which the search ends.
    position: usize,
    end: usize,
    /// A cell, finite or not, and the finite one before.
    cell: CellId,
    from: CellId,
    /// Where the last long search ended: the next one may end nearby, as those for the first
    /// positions of rows do.
    origin: CellId,
}

impl Search {
    /// Goes on with the next position, from a finite cell.
    fn pass(&mut self, cell: CellId) {
        (self.cell, self.from) = (cell, cell);
        self.position += 1;
    }
}

impl<G: Dimension<N, D>, const N: usize, const D: usize> Mesh<G, N, D> {
    /// Returns the finite cell that each position seems to be in; `None` where it seems to be
    /// outside of the hull.
    ///
    /// Rounded numbers decide, so that a guess may be wrong.
    pub(super) fn guesses(&self, positions: &[[f64; D]]) -> Vec<Option<CellId>> {
        let mut guesses = vec![None; positions.len()];
        let count = (positions.len() / LEAST).min(SEARCHES);
        let infinite = self.t.tds().cell_of(VertexId::INFINITE);
        let Some(infinite) = infinite.filter(|_| count > 0 && !self.has_no_simplices()) else {
            return guesses;
        };
        let mut cell = self.inside_of(infinite);
        let mut searches: [Search; SEARCHES] = std::array::from_fn(|k| {
            let [position, end] = [k, k + 1].map(|k| positions.len() * k.min(count) / count);
            let mut search = Search {
                position,
                end,
                cell,
                from: cell,
                origin: cell,
            };
            if position < end {
                self.end_long(&mut search, positions, &mut guesses);
                cell = search.cell;
            }
            search
        });
        while searches.iter().any(|search| search.position < search.end) {
            let before = searches.map(|search| search.position);
            take_turns(&self.t, &mut searches, positions, &mut guesses);
            for (search, before) in searches.iter_mut().zip(before) {
                if search.position == before && before < search.end {
                    self.end_long(search, positions, &mut guesses);
                }
            }
        }
        guesses
    }

    /// Ends a long search for a position by an exact one, and goes on with the next position.
    #[cold]
    fn end_long(
        &self,
        search: &mut Search,
        positions: &[[f64; D]],
        guesses: &mut [Option<CellId>],
    ) {
        let q = &positions[search.position];
        let distance = |cell: CellId| {
            let corner = self.t.tds().vertex(cell, 0);
            self.t.geometry().rough_distance(self.t.point(corner), q)
        };
        let here = self.inside_of(search.cell);
        let is_nearer = distance(search.origin) < distance(here);
        let start = if is_nearer { search.origin } else { here };
        let found = self.t.locate(q, Some(start)).cell(&self.t);
        let cell = found.map_or(start, |cell| self.inside_of(cell));
        guesses[search.position] = found.map(|_| cell);
        search.origin = cell;
        search.pass(cell);
    }
}

/// Lets each search take some steps.
///
/// `PERF:` not inlined, so that what is read again and again need not be reloaded after each guess.
#[inline(never)]
fn take_turns<G: Dimension<N, D>, const N: usize, const D: usize>(
    t: &Delaunay<G, N>,
    searches: &mut [Search; SEARCHES],
    positions: &[[f64; D]],
    guesses: &mut [Option<CellId>],
) {
    for _ in 0..PATIENCE {
        for search in searches.iter_mut() {
            if search.position < search.end {
                step(t, search, positions, guesses);
            }
        }
    }
}

/// Looks from the cell of a search at its position: goes to the neighbor across the facet that the
/// position lies furthest beyond, or on to the next position.
#[inline(always)]
fn step<G: Dimension<N, D>, const N: usize, const D: usize>(
    t: &Delaunay<G, N>,
    search: &mut Search,
    positions: &[[f64; D]],
    guesses: &mut [Option<CellId>],
) {
    let (cell, points) = (search.cell, t.points());
    let (q, guess) = (&positions[search.position], &mut guesses[search.position]);
    let mut corners = [q; N];
    for (corner, v) in corners.iter_mut().zip(t.tds().corners(cell)) {
        let Some(point) = points.get(v.index()) else {
            // The infinite vertex.
            *guess = None;
            return search.pass(search.from);
        };
        *corner = point;
    }
    let Some(sides) = t.geometry().rough_sides(corners, q) else {
        return search.pass(cell);
    };
    let (mut facet, mut least) = (0, sides[0]);
    for (i, &side) in sides.iter().enumerate().skip(1) {
        facet = select_unpredictable(side < least, i, facet);
        least = select_unpredictable(side < least, side, least);
    }
    let beyond = t.tds().neighbor(cell, facet);
    // Back where it came from: on the facet between, as far as rounded numbers can tell.
    let is_there = (least >= 0.0) | (beyond == search.from);
    *guess = Some(cell);
    search.cell = select_unpredictable(is_there, cell, beyond);
    search.from = cell;
    search.position += usize::from(is_there);
}
