use std::convert::Infallible;

use crate::num::lanes::prefetch;

use super::{CellId, Tds, VertexId};

/// Read access to cells and their neighbors, for any storage: what [`Tds`], the [compact
/// triangulation](crate::Compact) and structures of your own have in common.
///
/// The conventions are those of the [module](super). A structure that may be damaged, such as one
/// in a file, returns errors. Where [`Error`](Self::Error) is [`Infallible`], the compiler removes
/// all error handling. So each algorithm is written once over this trait: those without points are
/// in [`plane`](super::plane) and [`space`](super::space), those that need points in
/// [`query`](crate::query).
///
/// A structure of your own may store finite cells only, if it can answer for the infinite ones:
/// `examples/own_structure.rs` has one, an array of triangles.
///
/// # Laws
/// - Vertices are numbered below [`vertex_slots`](Self::vertex_slots), cells below
///   [`cell_slots`](Self::cell_slots).
/// - A result that is not an error is a number that exists: a vertex, or
///   [`INFINITE`](VertexId::INFINITE); a cell.
/// - Nothing panics, except that a complex that cannot be damaged may, for numbers that do not
///   exist.
///
/// # Models
/// [`Tds`], [`Compact`](crate::Compact).
///
/// ```
/// use breakline_triangulation::tds::{CellId, Complex};
///
/// /// Returns the vertices opposite to a triangle, one for each of its edges, as numbers.
/// fn opposite<T: Complex<3>>(complex: &T, cell: CellId) -> Result<Vec<usize>, T::Error> {
///     (0..3).map(|i| {
///         let beside = complex.neighbor(cell, i)?;
///         Ok(complex.vertex(beside, complex.index_of_neighbor(beside, cell)?)?.index())
///     }).collect()
/// }
/// ```
pub trait Complex<const N: usize> {
    /// The error for a link that does not hold; [`Infallible`] if that cannot happen.
    type Error;

    /// The dimension of the complex: -1 without a vertex, `N - 1` when full.
    fn dimension(&self) -> i32;

    /// One more than the largest vertex number; there may be gaps.
    fn vertex_slots(&self) -> usize;

    /// One more than the largest number of a cell; there may be gaps.
    fn cell_slots(&self) -> usize;

    /// Returns true if this is the number of a cell.
    fn is_used(&self, cell: CellId) -> bool;

    /// Returns the vertices of a cell, `dimension + 1` of them.
    ///
    /// Below full dimension, the rest of the array is not used, except that it must not contain
    /// [`VertexId::INFINITE`].
    ///
    /// # Errors
    /// If the cell or a vertex of it does not exist.
    fn corners(&self, cell: CellId) -> Result<[VertexId; N], Self::Error>;

    /// Returns the cell across the facet opposite vertex `i`, of `dimension + 1` vertices.
    ///
    /// # Errors
    /// If the cell does not exist, or has no neighbor there that exists.
    fn neighbor(&self, cell: CellId, i: usize) -> Result<CellId, Self::Error>;

    /// Returns a cell that has this vertex; `None` for the infinite vertex of an empty complex, and
    /// for an unused number.
    ///
    /// # Errors
    /// If the vertex, or the cell, does not exist.
    fn cell_of(&self, vertex: VertexId) -> Result<Option<CellId>, Self::Error>;

    /// Returns an error that names the cell `at` unless `holds` returns true.
    ///
    /// Algorithms call it where they rely on links that agree. A complex that cannot be damaged
    /// does not call `holds`, and returns `Ok(())`.
    ///
    /// # Errors
    /// If the links do not agree.
    fn ensure(&self, at: CellId, holds: impl FnOnce() -> bool) -> Result<(), Self::Error>;

    /// Prefetches the neighbors of a cell: a hint that may do nothing.
    #[inline(always)]
    fn fetch_neighbors(&self, _: CellId) {}

    /// The number of vertices of a cell: `dimension + 1`.
    #[inline(always)]
    fn width(&self) -> usize {
        (self.dimension() + 1) as usize
    }

    /// Returns vertex `i` of a cell.
    ///
    /// # Errors
    /// See [`corners`](Self::corners).
    #[inline(always)]
    fn vertex(&self, cell: CellId, i: usize) -> Result<VertexId, Self::Error> {
        Ok(self.corners(cell)?[i])
    }

    /// Returns the index of a vertex in a cell, or `None` if the cell does not have it.
    ///
    /// # Errors
    /// See [`corners`](Self::corners).
    #[inline(always)]
    fn index_of(&self, cell: CellId, vertex: VertexId) -> Result<Option<usize>, Self::Error> {
        // Mostly called for the infinite vertex, which is rarely found: branches are cheaper here.
        Ok(self.corners(cell)?.iter().position(|&v| v == vertex))
    }

    /// Returns true if the infinite vertex is a corner of the cell.
    ///
    /// # Errors
    /// See [`corners`](Self::corners).
    #[inline(always)]
    fn is_infinite(&self, cell: CellId) -> Result<bool, Self::Error> {
        Ok(self.corners(cell)?.contains(&VertexId::INFINITE))
    }

    /// Returns the index of the facet that `cell` shares with its neighbor `other`.
    ///
    /// # Errors
    /// If they are not neighbors.
    #[inline(always)]
    fn index_of_neighbor(&self, cell: CellId, other: CellId) -> Result<usize, Self::Error> {
        let mut found = None;
        for i in 0..self.width().min(N) {
            if self.neighbor(cell, i)? == other {
                found = Some(i);
                break;
            }
        }
        self.ensure(cell, || found.is_some())?;
        Ok(found.unwrap_or(0))
    }

    /// Returns the finite cell across the finite facet of an infinite cell, or the cell itself if
    /// it is finite.
    ///
    /// # Errors
    /// If that cell is infinite, too, or a link does not hold.
    #[inline(always)]
    fn inner(&self, cell: CellId) -> Result<CellId, Self::Error> {
        let Some(infinite) = self.index_of(cell, VertexId::INFINITE)? else {
            return Ok(cell);
        };
        let inner = self.neighbor(cell, infinite)?;
        self.ensure(inner, || {
            self.is_infinite(inner)
                .is_ok_and(|is_infinite| !is_infinite)
        })?;
        Ok(inner)
    }
}

/// Returns the finite vertices of a complex, in order of their numbers.
pub(crate) fn vertices_of<const N: usize, T: Complex<N>>(
    complex: &T,
) -> impl Iterator<Item = Result<VertexId, T::Error>> {
    let numbers = (0..complex.vertex_slots()).map(VertexId::new);
    numbers.filter_map(|vertex| {
        complex
            .cell_of(vertex)
            .map(|cell| cell.map(|_| vertex))
            .transpose()
    })
}

impl<const N: usize, V, C: Copy + Default> Complex<N> for Tds<N, V, C> {
    type Error = Infallible;

    #[inline(always)]
    fn dimension(&self) -> i32 {
        self.dimension
    }

    #[inline(always)]
    fn vertex_slots(&self) -> usize {
        self.vertex_cell.len()
    }

    #[inline(always)]
    fn cell_slots(&self) -> usize {
        self.links.len()
    }

    #[inline(always)]
    fn is_used(&self, cell: CellId) -> bool {
        self.is_used(cell)
    }

    #[inline(always)]
    fn corners(&self, cell: CellId) -> Result<[VertexId; N], Infallible> {
        Ok(self.links[cell.index()].vertices)
    }

    #[inline(always)]
    fn neighbor(&self, cell: CellId, i: usize) -> Result<CellId, Infallible> {
        Ok(self.links[cell.index()].neighbors[i])
    }

    #[inline(always)]
    fn cell_of(&self, vertex: VertexId) -> Result<Option<CellId>, Infallible> {
        Ok(self.cell_of(vertex))
    }

    #[inline(always)]
    fn fetch_neighbors(&self, cell: CellId) {
        for neighbor in self.links[cell.index()].neighbors {
            if let Some(links) = self.links.get(neighbor.index()) {
                prefetch(&links.vertices[0]);
            }
        }
    }

    #[inline(always)]
    fn ensure(&self, _: CellId, _: impl FnOnce() -> bool) -> Result<(), Infallible> {
        Ok(())
    }

    #[inline(always)]
    fn index_of_neighbor(&self, cell: CellId, other: CellId) -> Result<usize, Infallible> {
        Ok(self.index_of_neighbor(cell, other))
    }
}
