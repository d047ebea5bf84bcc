//! Combinatorics: vertices, cells and their neighbors, without coordinates.
//!
//! These conventions hold everywhere:
//! - A triangulation is stored as a *sphere*: besides the finite vertices there is one
//!   [`INFINITE`](VertexId::INFINITE) vertex, joined to the hull. So every cell has all its
//!   neighbors, and the hull needs no special case. Other closed manifolds need no infinite vertex.
//! - A full-dimensional cell has `N` vertices: 3 for triangles, 4 for tetrahedra. Neighbor `i` lies
//!   opposite vertex `i`.
//! - All cells are oriented alike: as the geometry sees them, those without the infinite vertex are
//!   counter-clockwise.
//! - Before the points span the space, the complex has a lower [dimension](Tds::dimension): -1 (no
//!   point), 0 (one), 1 (collinear), 2 (coplanar). Its cells then have `dimension + 1` vertices, in
//!   the low slots of the same arrays.
//!
//! ```text
//!                 2
//!                / \
//!   neighbor 1  /   \  neighbor 0
//!              /     \
//!             0-------1
//!             neighbor 2
//! ```
//!
//! | to find | use |
//! |---|---|
//! | the corners and neighbors of a cell | [`Tds::cell_vertices`], [`Tds::cell_neighbors`] |
//! | one corner, or one neighbor | [`Tds::vertex`], [`Tds::neighbor`] |
//! | the index of a cell in its neighbor | [`Tds::index_of_neighbor`] |
//! | all vertices | [`Tds::vertices`] |
//! | all cells, with or without the infinite ones | [`Tds::cells`], [`Tds::is_infinite`] |
//! | the faces, edges and vertices around a vertex, in the plane | [`Tds::around`], [`Tds::edges_around`], [`Tds::vertices_around`] |
//! | all edges, or one by its ends | [`Tds::edges`], [`Tds::finite_edges`], [`Tds::edge`] |
//! | all facets, in space | [`Tds::facets`], [`Tds::finite_facets`] |
//! | the cells around a vertex or an edge, in space | [`Tds::cells_around`], [`Tds::cells_around_edge`] |
//! | a cell with two, three or four given vertices, in space | [`Tds::cell_with`] |
//! | the convex hull | [`Tds::hull`]; in space [`Tds::hull_facets`] |
//! | data that you keep on edges | [`EdgeMap`] |
//! | the same for any storage of links | [`Complex`]; [`plane`], [`space`], [`Neighbors`] |
//!
//! | to build or edit | use |
//! |---|---|
//! | a complex of your own | [`Tds::from_cells`] |
//! | a split, and its inverse | [`Tds::split_cell`], [`Tds::split_facet`], [`Tds::split_edge`]; [`Tds::unsplit_cell`] |
//! | a flip of a facet or edge, a collapse, the star of a hole | [`Tds::flip`], [`Tds::flip_edge`], [`Tds::collapse`], [`Tds::star_hole`] |
//! | a check that it is a manifold, or a sphere | [`Tds::check_links`], [`Tds::check_manifold`], [`Tds::check_sphere`] |
//!
//! Removing cells and vertices leaves gaps in the numbers, which the next ones fill: an array
//! indexed by vertex has [`Tds::vertex_slots`] entries, one indexed by cell [`Tds::cell_slots`].
//! Numbers fit 32 bits: there are at most 2^32 - 3 cells. Passing the number of a vertex or cell
//! that does not exist panics, like an index out of bounds.
//!
//! A complex that stands alone is any closed manifold, built and edited by calls that check. The
//! [kinds of triangulations](crate#reexports) contain one that is a sphere, with read access only.

mod build;
mod check;
mod complex;
mod counted;
mod edge_map;
mod edit;
mod error;
mod id;
mod neighbors;
mod numbers;
pub mod plane;
mod raise;
mod rebuild;
mod refill;
mod remove;
mod ridges;
pub mod space;
mod zone;

pub use complex::Complex;
pub(crate) use complex::vertices_of;
pub use edge_map::EdgeMap;
pub use error::{EditError, TdsError};
pub use id::{CellId, CellTag, Id, VertexId, VertexTag};
pub use neighbors::Neighbors;
pub use numbers::{Cells, FiniteCells, Vertices};
pub(crate) use plane::Star;
pub(crate) use rebuild::Parts;
pub(crate) use refill::FacetSide;
pub(crate) use zone::Zone;

/// The vertices and neighbors of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Links<const N: usize> {
    pub(crate) vertices: [VertexId; N],
    pub(crate) neighbors: [CellId; N],
}

impl<const N: usize> Links<N> {
    pub(crate) const UNUSED: Self = Links::alone([VertexId::NONE; N]);

    /// Returns the links of a cell without neighbors.
    const fn alone(vertices: [VertexId; N]) -> Self {
        Links {
            vertices,
            neighbors: [CellId::NONE; N],
        }
    }
}

/// A closed manifold of cells with up to `N` vertices each, with payload `V` at each vertex and `C`
/// at each cell (`()` takes no memory).
#[derive(Debug, Clone)]
pub struct Tds<const N: usize, V = (), C = ()> {
    dimension: i32,
    links: Vec<Links<N>>,
    cell_data: Vec<C>,
    /// The numbers of removed cells, reused from the end.
    unused: Vec<CellId>,
    /// A cell of each finite vertex; `NONE` where the number is unused.
    vertex_cell: Vec<CellId>,
    vertex_data: Vec<V>,
    /// The numbers of removed vertices, reused from the end.
    unused_vertices: Vec<VertexId>,
    /// The number of vertices that keep their number but are in no cell.
    detached: usize,
    infinite_cell: CellId,
}

impl<const N: usize, V, C: Copy + Default> Default for Tds<N, V, C> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Returns the complex of the infinite vertex alone, of dimension -1.
    pub fn new() -> Self {
        Tds {
            dimension: -1,
            links: Vec::new(),
            cell_data: Vec::new(),
            unused: Vec::new(),
            vertex_cell: Vec::new(),
            vertex_data: Vec::new(),
            unused_vertices: Vec::new(),
            detached: 0,
            infinite_cell: CellId::NONE,
        }
    }

    /// Returns a full-dimensional complex, given its cells and a cell of each vertex. Vertices are
    /// numbered from 0, and all numbers are used.
    pub(crate) fn from_links(
        links: Vec<Links<N>>,
        vertex_cell: Vec<CellId>,
        infinite_cell: CellId,
    ) -> Self
    where
        V: Default,
    {
        let mut vertex_data = Vec::new();
        vertex_data.resize_with(vertex_cell.len(), V::default);
        Tds {
            dimension: N as i32 - 1,
            cell_data: vec![C::default(); links.len()],
            links,
            unused: Vec::new(),
            detached: vertex_cell
                .iter()
                .filter(|cell| **cell == CellId::NONE)
                .count(),
            vertex_cell,
            vertex_data,
            unused_vertices: Vec::new(),
            infinite_cell,
        }
    }

    /// Returns the same complex with these vertex payloads, in order of the vertices' numbers.
    pub(crate) fn with_vertex_data<W>(self, vertex_data: Vec<W>) -> Tds<N, W, C> {
        assert_eq!(vertex_data.len(), self.vertex_cell.len());
        Tds {
            dimension: self.dimension,
            links: self.links,
            cell_data: self.cell_data,
            unused: self.unused,
            vertex_cell: self.vertex_cell,
            vertex_data,
            unused_vertices: self.unused_vertices,
            detached: self.detached,
            infinite_cell: self.infinite_cell,
        }
    }

    /// Returns the same complex with new cell payloads: calls `data` for each cell, in order of
    /// their numbers. Linear time.
    pub fn with_cell_data<D: Copy + Default>(
        self,
        mut data: impl FnMut(CellId) -> D,
    ) -> Tds<N, V, D> {
        self.map_cell_data(|cell, _| data(cell))
    }

    /// Returns the same complex with new cell payloads: calls `data` with each cell and its old
    /// payload, in order of the cells' numbers.
    pub(crate) fn map_cell_data<D: Copy + Default>(
        self,
        mut data: impl FnMut(CellId, &C) -> D,
    ) -> Tds<N, V, D> {
        let mut cell_data = vec![D::default(); self.links.len()];
        for cell in self.cells() {
            cell_data[cell.index()] = data(cell, self.cell_data(cell));
        }
        Tds {
            dimension: self.dimension,
            links: self.links,
            cell_data,
            unused: self.unused,
            vertex_cell: self.vertex_cell,
            vertex_data: self.vertex_data,
            unused_vertices: self.unused_vertices,
            detached: self.detached,
            infinite_cell: self.infinite_cell,
        }
    }

    /// Reserves memory for this many more vertices and the cells that come with them.
    pub fn reserve(&mut self, vertices: usize) {
        // In the plane there are two triangles per vertex; in space about 6.7 tetrahedra.
        let cells = if N == 3 { 2 * vertices } else { 7 * vertices };
        self.links.reserve_exact(cells);
        self.cell_data.reserve_exact(cells);
        self.vertex_cell.reserve_exact(vertices);
        self.vertex_data.reserve_exact(vertices);
    }

    /// The dimension of the complex: -1 without a vertex, `N - 1` when full.
    #[inline]
    pub fn dimension(&self) -> i32 {
        self.dimension
    }

    /// The number of finite vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertex_cell.len() - self.unused_vertices.len() - self.detached
    }

    /// One more than the largest vertex number so far: an upper bound for indices. There are
    /// gaps once vertices have been removed.
    #[inline]
    pub fn vertex_slots(&self) -> usize {
        self.vertex_cell.len()
    }

    /// The number of cells, the infinite ones included.
    pub fn cell_count(&self) -> usize {
        self.links.len() - self.unused.len()
    }

    /// One more than the largest number of a cell so far: an upper bound for indices. There may be
    /// gaps.
    #[inline]
    pub fn cell_slots(&self) -> usize {
        self.links.len()
    }

    /// The finite vertices with their payloads, mutable, in order of their numbers.
    pub fn vertex_data_iter_mut(&mut self) -> impl Iterator<Item = (VertexId, &mut V)> {
        let slots = self
            .vertex_cell
            .iter()
            .zip(&mut self.vertex_data)
            .enumerate();
        slots
            .filter(|(_, (cell, _))| **cell != CellId::NONE)
            .map(|(i, (_, data))| (VertexId::new(i), data))
    }

    /// All cells with their payloads, mutable, the infinite ones included, in order of their
    /// numbers.
    pub fn cell_data_iter_mut(&mut self) -> impl Iterator<Item = (CellId, &mut C)> {
        let slots = self.links.iter().zip(&mut self.cell_data).enumerate();
        slots
            .filter(|(_, (links, _))| links.vertices[0] != VertexId::NONE)
            .map(|(i, (_, data))| (CellId::new(i), data))
    }

    /// Returns true if this is the number of a finite vertex. Accepts any number.
    #[inline]
    pub fn is_vertex(&self, vertex: VertexId) -> bool {
        self.vertex_cell
            .get(vertex.index())
            .is_some_and(|&cell| cell != CellId::NONE)
    }

    /// Returns true if this is the number of a cell. Accepts any number.
    #[inline]
    pub fn is_used(&self, cell: CellId) -> bool {
        self.links
            .get(cell.index())
            .is_some_and(|links| links.vertices[0] != VertexId::NONE)
    }

    /// The vertices of a cell: `dimension + 1` of them.
    #[inline]
    pub fn cell_vertices(&self, cell: CellId) -> &[VertexId] {
        &self.links[cell.index()].vertices[..(self.dimension + 1) as usize]
    }

    /// The neighbors of a cell, each opposite the vertex of the same index.
    #[inline]
    pub fn cell_neighbors(&self, cell: CellId) -> &[CellId] {
        &self.links[cell.index()].neighbors[..(self.dimension + 1) as usize]
    }

    /// The `N` vertices of a cell of a full-dimensional complex.
    #[inline(always)]
    pub fn corners(&self, cell: CellId) -> &[VertexId; N] {
        &self.links[cell.index()].vertices
    }

    /// Returns vertex `i` of a cell.
    #[inline(always)]
    pub fn vertex(&self, cell: CellId, i: usize) -> VertexId {
        self.links[cell.index()].vertices[i]
    }

    /// Returns the neighbor opposite vertex `i` of a cell.
    #[inline(always)]
    pub fn neighbor(&self, cell: CellId, i: usize) -> CellId {
        self.links[cell.index()].neighbors[i]
    }

    /// Returns the index of a vertex in a cell, or `None` if the cell does not have it.
    #[inline(always)]
    pub fn index_of(&self, cell: CellId, vertex: VertexId) -> Option<usize> {
        let i = first_of(&self.links[cell.index()].vertices, vertex);
        (i < N).then_some(i)
    }

    /// Returns the index of the facet that `cell` shares with its neighbor `other`.
    ///
    /// In a triangulation two cells share at most one facet. For cells that share none, the result
    /// is a valid index without meaning.
    #[inline(always)]
    pub fn index_of_neighbor(&self, cell: CellId, other: CellId) -> usize {
        // Always a valid index, so that it need not be checked later.
        first_of(&self.links[cell.index()].neighbors, other).min(N - 1)
    }

    /// Returns true if the infinite vertex is a corner of the cell.
    #[inline(always)]
    pub fn is_infinite(&self, cell: CellId) -> bool {
        self.links[cell.index()]
            .vertices
            .contains(&VertexId::INFINITE)
    }

    /// Returns a cell that has this vertex; `None` for the infinite vertex of an empty complex, and
    /// for an unused number.
    #[inline]
    pub fn cell_of(&self, vertex: VertexId) -> Option<CellId> {
        let cell = if vertex == VertexId::INFINITE {
            self.infinite_cell
        } else {
            *self.vertex_cell.get(vertex.index())?
        };
        (cell != CellId::NONE).then_some(cell)
    }

    /// The payload of a cell.
    #[inline(always)]
    pub fn cell_data(&self, cell: CellId) -> &C {
        &self.cell_data[cell.index()]
    }

    /// The payload of a cell, for changing it.
    #[inline(always)]
    pub fn cell_data_mut(&mut self, cell: CellId) -> &mut C {
        &mut self.cell_data[cell.index()]
    }

    /// The payload of a finite vertex.
    pub fn vertex_data(&self, vertex: VertexId) -> &V {
        &self.vertex_data[vertex.index()]
    }

    /// The payload of a finite vertex, for changing it.
    pub fn vertex_data_mut(&mut self, vertex: VertexId) -> &mut V {
        &mut self.vertex_data[vertex.index()]
    }

    /// Adds a vertex that is in no cell yet, and returns it.
    pub(crate) fn add_vertex(&mut self, data: V) -> VertexId {
        if let Some(vertex) = self.unused_vertices.pop() {
            self.vertex_data[vertex.index()] = data;
            return vertex;
        }
        self.vertex_cell.push(CellId::NONE);
        self.vertex_data.push(data);
        VertexId::new(self.vertex_cell.len() - 1)
    }

    /// Records that a vertex, which keeps its number, is in no cell.
    pub(crate) fn detach(&mut self, vertex: VertexId) {
        self.vertex_cell[vertex.index()] = CellId::NONE;
        self.detached += 1;
    }

    /// Records that a detached vertex is about to get cells, or that it is about to be removed.
    pub(crate) fn attach(&mut self) {
        self.detached -= 1;
    }

    /// Adds a cell and returns it. Its neighbors are not linked to it yet.
    #[inline(always)]
    fn add_cell(&mut self, links: Links<N>, data: C) -> CellId {
        match self.unused.pop() {
            Some(cell) => {
                self.links[cell.index()] = links;
                self.cell_data[cell.index()] = data;
                cell
            }
            None => {
                self.links.push(links);
                self.cell_data.push(data);
                CellId::new(self.links.len() - 1)
            }
        }
    }

    /// Frees the number of a cell that is no neighbor of another one any more.
    #[inline]
    pub(crate) fn remove_cell(&mut self, cell: CellId) {
        self.links[cell.index()] = Links::UNUSED;
        self.unused.push(cell);
    }

    /// Makes two cells neighbors across the facets opposite their vertices `i` and `j`.
    #[inline(always)]
    pub(crate) fn link(&mut self, a: CellId, i: usize, b: CellId, j: usize) {
        self.links[a.index()].neighbors[i] = b;
        self.links[b.index()].neighbors[j] = a;
    }

    /// Replaces the vertices of a cell, and makes it the cell of each of them.
    #[inline]
    pub(crate) fn set_corners(&mut self, cell: CellId, vertices: [VertexId; N]) {
        self.links[cell.index()].vertices = vertices;
        for vertex in vertices {
            self.set_cell_of(vertex, cell);
        }
    }

    #[inline(always)]
    fn set_cell_of(&mut self, vertex: VertexId, cell: CellId) {
        if vertex == VertexId::INFINITE {
            self.infinite_cell = cell;
        } else {
            self.vertex_cell[vertex.index()] = cell;
        }
    }
}

/// Returns the position of an item in a list, or `N` if it is not in the list.
///
/// `PERF:` without branches, which would be unpredictable.
#[inline(always)]
fn first_of<T: PartialEq, const N: usize>(list: &[T; N], item: T) -> usize {
    (0..N)
        .rev()
        .fold(N, |found, i| if list[i] == item { i } else { found })
}

/// Returns the vertices of a face but the one at index `i`, in order of their numbers: a key that
/// is the same for all cells around that smaller face.
fn face_without<const N: usize>(mut face: [VertexId; N], i: usize) -> [VertexId; N] {
    face[i] = VertexId::NONE;
    face.sort_unstable();
    face
}

/// Returns the next corner of a triangle, counter-clockwise.
///
/// `PERF:` a remainder takes twice as many instructions.
#[inline(always)]
pub const fn ccw(i: usize) -> usize {
    if i < 2 { i + 1 } else { 0 }
}

/// Returns the next corner of a triangle, clockwise.
#[inline(always)]
pub const fn cw(i: usize) -> usize {
    let before = i.wrapping_sub(1);
    if before < 2 { before } else { 2 }
}
