use std::convert::Infallible;
use std::iter::FusedIterator;

use super::{CellId, Tds, VertexId, ccw, cw};

/// Who is whose neighbor, wherever that is kept: what [`Tds`] and the
/// [compact triangulation](crate::triangulation::Compact) have in common, for reading.
///
/// The conventions are those of the [module](super). Whatever can be damaged answers with an error, so what is written
/// over this trait is written once, and where [`Error`](Self::Error) is [`Infallible`] nothing is left of that in the
/// machine code.
///
/// # Laws
/// - Vertices are numbered below [`vertex_slots`](Self::vertex_slots), cells below [`cell_slots`](Self::cell_slots).
/// - An answer that is no error is a number that exists: a vertex, or [`INFINITE`](VertexId::INFINITE); a cell.
/// - Nothing panics, but a complex that cannot be damaged may if asked for what does not exist.
///
/// # Models
/// [`Tds`], [`Compact`](crate::triangulation::Compact).
///
/// ```
/// use breakline_triangulation::tds::{CellId, Complex};
///
/// /// The vertices opposite a triangle, each seen over one of its edges, as numbers.
/// fn opposite<T: Complex<3>>(complex: &T, cell: CellId) -> Result<Vec<usize>, T::Error> {
///     (0..3).map(|i| {
///         let beside = complex.neighbor(cell, i)?;
///         Ok(complex.vertex(beside, complex.index_of_neighbor(beside, cell)?)?.index())
///     }).collect()
/// }
/// ```
pub trait Complex<const N: usize> {
    /// What becomes of a link that does not hold.
    type Error;

    /// Of the complex: -1 without a vertex, `N - 1` when full.
    fn dimension(&self) -> i32;

    /// Vertices are numbered below this, perhaps with gaps.
    fn vertex_slots(&self) -> usize;

    /// Cells are numbered below this, perhaps with gaps.
    fn cell_slots(&self) -> usize;

    /// Whether the number stands for a cell.
    fn is_used(&self, cell: CellId) -> bool;

    /// The vertices of a cell; below full dimension there is no vertex in the high places.
    ///
    /// # Errors
    /// If the cell or a vertex of it does not exist.
    fn corners(&self, cell: CellId) -> Result<[VertexId; N], Self::Error>;

    /// The cell opposite vertex `i`, of `dimension + 1` vertices.
    ///
    /// # Errors
    /// If there is none.
    fn neighbor(&self, cell: CellId, i: usize) -> Result<CellId, Self::Error>;

    /// A cell that has this vertex; `None` for the infinite vertex of an empty complex, and for a gap.
    ///
    /// # Errors
    /// If the vertex, or the cell, does not exist.
    fn cell_of(&self, vertex: VertexId) -> Result<Option<CellId>, Self::Error>;

    /// Whether links fit, asked where a walk relies on it: an error that names the cell if not. A complex that cannot
    /// be damaged does not look.
    ///
    /// # Errors
    /// If it does not hold.
    fn ensure(&self, at: CellId, holds: impl FnOnce() -> bool) -> Result<(), Self::Error>;

    /// Has the memory send what is known of the neighbors of a cell, ahead of the question for one of them: nothing else,
    /// or nothing at all.
    #[inline(always)]
    fn fetch_neighbors(&self, _: CellId) {}

    /// The number of vertices of a cell: `dimension + 1`.
    #[inline(always)]
    fn width(&self) -> usize {
        (self.dimension() + 1) as usize
    }

    /// One vertex of a cell.
    ///
    /// # Errors
    /// See [`corners`](Self::corners).
    #[inline(always)]
    fn vertex(&self, cell: CellId, i: usize) -> Result<VertexId, Self::Error> {
        Ok(self.corners(cell)?[i])
    }

    /// Where a vertex stands in a cell.
    ///
    /// # Errors
    /// See [`corners`](Self::corners).
    #[inline(always)]
    fn index_of(&self, cell: CellId, vertex: VertexId) -> Result<Option<usize>, Self::Error> {
        // Asked mostly for infinity, which is nearly never there: branches are cheaper here.
        Ok(self.corners(cell)?.iter().position(|&v| v == vertex))
    }

    /// Whether the infinite vertex is a corner.
    ///
    /// # Errors
    /// See [`corners`](Self::corners).
    #[inline(always)]
    fn is_infinite(&self, cell: CellId) -> Result<bool, Self::Error> {
        Ok(self.corners(cell)?.contains(&VertexId::INFINITE))
    }

    /// The index of the facet that `cell` shares with its neighbor `other`.
    ///
    /// # Errors
    /// If they are no neighbors.
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

    /// The finite cell beside an infinite one across its finite facet; a finite cell itself.
    ///
    /// # Errors
    /// If that is infinite, too, or a link does not hold.
    #[inline(always)]
    fn inner(&self, cell: CellId) -> Result<CellId, Self::Error> {
        let Some(infinite) = self.index_of(cell, VertexId::INFINITE)? else {
            return Ok(cell);
        };
        let inner = self.neighbor(cell, infinite)?;
        self.ensure(inner, || self.is_infinite(inner).is_ok_and(|is_infinite| !is_infinite))?;
        Ok(inner)
    }

    /// The ends of the edge opposite vertex `i` of a triangle, which has it on its left from the first to the second.
    ///
    /// # Errors
    /// See [`corners`](Self::corners).
    #[inline(always)]
    fn edge_ends(&self, cell: CellId, i: usize) -> Result<[VertexId; 2], Self::Error> {
        let corners = self.corners(cell)?;
        Ok([corners[ccw(i)], corners[cw(i)]])
    }
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

    /// A read whose result nobody waits for.
    #[inline(always)]
    fn fetch_neighbors(&self, cell: CellId) {
        for neighbor in self.links[cell.index()].neighbors {
            if let Some(links) = self.links.get(neighbor.index()) {
                std::hint::black_box(links.vertices[0]);
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

/// The cells that have a vertex, from one of them counter-clockwise, each with the place of the vertex in it.
///
/// Each step over a link is taken only if the link leads back: so no two steps lead to one cell, and the way cannot run
/// into a ring that it did not start from. It ends after each cell that has the vertex once, whatever the links say.
pub(crate) struct Star<'a, T> {
    complex: &'a T,
    vertex: VertexId,
    front: CellId,
    /// The same as `front` at the start, when all are left, and when none is.
    end: CellId,
    is_over: bool,
}

impl<'a, T: Complex<3>> Star<'a, T> {
    /// Of a vertex in a complex of dimension 1 or 2; below the `lowest` of them there are none.
    pub(crate) fn new(complex: &'a T, vertex: VertexId, lowest: i32) -> Result<Self, T::Error> {
        let start = if complex.dimension() >= lowest { complex.cell_of(vertex)? } else { None };
        let at = start.unwrap_or(CellId::NONE);
        Ok(Star { complex, vertex, front: at, end: at, is_over: start.is_none() })
    }

    /// Where the vertex stands in a cell.
    #[inline(always)]
    fn place(&self, cell: CellId) -> Result<usize, T::Error> {
        let place = super::first_of(&self.complex.corners(cell)?, self.vertex);
        self.complex.ensure(cell, || place < 3)?;
        Ok(place.min(2)) // an index into a cell whatever the links say
    }

    /// The next cell across the side that `turn` gives for the place of the vertex in a face.
    #[inline(always)]
    fn beside(
        &self,
        (cell, place): (CellId, usize),
        turn: impl Fn(usize) -> usize,
        back: impl Fn(usize) -> usize,
    ) -> Result<CellId, T::Error> {
        let complex = self.complex;
        let beside = complex.neighbor(cell, turned(complex, place, turn))?;
        complex.ensure(beside, || {
            let Ok(Some(j)) = complex.index_of(beside, self.vertex) else { return false };
            complex.neighbor(beside, turned(complex, j, back)).is_ok_and(|c| c == cell)
        })?;
        Ok(beside)
    }

    #[inline(always)]
    fn step(&mut self) -> Result<(CellId, usize), T::Error> {
        let here = (self.front, self.place(self.front)?);
        self.front = self.beside(here, ccw, cw)?;
        self.is_over = self.front == self.end;
        Ok(here)
    }

    fn step_back(&mut self) -> Result<(CellId, usize), T::Error> {
        self.end = self.beside((self.end, self.place(self.end)?), cw, ccw)?;
        self.is_over = self.front == self.end;
        Ok((self.end, self.place(self.end)?))
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

/// The place in a cell that a turn leads to from another one; on a line both ways lead to the only other.
#[inline(always)]
fn turned<T: Complex<3>>(complex: &T, place: usize, turn: impl Fn(usize) -> usize) -> usize {
    if complex.dimension() == 1 { 1 - place.min(1) } else { turn(place) }
}

/// The vertices that a vertex has an edge to, counter-clockwise, the infinite one included.
pub(crate) fn vertices_around<T: Complex<3>>(
    complex: &T,
    vertex: VertexId,
) -> Result<impl DoubleEndedIterator<Item = Result<VertexId, T::Error>> + '_, T::Error> {
    Ok(Star::new(complex, vertex, 1)?.map(|cell| {
        let (cell, i) = cell?;
        complex.vertex(cell, turned(complex, i, ccw))
    }))
}

/// The face on its left, and the index of the vertex opposite; on a line the index is 2, of no vertex.
type Edge = (CellId, usize);

/// The edges that start at a vertex, counter-clockwise.
pub(crate) fn edges_around<T: Complex<3>>(
    complex: &T,
    vertex: VertexId,
) -> Result<impl DoubleEndedIterator<Item = Result<Edge, T::Error>> + '_, T::Error> {
    Ok(Star::new(complex, vertex, 1)?.map(|cell| {
        let (cell, i) = cell?;
        Ok((cell, if complex.dimension() == 1 { 2 } else { cw(i) }))
    }))
}

/// The finite vertices, in order of their numbers.
pub(crate) fn vertices<T: Complex<3>>(complex: &T) -> impl Iterator<Item = Result<VertexId, T::Error>> + '_ {
    let numbers = (0..complex.vertex_slots()).map(VertexId::new);
    numbers.filter_map(|vertex| complex.cell_of(vertex).map(|cell| cell.map(|_| vertex)).transpose())
}

/// The cell to the left of the directed edge `a b` and the index of the edge in it (that of the vertex opposite), if
/// there is such an edge and dimension 2.
///
/// Time proportional to the degree of `a`; where that is high, to the smaller of both degrees.
pub(crate) fn edge<T: Complex<3>>(complex: &T, a: VertexId, b: VertexId) -> Result<Option<Edge>, T::Error> {
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

/// Whether the degree of a vertex is high, and higher than that of another one. Time proportional to the smaller degree.
pub(crate) fn is_busier<T: Complex<3>>(complex: &T, a: VertexId, b: VertexId) -> Result<bool, T::Error> {
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

/// The face with these three vertices, in any order, one of which may be the infinite one.
pub(crate) fn face<T: Complex<3>>(complex: &T, [a, b, c]: [VertexId; 3]) -> Result<Option<CellId>, T::Error> {
    for cell in Star::new(complex, a, 2)? {
        let (cell, _) = cell?;
        let corners = complex.corners(cell)?;
        if a != b && b != c && c != a && corners.contains(&b) && corners.contains(&c) {
            return Ok(Some(cell));
        }
    }
    Ok(None)
}
