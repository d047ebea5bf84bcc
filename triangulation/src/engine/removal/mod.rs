//! What the kinds need for removals, in the plane and in space.

mod low_degree;
mod plane;
mod space;
mod wrap;

use crate::geometry::Geometry;
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

use super::flip::NoConstraints;

/// A triangulation without constraints from which vertices can be removed: one of the plane or of
/// space.
pub trait Removal {
    /// Removes a vertex, and restores the law of the geometry's
    /// [`side_of_sphere`](Geometry::side_of_sphere). Returns true if all cells may have been
    /// replaced.
    fn remove_and_restore(&mut self, vertex: VertexId) -> bool;

    /// Returns the cells around a vertex.
    fn star(&self, vertex: VertexId) -> Vec<CellId>;
}

impl<G: Geometry<3>, V, C: Copy + Default> Removal for Triangulation<G, 3, V, C> {
    fn remove_and_restore(&mut self, vertex: VertexId) -> bool {
        let dimension = self.dimension();
        self.remove_vertex(NoConstraints, vertex);
        self.dimension() < dimension
    }

    fn star(&self, vertex: VertexId) -> Vec<CellId> {
        self.tds.around(vertex).collect()
    }
}

impl<G: Geometry<4>, V, C: Copy + Default> Removal for Triangulation<G, 4, V, C> {
    fn remove_and_restore(&mut self, vertex: VertexId) -> bool {
        self.remove_vertex_in_space(vertex)
    }

    fn star(&self, vertex: VertexId) -> Vec<CellId> {
        self.tds
            .cells_around(vertex)
            .into_iter()
            .map(|(cell, _)| cell)
            .collect()
    }
}
