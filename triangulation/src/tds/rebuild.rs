//! A complex that was saved: its cells without their numbers and neighbors, and the numbers of vertices.

use rustc_hash::FxHashSet;

use super::{Tds, TdsError, VertexId};

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
    /// number that is not free, or given twice.
    ///
    /// # Complexity
    /// Linear.
    pub(crate) fn from_parts(parts: Parts<V, C>) -> Result<Self, TdsError> {
        let Parts { dimension, cells, cell_data, vertex_data, free } = parts;
        let mut tds = Self::unlinked(dimension, cell_data, vertex_data, &cells)?;
        tds.link_by_facets()?;
        let mut named = FxHashSet::default();
        let is_free = |v: VertexId| v.index() < tds.vertex_slots() && !tds.is_vertex(v);
        if let Some(&wrong) = free.iter().find(|&&v| !is_free(v) || !named.insert(v)) {
            return Err(TdsError::CellOfVertex(wrong));
        }
        tds.unused_vertices = free;
        tds.detached = tds.detached_vertices().len();
        tds.check_links().into_iter().next().map_or(Ok(tds), Err)
    }
}
