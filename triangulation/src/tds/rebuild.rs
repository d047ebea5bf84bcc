//! Restoring a saved complex: its cells without numbers and neighbors, and the numbers of its
//! vertices.

use rustc_hash::FxHashSet;

use super::{Tds, TdsError, VertexId};

/// A complex without the numbers of its cells.
pub(crate) struct Parts<V, C> {
    pub(crate) dimension: i32,
    /// `dimension + 1` vertices for each cell, one cell after the other.
    pub(crate) cells: Vec<VertexId>,
    /// The payload of each cell.
    pub(crate) cell_data: Vec<C>,
    /// A payload for each vertex number, including unused ones.
    pub(crate) vertex_data: Vec<V>,
    /// The unused vertex numbers; the last is used next.
    pub(crate) free: Vec<VertexId>,
}

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// The payloads of all vertex numbers, including unused ones.
    #[cfg(feature = "serde")]
    pub(crate) fn payloads(&self) -> &[V] {
        &self.vertex_data
    }

    /// The unused vertex numbers; the last is used next.
    #[cfg(feature = "serde")]
    pub(crate) fn free_vertices(&self) -> &[VertexId] {
        &self.unused_vertices
    }

    /// Returns the vertices that keep their number but are in no cell.
    pub(crate) fn detached_vertices(&self) -> Vec<VertexId> {
        let free: FxHashSet<VertexId> = self.unused_vertices.iter().copied().collect();
        let numbers = (0..self.vertex_slots()).map(VertexId::new);
        numbers
            .filter(|v| !self.is_vertex(*v) && !free.contains(v))
            .collect()
    }

    /// Returns the complex of these parts, with sound [links](Tds::check_links).
    ///
    /// A vertex that is in no cell and whose number is not free counts as detached. The length of
    /// `cells` must be that of `cell_data` times the width of a cell.
    ///
    /// # Errors
    /// If a cell has a vertex that does not exist, or twice the same one; if a facet is not in two
    /// cells; or if a free number is in use, or given twice.
    ///
    /// # Complexity
    /// Linear.
    pub(crate) fn from_parts(parts: Parts<V, C>) -> Result<Self, TdsError> {
        let Parts {
            dimension,
            cells,
            cell_data,
            vertex_data,
            free,
        } = parts;
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
