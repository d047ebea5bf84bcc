//! Cells replaced by others that are given by their vertices, in any dimension.

use rustc_hash::FxHashMap;

use super::{CellId, Links, Tds, VertexId, face_without};

/// A side of a facet: a cell outside, or the position of a new cell; and the index of the vertex
/// opposite.
#[derive(Clone, Copy)]
pub(crate) enum FacetSide {
    Outside(CellId, usize),
    New(usize, usize),
}

/// The facets of which one side is known: for the vertices of each, in order, that side.
type OpenFacets<const N: usize> = FxHashMap<[VertexId; N], FacetSide>;

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Replaces the cells around a vertex, each with the index of the vertex in it, by others that
    /// fill the same space. They are given by their vertices, `dimension + 1` of them, and get
    /// default payloads. Returns false, and changes nothing, if they have a different border.
    ///
    /// Expected time linear in the number of cells.
    pub(crate) fn replace_star(
        &mut self,
        star: &[(CellId, usize)],
        cells: &[[VertexId; N]],
    ) -> bool {
        let mut open = OpenFacets::default();
        for &(cell, i) in star {
            let beyond = self.neighbor(cell, i);
            let side = FacetSide::Outside(beyond, self.index_of_neighbor(beyond, cell));
            open.insert(face_without(self.links[cell.index()].vertices, i), side);
        }
        let Some(pairs) = self.paired(open, cells) else {
            return false;
        };
        self.refill_star(star, cells, &pairs);
        true
    }

    /// Replaces the cells around a vertex by others with the same border, given the two sides of
    /// each facet of these.
    pub(crate) fn refill_star(
        &mut self,
        star: &[(CellId, usize)],
        cells: &[[VertexId; N]],
        sides: &[[FacetSide; 2]],
    ) {
        for &(cell, _) in star {
            self.remove_cell(cell);
        }
        self.add_cells(cells, sides);
    }

    /// Replaces all cells by others of some dimension, given by their vertices. Vertices without a
    /// cell keep the one that they had. Returns false, and leaves the complex without cells, if
    /// they do not fit together.
    pub(crate) fn replace_all(&mut self, dimension: i32, cells: &[[VertexId; N]]) -> bool {
        self.links.clear();
        self.cell_data.clear();
        self.unused.clear();
        self.infinite_cell = CellId::NONE;
        self.dimension = dimension;
        let pairs = self.paired(OpenFacets::default(), cells);
        self.add_cells(cells, pairs.as_deref().unwrap_or_default());
        pairs.is_some()
    }

    /// Returns the two sides of each facet of new cells, given the facets of which the outer side
    /// is known; `None` if a facet does not have two sides.
    fn paired(
        &self,
        mut open: OpenFacets<N>,
        cells: &[[VertexId; N]],
    ) -> Option<Vec<[FacetSide; 2]>> {
        let width = (self.dimension + 1) as usize;
        let mut pairs = Vec::with_capacity(width * cells.len());
        for (at, &vertices) in cells.iter().enumerate() {
            for i in 0..width {
                let (key, side) = (face_without(vertices, i), FacetSide::New(at, i));
                match open.remove(&key) {
                    Some(other) => pairs.push([side, other]),
                    None => _ = open.insert(key, side),
                }
            }
        }
        open.is_empty().then_some(pairs)
    }

    /// Adds cells, and links them across these facets.
    fn add_cells(&mut self, cells: &[[VertexId; N]], pairs: &[[FacetSide; 2]]) {
        let width = (self.dimension + 1) as usize;
        let mut new = Vec::with_capacity(cells.len());
        for &vertices in cells {
            let cell = self.add_cell(Links::alone(vertices), C::default());
            vertices[..width]
                .iter()
                .for_each(|&vertex| self.set_cell_of(vertex, cell));
            new.push(cell);
        }
        for sides in pairs {
            let [(a, i), (b, j)] = sides.map(|side| match side {
                FacetSide::Outside(cell, i) => (cell, i),
                FacetSide::New(at, i) => (new[at], i),
            });
            self.link(a, i, b, j);
        }
    }
}
