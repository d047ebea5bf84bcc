//! Queries around vertices in the plane, for any [`Complex`]: the functions correspond to the
//! methods of [`Tds`](super::Tds).
//!
//! Each returns an error at the first link that does not hold. All terminate, whatever the links
//! are.
//!
//! ```
//! use breakline_triangulation::tds::{Complex, VertexId, plane};
//!
//! /// The largest number of edges at a vertex.
//! fn largest_degree<T: Complex<3>>(complex: &T) -> Result<usize, T::Error> {
//!     let mut largest = 0;
//!     for vertex in plane::vertices(complex) {
//!         largest = largest.max(plane::vertices_around(complex, vertex?)?.count());
//!     }
//!     Ok(largest)
//! }
//! ```

mod around;

use std::iter::FusedIterator;

use super::{CellId, Complex, VertexId, ccw, cw, vertices_of};

/// Returns the ends of the edge opposite vertex `i` of a triangle. From the first to the second,
/// the triangle is on the left.
///
/// # Errors
/// If the triangle does not exist.
#[inline(always)]
pub fn edge_ends<T: Complex<3>>(
    complex: &T,
    cell: CellId,
    i: usize,
) -> Result<[VertexId; 2], T::Error> {
    let corners = complex.corners(cell)?;
    Ok([corners[ccw(i)], corners[cw(i)]])
}

/// The cells that have a vertex, counter-clockwise, each with the index of the vertex in it.
///
/// A step across a link is taken only if the link is mutual. So no two steps enter one cell, and
/// the iteration cannot run into a ring that does not contain its start. It ends at the latest
/// after each cell that has the vertex once, whatever the links say.
pub(crate) struct Star<'a, T> {
    complex: &'a T,
    vertex: VertexId,
    front: CellId,
    /// Equal to `front` at the start, when all cells are left, and at the end, when none is.
    end: CellId,
    is_over: bool,
}

impl<'a, T: Complex<3>> Star<'a, T> {
    /// Returns the star of a vertex; empty if the dimension is below `lowest`, which is 1 or 2.
    pub(crate) fn new(complex: &'a T, vertex: VertexId, lowest: i32) -> Result<Self, T::Error> {
        let start = if complex.dimension() >= lowest {
            complex.cell_of(vertex)?
        } else {
            None
        };
        let at = start.unwrap_or(CellId::NONE);
        Ok(Star {
            complex,
            vertex,
            front: at,
            end: at,
            is_over: start.is_none(),
        })
    }

    /// Returns the index of the vertex in a cell.
    #[inline(always)]
    fn index(&self, cell: CellId) -> Result<usize, T::Error> {
        let index = super::first_of(&self.complex.corners(cell)?, self.vertex);
        self.complex.ensure(cell, || index < 3)?;
        Ok(index.min(2)) // an index into a cell whatever the links say
    }

    /// Returns the next cell: across the side that `turn` computes from the index of the vertex in
    /// a cell.
    #[inline(always)]
    fn beside(
        &self,
        (cell, i): (CellId, usize),
        turn: impl Fn(usize) -> usize,
        back: impl Fn(usize) -> usize,
    ) -> Result<CellId, T::Error> {
        let complex = self.complex;
        let beside = complex.neighbor(cell, turned(complex, i, turn))?;
        complex.ensure(beside, || {
            let Ok(Some(j)) = complex.index_of(beside, self.vertex) else {
                return false;
            };
            complex
                .neighbor(beside, turned(complex, j, back))
                .is_ok_and(|c| c == cell)
        })?;
        Ok(beside)
    }

    #[inline(always)]
    fn step(&mut self) -> Result<(CellId, usize), T::Error> {
        let here = (self.front, self.index(self.front)?);
        self.front = self.beside(here, ccw, cw)?;
        self.is_over = self.front == self.end;
        Ok(here)
    }

    fn step_back(&mut self) -> Result<(CellId, usize), T::Error> {
        self.end = self.beside((self.end, self.index(self.end)?), cw, ccw)?;
        self.is_over = self.front == self.end;
        Ok((self.end, self.index(self.end)?))
    }
}

impl<T: Complex<3>> Iterator for Star<'_, T> {
    type Item = Result<(CellId, usize), T::Error>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        (!self.is_over).then(|| self.step().inspect_err(|_| self.is_over = true))
    }
}

impl<T: Complex<3>> DoubleEndedIterator for Star<'_, T> {
    fn next_back(&mut self) -> Option<Self::Item> {
        (!self.is_over).then(|| self.step_back().inspect_err(|_| self.is_over = true))
    }
}

impl<T: Complex<3>> FusedIterator for Star<'_, T> {}

/// Returns the index in a cell that a turn computes from another one; on a line, both turns return
/// the only other index.
#[inline(always)]
fn turned<T: Complex<3>>(complex: &T, i: usize, turn: impl Fn(usize) -> usize) -> usize {
    if complex.dimension() == 1 {
        1 - i.min(1)
    } else {
        turn(i)
    }
}

/// Returns the vertices that a vertex is joined to by an edge, counter-clockwise, the infinite one
/// included. For the infinite vertex these are the vertices on the hull, clockwise. Empty below
/// dimension 1.
///
/// # Errors
/// If the vertex does not exist. The iterator ends at the first error.
pub fn vertices_around<T: Complex<3>>(
    complex: &T,
    vertex: VertexId,
) -> Result<impl DoubleEndedIterator<Item = Result<VertexId, T::Error>> + '_, T::Error> {
    Ok(Star::new(complex, vertex, 1)?.map(|cell| {
        let (cell, i) = cell?;
        complex.vertex(cell, turned(complex, i, ccw))
    }))
}

/// An edge of the plane with a direction: the cell on its left, and the index of the vertex
/// opposite.
pub type DirectedEdge = (CellId, usize);

/// Returns the edges that start at a vertex, counter-clockwise, each as the cell on its left and
/// the index of the vertex opposite. On a line the cell is the edge, and the index is 2, which is
/// no vertex of it.
///
/// # Errors
/// If the vertex does not exist. The iterator ends at the first error.
pub fn edges_around<T: Complex<3>>(
    complex: &T,
    vertex: VertexId,
) -> Result<impl DoubleEndedIterator<Item = Result<DirectedEdge, T::Error>> + '_, T::Error> {
    Ok(Star::new(complex, vertex, 1)?.map(|cell| {
        let (cell, i) = cell?;
        Ok((cell, if complex.dimension() == 1 { 2 } else { cw(i) }))
    }))
}

/// Returns the finite vertices, in order of their numbers.
pub fn vertices<T: Complex<3>>(
    complex: &T,
) -> impl Iterator<Item = Result<VertexId, T::Error>> + '_ {
    vertices_of::<3, T>(complex)
}

/// Returns the cell to the left of the directed edge `a b` and the index of the edge in it (that of
/// the vertex opposite), or `None` if there is no such edge or the dimension is not 2.
///
/// # Errors
/// If a link around the vertices does not hold.
///
/// # Complexity
/// Time proportional to the degree of `a`; where that is high, to the smaller of both degrees.
pub fn edge<T: Complex<3>>(
    complex: &T,
    a: VertexId,
    b: VertexId,
) -> Result<Option<(CellId, usize)>, T::Error> {
    let mut around_a = Star::new(complex, a, 2)?;
    let is_edge = |(cell, i)| Ok((complex.vertex(cell, ccw(i))? == b).then_some((cell, cw(i))));
    for cell in around_a.by_ref().take(HIGH_DEGREE) {
        if let Some(edge) = is_edge(cell?)? {
            return Ok(Some(edge));
        }
    }
    if around_a.is_over {
        return Ok(None);
    }
    for (at_a, at_b) in around_a.zip(Star::new(complex, b, 2)?) {
        let (cell, i) = at_b?;
        let from_b = (complex.vertex(cell, cw(i))? == a).then_some((cell, ccw(i)));
        if let Some(edge) = is_edge(at_a?)?.or(from_b) {
            return Ok(Some(edge));
        }
    }
    Ok(None)
}

/// Beyond this, the degree of a vertex is compared with that of another one.
const HIGH_DEGREE: usize = 64;

/// Returns true if the degree of `a` is high, and higher than that of `b`. Time proportional to the
/// smaller degree.
pub(crate) fn is_busier<T: Complex<3>>(
    complex: &T,
    a: VertexId,
    b: VertexId,
) -> Result<bool, T::Error> {
    let mut around_a = Star::new(complex, a, 2)?;
    if around_a.by_ref().take(HIGH_DEGREE).count() < HIGH_DEGREE {
        return Ok(false);
    }
    let mut around_b = Star::new(complex, b, 2)?.skip(HIGH_DEGREE);
    for at_a in around_a {
        at_a?;
        if around_b.next().is_none() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Returns the face with these three vertices, in any order, one of which may be the infinite one.
///
/// # Errors
/// If a link around the first vertex does not hold.
///
/// # Complexity
/// Linear in the degree of the first vertex.
pub fn face<T: Complex<3>>(
    complex: &T,
    [a, b, c]: [VertexId; 3],
) -> Result<Option<CellId>, T::Error> {
    for cell in Star::new(complex, a, 2)? {
        let (cell, _) = cell?;
        let corners = complex.corners(cell)?;
        if a != b && b != c && c != a && corners.contains(&b) && corners.contains(&c) {
            return Ok(Some(cell));
        }
    }
    Ok(None)
}
