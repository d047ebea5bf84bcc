//! A complex from the vertices of its cells alone: who is whose neighbor follows from the facets that they share.

use rustc_hash::{FxHashMap, FxHashSet};

use super::{CellId, Flaw, Links, Tds, VertexId};

/// What a complex is, but for the numbers of its cells.
pub(crate) struct Parts<V, C> {
    pub(crate) dimension: i32,
    /// `dimension + 1` for each cell, one cell after the other.
    pub(crate) cells: Vec<VertexId>,
    /// Of each cell.
    pub(crate) cell_data: Vec<C>,
    /// Of each number of a vertex, those without one included.
    pub(crate) vertex_data: Vec<V>,
    /// Numbers without a vertex, the next to be used last.
    pub(crate) free: Vec<VertexId>,
}

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// The payloads of all numbers of vertices.
    pub(crate) fn payloads(&self) -> &[V] {
        &self.vertex_data
    }

    /// Numbers without a vertex, the next to be used last.
    pub(crate) fn free_vertices(&self) -> &[VertexId] {
        &self.unused_vertices
    }

    /// Vertices that keep their number and are in no cell.
    pub(crate) fn detached_vertices(&self) -> Vec<VertexId> {
        let free: FxHashSet<VertexId> = self.unused_vertices.iter().copied().collect();
        let numbers = (0..self.vertex_slots()).map(VertexId::new);
        numbers.filter(|v| !self.is_vertex(*v) && !free.contains(v)).collect()
    }

    /// The complex, of which then the [links](Tds::check_links) are sound. What is in no cell and is not free counts as
    /// detached. The length of `cells` has to be that of `cell_data` times the width of a cell.
    ///
    /// # Errors
    /// A cell with a vertex that is not there or is there twice, or with a facet that is not in two cells; a free
    /// number that is not free, or told twice.
    ///
    /// # Complexity
    /// Linear.
    pub(crate) fn from_parts(parts: Parts<V, C>) -> Result<Self, Vec<Flaw>> {
        let Parts { dimension, cells, cell_data, vertex_data, free } = parts;
        let width = (dimension + 1) as usize;
        let mut tds =
            Tds { dimension, cell_data, vertex_cell: vec![CellId::NONE; vertex_data.len()], vertex_data, ..Tds::new() };
        tds.links = vec![Links::UNUSED; tds.cell_data.len()];
        let exists = |v: VertexId| v == VertexId::INFINITE || v.index() < tds.vertex_cell.len();
        for (k, vertices) in cells.chunks_exact(width.max(1)).enumerate() {
            if let Some(&v) = vertices.iter().find(|&&v| !exists(v)) {
                return Err(vec![Flaw::CellOfVertex(v)]);
            }
            tds.links[k].vertices[..width].copy_from_slice(vertices);
        }
        for k in 0..tds.links.len() {
            for i in 0..width {
                let vertex = tds.links[k].vertices[i];
                tds.set_cell_of(vertex, CellId::new(k));
            }
        }
        tds.link_by_facets(width)?;
        let mut told = FxHashSet::default();
        let is_free = |v: VertexId| v.index() < tds.vertex_slots() && !tds.is_vertex(v);
        if let Some(&wrong) = free.iter().find(|&&v| !is_free(v) || !told.insert(v)) {
            return Err(vec![Flaw::CellOfVertex(wrong)]);
        }
        tds.unused_vertices = free;
        tds.detached = tds.detached_vertices().len();
        let flaws = tds.check_links();
        if flaws.is_empty() { Ok(tds) } else { Err(flaws) }
    }

    /// Makes cells neighbors across each facet that they share, which have to be two.
    fn link_by_facets(&mut self, width: usize) -> Result<(), Vec<Flaw>> {
        // A facet by its vertices in order; once it has both cells, nothing is left of the first.
        let mut open: FxHashMap<[VertexId; N], Option<(CellId, usize)>> = FxHashMap::default();
        let mut waiting = 0;
        for cell in (0..self.links.len()).map(CellId::new) {
            for i in 0..width {
                let mut facet = self.links[cell.index()].vertices;
                facet[i] = VertexId::NONE;
                facet.sort_unstable();
                match open.insert(facet, Some((cell, i))) {
                    None => waiting += 1,
                    Some(Some((beside, j))) => {
                        self.link(cell, i, beside, j);
                        open.insert(facet, None);
                        waiting -= 1;
                    }
                    Some(None) => return Err(vec![Flaw::NotMutual(cell, i)]),
                }
            }
        }
        let alone = open.into_values().flatten().min().filter(|_| waiting > 0);
        alone.map_or(Ok(()), |(cell, i)| Err(vec![Flaw::NotMutual(cell, i)]))
    }
}
