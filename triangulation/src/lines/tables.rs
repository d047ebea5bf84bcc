//! What is stored of lines.

use std::sync::OnceLock;

use crate::engine::trace::TraceBuffers;
use crate::geometry::Crossing;
use crate::tds::VertexId;

use super::chains::{Chains, undirected};
use super::index::{Index, NotLocal};
use super::mesh::Mesh;
use super::on_crossing::Rounding;
use super::vertex_set::VertexSet;

/// The lines of a triangulation: the owner of its constraints.
///
/// # Invariants
/// [`check`](Self::check) tests these:
/// - the chain of each segment consists of constrained edges, and the tables name nothing else;
/// - vertices that were added for crossings are on constraints, and no line was given by them;
/// - owned vertices are named by lines;
/// - segments wait for triangles only while there are none.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lines {
    pub(super) chains: Chains,
    /// Segments among collinear points, which no triangle can hold yet.
    pub(super) waiting: Vec<[VertexId; 2]>,
    /// Vertices added where segments cross.
    pub(super) added: VertexSet,
    /// The vertices in `added` as a list, once it was asked for.
    pub(super) added_list: OnceLock<Vec<VertexId>>,
    /// Vertices owned by lines, removed with the last of them.
    pub(super) owned: VertexSet,
    /// Computed on first use; removed by changes that do not update it.
    pub(super) index: OnceLock<Index>,
    /// How many times all lines were arranged anew.
    pub(super) rearrangements: usize,
    /// Sub-constraints that could not be inserted completely, because others block them.
    pub(super) missing: Vec<[VertexId; 2]>,
    /// How the crossings were rounded, if there are any.
    pub(super) rounding: Option<Rounding>,
    /// True if sub-constraints crossed after they had been arranged, which is possible off the grid
    /// only, and were arranged again.
    pub(super) recrossed: bool,
    /// True if constrained edges may belong to no line: those of the hull of a refined mesh.
    pub(super) has_stray_edges: bool,
    pub(super) buffers: TraceBuffers,
}

impl Lines {
    /// Records that a vertex splits an edge: a sub-constraint, or a part of one.
    pub(crate) fn split_edge(&mut self, a: VertexId, b: VertexId, at: VertexId) {
        if let Some(index) = self.index.get_mut() {
            index.split(&self.chains, undirected(a, b), at);
        }
        self.chains.split(a, b, at);
    }

    /// Reserves memory for this many more splits.
    pub(crate) fn reserve_splits(&mut self, splits: usize) {
        self.chains.splits.reserve(splits);
    }

    /// Records that constrained edges may belong to no line.
    pub(crate) fn expect_stray_edges(&mut self) {
        self.has_stray_edges = true;
    }

    /// Forgets splits of constrained edges that belong to no line.
    ///
    /// `PERF:` all splits are copied, so that this is done only if there can be such edges.
    pub(crate) fn drop_stray_splits(&mut self) {
        if self.has_stray_edges {
            self.chains.drop_stray_splits();
        }
    }

    /// Returns the vertices added where segments cross, in order.
    pub(crate) fn added(&self) -> &[VertexId] {
        self.added_list.get_or_init(|| self.added.iter().collect())
    }

    /// Returns how many triangles all insertions of sub-constraints have met.
    #[cfg(test)]
    pub(crate) fn met(&self) -> usize {
        self.buffers.met
    }

    /// Discards what was derived from the set of added vertices.
    pub(super) fn touch(&mut self) {
        self.added_list.take();
    }

    /// Returns the index. The first call takes linear time.
    pub(super) fn index(&self) -> &Index {
        self.index.get_or_init(|| Index::of(&self.chains))
    }

    /// Returns the index, mutable, with its grid.
    ///
    /// # Errors
    /// If edits cannot be local.
    pub(super) fn measured<G: Crossing, V, C: Copy + Default>(
        &mut self,
        t: &Mesh<G, V, C>,
    ) -> Result<&mut Index, NotLocal> {
        if !self.index().is_measured {
            let mut index = self.index.take().ok_or(NotLocal)?;
            index.measure(&self.chains, self.rounding, t);
            if self.recrossed {
                index.rounder = None;
            }
            self.index = OnceLock::from(index);
        }
        self.index
            .get_mut()
            .filter(|index| index.rounder.is_some())
            .ok_or(NotLocal)
    }

    /// Returns the index, if it exists, and the tables.
    pub(super) fn index_and_chains(&mut self) -> (Option<&mut Index>, &mut Chains) {
        (self.index.get_mut(), &mut self.chains)
    }
}
