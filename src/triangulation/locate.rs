use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, VertexId};

use super::Triangulation;

/// Where a point lies in a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// On a vertex.
    Vertex(VertexId),
    /// In a finite cell, or on its border. Bit `i` of `touching` is set if the point lies on the facet
    /// opposite vertex `i`: in the plane, no bit says inside of the triangle and one bit on that edge.
    Cell {
        /// The cell.
        cell: CellId,
        /// The facets that the point lies on.
        touching: u8,
    },
    /// Outside of the convex hull, in sight of the finite facet of this infinite cell.
    OutsideHull {
        /// An infinite cell.
        cell: CellId,
    },
    /// Outside of the line or plane that all points lie in; also for an empty triangulation, and for
    /// a second place beside a single point.
    OutsideAffineHull,
}

/// Marsaglia's xorshift: the walk turns corners in an order that no input can foresee, the same in
/// every run.
struct Dice(u32);

impl Dice {
    #[inline(always)]
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        ((u64::from(self.0) * n as u64) >> 32) as usize
    }
}

/// Steps after which a walk looks for a better place to start from. In spatial order nearly all are over long before.
const PATIENCE: usize = 64;

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Finds where `q` lies, by a remembering stochastic walk (Devillers, Pion, Teillaud 2002) from a
    /// cell nearby, or from the last insertion. Ends on any triangulation, with probability one. If it takes long, it goes on
    /// from the nearest of `n^(1/3)` of the `n` vertices (Mücke, Saias and Zhu 1996): then about as many steps are left where
    /// points are spread evenly.
    ///
    /// The point must be one that the geometry [admits](Geometry::admits): for others the predicates have no
    /// answer, and so has this.
    pub fn locate(&self, q: &G::Point, near: Option<CellId>) -> Location {
        let start = near.filter(|&c| self.tds.is_used(c)).or(self.last.filter(|&c| self.tds.is_used(c)));
        let Some(mut cell) = start.or_else(|| self.tds.cell_of(VertexId::INFINITE)) else {
            return Location::OutsideAffineHull;
        };
        let width = self.tds.cell_vertices(cell).len();
        if let Some(infinite) = self.tds.index_of(cell, VertexId::INFINITE) {
            cell = self.tds.neighbor(cell, infinite);
        }
        if width == 1 {
            let only = self.tds.vertex(cell, 0);
            return match self.geometry.compare(q, self.point(only)) {
                std::cmp::Ordering::Equal => Location::Vertex(only),
                _ => Location::OutsideAffineHull,
            };
        }
        if !self.is_full() && self.leaves_flat(cell, q) {
            return Location::OutsideAffineHull;
        }
        let mut dice = Dice(0x9E37_79B9);
        let mut from = None;
        let mut steps = 0;
        'walk: loop {
            steps += 1;
            if steps == PATIENCE
                && let Some(nearer) = self.jump(cell, q, &mut dice)
            {
                (cell, from) = (nearer, None);
            }
            let mut touching = 0u8;
            let first = dice.below(width);
            for turn in 0..width {
                let i = if first + turn < width { first + turn } else { first + turn - width };
                let beyond = self.tds.neighbor(cell, i);
                if from == Some(beyond) {
                    continue; // we came from there: `q` lies strictly on this side
                }
                match self.side_of_facet(cell, i, q) {
                    Sign::Positive => {}
                    Sign::Zero => touching |= 1 << i,
                    Sign::Negative if self.tds.is_infinite(beyond) => return Location::OutsideHull { cell: beyond },
                    Sign::Negative => {
                        from = Some(cell);
                        cell = beyond;
                        continue 'walk;
                    }
                }
            }
            if touching.count_ones() as usize == width - 1 {
                // On all facets but one: on the vertex opposite that one.
                return Location::Vertex(self.tds.vertex(cell, (!touching).trailing_zeros() as usize));
            }
            return Location::Cell { cell, touching };
        }
    }

    /// A finite cell that is nearer to `q` than this one, as far as some vertices tell.
    #[cold]
    fn jump(&self, cell: CellId, q: &G::Point, dice: &mut Dice) -> Option<CellId> {
        let slots = self.tds.vertex_slots();
        let far = |v: VertexId| self.geometry.rough_distance(self.point(v), q);
        let mut least = far(self.tds.vertex(cell, 0));
        let mut nearest = None;
        for _ in 0..(slots as f64).cbrt() as usize {
            let vertex = VertexId::new(dice.below(slots));
            if self.tds.is_vertex(vertex) && far(vertex) < least {
                (least, nearest) = (far(vertex), Some(vertex));
            }
        }
        let cell = self.tds.cell_of(nearest?)?;
        let infinite = self.tds.index_of(cell, VertexId::INFINITE);
        Some(infinite.map_or(cell, |i| self.tds.neighbor(cell, i)))
    }

    /// Whether `q` lies outside of the line or plane of all points, which a finite cell spans.
    fn leaves_flat(&self, cell: CellId, q: &G::Point) -> bool {
        let mut simplex = self.flat_with(cell, usize::MAX, q);
        simplex.push(q);
        let sign = match <[&G::Point; N]>::try_from(simplex) {
            Ok(full) => self.geometry.orientation(full),
            Err(flat) => self.geometry.orientation_in_flat(&flat),
        };
        sign != Sign::Zero
    }
}
