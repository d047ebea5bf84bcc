//! Where a point lies.

use rustc_hash::FxHashSet;

use crate::geometry::Geometry;
use crate::tds::{CellId, Complex, VertexId};
use crate::triangulation::Triangulation;

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
    pub(super) fn insert(&mut self, i: usize) {
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
        on.into_iter()
            .flat_map(|(cell, facets)| facets.iter().map(move |i| (cell, i)))
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
    pub fn cells<const N: usize, T: Complex<N>>(
        self,
        complex: &T,
    ) -> Result<Vec<CellId>, T::Error> {
        let start = match self {
            Location::Vertex(_) | Location::Cell { .. } => self.cell_in(complex)?,
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => None,
        };
        let Some(start) = start else {
            return Ok(Vec::new());
        };
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
    pub fn cell_in<const N: usize, T: Complex<N>>(
        self,
        complex: &T,
    ) -> Result<Option<CellId>, T::Error> {
        match self {
            Location::Vertex(vertex) => complex.cell_of(vertex),
            Location::Cell { cell, .. } | Location::OutsideHull { cell } => Ok(Some(cell)),
            Location::OutsideAffineHull | Location::Nowhere => Ok(None),
        }
    }
}
