//! The cells and vertices of a mesh.

/// Four vertices and the four neighbors opposite to them. A neighbor is `4 cell + face`, where
/// `face` is the index in the neighbor of the vertex opposite the shared facet. The vertices are
/// positively oriented, those of infinite cells as if the infinite vertex were beyond the hull.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub(super) neighbors: [u32; 4],
    pub(super) vertices: [u32; 4],
}

impl Cell {
    /// A cell that is not in use.
    pub(super) const UNUSED: Self = Cell {
        neighbors: [DUMMY; 4],
        vertices: [u32::MAX; 4],
    };

    pub(super) fn is_used(&self) -> bool {
        self.vertices[0] != u32::MAX
    }
}

/// The vertices of each facet of a cell, in the order that makes the facet and the vertex opposite
/// to it a positive cell.
pub(super) const FACETS: [[usize; 3]; 4] = [[2, 1, 3], [0, 2, 3], [1, 0, 3], [0, 1, 2]];

/// A cell that receives the writes of lanes that are not chosen.
pub(super) const DUMMY: u32 = 0;

/// A vertex.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) site: [f64; 3],
    /// The number in the star that was built last with this vertex, above a base that grows.
    pub(super) tag: u32,
}
