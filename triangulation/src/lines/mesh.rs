//! The triangulation that lines are in, and positions in it.

use crate::engine::ConstrainedEdges;
use crate::geometry::Crossing;
use crate::num::unsigned_zero;
use crate::tds::VertexId;
use crate::triangulation::Triangulation;

/// The triangulation whose constraints are those of lines.
pub(super) type Mesh<G, V, C> = Triangulation<G, 3, V, ConstrainedEdges<C>>;

/// Returns the coordinates of a vertex; negative zeros become positive.
#[inline]
pub(super) fn position<G: Crossing, V, C: Copy + Default>(
    t: &Mesh<G, V, C>,
    vertex: VertexId,
) -> [f64; 2] {
    t.geometry.plan(t.point(vertex)).map(unsigned_zero)
}
