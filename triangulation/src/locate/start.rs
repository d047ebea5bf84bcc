use crate::geometry::Geometry;
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

use super::Location;

/// A strategy to find where a point lies: a value that the caller owns and that may learn from
/// insertions and removals.
///
/// Optional: [`Triangulation::locate`] walks from the last insertion. Pass a strategy to
/// `insert_by` and `remove_by`, or call its [`locate`](Self::locate).
///
/// # Laws
/// - The answer is that of [`Triangulation::locate`]: the same vertex, or the same position
///   relative to the complex. If several cells share an edge that the point lies on, or see a point
///   outside of the hull, the answer may be any of them.
/// - A strategy that misses calls of [`inserted`](Self::inserted) and [`removed`](Self::removed) is
///   slower but still correct.
///
/// # Models
/// [`Near`], [`JumpAndWalk`], [`StraightLine`](super::StraightLine), [`Buckets`](super::Buckets),
/// [`Hierarchy`](crate::Hierarchy). All work with any kind of triangulation. A strategy of
/// your own chooses where a walk starts; here, where the last query ended:
///
/// ```
/// use std::cell::Cell;
/// use breakline_triangulation::geometry::{Geometry, Plane};
/// use breakline_triangulation::tds::CellId;
/// use breakline_triangulation::{Delaunay, Locate, Location, Triangulation};
///
/// #[derive(Default)]
/// struct LastAnswer(Cell<Option<CellId>>);
///
/// impl<G: Geometry<N>, const N: usize> Locate<G, N> for LastAnswer {
///     fn locate<V, C: Copy + Default>(&self, t: &Triangulation<G, N, V, C>, q: &G::Point) -> Location {
///         let location = t.locate(q, self.0.get()); // a cell that no longer exists does no harm
///         if let Location::Cell { cell, .. } = location {
///             self.0.set(Some(cell));
///         }
///         location
///     }
/// }
///
/// let points: Vec<[f64; 2]> = (0..100).map(|k| [k % 10, k / 10].map(f64::from)).collect();
/// let (t, v) = Delaunay::from_points(Plane::new(), &points)?;
/// let last = LastAnswer::default();
/// assert!(matches!(last.locate(&t, &[8.5, 8.25]), Location::Cell { facets, .. } if facets.is_empty()));
/// assert_eq!(last.locate(&t, &[8.0, 8.0]), Location::Vertex(v[88]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Locate<G: Geometry<N>, const N: usize> {
    /// Returns where a point lies; [`Location::Nowhere`] if the geometry does not
    /// [admit](Geometry::admits) it.
    fn locate<V, C: Copy + Default>(
        &self,
        triangulation: &Triangulation<G, N, V, C>,
        q: &G::Point,
    ) -> Location;

    /// Updates the strategy for a new vertex of a triangulation with this geometry.
    fn inserted(&mut self, _geometry: &G, _vertex: VertexId, _point: &G::Point) {}

    /// Updates the strategy for a removed vertex.
    fn removed(&mut self, _vertex: VertexId) {}
}

/// Starts at a cell, for example [that](crate::tds::Tds::cell_of) of a nearby vertex. With `None`,
/// or a cell that does not exist, starts where the last insertion ended. The strategy of
/// [`Triangulation::locate`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Near(pub Option<CellId>);

impl<G: Geometry<N>, const N: usize> Locate<G, N> for Near {
    fn locate<V, C: Copy + Default>(
        &self,
        triangulation: &Triangulation<G, N, V, C>,
        q: &G::Point,
    ) -> Location {
        triangulation.locate(q, self.0)
    }
}

/// Starts at the nearest of `n^(1/3)` of the `n` vertices, chosen pseudo-randomly; the same ones
/// for the same number of vertices. Needs a geometry that knows
/// [distances](Geometry::rough_distance).
///
/// For uniformly distributed points the walk then takes `O(n^(1/3))` steps (Mücke, Saias and Zhu
/// 1996).
#[derive(Debug, Clone, Copy, Default)]
pub struct JumpAndWalk;

impl<G: Geometry<N>, const N: usize> Locate<G, N> for JumpAndWalk {
    fn locate<V, C: Copy + Default>(
        &self,
        triangulation: &Triangulation<G, N, V, C>,
        q: &G::Point,
    ) -> Location {
        let nearest = triangulation.nearest_of_some(q);
        triangulation.locate(
            q,
            nearest.and_then(|vertex| triangulation.tds.cell_of(vertex)),
        )
    }
}
