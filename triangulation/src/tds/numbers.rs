//! Iterators over the vertices and cells of a complex.

use std::fmt;
use std::iter::FusedIterator;
use std::ops::Range;

use super::{CellId, Tds, VertexId};

/// An iterator over the numbers for which a method of the complex returns true.
macro_rules! numbers {
    ($(#[$documentation:meta])* $name:ident, $id:ident, $is_there:ident) => {
        $(#[$documentation])*
        pub struct $name<'t, const N: usize, V = (), C = ()> {
            tds: &'t Tds<N, V, C>,
            slots: Range<usize>,
            left: usize,
        }

        impl<'t, const N: usize, V, C> $name<'t, N, V, C> {
            /// Returns an iterator over these slots, of which so many are in use.
            fn of(tds: &'t Tds<N, V, C>, slots: Range<usize>, left: usize) -> Self {
                $name { tds, slots, left }
            }
        }

        impl<const N: usize, V, C: Copy + Default> Iterator for $name<'_, N, V, C> {
            type Item = $id;

            #[inline]
            fn next(&mut self) -> Option<$id> {
                let tds = self.tds;
                let mut numbers = self.slots.by_ref().map($id::new);
                let number = numbers.find(|&number| tds.$is_there(number))?;
                self.left -= 1;
                Some(number)
            }

            fn size_hint(&self) -> (usize, Option<usize>) {
                (self.left, Some(self.left))
            }
        }

        impl<const N: usize, V, C: Copy + Default> ExactSizeIterator for $name<'_, N, V, C> {}

        impl<const N: usize, V, C: Copy + Default> FusedIterator for $name<'_, N, V, C> {}

        impl<const N: usize, V, C> Clone for $name<'_, N, V, C> {
            fn clone(&self) -> Self {
                $name::of(self.tds, self.slots.clone(), self.left)
            }
        }

        impl<const N: usize, V, C> fmt::Debug for $name<'_, N, V, C> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let mut shown = f.debug_struct(stringify!($name));
                shown.field("slots", &self.slots).field("left", &self.left).finish()
            }
        }
    };
}

numbers! {
    /// An iterator over the finite vertices, in order of their numbers; returned by
    /// [`Tds::vertices`].
    Vertices, VertexId, is_vertex
}

numbers! {
    /// An iterator over all cells, the infinite ones included, in order of their numbers; returned
    /// by [`Tds::cells`].
    Cells, CellId, is_used
}

/// An iterator over the cells without the infinite vertex, in order of their numbers; returned by
/// [`Triangulation::finite_cells`](crate::Triangulation::finite_cells).
///
/// ```
/// use breakline_triangulation::Delaunay;
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::tds::FiniteCells;
///
/// /// Visits some of the cells at a time.
/// struct Visit<'t> {
///     rest: FiniteCells<'t, 3>,
/// }
///
/// let square = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
/// let (t, _) = Delaunay::from_points(Plane::new(), &square)?;
/// let mut visit = Visit { rest: t.finite_cells() };
/// assert!(visit.rest.next().is_some() && visit.rest.count() == 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct FiniteCells<'t, const N: usize, V = (), C = ()> {
    cells: Cells<'t, N, V, C>,
}

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// The finite vertices, in order of their numbers.
    pub fn vertices(&self) -> Vertices<'_, N, V, C> {
        Vertices::of(self, 0..self.vertex_slots(), self.vertex_count())
    }

    /// All cells, the infinite ones included, in order of their numbers.
    pub fn cells(&self) -> Cells<'_, N, V, C> {
        Cells::of(self, 0..self.cell_slots(), self.cell_count())
    }

    /// Returns the cells without the infinite vertex, in order of their numbers.
    pub(crate) fn finite_cells(&self) -> FiniteCells<'_, N, V, C> {
        FiniteCells {
            cells: self.cells(),
        }
    }
}

impl<const N: usize, V, C: Copy + Default> Iterator for FiniteCells<'_, N, V, C> {
    type Item = CellId;

    #[inline]
    fn next(&mut self) -> Option<CellId> {
        let tds = self.cells.tds;
        self.cells.find(|&cell| !tds.is_infinite(cell))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, Some(self.cells.left))
    }
}

impl<const N: usize, V, C: Copy + Default> FusedIterator for FiniteCells<'_, N, V, C> {}

impl<const N: usize, V, C> Clone for FiniteCells<'_, N, V, C> {
    fn clone(&self) -> Self {
        FiniteCells {
            cells: self.cells.clone(),
        }
    }
}

impl<const N: usize, V, C> fmt::Debug for FiniteCells<'_, N, V, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("FiniteCells").field(&self.cells).finish()
    }
}
