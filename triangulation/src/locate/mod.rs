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
mod start;
mod straight;
mod walk;

pub use buckets::Buckets;
pub use start::{JumpAndWalk, Locate, Near};
pub use straight::StraightLine;

use rustc_hash::FxHashSet;

use crate::geometry::Geometry;
use crate::tds::{CellId, Complex, VertexId};
use crate::triangulation::Triangulation;
pub use line::SpacePassage;
pub(crate) use walk::Dice;
pub use walk::locate;
use walk::{LOOKS, PATIENCE, Seems};

/// The position of a point relative to a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// On a vertex.
    Vertex(VertexId),
    /// In a finite cell, or on its border.
    Cell {
        /// The cell.
        cell: CellId,
        /// The facets of the cell that the point lies on: none inside of the cell, one in the
        /// interior of a facet, two on an edge of a tetrahedron.
        facets: Facets,
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

/// Some facets of a cell, each named by the index of the opposite vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Facets(u8);

impl Facets {
    /// Returns true if the facet opposite vertex `i` is among them.
    #[inline(always)]
    pub fn contains(self, i: usize) -> bool {
        i < 8 && self.0 >> i & 1 == 1
    }

    /// Returns true if there are none.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The number of facets.
    #[inline(always)]
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// The indices of the opposite vertices, in order.
    #[inline]
    pub fn iter(self) -> impl Iterator<Item = usize> {
        let mut left = self.0;
        std::iter::from_fn(move || {
            let next = (left != 0).then(|| left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some(next)
        })
    }

    /// Returns only the facet opposite vertex `i`, at most 7.
    #[inline(always)]
    pub(crate) fn only(i: usize) -> Self {
        Facets(1 << i)
    }

    /// Adds the facet opposite vertex `i`, at most 7.
    #[inline(always)]
    fn insert(&mut self, i: usize) {
        self.0 |= 1 << i;
    }
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
        let on = match self {
            Location::Cell { cell, facets } => Some((cell, facets)),
            _ => None,
        };
        on.into_iter().flat_map(|(cell, facets)| facets.iter().map(move |i| (cell, i)))
    }

    /// Returns all cells that contain the point, inside or on their border, infinite ones included:
    /// one for a point inside of a cell, two in the interior of a facet, and all around the edge or
    /// vertex that the point lies on. Empty outside of the hull.
    ///
    /// # Errors
    /// If a link of the complex does not hold.
    ///
    /// # Complexity
    /// Linear in the number of these cells.
    ///
    /// ```
    /// use breakline_triangulation::Delaunay;
    /// use breakline_triangulation::geometry::Space;
    ///
    /// let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0], [4.0, 4.0, 4.0]];
    /// let (t, v) = Delaunay::from_points(Space::new(), &corners)?;
    /// let Ok(cells) = t.locate(&[2.0, 2.0, 0.0], None).cells(t.tds());
    /// let around_edge = t.tds().cells().filter(|&c| [v[1], v[2]].iter().all(|&end| t.tds().index_of(c, end).is_some()));
    /// assert_eq!(cells.len(), around_edge.count());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn cells<const N: usize, T: Complex<N>>(self, complex: &T) -> Result<Vec<CellId>, T::Error> {
        let start = match self {
            Location::Vertex(_) | Location::Cell { .. } => self.cell_in(complex)?,
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => None,
        };
        let Some(start) = start else { return Ok(Vec::new()) };
        let width = complex.width().min(N);
        let corners = complex.corners(start)?;
        let spans = |i: &usize| match self {
            Location::Vertex(vertex) => corners[*i] == vertex,
            Location::Cell { facets, .. } => !facets.contains(*i),
            _ => false,
        };
        // The point is in the interior of what these vertices span.
        let around: Vec<VertexId> = (0..width).filter(spans).map(|i| corners[i]).collect();
        let mut cells = vec![start];
        let mut seen = FxHashSet::from_iter([start]);
        let mut done = 0;
        while let Some(&cell) = cells.get(done) {
            done += 1;
            let corners = complex.corners(cell)?;
            for i in (0..width).filter(|&i| !around.contains(&corners[i])) {
                let beyond = complex.neighbor(cell, i)?;
                if seen.insert(beyond) {
                    cells.push(beyond);
                }
            }
        }
        Ok(cells)
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
        let Ok(nearest) = walk::nearest_of_some(self, q, f64::INFINITY, samples, &mut Dice::default());
        nearest
    }
}
