//! Point location: a walk, and strategies for where it starts.
//!
//! | strategy | steps of a walk, for `n` evenly spread points |
//! |---|---|
//! | [`Near`] a cell, or the last insertion | as many as cells lie between |
//! | [`JumpAndWalk`] from the nearest of `n^(1/3)` vertices (Mücke, Saias and Zhu 1996) | `n^(1/3)`, and as many distances |
//! | [`Buckets`] from a vertex in the same square of a grid | a few; no better than without if all points are in one square |
//! | [`Hierarchy`] of samples (Devillers 2002) | `log n`, however the points are spread |
//!
//! These walk from one triangle to the next across an edge that separates it from the point. At
//! first they decide by rounded numbers and cross the edge that the point is furthest beyond, for
//! as long as that makes progress (structural filtering: Funke, Mehlhorn and Näher 1999). Then they
//! decide by exact predicates and cross any separating edge, chosen pseudo-randomly (the stochastic
//! walk). [`StraightLine`] goes through the triangles that a line to the point meets (both:
//! Devillers, Pion and Teillaud 2002).
//!
//! A strategy is a value that the caller owns. Some strategies learn from insertions and removals:
//! pass these to [`Locate::inserted`] and [`Locate::removed`], or insert and remove with the
//! strategy: [`Delaunay::insert_by`](crate::Delaunay::insert_by),
//! [`Delaunay::remove_by`](crate::Delaunay::remove_by). A strategy that misses updates is slower
//! but still correct.

mod buckets;
mod hierarchy;
mod start;
mod straight;
mod walk;

pub use buckets::Buckets;
pub use hierarchy::Hierarchy;
pub use start::{JumpAndWalk, Locate, Near};
pub use straight::StraightLine;

use crate::geometry::Geometry;
use crate::tds::{CellId, Complex, VertexId};

use super::Triangulation;
pub(super) use walk::Dice;
pub use walk::locate;
use walk::{LOOKS, PATIENCE, Seems};

/// The position of a point relative to a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// On a vertex.
    Vertex(VertexId),
    /// In a finite cell, or on its border. Bit `i` of `touching` is set if the point lies on the
    /// facet opposite vertex `i`. In the plane: no bit inside of the triangle, one bit on an edge.
    Cell {
        /// The cell.
        cell: CellId,
        /// The facets that the point lies on.
        touching: u8,
    },
    /// Outside of the convex hull, on the outer side of the finite facet of this infinite cell.
    OutsideHull {
        /// An infinite cell.
        cell: CellId,
    },
    /// Outside of the line or plane that contains all points; also for an empty triangulation, and
    /// for any other site if there is a single point.
    OutsideAffineHull,
    /// Nowhere: the geometry does not [admit](Geometry::admits) the point. A coordinate is NaN or
    /// infinite, or beyond the [range](crate::kernel::Kernel::RANGE) of the kernel; the range of
    /// [`Wide`](crate::kernel::Wide) is all finite numbers.
    Nowhere,
}

impl Location {
    /// Returns a cell at the point, from which to search its neighborhood.
    pub fn cell<G: Geometry<N>, const N: usize, V, C: Copy + Default>(
        self,
        triangulation: &Triangulation<G, N, V, C>,
    ) -> Option<CellId> {
        let Ok(cell) = self.cell_in(&triangulation.tds);
        cell
    }

    /// Returns the vertex that the point lies on; `None` if it lies on none.
    pub fn vertex(self) -> Option<VertexId> {
        match self {
            Location::Vertex(vertex) => Some(vertex),
            _ => None,
        }
    }

    /// Returns the facets of the [cell](Self::cell) that the point lies on, each as the cell and
    /// the index of the opposite vertex: none inside of the cell, one in the interior of a facet,
    /// two on an edge of a tetrahedron. Also none on a vertex and outside of the hull.
    ///
    /// ```
    /// use breakline_triangulation::Delaunay;
    /// use breakline_triangulation::geometry::Plane;
    ///
    /// let (t, v) = Delaunay::from_points(Plane::new(), &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])?;
    /// let facets: Vec<_> = t.locate(&[4.0, 1.0], None).facets().collect();
    /// let mut ends = t.tds().edge_ends(facets[0].0, facets[0].1);
    /// ends.sort();
    /// assert_eq!((facets.len(), ends), (1, [v[1].min(v[2]), v[1].max(v[2])]));
    /// assert_eq!(t.locate(&[3.0, 2.0], None).facets().count(), 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    pub fn facets(self) -> impl Iterator<Item = (CellId, usize)> {
        let (cell, touching) = match self {
            Location::Cell { cell, touching } => (Some(cell), touching),
            _ => (None, 0),
        };
        let is_on = move |i: &usize| touching >> i & 1 == 1;
        cell.into_iter().flat_map(move |cell| (0..u8::BITS as usize).filter(is_on).map(move |i| (cell, i)))
    }

    /// Like [`cell`](Self::cell), in any complex.
    ///
    /// # Errors
    /// If the vertex does not exist.
    pub fn cell_in<const N: usize, T: Complex<N>>(self, complex: &T) -> Result<Option<CellId>, T::Error> {
        match self {
            Location::Vertex(vertex) => complex.cell_of(vertex),
            Location::Cell { cell, .. } | Location::OutsideHull { cell } => Ok(Some(cell)),
            Location::OutsideAffineHull | Location::Nowhere => Ok(None),
        }
    }
}

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
    /// A point that the geometry does not [admit](Geometry::admits) is [`Location::Nowhere`].
    pub fn locate(&self, q: &G::Point, near: Option<CellId>) -> Location {
        let Ok(location) = locate(self, q, self.start(near));
        location
    }

    /// Returns where a walk starts: at a cell nearby if it exists, or where the last insertion
    /// ended.
    #[inline]
    pub(super) fn start(&self, near: Option<CellId>) -> Option<CellId> {
        near.filter(|&c| self.tds.is_used(c)).or(self.last)
    }

    /// Returns a cell that contains `q` or is not far from it, given one nearby. Less certain than
    /// [`locate`](Self::locate), and faster.
    fn approach(&self, q: &G::Point, near: Option<CellId>) -> Option<CellId> {
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
        let Ok(nearest) = walk::nearest_of_some(self, q, f64::INFINITY, samples, &mut Dice::default());
        nearest
    }
}
