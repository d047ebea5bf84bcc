use crate::geometry::Geometry;
use crate::tds::{CellId, VertexId};

use super::super::Triangulation;
use super::{Dice, Location};

/// A strategy to find where a point lies.
///
/// # Laws
/// - The answer is that of [`Triangulation::locate`]: the same vertex, or the same place relative to the complex; of the
///   cells that an edge or the outside of the hull is told by, any.
/// - What [`inserted`](Self::inserted) and [`removed`](Self::removed) have not been told changes the time only.
///
/// # Models
/// [`Near`], [`JumpAndWalk`], [`StraightLine`], [`Buckets`], [`Hierarchy`](super::Hierarchy). All take any kind of triangulation.
pub trait Locate<G: Geometry<N>, const N: usize> {
    /// Where a point lies, which the geometry must [admit](Geometry::admits).
    fn locate<V, C: Copy + Default>(&self, triangulation: &Triangulation<G, N, V, C>, q: &G::Point) -> Location;

    /// Learns of a new vertex of a triangulation with this geometry.
    fn inserted(&mut self, _geometry: &G, _vertex: VertexId, _point: &G::Point) {}

    /// Learns that a vertex is there no more.
    fn removed(&mut self, _vertex: VertexId) {}
}

/// From a cell nearby; or, without one, from where the last insertion was. What [`Triangulation::locate`] does.
#[derive(Debug, Clone, Copy, Default)]
pub struct Near(pub Option<CellId>);

impl<G: Geometry<N>, const N: usize> Locate<G, N> for Near {
    fn locate<V, C: Copy + Default>(&self, triangulation: &Triangulation<G, N, V, C>, q: &G::Point) -> Location {
        triangulation.locate(q, self.0)
    }
}

/// From the nearest of `n^(1/3)` of the `n` vertices, chosen as if at random; the same ones for the same number of vertices.
/// Takes a geometry that knows [distances](Geometry::rough_distance).
///
/// Of uniformly distributed points the walk takes `O(n^(1/3))` steps then (Mücke, Saias and Zhu 1996).
#[derive(Debug, Clone, Copy, Default)]
pub struct JumpAndWalk;

impl<G: Geometry<N>, const N: usize> Locate<G, N> for JumpAndWalk {
    fn locate<V, C: Copy + Default>(&self, triangulation: &Triangulation<G, N, V, C>, q: &G::Point) -> Location {
        let nearest = triangulation.nearest_of_some(q, f64::INFINITY, &mut Dice::default());
        triangulation.locate(q, nearest.and_then(|vertex| triangulation.tds.cell_of(vertex)))
    }
}
