//! Queries around vertices and edges in space, for any [`Complex`]: the functions correspond to the
//! methods of [`Tds`](super::Tds).
//!
//! Each returns an error at the first link that does not hold. All terminate, whatever the links
//! are.
//!
//! ```
//! use breakline_triangulation::tds::{Complex, VertexId, space};
//!
//! /// The largest number of cells around an edge that starts at a vertex.
//! fn thickest<T: Complex<4>>(complex: &T, vertex: VertexId) -> Result<usize, T::Error> {
//!     let mut thickest = 0;
//!     for (cell, i) in space::cells_around(complex, vertex)? {
//!         for j in (0..4).filter(|&j| j != i) {
//!             thickest = thickest.max(space::cells_around_edge(complex, (cell, i, j))?.count());
//!         }
//!     }
//!     Ok(thickest)
//! }
//! ```

mod around;

use std::iter::FusedIterator;

use super::{CellId, Complex, VertexId};

/// An edge with a direction, in any dimension: a cell that has it, and the indices of its start and
/// its end there.
pub type Edge = (CellId, usize, usize);

/// Returns the other two indices of a tetrahedron, so that `i j k l` is an even permutation:
/// counter-clockwise around the edge from `i` to `j`, seen from its end, `l` follows `k`.
///
/// ```text
///          j                 l
///        / | \            /     \
///       k--|--l   from   k - j - (the next)
///        \ | /    above:  \     /
///          i                 ...
/// ```
#[inline(always)]
pub const fn beside(i: usize, j: usize) -> [usize; 2] {
    const TABLE: [[[usize; 2]; 4]; 4] = [
        [[0, 0], [2, 3], [3, 1], [1, 2]],
        [[3, 2], [0, 0], [0, 3], [2, 0]],
        [[1, 3], [3, 0], [0, 0], [0, 1]],
        [[2, 1], [0, 2], [1, 0], [0, 0]],
    ];
    TABLE[i & 3][j & 3]
}

/// The indices of the other vertices of a tetrahedron, for each of its vertices, counter-clockwise
/// as seen from outside.
pub(crate) const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [1, 0, 2]];

/// The cells around an edge, counter-clockwise seen from its end.
///
/// A step across a link is taken only if the link is mutual. So no two steps enter one cell, and
/// the iteration cannot run into a ring that does not contain its start.
struct CellsAroundEdge<'a, T> {
    complex: &'a T,
    ends: [VertexId; 2],
    front: CellId,
    /// Equal to `front` at the start, when all cells are left, and at the end, when none is.
    end: CellId,
    is_over: bool,
}

impl<T: Complex<4>> CellsAroundEdge<'_, T> {
    /// Returns the edge in a cell.
    #[inline(always)]
    fn edge_in(&self, cell: CellId) -> Result<Edge, T::Error> {
        let corners = self.complex.corners(cell)?;
        let [i, j] = self.ends.map(|end| super::first_of(&corners, end));
        self.complex.ensure(cell, || i < 4 && j < 4 && i != j)?;
        Ok((cell, i.min(3), j.min(3))) // indices into a cell whatever the links say
    }

    /// Returns the next cell, across the facet opposite the one of the two other vertices that
    /// `forth` selects.
    #[inline(always)]
    fn step(&self, cell: CellId, forth: usize) -> Result<CellId, T::Error> {
        let (_, i, j) = self.edge_in(cell)?;
        let next = self.complex.neighbor(cell, beside(i, j)[forth])?;
        self.complex.ensure(next, || {
            let Ok((_, i, j)) = self.edge_in(next) else {
                return false;
            };
            self.complex
                .neighbor(next, beside(i, j)[1 - forth])
                .is_ok_and(|back| back == cell)
        })?;
        Ok(next)
    }
}

impl<T: Complex<4>> Iterator for CellsAroundEdge<'_, T> {
    type Item = Result<Edge, T::Error>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let here = self.edge_in(self.front).and_then(|edge| {
            self.front = self.step(self.front, 0)?;
            self.is_over = self.front == self.end;
            Ok(edge)
        });
        Some(here.inspect_err(|_| self.is_over = true))
    }
}

impl<T: Complex<4>> DoubleEndedIterator for CellsAroundEdge<'_, T> {
    fn next_back(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let here = self.step(self.end, 1).and_then(|cell| {
            self.end = cell;
            self.is_over = self.front == self.end;
            self.edge_in(cell)
        });
        Some(here.inspect_err(|_| self.is_over = true))
    }
}

impl<T: Complex<4>> FusedIterator for CellsAroundEdge<'_, T> {}

/// Returns the start and the end of an edge.
///
/// # Errors
/// If the cell does not exist.
///
/// # Panics
/// If an index is 4 or more.
#[inline]
pub fn edge_ends<T: Complex<4>>(
    complex: &T,
    (cell, i, j): Edge,
) -> Result<[VertexId; 2], T::Error> {
    let corners = complex.corners(cell)?;
    Ok([corners[i], corners[j]])
}

/// Returns the cells around an edge, the infinite ones included, counter-clockwise seen from its
/// end, each with the indices of the edge in it. The given cell is the first. Empty below
/// dimension 3.
///
/// The facets around the edge are those opposite the first of the [other two](beside) indices of
/// each cell: each lies between its cell and the next.
///
/// # Errors
/// If the cell does not exist. The iterator ends at the first error.
///
/// # Panics
/// If an index is 4 or more.
pub fn cells_around_edge<T: Complex<4>>(
    complex: &T,
    edge: Edge,
) -> Result<impl DoubleEndedIterator<Item = Result<Edge, T::Error>> + FusedIterator + '_, T::Error>
{
    let ends = edge_ends(complex, edge)?;
    let is_edge = complex.dimension() == 3 && edge.1 != edge.2;
    Ok(CellsAroundEdge {
        complex,
        ends,
        front: edge.0,
        end: edge.0,
        is_over: !is_edge,
    })
}

/// Returns the cells that have a vertex, the infinite ones included, each with the index of the
/// vertex in it: its star. The facets opposite the vertex are its link.
///
/// The first cell is that of [`cell_of`](Complex::cell_of); each of the others shares a facet with
/// one before it. The complex may have any dimension. Empty for a vertex without a cell.
///
/// # Errors
/// If the vertex does not exist, or a link around it does not hold.
///
/// # Complexity
/// Linear in the number of these cells.
pub fn cells_around<T: Complex<4>>(
    complex: &T,
    vertex: VertexId,
) -> Result<Vec<(CellId, usize)>, T::Error> {
    let mut star = StarSearch::new(complex, vertex)?;
    while star.grow()? {}
    Ok(star.cells)
}

/// Returns the vertices that a vertex is joined to by an edge, the infinite one included, each at
/// least once, in the order in which the cells around the vertex are found.
pub(super) fn neighbors_of<T: Complex<4>>(
    complex: &T,
    vertex: VertexId,
) -> Result<impl Iterator<Item = Result<VertexId, T::Error>> + use<'_, T>, T::Error> {
    let mut star = StarSearch::new(complex, vertex)?;
    Ok(std::iter::from_fn(move || {
        loop {
            if let Some(neighbor) = star.ends.pop() {
                return Some(Ok(neighbor));
            }
            match star.grow() {
                Ok(true) => {}
                Ok(false) => return None,
                Err(error) => return Some(Err(error)),
            }
        }
    }))
}

/// Part of the cells around a vertex.
struct StarSearch<'t, T> {
    complex: &'t T,
    vertex: VertexId,
    /// The cells found so far, each with the index of the vertex in it.
    cells: Vec<(CellId, usize)>,
    /// The same cells.
    seen: CellSet,
    /// The number of cells whose neighbors have been added.
    done: usize,
    /// The other vertices of the cells, each at least once; for the caller, who may remove them.
    ends: Vec<VertexId>,
}

/// A set of cells: an open hash table of their numbers.
struct CellSet {
    /// `1 << bits` of them, at most half of which are in use; the others are `NONE`.
    slots: Vec<CellId>,
    bits: u32,
    len: usize,
}

impl CellSet {
    /// Returns an empty set with room for twice the average number of cells around a vertex.
    fn new() -> Self {
        const BITS: u32 = 7;
        CellSet {
            slots: vec![CellId::NONE; 1 << BITS],
            bits: BITS,
            len: 0,
        }
    }

    /// Adds a cell; returns false if it is there.
    #[inline(always)]
    fn insert(&mut self, cell: CellId) -> bool {
        if 2 * self.len >= self.slots.len() {
            self.grow();
        }
        let is_new = self.put(cell);
        self.len += usize::from(is_new);
        is_new
    }

    /// Puts a cell into a slot; returns false if it is there.
    #[inline(always)]
    fn put(&mut self, cell: CellId) -> bool {
        let last = self.slots.len() - 1;
        // The high bits of the product depend on all bits of the number.
        let hash = u64::from(cell.stored().get()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut at = (hash >> (64 - self.bits)) as usize & last;
        while self.slots[at] != CellId::NONE {
            if self.slots[at] == cell {
                return false;
            }
            at = (at + 1) & last;
        }
        self.slots[at] = cell;
        true
    }

    #[cold]
    fn grow(&mut self) {
        self.bits += 1;
        let twice = vec![CellId::NONE; 1 << self.bits];
        for cell in std::mem::replace(&mut self.slots, twice) {
            if cell != CellId::NONE {
                self.put(cell);
            }
        }
    }
}

impl<'t, T: Complex<4>> StarSearch<'t, T> {
    /// Returns one cell; none for a vertex without a cell.
    fn new(complex: &'t T, vertex: VertexId) -> Result<Self, T::Error> {
        let mut star = StarSearch {
            complex,
            vertex,
            cells: Vec::with_capacity(32),
            seen: CellSet::new(),
            done: 0,
            ends: Vec::new(),
        };
        if let Some(first) = complex.cell_of(vertex)? {
            star.add(first)?;
            let corners = complex.corners(first)?;
            star.ends.extend(
                corners[..complex.width().min(4)]
                    .iter()
                    .filter(|&&v| v != vertex),
            );
        }
        Ok(star)
    }

    /// Adds a cell; returns false if it is there.
    fn add(&mut self, cell: CellId) -> Result<bool, T::Error> {
        let is_new = self.seen.insert(cell);
        if is_new {
            self.complex.fetch_neighbors(cell);
            let index = self.complex.index_of(cell, self.vertex)?;
            self.complex.ensure(cell, || index.is_some())?;
            self.cells.extend(index.map(|index| (cell, index)));
        }
        Ok(is_new)
    }

    /// Adds the neighbors of the first cell whose neighbors have not been added. Returns false if
    /// there is no such cell.
    fn grow(&mut self) -> Result<bool, T::Error> {
        let Some(&(cell, index)) = self.cells.get(self.done) else {
            return Ok(false);
        };
        self.done += 1;
        let width = self.complex.width().min(4);
        for i in (0..width).filter(|&i| i != index) {
            let beyond = self.complex.neighbor(cell, i)?;
            self.complex.ensure(beyond, || {
                self.complex.index_of_neighbor(beyond, cell).is_ok()
            })?;
            if self.add(beyond)? {
                let opposite = self.complex.index_of_neighbor(beyond, cell)?;
                self.ends.push(self.complex.corners(beyond)?[opposite]);
            }
        }
        Ok(true)
    }
}

/// Returns the vertices that a vertex is joined to by an edge, the infinite one included, in order
/// of their numbers. Empty below dimension 1.
///
/// # Errors
/// Those of [`cells_around`].
///
/// # Complexity
/// O(k log k) for the k cells around the vertex. To stop early, use
/// [`neighbors_of`](super::Neighbors::neighbors_of), which may return a vertex more than once.
pub fn vertices_around<T: Complex<4>>(
    complex: &T,
    vertex: VertexId,
) -> Result<Vec<VertexId>, T::Error> {
    let mut vertices = Vec::new();
    if complex.dimension() < 1 {
        return Ok(vertices);
    }
    for (cell, index) in cells_around(complex, vertex)? {
        let corners = complex.corners(cell)?;
        vertices.extend(
            (0..complex.width().min(4))
                .filter(|&i| i != index)
                .map(|i| corners[i]),
        );
    }
    vertices.sort_unstable();
    vertices.dedup();
    Ok(vertices)
}

/// Returns a cell that has these vertices, two to four different ones in any order, one of which
/// may be the infinite one; `None` if there is none.
///
/// # Errors
/// Those of [`cells_around`].
///
/// # Complexity
/// Linear in the number of cells around the first vertex.
pub fn cell_with<T: Complex<4>>(
    complex: &T,
    vertices: &[VertexId],
) -> Result<Option<CellId>, T::Error> {
    let is_new = |(at, vertex): (usize, &VertexId)| !vertices[..at].contains(vertex);
    let [first, others @ ..] = vertices else {
        return Ok(None);
    };
    if others.is_empty() || !vertices.iter().enumerate().all(is_new) {
        return Ok(None);
    }
    let width = complex.width().min(4);
    for (cell, _) in cells_around(complex, *first)? {
        let corners = complex.corners(cell)?;
        if others.iter().all(|other| corners[..width].contains(other)) {
            return Ok(Some(cell));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_of_many_cells_has_each_once() {
        let mut set = CellSet::new();
        let cells = || (0..1000).map(|k| CellId::new(k * k % 1009));
        let new = cells().filter(|&cell| set.insert(cell)).count();
        assert_eq!(new, 505);
        assert!(cells().all(|cell| !set.insert(cell)));
        assert_eq!((set.len, set.slots.len()), (505, 1024));
    }
}
