//! Point location: a walk, and strategies for where it starts.
//!
//! | strategy | steps of a walk, for `n` evenly spread points |
//! |---|---|
//! | [`Near`] a cell, or the last insertion | as many as cells lie between |
//! | [`JumpAndWalk`] from the nearest of `n^(1/3)` vertices (Mücke, Saias and Zhu 1996) | `n^(1/3)`, and as many distances |
//! | [`Buckets`] from a vertex in the same square (cube) of a grid | a few; no better than without if all points are in one |
//! | [`Hierarchy`](crate::Hierarchy) of samples (Devillers 2002) | `log n`, however the points are spread |
//!
//! These walk from one cell to the next across a facet that separates it from the point. At first
//! they decide by rounded numbers and cross the facet that the point is furthest beyond, for as
//! long as that makes progress (structural filtering: Funke, Mehlhorn and Näher 1999). Then they
//! decide by exact predicates and cross any separating facet, chosen pseudo-randomly (the
//! stochastic walk). [`StraightLine`] goes through the cells that a line to the point meets (both:
//! Devillers, Pion and Teillaud 2002).
//!
//! A strategy is a value that the caller owns. Some strategies learn from insertions and removals:
//! pass these to [`Locate::inserted`] and [`Locate::removed`], or insert and remove with the
//! strategy: [`Delaunay::insert_by`](crate::Delaunay::insert_by),
//! [`Delaunay::remove_by`](crate::Delaunay::remove_by). A strategy that misses updates is slower
//! but still correct.

mod buckets;
pub(crate) mod line;
mod location;
mod start;
mod straight;
mod walk;

pub use buckets::Buckets;
pub use location::{Facets, Location};
pub use start::{JumpAndWalk, Locate, Near};
pub use straight::StraightLine;

use crate::geometry::Geometry;
use crate::tds::{CellId, Complex, VertexId};
use crate::triangulation::Triangulation;
pub use line::SpacePassage;
pub(crate) use walk::Dice;
pub use walk::locate;
use walk::{LOOKS, PATIENCE, Seems};

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Returns where `q` lies, by a walk from a cell nearby, or from the last insertion.
    ///
    /// The walk first decides by rounded numbers, for as long as these make progress (Funke,
    /// Mehlhorn and Näher 1999), then by exact predicates, as a stochastic walk (Devillers, Pion
    /// and Teillaud 2002). It ends on any triangulation, with probability one. If it takes long, it
    /// continues from the nearest of `n^(1/3)` of the `n` vertices (Mücke, Saias and Zhu 1996),
    /// from where about as many steps are left if points are spread evenly. If it takes many more,
    /// as along curves, it continues from the nearest of `3 n^(1/2)`.
    ///
    /// For points that are far from each other, use a [strategy](Locate): a
    /// [`Hierarchy`](crate::Hierarchy) takes `O(log n)` steps. For points in order, give the cell
    /// of the one before as `near`.
    ///
    /// A point that the geometry does not [admit](Geometry::admits) is [`Location::Nowhere`].
    pub fn locate(&self, q: &G::Point, near: Option<CellId>) -> Location {
        let Ok(location) = locate(self, q, self.start(near));
        location
    }

    /// Returns where a walk starts: at a cell nearby if it exists, or where the last insertion
    /// ended.
    #[inline]
    pub(crate) fn start(&self, near: Option<CellId>) -> Option<CellId> {
        near.filter(|&c| self.tds.is_used(c)).or(self.last)
    }

    /// Returns a cell that contains `q` or is not far from it, given one nearby. Less certain than
    /// [`locate`](Self::locate), and faster.
    pub(crate) fn approach(&self, q: &G::Point, near: Option<CellId>) -> Option<CellId> {
        let mut near = near.filter(|&c| self.tds.is_used(c));
        if self.tds.width() == N
            && let Some(start) = near
        {
            let Ok(start) = self.tds.inner(start);
            let Ok(reached) = walk::approach(self, q, start, PATIENCE);
            if reached.seems != Seems::Elsewhere {
                return Some(reached.cell);
            }
            near = Some(reached.cell);
        }
        self.locate(q, near).cell(self)
    }

    fn nearest_of_some(&self, q: &G::Point) -> Option<VertexId> {
        let samples = LOOKS[0](self.tds.vertex_slots() as f64) as usize;
        let Ok(nearest) =
            walk::nearest_of_some(self, q, f64::INFINITY, samples, &mut Dice::default());
        nearest
    }
}
