//! Cells replaced by others that are given by their vertices, in any dimension.

use rustc_hash::FxHashMap;

use super::{CellId, Links, Tds, VertexId};

/// The facets that have one cell so far: for the vertices of each, in order, the cell and the index
/// of the vertex opposite.
type Open<const N: usize> = FxHashMap<[VertexId; N], (CellId, usize)>;

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Replaces the cells around a vertex, each with the index of the vertex in it, by others that
    /// fill the same space. They are given by their vertices, `dimension + 1` of them, and get
    /// default payloads.
    ///
    /// Expected time linear in the number of cells.
    pub(crate) fn replace_star(&mut self, star: &[(CellId, usize)], cells: &[[VertexId; N]]) {
        let mut open = Open::default();
        for &(cell, i) in star {
            let beyond = self.neighbor(cell, i);
            open.insert(self.facet_key(cell, i), (beyond, self.index_of_neighbor(beyond, cell)));
        }
        for &(cell, _) in star {
            self.remove_cell(cell);
        }
        self.add_cells(open, cells);
    }

    /// Replaces all cells by others of some dimension, given by their vertices. Vertices without a
    /// cell keep the one that they had.
    pub(crate) fn replace_all(&mut self, dimension: i32, cells: &[[VertexId; N]]) {
        self.links.clear();
        self.cell_data.clear();
        self.unused.clear();
        self.infinite_cell = CellId::NONE;
        self.dimension = dimension;
        self.add_cells(Open::default(), cells);
    }

    fn add_cells(&mut self, mut open: Open<N>, cells: &[[VertexId; N]]) {
        let width = (self.dimension + 1) as usize;
        for &vertices in cells {
            let cell = self.add_cell(Links::alone(vertices), C::default());
            for (i, &vertex) in vertices[..width].iter().enumerate() {
                self.set_cell_of(vertex, cell);
                let key = self.facet_key(cell, i);
                match open.remove(&key) {
                    Some((other, j)) => self.link(cell, i, other, j),
                    None => _ = open.insert(key, (cell, i)),
                }
            }
        }
        debug_assert!(open.is_empty(), "the new cells do not fit");
    }

    /// Returns the vertices of a facet, in order, for finding the other cell that has it.
    fn facet_key(&self, cell: CellId, i: usize) -> [VertexId; N] {
        let mut key = self.links[cell.index()].vertices;
        key[i] = VertexId::NONE;
        key.sort_unstable();
        key
    }
}
